//! What can go wrong with a scene, each said in one sentence: what, which object, what to do.

use std::path::PathBuf;

/// Why a scene could not be loaded or changed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The file itself could not be read.
    #[error("cannot read the scene {}: {source}", path.display())]
    Read {
        /// The path as given.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is not valid glTF in a part that the scene needs.
    #[error("cannot load the scene {scene:?}: {fault}")]
    Malformed {
        /// Name of the scene.
        scene: String,
        /// Which object is at fault, and how.
        fault: String,
    },
    /// The file says that it cannot be shown without extensions that are not supported.
    #[error(
        "cannot load the scene {scene:?}: it requires {extensions}, which irradia does not support; export it without"
    )]
    RequiredExtensions {
        /// Name of the scene.
        scene: String,
        /// The extensions' names, separated by commas.
        extensions: String,
    },
    /// No file and no built-in scene goes by this name.
    #[error("there is no scene {name:?}: give a .gltf or .glb file, or one of the built-in scenes: {known}")]
    UnknownScene {
        /// What was asked for.
        name: String,
        /// The built-in scenes' names, separated by commas.
        known: String,
    },
    /// The scene has no camera of this name or number.
    #[error("the scene {scene:?} has no camera {camera:?}; {known}")]
    UnknownCamera {
        /// Name of the scene.
        scene: String,
        /// What was asked for.
        camera: String,
        /// A clause on the cameras there are.
        known: String,
    },
    /// An identifier that this scene never gave out.
    #[error("the scene {scene:?} has no {kind} {index}; it has {count} of that kind")]
    UnknownId {
        /// Name of the scene.
        scene: String,
        /// "mesh", "node" and so on.
        kind: &'static str,
        /// The identifier's number.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// An object that was handed to the scene contradicts itself.
    #[error("cannot take {object} into the scene {scene:?}: {fault}")]
    InvalidObject {
        /// Name of the scene.
        scene: String,
        /// The object's kind and name.
        object: String,
        /// What is wrong with it.
        fault: String,
    },
}
