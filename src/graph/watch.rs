//! What each pass writes, told to somebody who looks at it right after the pass.

use ash::vk;

use super::bindings::{Access, BufferRef, BufferUse, ImageRef, ImageUse};
use super::declare::{Graph, Output, Watcher, places};
use super::pass::Pass;
use super::resource::Body;

impl Graph<'_> {
    /// Lets `watcher` declare passes after each one that is declared from now on, but for its own.
    pub(crate) fn watch(&mut self, watcher: Watcher) {
        self.watcher = Some(watcher);
    }

    /// The buffers that passes read as texels of floats, by name, with their formats: what their words are is known from that alone.
    pub(crate) fn float_texels(&self) -> Vec<(String, vk::Format)> {
        let accesses = self.passes.iter().flat_map(Pass::accesses);
        let texels = accesses.filter_map(|access| match access {
            Access::Buffer { buffer, usage: BufferUse::Texels(format) } => Some((*buffer, *format)),
            _ => None,
        });
        let floats = [vk::Format::R32_SFLOAT, vk::Format::R32G32_SFLOAT, vk::Format::R32G32B32A32_SFLOAT];
        let mut found: Vec<(String, vk::Format)> = texels
            .filter(|(_, format)| floats.contains(format))
            .map(|(buffer, format)| (self.resources[buffer].name.clone(), format))
            .collect();
        found.sort();
        found.dedup();
        found
    }

    /// Tells the watcher of the pass that was added last.
    pub(super) fn tell_watcher(&mut self, accesses: &[Access]) {
        let Some(mut watcher) = self.watcher.take() else { return };
        let name = self.passes.last().map(Pass::full_name).unwrap_or_default();
        let mut outputs = Vec::new();
        for access in accesses {
            for ((id, place), _, writes) in places(access) {
                let resource = &self.resources[id];
                let output = match (&resource.body, access) {
                    (Body::Image(info), Access::Image { usage, .. }) if !matches!(usage, ImageUse::Depth { .. }) => {
                        let [mip, layer] = info.level_and_layer(place);
                        Output::Image(ImageRef::whole(id, *info).mip(mip).layer(layer))
                    }
                    (Body::Buffer { bytes }, _) => Output::Buffer(BufferRef {
                        id,
                        count: usize::try_from(bytes / 4).unwrap_or(0),
                        element: std::marker::PhantomData,
                    }),
                    _ => continue,
                };
                if writes {
                    outputs.push((resource.name.clone(), output));
                }
            }
        }
        watcher(self, &name, &outputs);
        self.watcher = Some(watcher);
    }
}
