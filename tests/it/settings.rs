//! Settings as files: what older builds wrote still loads, and the documented table is the one that the program has.

use std::fmt::Write as _;
use std::path::Path;

use irradia::renderer::{Preset, Settings, Technique};
use serde_json::Value;

#[test]
fn settings_written_before_there_were_tables_of_options_still_load() {
    let written: Vec<Value> =
        serde_json::from_str(include_str!("../data/settings-before-options.json")).expect("a list of settings");
    for json in written {
        let name = |key: &str| json[key].as_str().expect("a name");
        let technique = Technique::from_name(name("technique")).expect("a technique");
        let preset = Preset::from_name(name("preset")).expect("a preset");
        let read: Settings = serde_json::from_value(json.clone()).expect("settings");
        assert_eq!(read, Settings::new(technique, preset), "{json}");
        let mut older = json.clone();
        older["vpl"].as_object_mut().expect("options").remove("levels");
        older.as_object_mut().expect("settings").remove("photons");
        assert_eq!(serde_json::from_value::<Settings>(older).expect("settings"), read, "without what came later");
    }
}

/// A choice may read like a yes or a no.
#[test]
fn settling_is_yes_or_no_too() {
    let mut settings = Settings::new(Technique::Lightmaps, Preset::Default);
    for (value, expected) in [("true", "always"), ("false", "never"), ("first", "first")] {
        settings.set("lightmaps.settle", value).expect("a choice");
        assert_eq!(settings.options()["lightmaps"]["settle"], expected);
        let read: Settings = serde_json::from_value(serde_json::to_value(&settings).expect("JSON")).expect("settings");
        assert_eq!(read, settings);
    }
    let other = settings.set("lightmaps.source", "true").expect_err("no such choice").to_string();
    assert!(other.contains("lightmaps.source") && other.contains("photons"), "{other}");
}

/// `docs/settings.md` as it ought to be; `IRRADIA_WRITE_DOCS=1 cargo test --test it settings` writes it.
#[test]
fn the_documented_settings_are_those_there_are() {
    let mut text = String::from(
        "# Settings\n\nAll that `--set PIECE.KEY=VALUE` takes, with its default; `irradia settings` prints the same. Presets and techniques \
         change some of them.\n",
    );
    let settings = Settings::new(Technique::Rsm, Preset::Default);
    let values = settings.options();
    for (piece, table) in settings.tables() {
        write!(text, "\n## {piece}\n\n| setting | default | takes | unit | cost | |\n|---|---|---|---|---|---|\n")
            .expect("text");
        for info in table {
            let cells = [info.kind.to_string(), info.unit.to_owned(), info.cost.to_owned(), info.doc.trim().to_owned()];
            let default = values[piece][info.name].to_string().replace('"', "");
            writeln!(text, "| `{piece}.{}` | {default} | {} |", info.name, cells.join(" | ")).expect("text");
        }
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/settings.md");
    if std::env::var_os("IRRADIA_WRITE_DOCS").is_some() {
        std::fs::write(&path, &text).expect("docs can be written");
    }
    let documented = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        documented == text,
        "docs/settings.md is out of date; IRRADIA_WRITE_DOCS=1 cargo test --test it settings writes it"
    );
}
