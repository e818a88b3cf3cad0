//! The scenes that come with irradia: small glTF files in `scenes/`, built into the program.

use super::{LoadOptions, Scene, SceneError};
use std::path::Path;

struct Builtin {
    name: &'static str,
    bytes: &'static [u8],
}

/// One line a scene: `"name" => "file in scenes/"`.
macro_rules! builtins {
    ($($name:literal => $file:literal,)*) => {
        const BUILTINS: &[Builtin] = &[$(Builtin {
            name: $name,
            bytes: include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/", $file)),
        }),*];
        const NAMES: &[&str] = &[$($name),*];
    };
}

builtins! {
    "plane" => "plane.glb",
    "furnace" => "furnace.glb",
    "cornell-empty" => "cornell-empty.glb",
    "cornell-point" => "cornell-point.glb",
    "cornell-spot" => "cornell-spot.glb",
    "cornell-panel" => "cornell-panel.glb",
    "cornell-glossy" => "cornell-glossy.glb",
    "corridor" => "corridor.glb",
    "two-rooms" => "two-rooms.glb",
    "leak" => "leak.glb",
    "ring" => "ring.glb",
    "ring-occluded" => "ring-occluded.glb",
    "water" => "water.glb",
    "bumpy" => "bumpy.glb",
    "maze" => "maze.glb",
    "lights" => "lights.glb",
    "textured" => "textured.glb",
    "animated" => "animated.glb",
    "cube-and-sphere" => "cube-and-sphere.glb",
    "rooms-divided" => "rooms-divided.glb",
    "rooms-connected" => "rooms-connected.glb",
    "rooms-dimmed" => "rooms-dimmed.glb",
    "rooms-switched" => "rooms-switched.glb",
}

/// The names of all built-in scenes, in the order in which they are best read.
pub fn builtin_names() -> &'static [&'static str] {
    NAMES
}

impl Scene {
    /// The built-in scene of a name; `None` if there is none.
    ///
    /// # Errors
    /// Those of [`Scene::from_bytes`]; a test loads them all.
    pub fn builtin(name: &str) -> Option<Result<Scene, SceneError>> {
        let builtin = BUILTINS.iter().find(|builtin| builtin.name == name)?;
        Some(Scene::from_bytes(builtin.name, builtin.bytes, None))
    }

    /// What a command line means by a scene: a file, if it exists or ends in .gltf or .glb, else a built-in scene. With the
    /// default [`LoadOptions`].
    ///
    /// # Errors
    /// [`SceneError::UnknownScene`], which lists the built-in scenes; else those of [`Scene::load`].
    pub fn open(spec: &str) -> Result<Scene, SceneError> {
        Scene::open_with(spec, &LoadOptions::default())
    }

    /// As [`Scene::open`], with options.
    ///
    /// # Errors
    /// Those of [`Scene::open`].
    pub fn open_with(spec: &str, options: &LoadOptions) -> Result<Scene, SceneError> {
        let path = Path::new(spec);
        let extension = path.extension().map(|extension| extension.to_ascii_lowercase());
        if path.is_file() || extension.is_some_and(|extension| extension == "gltf" || extension == "glb") {
            return Scene::load_with(path, options);
        }
        Scene::builtin(spec)
            .unwrap_or_else(|| Err(SceneError::UnknownScene { name: spec.to_owned(), known: NAMES.join(", ") }))
    }
}
