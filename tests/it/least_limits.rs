//! Devices that offer no more than Vulkan promises: what is done in another way there, done on the device at hand.

use std::process::Command;

use irradia::output::{ExrImage, read_exr};

use crate::files::empty_folder;

fn rendered(test: &str, method: [&str; 2], variable: (&str, &str)) -> ExrImage {
    let path = empty_folder("least_limits", test).join("image.exr");
    let output = Command::new(env!("CARGO_BIN_EXE_irradia"))
        .args(["render", "cornell-point", "--size", "64x48", "--slots", "all", "--validation", "sync"])
        .args(method)
        .arg("-o")
        .arg(&path)
        .env(variable.0, variable.1)
        .output()
        .expect("the program starts");
    assert!(output.status.success(), "{variable:?}: {}", String::from_utf8_lossy(&output.stderr));
    read_exr(&path).expect("an EXR of ours")
}

/// Texels have the same bits wherever they are read from.
#[test]
fn lists_in_storage_buffers_change_no_bit() {
    let method = ["--technique", "hybrid"];
    let storage = rendered("storage", method, ("IRRADIA_LISTS", "storage"));
    let usual = rendered("usual", method, ("IRRADIA_NOTHING", ""));
    assert!(storage.image.pixels.iter().any(|pixel| pixel[0] > 0.0));
    assert!(storage.slots == usual.slots, "a slot differs");
}

/// Depths by the triangles' planes are where a fine rasteriser has them, and light and shadow with them, but along edges.
#[test]
fn depths_of_planes_are_those_of_a_fine_rasteriser() {
    let method = ["--technique", "direct"];
    let [planes, rasterised] =
        ["planes", "rasterised"].map(|depths| rendered(depths, method, ("IRRADIA_DEPTHS", depths)).image.pixels);
    let off =
        |(a, b): &(&[f32; 3], &[f32; 3])| (0..3).any(|channel| (a[channel] - b[channel]).abs() > 1e-3 * b[channel]);
    let differ = planes.iter().zip(&rasterised).filter(off).count();
    assert!(differ * 100 <= planes.len(), "{differ} of {} pixels differ", planes.len());
}
