//! Features as hosts have them: the chain that a device must be created with, and the one that it was created with.

#![allow(unsafe_code, reason = "chains of structs are raw pointers")]

use ash::vk;

use super::features::Features;

impl Features {
    /// The same for a host, whose semaphores count.
    pub(super) fn with_timelines(mut self) -> Features {
        self.vulkan12.timeline_semaphore = vk::TRUE;
        self
    }

    /// What a host says that it enabled: a chain that begins with a `VkPhysicalDeviceFeatures2`, as it stood behind its `VkDeviceCreateInfo`.
    ///
    /// # Safety
    /// `chain` is null or such a chain.
    pub(super) unsafe fn of_chain(chain: *const std::ffi::c_void) -> Features {
        let mut found = Features::default();
        let mut next = chain.cast::<vk::BaseInStructure<'_>>();
        // SAFETY: the caller's: each struct says which it is and where the next one lies.
        while let Some(base) = unsafe { next.as_ref() } {
            // SAFETY: the type says what it points to.
            unsafe {
                match base.s_type {
                    vk::StructureType::PHYSICAL_DEVICE_FEATURES_2 => {
                        found.core = next.cast::<vk::PhysicalDeviceFeatures2<'_>>().read().features;
                    }
                    vk::StructureType::PHYSICAL_DEVICE_VULKAN_1_2_FEATURES => {
                        let all = next.cast::<vk::PhysicalDeviceVulkan12Features<'_>>().read();
                        found.vulkan12.scalar_block_layout |= all.scalar_block_layout;
                        found.vulkan12.host_query_reset |= all.host_query_reset;
                        found.vulkan12.timeline_semaphore |= all.timeline_semaphore;
                    }
                    vk::StructureType::PHYSICAL_DEVICE_VULKAN_1_3_FEATURES => {
                        let all = next.cast::<vk::PhysicalDeviceVulkan13Features<'_>>().read();
                        found.vulkan13.synchronization2 |= all.synchronization2;
                        found.vulkan13.dynamic_rendering |= all.dynamic_rendering;
                        found.vulkan13.maintenance4 |= all.maintenance4;
                    }
                    vk::StructureType::PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES => {
                        let one = next.cast::<vk::PhysicalDeviceScalarBlockLayoutFeatures<'_>>().read();
                        found.vulkan12.scalar_block_layout |= one.scalar_block_layout;
                    }
                    vk::StructureType::PHYSICAL_DEVICE_HOST_QUERY_RESET_FEATURES => {
                        let one = next.cast::<vk::PhysicalDeviceHostQueryResetFeatures<'_>>().read();
                        found.vulkan12.host_query_reset |= one.host_query_reset;
                    }
                    vk::StructureType::PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES => {
                        let one = next.cast::<vk::PhysicalDeviceTimelineSemaphoreFeatures<'_>>().read();
                        found.vulkan12.timeline_semaphore |= one.timeline_semaphore;
                    }
                    vk::StructureType::PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES => {
                        let one = next.cast::<vk::PhysicalDeviceSynchronization2Features<'_>>().read();
                        found.vulkan13.synchronization2 |= one.synchronization2;
                    }
                    vk::StructureType::PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES => {
                        let one = next.cast::<vk::PhysicalDeviceDynamicRenderingFeatures<'_>>().read();
                        found.vulkan13.dynamic_rendering |= one.dynamic_rendering;
                    }
                    vk::StructureType::PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES => {
                        let one = next.cast::<vk::PhysicalDeviceMaintenance4Features<'_>>().read();
                        found.vulkan13.maintenance4 |= one.maintenance4;
                    }
                    _ => {}
                }
            }
            next = base.p_next;
        }
        found
    }

    /// Whether a host may hand over timeline semaphores.
    pub(super) fn timelines(&self) -> bool {
        self.vulkan12.timeline_semaphore == vk::TRUE
    }
}

/// A chain for `VkDeviceCreateInfo::pNext`, which stays where it is as long as this lives.
pub(crate) struct FeatureChain {
    head: Box<vk::PhysicalDeviceFeatures2<'static>>,
    _features: Box<Features>,
}

impl FeatureChain {
    pub(super) fn new(features: Features) -> FeatureChain {
        let mut features = Box::new(features.unchained());
        features.vulkan13.p_next = std::ptr::from_mut(&mut features.vulkan12).cast();
        let mut head = Box::new(vk::PhysicalDeviceFeatures2::default().features(features.core));
        head.p_next = std::ptr::from_mut(&mut features.vulkan13).cast();
        FeatureChain { head, _features: features }
    }

    /// The `VkPhysicalDeviceFeatures2` that it begins with.
    pub(crate) fn head(&self) -> *const std::ffi::c_void {
        std::ptr::from_ref(&*self.head).cast()
    }
}

// SAFETY: its pointers lead to boxes of its own, which nobody writes to.
unsafe impl Send for FeatureChain {}
// SAFETY: as above.
unsafe impl Sync for FeatureChain {}

#[cfg(test)]
mod tests {
    use super::super::Validation;
    use super::*;

    #[test]
    fn what_a_host_enabled_is_read_from_its_chain() {
        let wanted = Features::wanted(&Features::default(), false, Validation::Off).with_timelines();
        let chain = FeatureChain::new(wanted);
        // SAFETY: a chain of living structs.
        let read = unsafe { Features::of_chain(chain.head()) };
        assert_eq!((read.missing(), read.timelines()), (None, true));
        // SAFETY: null is no features at all.
        let none = unsafe { Features::of_chain(std::ptr::null()) };
        assert_eq!(none.missing().map(|(name, _)| name), Some("synchronization2"));

        // One struct a feature, as programs write that were made for Vulkan 1.1.
        let mut layout = vk::PhysicalDeviceScalarBlockLayoutFeatures::default().scalar_block_layout(true);
        let mut reset = vk::PhysicalDeviceHostQueryResetFeatures::default().host_query_reset(true);
        let mut synchronization = vk::PhysicalDeviceSynchronization2Features::default().synchronization2(true);
        let mut rendering = vk::PhysicalDeviceDynamicRenderingFeatures::default().dynamic_rendering(true);
        let mut maintenance = vk::PhysicalDeviceMaintenance4Features::default();
        let core = vk::PhysicalDeviceFeatures {
            fragment_stores_and_atomics: vk::TRUE,
            draw_indirect_first_instance: vk::TRUE,
            independent_blend: vk::TRUE,
            ..Default::default()
        };
        let all = vk::PhysicalDeviceFeatures2::default()
            .features(core)
            .push_next(&mut layout)
            .push_next(&mut reset)
            .push_next(&mut synchronization)
            .push_next(&mut rendering)
            .push_next(&mut maintenance);
        // SAFETY: as above.
        let read = unsafe { Features::of_chain(std::ptr::from_ref(&all).cast()) };
        assert_eq!(read.missing().map(|(name, _)| name), Some("maintenance4"));
    }
}
