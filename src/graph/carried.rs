//! Contents that several ways lead to: all of the work, or a part of it on what memory holds of an earlier frame. A pass names such a content itself
//! ([`PassBuilder::leaves`](super::builder::PassBuilder::leaves)); which way a frame goes is decided while it is declared, by what memory holds.
//!
//! The key has to name all that the content depends on, and both ways have to leave the same.

use super::bindings::{BufferRef, ImageRef};
use super::declare::Graph;
use super::key::hash_of;
use super::resource::Body;

impl Graph<'_> {
    /// A buffer for such contents: no frame's use of it moves it to other memory.
    pub(crate) fn carried_buffer<T>(&mut self, name: &str, count: usize) -> BufferRef<T> {
        let buffer = self.buffer(name, count);
        self.keep_for_passes(buffer);
        buffer
    }

    /// Whether memory holds the content `key` of a buffer.
    pub(crate) fn finds<T>(&self, buffer: BufferRef<T>, key: u64) -> bool {
        self.held_key(buffer) == Some(key)
    }

    /// The key of what memory holds of a buffer from an earlier frame.
    pub(crate) fn held_key<T>(&self, buffer: BufferRef<T>) -> Option<u64> {
        let resource = &self.resources[buffer.id];
        let Body::Buffer { bytes } = resource.body else { return None };
        self.store.buffer_key(&resource.name, bytes).filter(|_| self.store.fits(resource))
    }

    /// The key of what the passes that are declared so far leave in a buffer: it names all that this depends on.
    pub(crate) fn key_of<T>(&self, buffer: BufferRef<T>) -> u64 {
        self.resources[buffer.id].content[0].0
    }

    /// The same of all parts of an image.
    pub(crate) fn key_of_image(&self, image: ImageRef) -> u64 {
        hash_of(&self.resources[image.id].content.iter().map(|content| content.0).collect::<Vec<u64>>())
    }

    /// Lets passes start from the content `key` of a buffer, which memory holds ([`Graph::finds`]).
    pub(crate) fn carry_on<T>(&mut self, buffer: BufferRef<T>, key: u64) {
        self.resources[buffer.id].content[0].0 = key;
    }
}
