//! Files of references: what they hold comes back, and what is no longer sound is said to be so.

use super::*;
use crate::output::target::tests::TestFolder;
use crate::output::{read_attributes, read_exr};

#[test]
fn a_file_comes_back_to_the_bit_and_opens_in_any_viewer() {
    let folder = TestFolder::new("reference-file");
    let path = folder.0.join("a.exr");
    let mut written = Maker::new().make(16 * 11, None);
    written.shard = Some((Shard { index: 1, count: 2 }, 352));
    written.write(&path).expect("written");
    let read = ReferenceFile::read(&path).expect("sound");
    assert_eq!(read, written);
    assert!(bits(&read) == bits(&written));
    assert_eq!(folder.names(), ["a.exr"]);

    ::exr::meta::MetaData::read_from_file(&path, true).expect("valid by the strict rules");
    let seen = read_exr(&path).expect("an EXR");
    let reference = written.reference();
    assert_eq!((seen.image, seen.slots), (reference.image.clone(), reference.slots.clone()));
    let attributes = read_attributes(&path).expect("an EXR");
    let has = |name: &str, value: &str| assert_eq!(attributes.get(name).map(String::as_str), Some(value), "{name}");
    has("scene", "a plane");
    has("spp", "176");
    has("bounces", "unlimited");
    has("filter", "center");
    has("estimator", "path");
    has("size", "24x16");
    has("device", "mock");
    has("irradia", env!("CARGO_PKG_VERSION"));
    has("noise.image.rrmse", &reference.image_noise().rrmse.to_string());
    has("noise.direct.rmse", &reference.noise["direct"].rmse.to_string());
    for name in ["key", "scene_hash", "camera_view", "seed", "samples_per_second", "rays_per_second", "seconds"] {
        assert!(attributes.contains_key(name), "{name}");
    }
}

#[test]
fn damaged_files_are_never_believed() {
    let folder = TestFolder::new("reference-damaged");
    let path = folder.0.join("a.exr");
    let file = Maker::of(&request([5, 3])).make(16 * 3, None);
    file.write(&path).expect("written");
    let sound = std::fs::read(&path).expect("just written");
    for at in (0..sound.len()).step_by((sound.len() / 400).max(1)) {
        let mut flipped = sound.clone();
        flipped[at] ^= 0x10;
        for bytes in [&flipped[..], &sound[..at]] {
            std::fs::write(&path, bytes).expect("writable");
            let error = ReferenceFile::read(&path).expect_err("not as it was written").to_string();
            assert!(error.contains("a.exr"), "byte {at}: {error}");
            // Who looks at it as a picture, or lists it, gets an answer of some kind.
            let _ = (read_exr(&path), read_attributes(&path));
        }
    }
}

#[test]
fn files_of_other_versions_and_other_pictures_say_so() {
    let folder = TestFolder::new("reference-versions");
    let path = folder.0.join("a.exr");
    let mut file = Maker::of(&request([5, 3])).make(16, None);
    file.about.attributes.insert("reference_version".to_owned(), "0".to_owned());
    file.write(&path).expect("written");
    let old = ReferenceFile::read(&path).expect_err("too old").to_string();
    assert!(old.contains("version 0"), "{old}");
    let reference = file.reference();
    crate::output::write_exr(&path, &reference.image, &reference.slots, &Default::default()).expect("written");
    let picture = ReferenceFile::read(&path).expect_err("a picture").to_string();
    assert!(picture.contains("it is none"), "{picture}");
}
