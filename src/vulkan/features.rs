//! The device features that irradia uses: those that it cannot do without, and those that it uses where they are.

#![allow(unsafe_code, reason = "chains of structs are raw pointers")]

use ash::vk;

use super::instance::{Instance, Validation};

/// Features of a device: offered, wanted, or enabled.
#[derive(Clone, Copy, Default)]
pub(crate) struct Features {
    pub(super) core: vk::PhysicalDeviceFeatures,
    pub(super) vulkan12: vk::PhysicalDeviceVulkan12Features<'static>,
    pub(super) vulkan13: vk::PhysicalDeviceVulkan13Features<'static>,
}

/// A feature that irradia cannot do without, and what needs it.
struct Requirement {
    name: &'static str,
    needed_by: &'static str,
    present: bool,
}

impl Features {
    /// All that a device has.
    pub(super) fn offered(instance: &Instance, device: vk::PhysicalDevice) -> Features {
        let mut found = Features::default();
        let mut features = vk::PhysicalDeviceFeatures2::default();
        features = features.push_next(&mut found.vulkan13).push_next(&mut found.vulkan12);
        // SAFETY: the device belongs to the living instance; the chained structures live on.
        unsafe { instance.raw.get_physical_device_features2(device, &mut features) };
        let core = features.features;
        found.core = core;
        found.unchained()
    }

    /// What a device is created with: what is required, and of the rest what is offered.
    pub(super) fn wanted(offered: &Features, texels_in_storage: bool, validation: Validation) -> Features {
        let core = vk::PhysicalDeviceFeatures {
            // A fetch beyond a texel buffer's end reads zeros, as a driver that has them does by itself.
            robust_buffer_access: vk::Bool32::from(texels_in_storage),
            fragment_stores_and_atomics: vk::TRUE,
            draw_indirect_first_instance: vk::TRUE,
            independent_blend: vk::TRUE,
            // Optional ones: used where present.
            geometry_shader: offered.core.geometry_shader,
            multi_draw_indirect: offered.core.multi_draw_indirect,
            pipeline_statistics_query: offered.core.pipeline_statistics_query,
            sampler_anisotropy: offered.core.sampler_anisotropy,
            shader_clip_distance: offered.core.shader_clip_distance,
            // GPU-assisted validation counts in vertex shaders and with 64-bit integers.
            vertex_pipeline_stores_and_atomics: offered.core.vertex_pipeline_stores_and_atomics,
            shader_int64: if validation == Validation::GpuAssisted { offered.core.shader_int64 } else { vk::FALSE },
            ..Default::default()
        };
        let vulkan12 = vk::PhysicalDeviceVulkan12Features::default().scalar_block_layout(true).host_query_reset(true);
        let vulkan13 = vk::PhysicalDeviceVulkan13Features::default()
            .synchronization2(true)
            .dynamic_rendering(true)
            .maintenance4(true);
        Features { core, vulkan12, vulkan13 }
    }

    /// What irradia cannot do without and is not there: its name, and what needs it.
    pub(super) fn missing(&self) -> Option<(&'static str, &'static str)> {
        let Features { core, vulkan12, vulkan13 } = self;
        let needs =
            |name, needed_by, present: vk::Bool32| Requirement { name, needed_by, present: present == vk::TRUE };
        let requirements = [
            needs("synchronization2", "the pass graph", vulkan13.synchronization2),
            needs("dynamicRendering", "every raster pass", vulkan13.dynamic_rendering),
            needs("maintenance4", "shaders with a local size by constant", vulkan13.maintenance4),
            needs("scalarBlockLayout", "structs shared with shaders", vulkan12.scalar_block_layout),
            needs("hostQueryReset", "timings", vulkan12.host_query_reset),
            needs("fragmentStoresAndAtomics", "lists built while rasterising", core.fragment_stores_and_atomics),
            needs("drawIndirectFirstInstance", "indirect draws", core.draw_indirect_first_instance),
            needs("independentBlend", "the G-buffer", core.independent_blend),
        ];
        let missing = requirements.into_iter().find(|requirement| !requirement.present);
        missing.map(|requirement| (requirement.name, requirement.needed_by))
    }

    /// As a chain, for as long as `self` stays where it is.
    pub(super) fn chain(&mut self) -> vk::PhysicalDeviceFeatures2<'_> {
        *self = self.unchained();
        vk::PhysicalDeviceFeatures2::default()
            .features(self.core)
            .push_next(&mut self.vulkan13)
            .push_next(&mut self.vulkan12)
    }

    /// Without pointers from one struct to the next.
    pub(super) fn unchained(mut self) -> Features {
        self.vulkan12.p_next = std::ptr::null_mut();
        self.vulkan13.p_next = std::ptr::null_mut();
        self
    }
}

// SAFETY: the pointers in it are null but while `chain` borrows it.
unsafe impl Send for Features {}
// SAFETY: as above.
unsafe impl Sync for Features {}
