//! Reading glTF 2.0 files, .gltf and .glb.
//!
//! Nothing in a file may make the reader panic, hang, or allocate beyond what the file's own size justifies. And a fault in a
//! part that the active scene does not use does not stop the rest: only what its nodes reach is read, in this order: nodes
//! ([`nodes`]), the meshes they place ([`primitives`], through [`accessor`]), the materials those use, the images those use
//! ([`materials`], [`images`]).

mod accessor;
mod container;
mod document;
mod files;
mod images;
mod light_animation;
mod loader;
mod materials;
mod nodes;
mod pixels;
mod primitives;

use super::{LoadOptions, Scene, SceneError};
use accessor::Accessors;
use container::Storage;
use document::Document;
pub use files::ReadFile;
use files::{Files, Source, read_main};
use loader::Loader;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

/// Extensions that are understood.
const SUPPORTED_EXTENSIONS: [&str; 10] = [
    "KHR_animation_pointer",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

impl Scene {
    /// Loads a .gltf or .glb file, with the default [`LoadOptions`].
    ///
    /// # Errors
    /// [`SceneError::Read`], [`SceneError::Malformed`], [`SceneError::RequiredExtensions`].
    pub fn load(path: &Path) -> Result<Scene, SceneError> {
        Scene::load_with(path, &LoadOptions::default())
    }

    /// Loads a .gltf or .glb file.
    ///
    /// # Errors
    /// Those of [`Scene::load`].
    pub fn load_with(path: &Path, options: &LoadOptions) -> Result<Scene, SceneError> {
        let bytes = read_main(path, options).map_err(|source| SceneError::Read { path: path.to_owned(), source })?;
        let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
        Scene::from_bytes_with(&name, &bytes, Some(path.parent().unwrap_or(Path::new(""))), options)
    }

    /// Reads the bytes of a .gltf or .glb file. Files that it refers to are looked for in `base_dir`; without one, they are errors.
    ///
    /// # Errors
    /// [`SceneError::Malformed`], [`SceneError::RequiredExtensions`].
    pub fn from_bytes(name: &str, bytes: &[u8], base_dir: Option<&Path>) -> Result<Scene, SceneError> {
        Scene::from_bytes_with(name, bytes, base_dir, &LoadOptions::default())
    }

    /// As [`Scene::from_bytes`], with options.
    ///
    /// # Errors
    /// Those of [`Scene::from_bytes`].
    pub fn from_bytes_with(
        name: &str,
        bytes: &[u8],
        base_dir: Option<&Path>,
        options: &LoadOptions,
    ) -> Result<Scene, SceneError> {
        Scene::from_bytes_and(name, bytes, Source::Folder(base_dir), options)
    }

    /// As [`Scene::from_bytes_with`]; files that it refers to are read by `read`, from wherever the caller keeps them.
    ///
    /// # Errors
    /// Those of [`Scene::from_bytes`].
    pub fn from_bytes_by(
        name: &str,
        bytes: &[u8],
        read: &ReadFile<'_>,
        options: &LoadOptions,
    ) -> Result<Scene, SceneError> {
        Scene::from_bytes_and(name, bytes, Source::Caller(read), options)
    }

    fn from_bytes_and(
        name: &str,
        bytes: &[u8],
        source: Source<'_>,
        options: &LoadOptions,
    ) -> Result<Scene, SceneError> {
        let malformed = |fault: String| SceneError::Malformed { scene: name.to_owned(), fault };
        let (json, binary) = container::split(bytes).map_err(malformed)?;
        let document: Document =
            serde_json::from_slice(json).map_err(|error| malformed(format!("it is not a glTF document ({error})")))?;
        if !document.asset.version.starts_with("2.") {
            return Err(malformed(format!(
                "its glTF version is {:?}; only version 2 is supported",
                document.asset.version
            )));
        }
        let required = unsupported(&document.extensions_required);
        if !required.is_empty() {
            return Err(SceneError::RequiredExtensions { scene: name.to_owned(), extensions: required.join(", ") });
        }
        let files = Files::new(source, options, bytes.len() as u64);
        let storage = Storage::read(&document, binary, files, bytes.len() as u64);
        let mut loader = Loader {
            accessors: Accessors::new(&document, &storage),
            document: &document,
            storage: &storage,
            options,
            scene: Scene::empty(name),
        };
        loader.scene.description = document.asset.extras["description"].as_str().map(str::to_owned);
        let unknown = unsupported(&document.extensions_used);
        if !unknown.is_empty() {
            loader.warn(format!("extensions that are not supported are ignored: {}", unknown.join(", ")));
        }
        loader.load().map_err(malformed)?;
        loader.note_dark_cameras();
        Ok(loader.scene)
    }
}

/// The names among `extensions` that are not supported, each once, in order.
fn unsupported(extensions: &[String]) -> Vec<&str> {
    let names: BTreeSet<&str> = extensions.iter().map(String::as_str).collect();
    names.into_iter().filter(|name| !SUPPORTED_EXTENSIONS.contains(name)).collect()
}

impl Loader<'_> {
    /// Which cameras the file says to stand in the dark.
    fn note_dark_cameras(&mut self) {
        let names = self.document.asset.extras["dark"].as_array().into_iter().flatten().filter_map(Value::as_str);
        for name in names {
            if self.scene.camera_view(Some(name)).is_ok() {
                self.scene.dark_cameras.push(name.to_owned());
            } else {
                self.warn(format!("there is no camera {name:?}, which is said to stand in the dark"));
            }
        }
    }

    fn load(&mut self) -> Result<(), String> {
        let tree = self.read_tree()?;
        let mesh_indices: BTreeSet<usize> = tree.iter().filter_map(|branch| branch.node.mesh).collect();
        let meshes = self.read_meshes(&mesh_indices)?;
        let materials = self.add_materials(&meshes)?;
        let mesh_ids = self.add_meshes(&mesh_indices, meshes, &materials)?;
        let (node_ids, light_ids) = self.add_nodes(&tree, &mesh_ids)?;
        self.add_animations(&tree, &node_ids, &light_ids)
    }
}
