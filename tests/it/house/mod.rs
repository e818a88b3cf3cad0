//! The order of the house: imports point down the list of rooms in `ROOMS`, never up, never across, and no two files of `src/` use
//! each other, however many others lie between them.
//!
//! All paths that start with `crate`, `super`, `self`, a child module or, in the program, `irradia` count, not those of `use` lines alone. A path through
//! a re-export counts as one to the file that has the item.

mod paths;
mod source;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use self::source::Tree;

/// The rooms, each with its level: a room uses rooms of lower levels, and itself.
const ROOMS: &[(u32, &[&str])] = &[
    (0, &["scene", "slot", "image"]),
    (1, &["output"]),
    (2, &["metrics"]),
    (3, &["vulkan"]),
    (4, &["graph"]),
    (5, &["shaders"]),
    (6, &["frame"]),
    (7, &["method"]),
    (8, &["direct", "diffuse", "caustics", "specular", "estimator"]),
    (9, &["renderer"]),
    (10, &["reference", "bake"]),
    (11, &["bench"]),
    (12, &["cli", "capi", "stress"]),
];

/// Below the graph nobody knows what pictures are made of, and the pictures' rooms know no device.
const STRANGERS: &[(&str, &[&str])] = &[("vulkan", &["scene", "slot", "image", "output", "metrics"])];

fn level(room: &str) -> Option<u32> {
    ROOMS.iter().find(|(_, rooms)| rooms.contains(&room)).map(|(level, _)| *level)
}

/// Whether a file of the one room may use one of the other.
fn may_use(from: &str, to: &str) -> bool {
    let stranger = STRANGERS.iter().any(|(room, strangers)| *room == from && strangers.contains(&to));
    match (level(from), level(to)) {
        (Some(from_level), Some(to_level)) => from == to || (to_level < from_level && !stranger),
        _ => false,
    }
}

/// The first folder below `src/`, or the name of a file that lies there itself.
fn room_of(file: &Path) -> String {
    let first = file.iter().next().map(|part| part.to_string_lossy().into_owned()).unwrap_or_default();
    first.trim_end_matches(".rs").to_owned()
}

fn tree() -> Tree {
    Tree::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"))
}

#[test]
fn imports_point_down() {
    let tree = tree();
    let mut wrong = BTreeSet::new();
    for (from, to) in tree.edges() {
        let (from_room, to_room) = (room_of(&from), room_of(&to));
        // `lib.rs` and `main.rs` say which rooms there are.
        let names_rooms = ["lib", "main"].contains(&&*from_room);
        if !names_rooms && !may_use(&from_room, &to_room) {
            wrong.insert(format!("{} uses {}", from.display(), to.display()));
        }
    }
    let list: Vec<_> = wrong.iter().map(String::as_str).collect();
    assert!(list.is_empty(), "{} imports against the order of rooms:\n{}", list.len(), list.join("\n"));
}

#[test]
fn every_room_is_on_the_list() {
    for file in tree().files() {
        let room = room_of(file);
        assert!(["lib", "main"].contains(&&*room) || level(&room).is_some(), "{} has no level", file.display());
    }
}

#[test]
fn no_files_use_each_other() {
    let mut uses: BTreeMap<PathBuf, BTreeSet<PathBuf>> = BTreeMap::new();
    for (from, to) in tree().edges() {
        uses.entry(from).or_default().insert(to);
    }
    let circles = paths::circles(&uses);
    let text: Vec<String> = circles
        .iter()
        .map(|circle| circle.iter().map(|file| file.display().to_string()).collect::<Vec<_>>().join(", "))
        .collect();
    assert!(text.is_empty(), "{} circles of files:\n{}", text.len(), text.join("\n"));
}

#[test]
fn the_reader_sees_paths_of_every_form() {
    let files = [
        ("lib.rs", "mod a; mod b; mod c; pub use c::Thing;"),
        ("a.rs", "fn f() { let x = crate::b::made(1); super::c::other(); } // crate::nothing::at_all"),
        ("b/mod.rs", "mod inner;\npub(crate) use inner::{made, Kind as Sort};\nfn g() { inner::made(\"crate::c\") }"),
        ("b/inner.rs", "pub fn made() {} pub enum Kind {} #[cfg(test)] mod tests { use crate::a::f; }"),
        (
            "c.rs",
            "use crate::{b::{self, Sort}, Thing};\npub struct Thing; pub fn other() -> impl Fn() + use<> { || {} }",
        ),
    ];
    let tree = Tree::of(files.map(|(path, text)| (PathBuf::from(path), text.to_owned())));
    let edges: Vec<String> =
        tree.edges().into_iter().map(|(from, to)| format!("{} {}", from.display(), to.display())).collect();
    let expected =
        ["a.rs b/inner.rs", "a.rs c.rs", "b/mod.rs b/inner.rs", "c.rs b/inner.rs", "c.rs b/mod.rs", "lib.rs c.rs"];
    assert_eq!(edges, expected);
}

#[test]
fn circles_are_found_through_others() {
    let uses = |pairs: &[(&str, &str)]| {
        let mut uses: BTreeMap<PathBuf, BTreeSet<PathBuf>> = BTreeMap::new();
        for (from, to) in pairs {
            uses.entry(from.into()).or_default().insert(to.into());
        }
        paths::circles(&uses)
    };
    assert!(uses(&[("a", "b"), ("b", "c"), ("a", "c")]).is_empty());
    assert_eq!(uses(&[("a", "b"), ("b", "c"), ("c", "a"), ("c", "d")]), [["a", "b", "c"].map(PathBuf::from).to_vec()]);
    assert!(may_use("renderer", "frame") && !may_use("frame", "renderer"), "the list is read from the top");
    assert!(!may_use("diffuse", "caustics") && !may_use("vulkan", "scene"));
}
