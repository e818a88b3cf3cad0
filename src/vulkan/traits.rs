//! What passes are shaped by that depends on the driver and that no query of Vulkan tells.

use ash::vk;

/// How a driver runs shaders. All that is made otherwise for one driver than for another asks here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct DeviceTraits {
    /// Shaders run on the host's processor: memory is the host's, rasterising and filtering cost what their arithmetic costs.
    pub(crate) software: bool,
    /// The invocations of a subgroup are lanes of one vector: neighbouring local indices, all there, and together again behind every branch. The
    /// specification promises none of the three, so that passes which rest on it have another way.
    pub(crate) lanes_in_step: bool,
    /// Steps that all loops of one invocation may take together: the driver ends them there, or, of a GPU, the system ends a dispatch that
    /// holds it for seconds.
    pub(crate) loop_steps: u32,
    /// Whether its compiler takes fragment shaders: those of blits too.
    pub(crate) draws: bool,
}

impl DeviceTraits {
    /// Of a GPU: about what one works off in a tenth of a second.
    pub(crate) const GPU: DeviceTraits =
        DeviceTraits { software: false, lanes_in_step: false, loop_steps: 1 << 22, draws: true };

    /// By what the device says of itself.
    pub(crate) fn of(kind: vk::PhysicalDeviceType, driver: vk::DriverId, subgroup_size: u32) -> DeviceTraits {
        let software = kind == vk::PhysicalDeviceType::CPU;
        match driver {
            // Loops end after 65,535 steps of all together. Fragment shaders crash its compiler where vectors have 16 lanes, which they have only
            // if LP_NATIVE_VECTOR_WIDTH says so.
            vk::DriverId::MESA_LLVMPIPE => {
                DeviceTraits { software, lanes_in_step: true, loop_steps: 65_535, draws: subgroup_size < 16 }
            }
            vk::DriverId::GOOGLE_SWIFTSHADER => DeviceTraits { software, lanes_in_step: true, ..DeviceTraits::GPU },
            _ => DeviceTraits { software, ..DeviceTraits::GPU },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_known_is_not_relied_on() {
        let cpu = vk::PhysicalDeviceType::CPU;
        let lavapipe = DeviceTraits::of(cpu, vk::DriverId::MESA_LLVMPIPE, 8);
        assert!(lavapipe.software && lavapipe.lanes_in_step && lavapipe.draws);
        assert!(!DeviceTraits::of(cpu, vk::DriverId::MESA_LLVMPIPE, 16).draws);
        let unknown = DeviceTraits::of(cpu, vk::DriverId::from_raw(9999), 4);
        assert_eq!(unknown, DeviceTraits { software: true, ..DeviceTraits::GPU });
        let gpu = DeviceTraits::of(vk::PhysicalDeviceType::DISCRETE_GPU, vk::DriverId::NVIDIA_PROPRIETARY, 32);
        assert_eq!(gpu, DeviceTraits::GPU);
    }
}
