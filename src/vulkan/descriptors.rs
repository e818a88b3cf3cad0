//! Descriptor sets: those of a recording, and those of materials, which outlive it.

#![allow(unsafe_code, reason = "every Vulkan command is an unsafe call")]

use std::sync::Arc;

use ash::vk;

use super::device::Device;
use super::error::{Called, VulkanError};
use super::program::BindingKind;
use super::recorder::Recorder;

/// What a descriptor points to.
pub(crate) enum Descriptor {
    Image { view: vk::ImageView, layout: vk::ImageLayout, sampler: vk::Sampler },
    Texels(vk::BufferView),
    Buffer(vk::Buffer),
}

impl Recorder {
    /// A descriptor set of this recording.
    pub(crate) fn descriptor_set(
        &self,
        layout: vk::DescriptorSetLayout,
        bindings: &[(u32, BindingKind, Descriptor)],
    ) -> Result<vk::DescriptorSet, VulkanError> {
        write_descriptor_set(&self.device, self.descriptors, layout, bindings)
    }
}

fn write_descriptor_set(
    device: &Device,
    pool: vk::DescriptorPool,
    layout: vk::DescriptorSetLayout,
    bindings: &[(u32, BindingKind, Descriptor)],
) -> Result<vk::DescriptorSet, VulkanError> {
    let layouts = [layout];
    let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
    // SAFETY: pool and layout are alive.
    let set = unsafe { device.raw.allocate_descriptor_sets(&info) }.called("vkAllocateDescriptorSets")?[0];
    enum Info {
        Image([vk::DescriptorImageInfo; 1]),
        Texels([vk::BufferView; 1]),
        Buffer([vk::DescriptorBufferInfo; 1]),
    }
    let infos: Vec<Info> = bindings
        .iter()
        .map(|(_, _, descriptor)| match *descriptor {
            Descriptor::Image { view, layout, sampler } => {
                Info::Image([vk::DescriptorImageInfo { sampler, image_view: view, image_layout: layout }])
            }
            Descriptor::Texels(view) => Info::Texels([view]),
            Descriptor::Buffer(buffer) => {
                Info::Buffer([vk::DescriptorBufferInfo { buffer, offset: 0, range: vk::WHOLE_SIZE }])
            }
        })
        .collect();
    let writes: Vec<_> = bindings
        .iter()
        .zip(&infos)
        .map(|((binding, kind, _), info)| {
            let write = vk::WriteDescriptorSet::default()
                .dst_set(set)
                .dst_binding(*binding)
                .descriptor_count(1)
                .descriptor_type(device.descriptor_type(*kind));
            match info {
                Info::Image(info) => write.image_info(info),
                Info::Texels(views) => write.texel_buffer_view(views),
                Info::Buffer(info) => write.buffer_info(info),
            }
        })
        .collect();
    // SAFETY: the set was just made and is not in use; everything the writes point to is alive.
    unsafe { device.raw.update_descriptor_sets(&writes, &[]) };
    Ok(set)
}

/// Descriptor sets that outlive a frame: what materials bind for their draws.
pub(crate) struct MaterialSets {
    device: Arc<Device>,
    pool: vk::DescriptorPool,
    sets: Vec<vk::DescriptorSet>,
}

impl MaterialSets {
    /// One set for each element of `materials`, all with `layout`.
    pub(crate) fn new(
        device: &Arc<Device>,
        layout: vk::DescriptorSetLayout,
        materials: &[Vec<(u32, BindingKind, Descriptor)>],
    ) -> Result<MaterialSets, VulkanError> {
        let count = u32::try_from(materials.len()).unwrap_or(u32::MAX).max(1);
        let textures = materials.iter().map(|bindings| bindings.len() as u32).sum::<u32>().max(1);
        let sizes =
            [vk::DescriptorPoolSize { ty: vk::DescriptorType::COMBINED_IMAGE_SAMPLER, descriptor_count: textures }];
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(count).pool_sizes(&sizes);
        // SAFETY: the device is alive.
        let pool =
            unsafe { device.raw.create_descriptor_pool(&info, None) }.called("vkCreateDescriptorPool for materials")?;
        let mut made = MaterialSets { device: device.clone(), pool, sets: Vec::new() };
        for bindings in materials {
            made.sets.push(write_descriptor_set(device, pool, layout, bindings)?);
        }
        Ok(made)
    }

    pub(crate) fn get(&self, index: usize) -> vk::DescriptorSet {
        self.sets[index]
    }
}

impl Drop for MaterialSets {
    fn drop(&mut self) {
        // SAFETY: the last frame that used the sets has finished (module invariant).
        unsafe { self.device.raw.destroy_descriptor_pool(self.pool, None) };
    }
}
