//! The set of samples decides every bit: not who made them, nor when, nor in which order.

use std::path::PathBuf;

use super::*;
use crate::output::target::tests::TestFolder;

const SPP: u32 = 16 * 21;

fn shards(folder: &TestFolder, maker: &Maker, count: u32) -> Vec<PathBuf> {
    let shard = |index| {
        let path = folder.0.join(format!("{index}-{count}.exr"));
        maker.work().make_shard(SPP, Shard { index, count }, &path, &mut |_| ()).expect("made");
        path
    };
    (1..=count).map(shard).collect()
}

#[test]
fn resuming_shards_and_merging_give_the_same_bits() {
    let folder = TestFolder::new("reference-merging");
    let maker = Maker::new();
    let whole = maker.make(SPP, None);
    let expected = bits(&whole);

    let cache = Cache::at(folder.0.join("cache"));
    for spp in [16, 48, 49, 176, SPP] {
        maker.make(spp, Some(&cache));
    }
    let resumed = cache.read(&maker.about.key).expect("cached");
    assert_eq!((resumed.spp(), bits(&resumed) == expected), (SPP, true));

    for count in [1, 2, 3, 5] {
        let mut paths = shards(&folder, &maker, count);
        for _ in 0..count {
            paths.rotate_left(1);
            let merged = merge(&paths).expect("complete");
            assert!(bits(&merged) == expected, "{paths:?}");
            assert_eq!(merged.state, whole.state);
        }
        paths.reverse();
        assert!(bits(&merge(&paths).expect("complete")) == expected, "{paths:?}");
    }
}

#[test]
fn an_interrupted_shard_goes_on_where_it_was() {
    let folder = TestFolder::new("reference-interrupted");
    let path = folder.0.join("a.exr");
    let shard = Shard { index: 2, count: 2 };
    let mut maker = Maker::new();
    maker.work().make_shard(SPP, shard, &folder.0.join("whole.exr"), &mut |_| ()).expect("made");
    let all = maker.made.borrow().len();

    maker.left = 7;
    assert!(maker.work().make_shard(SPP, shard, &path, &mut |_| ()).is_err(), "the device is lost");
    assert_eq!(ReferenceFile::read(&path).expect("what was done is kept").state.chunk_count(), 3);

    maker.left = u32::MAX;
    maker.made.borrow_mut().clear();
    let file = maker.work().make_shard(SPP, shard, &path, &mut |_| ()).expect("made");
    assert_eq!(maker.made.borrow().len(), all - 6, "what was saved is not made again");
    assert_eq!(file.state, ReferenceFile::read(&folder.0.join("whole.exr")).expect("written").state);
}

#[test]
fn chunks_in_any_order_make_the_same_state() {
    let maker = Maker::new();
    let mut source = (maker.work().source)().expect("a source");
    let chunk = |index| {
        let mut half = |half| source.sums(half, index * CHUNK_SAMPLES, CHUNK_SAMPLES).expect("made");
        blocks::Block::chunk(index, [half(0), half(1)])
    };
    let chunks: Vec<_> = (0..13).map(chunk).collect();
    let state = |order: &mut dyn Iterator<Item = usize>| {
        let mut state = blocks::State::default();
        order.for_each(|index| state.insert(chunks[index].clone()).expect("each once"));
        state
    };
    let ascending = state(&mut (0..13));
    assert_eq!(ascending.blocks().map(|block| block.level).collect::<Vec<_>>(), [3, 2, 0]);
    assert_eq!(state(&mut (0..13).rev()), ascending);
    assert_eq!(state(&mut (0..13).map(|index| index * 5 % 13)), ascending);
    let some = state(&mut [3, 4, 8].into_iter());
    assert_eq!(some.missing(0..10), [0..3, 5..8, 9..10]);
}

#[test]
fn shards_that_do_not_fit_say_which_samples() {
    let folder = TestFolder::new("reference-misfits");
    let maker = Maker::new();
    let paths = shards(&folder, &maker, 3);
    let message = |paths: &[&PathBuf]| {
        let paths: Vec<PathBuf> = paths.iter().map(|path| (*path).clone()).collect();
        merge(&paths).expect_err("they do not fit").to_string()
    };
    assert!(message(&[&paths[0], &paths[2]]).contains("samples 113 to 224 "), "the middle");
    assert!(message(&[&paths[0], &paths[1]]).contains("samples 225 to 336 "), "the end");
    assert!(message(&[&paths[1]]).contains("samples 1 to 112, 225 to 336 "), "both ends");
    let double = message(&[&paths[0], &paths[1], &paths[2], &paths[1]]);
    assert!(double.contains("2-3.exr") && double.contains("113 to"), "{double}");

    let other = Maker::of(&ReferenceRequest { bounces: Some(1), ..request(SIZE) });
    let other_path = folder.0.join("other.exr");
    other.make(16, None).write(&other_path).expect("written");
    let different = message(&[&paths[0], &other_path]);
    assert!(different.contains("bounces, unlimited and 1"), "{different}");
    assert!(message(&[]).contains("nothing to merge"));

    let shard = Shard { index: 2, count: 9 };
    let empty = maker.work().make_shard(16, shard, &other_path, &mut |_| ()).expect_err("too small").to_string();
    assert!(empty.contains("2/9"), "{empty}");
}
