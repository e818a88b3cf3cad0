//! The cache: what is kept, what is made again, what is removed.

use std::fs;

use super::*;
use crate::output::target::tests::TestFolder;

#[test]
fn only_what_is_missing_is_made() {
    let folder = TestFolder::new("reference-cache");
    let cache = Cache::at(folder.0.join("made/when/needed"));
    let maker = Maker::new();
    let made = || maker.made.borrow_mut().drain(..).count();
    assert_eq!(maker.make(32, Some(&cache)).spp(), 32);
    assert_eq!(made(), 4);
    assert_eq!(maker.make(100, Some(&cache)).spp(), 112);
    assert_eq!(made(), 10);
    assert_eq!(maker.make(16, Some(&cache)).spp(), 112, "more samples than asked for are used as they are");
    assert_eq!(made(), 0);
    let mut steps = Vec::new();
    maker
        .work()
        .make(144.into(), Some(&cache), &mut |progress| steps.push((progress.done, progress.total)))
        .expect("made");
    assert_eq!(steps, [(0, 2), (1, 2), (2, 2)]);
}

#[test]
fn it_lists_and_clears_and_leaves_other_files_alone() {
    let folder = TestFolder::new("reference-list");
    let cache = Cache::at(&folder.0);
    assert!(cache.list().is_empty());
    let makers = [0, 1].map(|seed| Maker::of(&ReferenceRequest { seed, ..request([5, 3]) }));
    for maker in &makers {
        maker.make(16, Some(&cache));
    }
    let other = folder.0.join("notes.txt");
    fs::write(&other, "mine").expect("writable");
    let keys = || cache.list().into_iter().map(|entry| entry.content.expect("sound").key).collect::<Vec<_>>();
    assert_eq!(keys().len(), 2);
    let entry = &cache.list()[0];
    let name = entry.path.file_name().expect("a name").to_string_lossy().into_owned();
    assert!(name.starts_with("a_plane-5x3-"), "{name}");
    let content = entry.content.as_ref().expect("sound");
    assert_eq!((content.scene.as_str(), content.size.as_str(), content.spp), ("a plane", "5x3", 16));
    assert!(content.noise > 0.0 && entry.bytes > 0);

    let unknown = cache.clear(Some("0123")).expect_err("no such key").to_string();
    assert!(unknown.contains("0123"), "{unknown}");
    let first = makers[0].about.key.as_str();
    assert_eq!(cache.clear(Some(&first[..8])).expect("removed").len(), 1);
    assert_eq!(keys(), [makers[1].about.key.clone()]);
    assert_eq!(cache.clear(None).expect("removed").len(), 1);
    assert!(cache.list().is_empty() && other.exists());
}

#[test]
fn a_damaged_file_is_listed_as_such_and_made_anew() {
    let folder = TestFolder::new("reference-cache-damaged");
    let cache = Cache::at(&folder.0);
    let maker = Maker::of(&request([5, 3]));
    let expected = bits(&maker.make(48, Some(&cache)));
    let path = cache.find(&maker.about.key).expect("cached");
    let bytes = fs::read(&path).expect("written");
    fs::write(&path, &bytes[..bytes.len() / 2]).expect("writable");
    assert!(bits(&maker.make(48, Some(&cache))) == expected);
    assert!(bits(&cache.read(&maker.about.key).expect("whole again")) == expected);
    fs::write(&path, &bytes[..20]).expect("writable");
    assert!(cache.list()[0].content.is_err());
    assert_eq!(cache.clear(None).expect("removed").len(), 1);
}

#[test]
fn without_a_place_to_write_the_reference_is_made_all_the_same() {
    let folder = TestFolder::new("reference-cache-file");
    let file = folder.0.join("a file, no folder");
    fs::write(&file, "").expect("writable");
    let cache = Cache::at(file.join("cache"));
    assert_eq!(Maker::of(&request([5, 3])).make(16, Some(&cache)).spp(), 16);
}

#[test]
fn merged_shards_do_not_replace_more_samples() {
    let folder = TestFolder::new("reference-keep");
    let cache = Cache::at(&folder.0);
    let maker = Maker::of(&request([5, 3]));
    let (few, many) = (maker.make(16, None), maker.make(64, None));
    for file in [&many, &few] {
        cache.keep(file).expect("kept");
        assert_eq!(cache.read(&maker.about.key).expect("cached").spp(), 64);
    }
}

#[test]
fn who_reads_while_others_write_finds_a_whole_file() {
    let folder = TestFolder::new("reference-concurrent");
    let cache = Cache::at(&folder.0);
    let maker = Maker::of(&request([5, 3]));
    let files = [16, 48].map(|spp| maker.make(spp, None));
    cache.keep(&files[0]).expect("written");
    std::thread::scope(|scope| {
        for file in &files {
            scope.spawn(|| (0..20).for_each(|_| drop(cache.keep(file).expect("written"))));
        }
        for _ in 0..20 {
            let path = cache.find(&maker.about.key).expect("always there");
            let read = ReferenceFile::read(&path).expect("whole");
            assert!(files.iter().any(|file| file.state == read.state));
        }
    });
    assert_eq!(cache.list().len(), 1);
    assert_eq!(folder.names().iter().filter(|name| *name != ".lock").count(), 1, "nothing is left over");
}

/// Names the cache that a second process of the test below writes to.
const SECOND_PROCESS: &str = "IRRADIA_TEST_SECOND_PROCESS";

#[test]
fn of_two_processes_the_one_with_more_samples_has_its_way() {
    let maker = Maker::of(&request([5, 3]));
    let keep_up_to = |cache: &Cache, most: u32| {
        for spp in (16..=most).step_by(16) {
            cache.keep(&maker.make(spp, None)).expect("kept");
            let found = cache.read(&maker.about.key).expect("cached").spp();
            assert!(found >= spp, "{spp} samples were kept, {found} are there");
        }
    };
    if let Some(folder) = std::env::var_os(SECOND_PROCESS) {
        // It goes on when the first one is done.
        return (0..4).for_each(|_| keep_up_to(&Cache::at(&folder), 256));
    }
    let folder = TestFolder::new("reference-two-processes");
    let cache = Cache::at(&folder.0);
    let name = "reference::tests::cache::of_two_processes_the_one_with_more_samples_has_its_way";
    let mut second = std::process::Command::new(std::env::current_exe().expect("this test"))
        .args(["--exact", name, "--nocapture"])
        .env(SECOND_PROCESS, &folder.0)
        .spawn()
        .expect("this test starts again");
    keep_up_to(&cache, 320);
    assert!(second.wait().expect("it runs").success());
    assert_eq!(cache.read(&maker.about.key).expect("cached").spp(), 320);
}
