//! What is bound where a pass has nothing to bind: a descriptor must be valid even if the program is specialised never to read it.

use std::marker::PhantomData;

use ash::vk;

use super::bindings::{Access, BufferRef, BufferUse, ImageRef, ImageUse};
use super::declare::Graph;
use crate::vulkan::program::{Binding, BindingKind, ImageDim};
use crate::vulkan::{ImageInfo, SamplerKind};

/// Words of the buffer: the most that a texel has.
const WORDS: usize = 4;

/// What the names of such resources begin with.
const NOTHING: &str = "nothing.";

/// Whether a resource is one that nobody is meant to write.
pub(super) fn stands_for_nothing(name: &str) -> bool {
    name.starts_with(NOTHING)
}

impl Graph<'_> {
    /// A resource that nobody writes, in place of what `binding` would read. Passes that share it do not depend on each other.
    pub(super) fn nothing(&mut self, binding: &Binding) -> Access {
        match binding.kind {
            BindingKind::SampledImage(dim) => {
                self.no_image(dim, binding.integers).access(ImageUse::Sampled(SamplerKind::NearestClamp))
            }
            BindingKind::TexelBuffer if binding.integers => {
                self.no_buffer().access(BufferUse::Texels(vk::Format::R32G32B32A32_UINT))
            }
            BindingKind::TexelBuffer => self.no_buffer().access(BufferUse::Texels(vk::Format::R32G32B32A32_SFLOAT)),
            BindingKind::Storage => self.no_buffer().access(BufferUse::Absent),
            BindingKind::StorageImage(_) | BindingKind::Uniform => {
                unreachable!("storage images and uniform blocks are never left out")
            }
        }
    }

    fn named(&self, name: &str) -> Option<usize> {
        self.resources.iter().position(|resource| resource.name == name)
    }

    fn no_buffer(&mut self) -> BufferRef<u32> {
        let name = format!("{NOTHING}words");
        match self.named(&name) {
            Some(id) => BufferRef { id, count: WORDS, element: PhantomData },
            None => self.buffer(&name, WORDS),
        }
    }

    fn no_image(&mut self, dim: ImageDim, integers: bool) -> ImageRef {
        let format = if integers { vk::Format::R32_UINT } else { vk::Format::R32_SFLOAT };
        let info = ImageInfo {
            format,
            extent: [1; 3],
            mips: 1,
            layers: if dim == ImageDim::Cube { 6 } else { 1 },
            volume: dim == ImageDim::D3,
        };
        let name = format!("{NOTHING}{dim:?}.{format:?}").to_lowercase();
        match self.named(&name) {
            Some(id) => ImageRef::whole(id, info),
            None => self.image_with(&name, info),
        }
    }
}
