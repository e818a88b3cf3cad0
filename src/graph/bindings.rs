//! Handles of images and buffers, and the typed ways in which a pass binds them. The structs that build.rs generates
//! hold these types, so that a sampled image cannot stand where a storage image belongs.

use std::marker::PhantomData;
use std::ops::Range;

use ash::vk;

use crate::vulkan::program::Program;
use crate::vulkan::{ImageInfo, SamplerKind};

/// What a pass binds to one set of its program.
pub(crate) trait BindingSet {
    const PROGRAM: &'static Program;
    const SET: u32;
    /// Every binding that the program uses, with what is bound to it; `None`: nothing, since the program is specialised not to read it.
    fn visit(&self, visitor: &mut dyn FnMut(u32, Option<Access>));
    fn push_bytes(&self) -> &[u8];
    fn constants(&self) -> Vec<u32>;
}

/// An image of the frame, or some of its mip levels. A copyable name, not the memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ImageRef {
    pub(super) id: usize,
    pub(super) mips: (u32, u32),
    pub(super) layers: (u32, u32),
    pub(super) info: ImageInfo,
}

impl ImageRef {
    pub(crate) fn info(&self) -> ImageInfo {
        self.info
    }

    /// All levels and layers of an image.
    pub(super) fn whole(id: usize, info: ImageInfo) -> ImageRef {
        ImageRef { id, mips: (0, info.mips), layers: (0, info.layers), info }
    }

    /// Only layer `layer`, or face `layer` of a cube: +x, −x, +y, −y, +z, −z.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests draw layers; the methods that do so come later"))]
    pub(crate) fn layer(self, layer: u32) -> ImageRef {
        ImageRef { layers: (layer, layer + 1), ..self }
    }

    pub(super) fn part(self) -> Part {
        Part { mips: self.mips.0..self.mips.1, layers: self.layers.0..self.layers.1, levels: self.info.mips }
    }

    /// Width and height of the first of its mip levels.
    pub(crate) fn size(&self) -> [u32; 2] {
        [0, 1].map(|axis| (self.info.extent[axis] >> self.mips.0).max(1))
    }

    /// Only mip level `level`.
    pub(crate) fn mip(self, level: u32) -> ImageRef {
        ImageRef { mips: (level, level + 1), ..self }
    }

    /// For `texelFetch`, or the nearest texel.
    pub(crate) fn sampled(self) -> SampledImage {
        self.sampled_with(SamplerKind::NearestClamp)
    }

    pub(crate) fn sampled_with(self, sampler: SamplerKind) -> SampledImage {
        SampledImage(Some(self.access(ImageUse::Sampled(sampler))))
    }

    pub(crate) fn read(self) -> ReadImage {
        ReadImage(Some(self.access(ImageUse::StorageRead)))
    }

    /// Every texel is written; what was there before does not matter.
    pub(crate) fn write(self) -> WriteImage {
        WriteImage(Some(self.access(ImageUse::StorageWrite)))
    }

    /// Some texels are written; what the others hold is undefined, and nobody may care.
    pub(crate) fn start(self) -> WriteImage {
        WriteImage(Some(self.access(ImageUse::StorageStart)))
    }

    /// Some texels are written; the others keep what they held.
    pub(crate) fn modify(self) -> WriteImage {
        WriteImage(Some(self.access(ImageUse::StorageModify)))
    }

    pub(crate) fn read_write(self) -> ReadWriteImage {
        ReadWriteImage(Some(self.access(ImageUse::StorageModify)))
    }

    /// Some texels are written, before they are read; what the others hold is undefined, and nobody may care.
    pub(crate) fn start_then_read(self) -> ReadWriteImage {
        ReadWriteImage(Some(self.access(ImageUse::StorageStart)))
    }

    pub(super) fn access(self, usage: ImageUse) -> Access {
        Access::Image { image: self.id, part: self.part(), usage }
    }
}

/// A buffer of the frame that holds elements of `T`. A copyable name, not the memory.
#[derive(Debug)]
pub(crate) struct BufferRef<T> {
    pub(super) id: usize,
    pub(super) count: usize,
    pub(super) element: PhantomData<fn() -> T>,
}

impl<T> Clone for BufferRef<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for BufferRef<T> {}

