//! Buffers and images: named, sub-allocated, freed by themselves.

#![allow(unsafe_code, reason = "creation and destruction of buffers and images")]

use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

use super::device::Device;
use super::error::{Called, VulkanError};
use super::program::ImageDim;

/// Where memory lies and who may touch it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Location {
    /// On the device alone.
    Device,
    /// Written by the host, read by the device.
    Upload,
    /// Written by the device, read by the host.
    ReadBack,
}

impl Location {
    fn memory(self) -> MemoryLocation {
        match self {
            Location::Device => MemoryLocation::GpuOnly,
            Location::Upload => MemoryLocation::CpuToGpu,
            Location::ReadBack => MemoryLocation::GpuToCpu,
        }
    }
}

/// Memory taken from the device's allocator, and its place in the register of the living.
struct Memory {
    device: Arc<Device>,
    allocation: Option<Allocation>,
    id: u64,
}

impl Memory {
    fn new(
        device: &Arc<Device>,
        name: &str,
        requirements: vk::MemoryRequirements,
        location: Location,
        linear: bool,
    ) -> Result<Memory, VulkanError> {
        let description = AllocationCreateDesc {
            name,
            requirements,
            location: location.memory(),
            linear,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        };
        let allocation = device.allocator().allocate(&description).map_err(|error| {
            tracing::debug!("gpu-allocator: {error}");
            let mib = requirements.size as f64 / f64::from(1 << 20);
            VulkanError::OutOfMemory { what: name.to_owned(), mib, last_pass: "none of this frame".to_owned() }
        })?;
        Ok(Memory {
            device: device.clone(),
            id: device.register(name, requirements.size),
            allocation: Some(allocation),
        })
    }

    fn allocation(&self) -> &Allocation {
        self.allocation.as_ref().expect("taken only by drop")
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        self.device.forget(self.id);
        if let Some(allocation) = self.allocation.take() {
            // Freeing fails only for an allocation of another allocator.
            let _ = self.device.allocator().free(allocation);
        }
    }
}

/// A buffer and the texel views made of it.
pub(crate) struct Buffer {
    pub(crate) raw: vk::Buffer,
    pub(crate) size: u64,
    views: Mutex<HashMap<vk::Format, vk::BufferView>>,
    name: String,
    // Freed after the buffer that lies in it.
    memory: Memory,
}

impl Buffer {
    /// A buffer of `size` bytes (at least one texel of 16, so that empty lists can be bound too).
    pub(crate) fn new(
        device: &Arc<Device>,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
        location: Location,
    ) -> Result<Buffer, VulkanError> {
        let size = size.max(16).next_multiple_of(4);
        let texels = vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER;
        let in_storage = device.traits().texels_in_storage && usage.contains(texels);
        let usage = if in_storage { usage & !texels | vk::BufferUsageFlags::STORAGE_BUFFER } else { usage };
        let info = vk::BufferCreateInfo::default().size(size).usage(usage).sharing_mode(vk::SharingMode::EXCLUSIVE);
        // SAFETY: the device is alive.
        let raw = unsafe { device.raw.create_buffer(&info, None) }.called(&format!("vkCreateBuffer for {name}"))?;
        // SAFETY: the buffer was just made.
        let requirements = unsafe { device.raw.get_buffer_memory_requirements(raw) };
        let bound = Memory::new(device, name, requirements, location, true).and_then(|memory| {
            let allocation = memory.allocation();
            // SAFETY: the memory meets the buffer's requirements and nothing is bound yet.
            unsafe { device.raw.bind_buffer_memory(raw, allocation.memory(), allocation.offset()) }
                .called(&format!("vkBindBufferMemory for {name}"))?;
            Ok(memory)
        });
        match bound {
            Ok(memory) => {
                device.set_name(raw, name);
                Ok(Buffer { raw, size, views: Mutex::default(), name: name.to_owned(), memory })
            }
            Err(error) => {
                // SAFETY: the buffer was never used.
                unsafe { device.raw.destroy_buffer(raw, None) };
                Err(error)
            }
        }
    }

    /// Bytes of device memory that it holds.
    pub(crate) fn bytes(&self) -> u64 {
        self.memory.allocation().size()
    }

    /// Its memory as the host sees it, if the host does.
    pub(crate) fn mapped(&self) -> Option<&[u8]> {
        self.memory.allocation().mapped_slice()?.get(..usize::try_from(self.size).ok()?)
    }

    /// Writes `bytes` at `offset`; `false` if the host does not see this memory or they do not fit.
    pub(crate) fn write(&mut self, offset: usize, bytes: &[u8]) -> bool {
        let mapped = self.memory.allocation.as_mut().and_then(Allocation::mapped_slice_mut);
        let place = mapped.and_then(|mapped| mapped.get_mut(offset..offset + bytes.len()));
        place.map(|place| place.copy_from_slice(bytes)).is_some()
    }

