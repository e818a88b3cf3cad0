//! `irradia compare` from outside: the table, the files, and what it says of files that cannot be compared. No device needed.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use irradia::bench::comparison::ComparisonReport;
use irradia::output::{Attributes, write_exr};
use irradia::renderer::{ColorImage, Slot};

use crate::files::{empty_folder, names_in, read_png};

fn folder(test: &str) -> PathBuf {
    empty_folder("compare", test)
}

/// Runs in `folder`, so that messages hold the files' names alone; without Vulkan, which it shall not need.
fn compare(folder: &Path, arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_irradia"));
    program.current_dir(folder).env("VK_DRIVER_FILES", "none").env("VK_ICD_FILENAMES", "none");
    program.arg("compare").args(arguments).output().expect("the program starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn assert_fails(folder: &Path, status: i32, arguments: &[&str], words: &[&str]) {
    let output = compare(folder, arguments);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {message}");
    assert!(output.stdout.is_empty());
    assert!(status != 1 || message.starts_with("irradia: ") && message.lines().count() == 1, "{message}");
    for word in words {
        assert!(message.contains(word), "{word} is not in: {message}");
    }
}

fn constant(value: f32) -> ColorImage {
    ColorImage { size: [24, 16], pixels: vec![[value; 3]; 24 * 16] }
}

fn write(folder: &Path, name: &str, image: f32, slots: &[(Slot, f32)], attributes: &[(&str, &str)]) {
    let slots: BTreeMap<Slot, ColorImage> = slots.iter().map(|(slot, value)| (*slot, constant(*value))).collect();
    let attributes: Attributes = attributes.iter().map(|(name, value)| (name.to_string(), value.to_string())).collect();
    write_exr(&folder.join(name), &constant(image), &slots, &attributes).expect("the test's own folder");
}

/// `a.exr`, 1.5 with slots, and `b.exr`, 1 with others and its noise.
fn example(test: &str) -> PathBuf {
    let folder = folder(test);
    write(&folder, "a.exr", 1.5, &[(Slot::Diffuse, 0.51), (Slot::Direct, 1.0)], &[]);
    let noise = [("noise.image.rmse", "1e-3"), ("noise.diffuse.rmse", "0.02")];
    write(&folder, "b.exr", 1.0, &[(Slot::Diffuse, 0.5), (Slot::Specular, 0.5)], &noise);
    folder
}

#[test]
fn the_table_has_a_row_for_each_layer_of_both() {
    let folder = example("table");
    let output = compare(&folder, &["a.exr", "b.exr"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let table = text(&output.stdout);
    let row = |layer: &str| {
        let line = table.lines().find(|line| line.split_whitespace().next() == Some(layer));
        line.map(|line| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>())
    };
    let header = "layer rmse rrmse 8×8 relmse psnr dB ssim flip mean ratio noise rmse";
    assert_eq!(row("layer").map(|cells| cells.join(" ")).as_deref(), Some(header), "{table}");
    let image = row("image").expect("a row");
    assert_eq!(image[..3], ["image", "0.500", "0.500"], "{table}");
    assert_eq!(image[image.len() - 2..], ["1.5000", "0.00100"], "{table}");
    // 0.01 is below twice the noise of 0.02.
    assert_eq!(row("diffuse").expect("a row")[..5], ["diffuse", "<", "0.0400", "<", "0.0800"], "{table}");
    assert_eq!((row("direct"), row("specular")), (None, None), "{table}");
    let warnings = text(&output.stderr);
    assert!(warnings.contains("a.exr alone has direct") && warnings.contains("b.exr alone has specular"), "{warnings}");
    assert_eq!(names_in(&folder), ["a.exr", "b.exr"]);
}

#[test]
fn json_and_heat_map_are_written_whole() {
    let folder = example("files");
    let arguments = ["a.exr", "b.exr", "-q", "--json", "c.json", "--heatmap", "c.png", "--slot", "diffuse"];
    let output = compare(&folder, &arguments);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
    assert_eq!(names_in(&folder), ["a.exr", "b.exr", "c.json", "c.png"]);
    let json = fs::read_to_string(folder.join("c.json")).expect("written");
    let report: ComparisonReport = serde_json::from_str(&json).expect("the schema");
    assert_eq!((report.schema.as_str(), report.size), ("irradia-compare/1", [24, 16]));
    assert_eq!((report.image.as_str(), report.reference.as_str()), ("a.exr", "b.exr"));
    assert_eq!(report.errors.keys().collect::<Vec<_>>(), ["diffuse", "image"]);
    assert_eq!((report.errors["image"].errors.rmse, report.errors["image"].bias), (0.5, [0.5; 3]));
    assert_eq!(report.noise, BTreeMap::from([("image".to_owned(), 1e-3), ("diffuse".to_owned(), 0.02)]));
    let (size, map) = read_png(&folder.join("c.png"));
    assert_eq!(size, [24, 16 + 12]);
    // 0.02 of the mean everywhere; in the whole image it is one half.
    let diffuse = map[0];
    assert!(map.iter().take(24 * 16).all(|pixel| *pixel == diffuse));
    compare(&folder, &["a.exr", "b.exr", "-q", "--heatmap", "d.png"]);
    let whole = read_png(&folder.join("d.png")).1[0];
    assert!(whole[0] > diffuse[0], "{whole:?} is brighter than {diffuse:?}");
}

#[test]
fn what_cannot_be_compared_is_one_sentence_and_no_file() {
    let folder = example("failures");
    let mut pixels = constant(1.0);
    pixels.pixels[24 * 3 + 7][0] = f32::NAN;
    write_exr(&folder.join("nan.exr"), &pixels, &BTreeMap::new(), &Attributes::new()).expect("written");
    let small = ColorImage { size: [8, 8], pixels: vec![[1.0; 3]; 64] };
    write_exr(&folder.join("small.exr"), &small, &BTreeMap::new(), &Attributes::new()).expect("written");
    fs::write(folder.join("text.exr"), "no image").expect("the test's own folder");
    let before = names_in(&folder);
    let files = ["--json", "c.json", "--heatmap", "c.png"];
    let fails =
        |a: &str, b: &str, words: &[&str]| assert_fails(&folder, 1, &[&[a, b, "-q"], &files[..]].concat(), words);
    fails("nan.exr", "b.exr", &["nan.exr", "(image)", "the image holds [NaN, 1.0, 1.0] in pixel (7, 3)"]);
    fails("a.exr", "nan.exr", &["the reference holds"]);
    fails("a.exr", "small.exr", &["24x16", "8x8", "same size"]);
    fails("a.exr", "none.exr", &["none.exr cannot be read"]);
    fails("text.exr", "b.exr", &["text.exr cannot be read"]);
    let slot = ["a.exr", "b.exr", "-q", "--heatmap", "c.png", "--slot"];
    assert_fails(&folder, 1, &[&slot[..], &["specular"]].concat(), &["a.exr has no slot specular", "image, diffuse"]);
    assert_fails(&folder, 1, &["a.exr", "b.exr", "--json", "none/c.json"], &["there is no folder"]);
    assert_eq!(names_in(&folder), before);
}

#[test]
fn wrong_usage_is_status_2() {
    let folder = folder("usage");
    assert_fails(&folder, 2, &["a.exr"], &["<B>"]);
    assert_fails(&folder, 2, &["a.png", "b.exr"], &["display values", ".exr"]);
    assert_fails(&folder, 2, &["a.exr", "b.exr", "--heatmap", "c.exr"], &[".png"]);
    assert_fails(&folder, 2, &["a.exr", "b.exr", "--slot", "diffuse"], &["--heatmap"]);
    assert_fails(&folder, 2, &["a.exr", "b.exr", "--heatmap", "c.png", "--slot", "sky"], &["sky", "image", "caustics"]);
}