impl<T> BufferRef<T> {
    /// Number of elements.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    pub(crate) fn uniform(self) -> Uniform<T> {
        Uniform(Some(self.access(BufferUse::Uniform)), PhantomData)
    }

    pub(crate) fn read(self) -> ReadBuffer<T> {
        ReadBuffer(Some(self.access(BufferUse::Read)), PhantomData)
    }

    /// Every element is written; what was there before does not matter.
    pub(crate) fn write(self) -> WriteBuffer<T> {
        WriteBuffer(Some(self.access(BufferUse::Write)), PhantomData)
    }

    /// Some elements are written; what the others hold is undefined, and nobody may care.
    pub(crate) fn start(self) -> WriteBuffer<T> {
        WriteBuffer(Some(self.access(BufferUse::Start)), PhantomData)
    }

    /// Some elements are written; the others keep what they held.
    pub(crate) fn modify(self) -> WriteBuffer<T> {
        WriteBuffer(Some(self.access(BufferUse::Modify)), PhantomData)
    }

    pub(crate) fn read_write(self) -> ReadWriteBuffer<T> {
        ReadWriteBuffer(Some(self.access(BufferUse::Modify)), PhantomData)
    }

    /// Every element is written before it is read; what was there before does not matter.
    pub(crate) fn write_then_read(self) -> ReadWriteBuffer<T> {
        ReadWriteBuffer(Some(self.access(BufferUse::Write)), PhantomData)
    }

    /// Some elements are written, before they are read; what the others hold is undefined, and nobody may care.
    pub(crate) fn start_then_read(self) -> ReadWriteBuffer<T> {
        ReadWriteBuffer(Some(self.access(BufferUse::Start)), PhantomData)
    }

    /// As texels of `format`, the fastest way to read a list in an inner loop on the software driver.
    pub(crate) fn texels(self, format: vk::Format) -> TexelBuffer {
        TexelBuffer(Some(self.access(BufferUse::Texels(format))))
    }

    pub(super) fn access(self, usage: BufferUse) -> Access {
        Access::Buffer { buffer: self.id, usage }
    }
}

/// Some levels of some layers of an image.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Part {
    pub(super) mips: Range<u32>,
    pub(super) layers: Range<u32>,
    /// All levels of the image.
    pub(super) levels: u32,
}

impl Part {
    /// Their numbers, as [`ImageInfo::level_and_layer`] has them.
    pub(super) fn places(&self) -> impl Iterator<Item = u32> + use<> {
        let (mips, levels) = (self.mips.clone(), self.levels);
        self.layers.clone().flat_map(move |layer| mips.clone().map(move |mip| layer * levels + mip))
    }
}

/// One use of one resource by one pass.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Access {
    Image { image: usize, part: Part, usage: ImageUse },
    Buffer { buffer: usize, usage: BufferUse },
}

/// How a pass uses an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum ImageUse {
    Sampled(SamplerKind),
    StorageRead,
    /// Writes everything.
    StorageWrite,
    /// Writes some; nobody cares for what the rest holds.
    StorageStart,
    /// Reads or keeps what it does not write.
    StorageModify,
    /// A colour attachment; `keep`: drawn over what it holds.
    Color {
        keep: bool,
    },
    /// A depth or stencil attachment that is written; `keep` as above.
    Depth {
        keep: bool,
    },
    /// A depth or stencil attachment that is only tested against.
    DepthTest,
    /// Cleared by the transfer engine.
    Clear,
}

/// How a pass uses a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum BufferUse {
    Uniform,
    Read,
    /// Writes everything.
    Write,
    /// Writes some; nobody cares for what the rest holds.
    Start,
    /// Reads or keeps what it does not write.
    Modify,
    /// What stands for nothing: the program could read and write it, and is specialised not to.
    Absent,
    Texels(vk::Format),
    Indirect,
    Clear,
}

macro_rules! image_binding {
    ($($(#[$doc:meta])* $name:ident),*) => { $(
        $(#[$doc])*
        #[derive(Clone, Debug)]
        pub(crate) struct $name(pub(super) Option<Access>);

        impl $name {
            pub(crate) fn access(&self) -> Option<Access> {
                self.0.clone()
            }
        }
    )* };
}

image_binding! {
    /// `sampler2D` and its like.
    SampledImage,
    /// A `readonly` storage image.
    ReadImage,
    /// A `writeonly` storage image.
    WriteImage,
    /// A storage image that is read and written.
    ReadWriteImage,
    /// `samplerBuffer`.
    TexelBuffer
}

macro_rules! buffer_binding {
    ($($(#[$doc:meta])* $name:ident),*) => { $(
        $(#[$doc])*
        #[derive(Debug)]
        pub(crate) struct $name<T>(pub(super) Option<Access>, pub(super) PhantomData<fn() -> T>);

        impl<T> Clone for $name<T> {
            fn clone(&self) -> Self {
                $name(self.0.clone(), PhantomData)
            }
        }

        impl<T> $name<T> {
            pub(crate) fn access(&self) -> Option<Access> {
                self.0.clone()
            }
        }
    )* };
}

buffer_binding! {
    /// A uniform block.
    Uniform,
    /// A `readonly` buffer.
    ReadBuffer,
    /// A `writeonly` buffer.
    WriteBuffer,
    /// A buffer that is read and written.
    ReadWriteBuffer
}

// What programs read may be left out where a specialisation constant keeps them from reading it: the graph then binds something that nobody
// writes.

impl SampledImage {
    pub(crate) fn absent() -> SampledImage {
        SampledImage(None)
    }

    /// `image` if there is one.
    pub(crate) fn of(image: Option<ImageRef>) -> SampledImage {
        image.map_or(SampledImage::absent(), ImageRef::sampled)
    }
}

impl TexelBuffer {
    pub(crate) fn absent() -> TexelBuffer {
        TexelBuffer(None)
    }
}

impl<T> ReadBuffer<T> {
    pub(crate) fn absent() -> ReadBuffer<T> {
        ReadBuffer(None, PhantomData)
    }
}

impl<T> ReadWriteBuffer<T> {
    pub(crate) fn absent() -> ReadWriteBuffer<T> {
        ReadWriteBuffer(None, PhantomData)
    }
}
