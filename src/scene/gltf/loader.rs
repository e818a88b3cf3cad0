//! What every part of the reader works on.

use super::accessor::Accessors;
use super::container::Storage;
use super::document::Document;
use crate::scene::load_options::LoadOptions;
use crate::scene::world::Scene;

/// A scene on its way from the document. Faults are sentences without the scene's name, which `Scene::from_bytes` adds.
pub(super) struct Loader<'a> {
    pub(super) document: &'a Document,
    pub(super) storage: &'a Storage<'a>,
    pub(super) options: &'a LoadOptions,
    pub(super) accessors: Accessors<'a>,
    pub(super) scene: Scene,
}

impl Loader<'_> {
    /// Notes that something was left out or changed.
    pub(super) fn warn(&mut self, warning: String) {
        tracing::warn!("scene {:?}: {warning}", self.scene.name);
        self.scene.warnings.push(warning);
    }
}