    /// A view of the whole buffer as texels of `format`; `None` where the device reads the buffer itself.
    pub(crate) fn texels(&self, format: vk::Format) -> Result<Option<vk::BufferView>, VulkanError> {
        let device = &self.memory.device;
        let limit = u64::from(device.limits().max_storage_buffer_range);
        if !device.traits().texels_in_storage {
            return self.texel_view(format).map(Some);
        }
        if self.size > limit {
            return Err(VulkanError::TooLarge {
                what: self.name.clone(),
                asked: format!("{} bytes", self.size),
                limit: limit.to_string(),
            });
        }
        Ok(None)
    }

    fn texel_view(&self, format: vk::Format) -> Result<vk::BufferView, VulkanError> {
        let device = &self.memory.device;
        let mut views = self.views.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(view) = views.get(&format) {
            return Ok(*view);
        }
        let elements = self.size / texel_bytes(format);
        let limit = u64::from(device.limits().max_texel_buffer_elements);
        if elements > limit {
            return Err(VulkanError::TooLarge {
                what: self.name.clone(),
                asked: format!("{elements} texels"),
                limit: limit.to_string(),
            });
        }
        let info = vk::BufferViewCreateInfo::default().buffer(self.raw).format(format).range(vk::WHOLE_SIZE);
        // SAFETY: the buffer is alive and was made for texel use.
        let view = unsafe { device.raw.create_buffer_view(&info, None) }
            .called(&format!("vkCreateBufferView for {}", self.name))?;
        views.insert(format, view);
        Ok(view)
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        let views = std::mem::take(self.views.get_mut().unwrap_or_else(PoisonError::into_inner));
        // SAFETY: the frame that used it has finished (module invariant).
        unsafe {
            for view in views.into_values() {
                self.memory.device.raw.destroy_buffer_view(view, None);
            }
            self.memory.device.raw.destroy_buffer(self.raw, None);
        }
    }
}

/// Shape and format of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ImageInfo {
    pub(crate) format: vk::Format,
    /// Width, height, depth in texels; depth 1 unless it is a volume.
    pub(crate) extent: [u32; 3],
    pub(crate) mips: u32,
    pub(crate) layers: u32,
    /// Whether it is a volume even if its depth is 1.
    pub(crate) volume: bool,
}

impl ImageInfo {
    /// Mip levels of all layers.
    pub(crate) fn parts(&self) -> u32 {
        self.mips * self.layers
    }

    /// The level and the layer that part number `part` is: layers after each other, each with all its levels.
    pub(crate) fn level_and_layer(&self, part: u32) -> [u32; 2] {
        [part % self.mips, part / self.mips]
    }

    /// Whether six layers may be the faces of a cube.
    pub(crate) fn holds_cubes(&self) -> bool {
        !self.volume && self.layers >= 6 && self.extent[0] == self.extent[1]
    }

    /// Bytes of one level of one layer, rows close together.
    pub(crate) fn part_bytes(&self, level: u32) -> u64 {
        let texels: u64 = self.extent.iter().map(|&length| u64::from((length >> level).max(1))).product();
        texels * texel_bytes(self.format)
    }

    pub(crate) fn aspect(&self) -> vk::ImageAspectFlags {
        match self.format {
            vk::Format::D32_SFLOAT => vk::ImageAspectFlags::DEPTH,
            vk::Format::S8_UINT => vk::ImageAspectFlags::STENCIL,
            vk::Format::D32_SFLOAT_S8_UINT => vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL,
            _ => vk::ImageAspectFlags::COLOR,
        }
    }
}

/// What of an image a view shows.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct SubresourceView {
    pub(crate) dim: ImageDim,
    pub(crate) mips: Range<u32>,
    pub(crate) layers: Range<u32>,
    pub(crate) aspect: vk::ImageAspectFlags,
    /// The image's own format, or another of the same texel size.
    pub(crate) format: vk::Format,
}

/// An image and the views made of it.
pub(crate) struct Image {
    pub(crate) raw: vk::Image,
    pub(crate) info: ImageInfo,
    views: Mutex<HashMap<SubresourceView, vk::ImageView>>,
    name: String,
    // Freed after the image that lies in it.
    memory: Memory,
}

