//! Mistakes in the declaration of a frame that would show as a wrong picture, or as nothing at all: each is a sentence that names pass and resource.

use super::bindings::Access;
use super::declare::{Graph, NOTHING};
use super::demand::Place;
use super::needs::two_layouts;
use super::nothing::stands_for_nothing;
use super::pass::{Draws, Pass, Work};
use super::resource::Body;

/// Words of the arguments of an indirect dispatch, and of a draw without indices.
const DISPATCH_WORDS: u64 = 3;
const DRAW_WORDS: u64 = 4;

impl Graph<'_> {
    /// Looks for what is wrong with a pass whatever its inputs hold.
    pub(super) fn note_mistakes_of(&mut self, pass: &Pass) {
        let name = pass.full_name();
        // Submissions of one work repeat their passes, vertex by vertex, and add them up by name.
        if !self.goes_on && self.passes.iter().any(|known| known.full_name() == name) {
            self.note_mistake(|| format!("two passes are called {name}"));
        }
        let holds_depth = |id: usize| self.holds_depth(id);
        if let Some(image) = two_layouts(pass, holds_depth) {
            let image = self.resources[image].name.clone();
            self.note_mistake(|| format!("{name} uses the image {image} in two layouts"));
        }
        for counter in &pass.counters {
            let resource = self.resources[counter.buffer].name.clone();
            let uses = |access: &Access| matches!(access, Access::Buffer { buffer, .. } if *buffer == counter.buffer);
            if !pass.accesses().any(uses) {
                self.note_mistake(|| format!("{name} counts {} in {resource}, which it does not use", counter.name));
            }
            self.note_beyond(&name, counter.buffer, counter.offset, 1);
        }
        match &pass.work {
            Work::DispatchIndirect { buffer, offset } => self.note_beyond(&name, *buffer, *offset, DISPATCH_WORDS),
            Work::Draw(Draws::Indirect { buffer, offset, count }) => {
                self.note_beyond(&name, *buffer, *offset, DRAW_WORDS * u64::from(*count));
            }
            _ => {}
        }
    }

    fn note_beyond(&mut self, pass: &str, buffer: usize, offset: u64, words: u64) {
        let resource = &self.resources[buffer];
        let bytes = match &resource.body {
            Body::Buffer { bytes } => *bytes,
            Body::Upload(data) => data.len() as u64,
            Body::ExternalBuffer(buffer) => buffer.size,
            Body::Image(_) | Body::ExternalImage(_) => 0,
        };
        if offset + 4 * words > bytes {
            let (name, index) = (resource.name.clone(), offset / 4);
            self.note_mistake(|| {
                format!("{pass} takes {words} words from word {index} on of {name}, which has {}", bytes / 4)
            });
        }
    }

    pub(super) fn note_read_of_nothing(&mut self, pass: &Pass, (resource, place): Place, key: u64) {
        let resource = &self.resources[resource];
        if key != NOTHING || stands_for_nothing(&resource.name) {
            return;
        }
        let what = match &resource.body {
            Body::Image(info) if info.parts() > 1 => {
                let [level, layer] = info.level_and_layer(place);
                let layer = if info.layers > 1 { format!(" of layer {layer}") } else { String::new() };
                format!("level {level}{layer} of {}", resource.name)
            }
            _ => resource.name.clone(),
        };
        let name = pass.full_name();
        self.note_mistake(|| format!("{name} reads {what}, which nobody has written"));
    }
}
