//! What build.rs says of a program: its stages, bindings, push constants. All of it is static data.

use ash::vk;

use super::error::VulkanError;
#[cfg(debug_assertions)]
use super::live_shaders;

/// A shader program: one compute stage, or vertex, geometry and fragment stages.
#[derive(Debug)]
pub(crate) struct Program {
    pub(crate) name: &'static str,
    pub(crate) stages: &'static [Stage],
    pub(crate) bindings: &'static [Binding],
    pub(crate) push_size: u32,
    /// Identifiers of the specialisation constants, in the order in which the typed struct gives their values.
    pub(crate) constants: &'static [u32],
    pub(crate) local_size: [u32; 3],
}

impl Program {
    pub(crate) fn is_compute(&self) -> bool {
        self.stages.iter().any(|stage| stage.kind == StageKind::Compute)
    }

    /// What is declared with this number in set 0.
    pub(crate) fn binding(&self, number: u32) -> &Binding {
        let found = self.bindings.iter().find(|binding| (binding.set, binding.binding) == (0, number));
        found.expect("generated from the same SPIR-V")
    }

    pub(crate) fn has_set(&self, set: u32) -> bool {
        self.bindings.iter().any(|binding| binding.set == set)
    }

    /// The SPIR-V of each stage.
    pub(crate) fn spirv(&self) -> Result<Vec<Vec<u32>>, VulkanError> {
        #[cfg(debug_assertions)]
        if let Some(stages) = live_shaders::spirv(self.name)? {
            return Ok(stages);
        }
        Ok(self.stages.iter().map(|stage| stage.spirv.words()).collect())
    }

    pub(crate) fn stage_flags(&self) -> vk::ShaderStageFlags {
        self.stages.iter().fold(vk::ShaderStageFlags::empty(), |flags, stage| flags | stage.kind.flag())
    }
}

/// One stage of a program.
#[derive(Debug)]
pub(crate) struct Stage {
    pub(crate) kind: StageKind,
    pub(crate) needs: StageNeeds,
    pub(crate) spirv: Spirv,
}

/// What a stage asks of a device (src/vulkan/limits.rs).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct StageNeeds {
    /// Texel buffers count among them.
    pub(crate) sampled_images: u32,
    pub(crate) samplers: u32,
    pub(crate) storage_images: u32,
    pub(crate) uniform_buffers: u32,
    pub(crate) storage_buffers: u32,
    pub(crate) shared_bytes: u32,
    /// `VkSubgroupFeatureFlags`.
    pub(crate) subgroup_operations: u32,
    pub(crate) clip_distances: bool,
}

impl StageNeeds {
    pub(crate) fn bindings(&self) -> u32 {
        self.sampled_images + self.storage_images + self.uniform_buffers + self.storage_buffers
    }
}

/// SPIR-V as bytes in the machine's order.
pub(crate) struct Spirv(pub(crate) &'static [u8]);

impl Spirv {
    pub(crate) fn words(&self) -> Vec<u32> {
        self.0.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
    }
}

impl std::fmt::Debug for Spirv {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Spirv({} words)", self.0.len() / 4)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(dead_code, reason = "which stages occur depends on the shaders")]
pub(crate) enum StageKind {
    Vertex,
    Geometry,
    Fragment,
    Compute,
}

impl StageKind {
    pub(crate) fn flag(self) -> vk::ShaderStageFlags {
        match self {
            StageKind::Vertex => vk::ShaderStageFlags::VERTEX,
            StageKind::Geometry => vk::ShaderStageFlags::GEOMETRY,
            StageKind::Fragment => vk::ShaderStageFlags::FRAGMENT,
            StageKind::Compute => vk::ShaderStageFlags::COMPUTE,
        }
    }
}

/// A binding of a program.
#[derive(Debug)]
pub(crate) struct Binding {
    pub(crate) set: u32,
    pub(crate) binding: u32,
    pub(crate) kind: BindingKind,
    /// Of sampled images and texel buffers: whether shaders read integers.
    pub(crate) integers: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(dead_code, reason = "which kinds occur depends on the shaders")]
pub(crate) enum BindingKind {
    SampledImage(ImageDim),
    StorageImage(ImageDim),
    TexelBuffer,
    Uniform,
    Storage,
}

impl BindingKind {
    pub(crate) fn descriptor_type(self) -> vk::DescriptorType {
        match self {
            BindingKind::SampledImage(_) => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
            BindingKind::StorageImage(_) => vk::DescriptorType::STORAGE_IMAGE,
            BindingKind::TexelBuffer => vk::DescriptorType::UNIFORM_TEXEL_BUFFER,
            BindingKind::Uniform => vk::DescriptorType::UNIFORM_BUFFER,
            BindingKind::Storage => vk::DescriptorType::STORAGE_BUFFER,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(dead_code, reason = "which dimensions occur depends on the shaders")]
pub(crate) enum ImageDim {
    D2,
    D2Array,
    D3,
    Cube,
}

impl ImageDim {
    pub(crate) fn view_type(self) -> vk::ImageViewType {
        match self {
            ImageDim::D2 => vk::ImageViewType::TYPE_2D,
            ImageDim::D2Array => vk::ImageViewType::TYPE_2D_ARRAY,
            ImageDim::D3 => vk::ImageViewType::TYPE_3D,
            ImageDim::Cube => vk::ImageViewType::CUBE,
        }
    }
}