impl Image {
    pub(crate) fn new(
        device: &Arc<Device>,
        name: &str,
        info: ImageInfo,
        usage: vk::ImageUsageFlags,
        flags: vk::ImageCreateFlags,
    ) -> Result<Image, VulkanError> {
        check_size(device, name, &info)?;
        let [width, height, depth] = info.extent;
        let kind = if info.volume { vk::ImageType::TYPE_3D } else { vk::ImageType::TYPE_2D };
        if !device.has_images(info.format, kind, usage, flags)? {
            let format = format!("{:?}", info.format).to_lowercase();
            let reason = format!("it has no images of format {format} for {usage:?}, which {name} needs");
            return Err(VulkanError::Unfit { device: device.report().name.clone(), reason });
        }
        let create = vk::ImageCreateInfo::default()
            .flags(flags)
            .image_type(kind)
            .format(info.format)
            .extent(vk::Extent3D { width, height, depth })
            .mip_levels(info.mips)
            .array_layers(info.layers)
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(usage)
            .sharing_mode(vk::SharingMode::EXCLUSIVE);
        // SAFETY: the device is alive; the size was checked against its limits.
        let raw = unsafe { device.raw.create_image(&create, None) }.called(&format!("vkCreateImage for {name}"))?;
        // SAFETY: the image was just made.
        let requirements = unsafe { device.raw.get_image_memory_requirements(raw) };
        let bound = Memory::new(device, name, requirements, Location::Device, false).and_then(|memory| {
            let allocation = memory.allocation();
            // SAFETY: the memory meets the image's requirements and nothing is bound yet.
            unsafe { device.raw.bind_image_memory(raw, allocation.memory(), allocation.offset()) }
                .called(&format!("vkBindImageMemory for {name}"))?;
            Ok(memory)
        });
        match bound {
            Ok(memory) => {
                device.set_name(raw, name);
                Ok(Image { raw, info, views: Mutex::default(), name: name.to_owned(), memory })
            }
            Err(error) => {
                // SAFETY: the image was never used.
                unsafe { device.raw.destroy_image(raw, None) };
                Err(error)
            }
        }
    }

    /// Bytes of device memory that it holds.
    pub(crate) fn bytes(&self) -> u64 {
        self.memory.allocation().size()
    }

    pub(crate) fn view(&self, what: &SubresourceView) -> Result<vk::ImageView, VulkanError> {
        let device = &self.memory.device;
        let mut views = self.views.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(view) = views.get(what) {
            return Ok(*view);
        }
        let range = vk::ImageSubresourceRange {
            aspect_mask: what.aspect,
            base_mip_level: what.mips.start,
            level_count: what.mips.end - what.mips.start,
            base_array_layer: what.layers.start,
            layer_count: what.layers.end - what.layers.start,
        };
        let info = vk::ImageViewCreateInfo::default()
            .image(self.raw)
            .view_type(what.dim.view_type())
            .format(what.format)
            .subresource_range(range);
        // SAFETY: the image is alive and the range lies within it.
        let view = unsafe { device.raw.create_image_view(&info, None) }
            .called(&format!("vkCreateImageView for {}", self.name))?;
        device.set_name(view, &self.name);
        views.insert(what.clone(), view);
        Ok(view)
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        let views = std::mem::take(self.views.get_mut().unwrap_or_else(PoisonError::into_inner));
        // SAFETY: the frame that used it has finished (module invariant).
        unsafe {
            for view in views.into_values() {
                self.memory.device.raw.destroy_image_view(view, None);
            }
            self.memory.device.raw.destroy_image(self.raw, None);
        }
    }
}

fn check_size(device: &Device, name: &str, info: &ImageInfo) -> Result<(), VulkanError> {
    let limits = device.limits();
    let side = if info.volume { limits.max_image_dimension3_d } else { limits.max_image_dimension2_d };
    let too_large = |asked: String, limit: u32| {
        Err(VulkanError::TooLarge { what: name.to_owned(), asked, limit: limit.to_string() })
    };
    if info.extent.iter().any(|&length| length > side) {
        return too_large(format!("{}x{}x{} texels", info.extent[0], info.extent[1], info.extent[2]), side);
    }
    if info.layers > limits.max_image_array_layers {
        return too_large(format!("{} layers", info.layers), limits.max_image_array_layers);
    }
    Ok(())
}

/// Bytes of one texel of the formats that texel buffers and read-backs use.
pub(crate) fn texel_bytes(format: vk::Format) -> u64 {
    match format {
        vk::Format::R32G32B32A32_SFLOAT | vk::Format::R32G32B32A32_UINT => 16,
        vk::Format::R16G16B16A16_SFLOAT | vk::Format::R32G32_SFLOAT | vk::Format::R32G32_UINT => 8,
        vk::Format::R8_UNORM | vk::Format::S8_UINT => 1,
        _ => 4,
    }
}
