//! What passes are shaped by that depends on the driver.

use ash::vk;

/// Fewer texels than this in a texel buffer are too few: a vertex takes three, a path as many as eight.
const ENOUGH_TEXELS: u32 = 1 << 26;
/// With fewer bits a vertex is moved so far to the grid of sub-pixels that depths are not those of planes at pixels' centres.
const ENOUGH_SUB_PIXEL_BITS: u32 = 8;

/// How a driver runs shaders. All that is made otherwise for one driver than for another asks here; tests open devices that are taken for
/// others.
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
    /// Texel buffers are small: lists that shaders read as texels are storage buffers (storage_texels).
    pub(crate) texels_in_storage: bool,
    /// Vertices are rounded coarsely: depths that are read are those of the triangles' planes (src/frame/plane_depth.rs).
    pub(crate) plane_depths: bool,
}

impl DeviceTraits {
    /// Of a GPU: about what one works off in a tenth of a second.
    pub(crate) const GPU: DeviceTraits = DeviceTraits {
        software: false,
        lanes_in_step: false,
        loop_steps: 1 << 22,
        draws: true,
        texels_in_storage: false,
        plane_depths: false,
    };

    /// By what the device says of itself.
    pub(crate) fn of(
        properties: &vk::PhysicalDeviceProperties,
        driver: vk::DriverId,
        subgroup_size: u32,
    ) -> DeviceTraits {
        let any = DeviceTraits {
            software: properties.device_type == vk::PhysicalDeviceType::CPU,
            texels_in_storage: properties.limits.max_texel_buffer_elements < ENOUGH_TEXELS,
            plane_depths: properties.limits.sub_pixel_precision_bits < ENOUGH_SUB_PIXEL_BITS,
            ..DeviceTraits::GPU
        };
        match driver {
            // Loops end after 65,535 steps of all together. Fragment shaders crash its compiler where vectors have 16 lanes, which they have only
            // if LP_NATIVE_VECTOR_WIDTH says so.
            vk::DriverId::MESA_LLVMPIPE => {
                DeviceTraits { lanes_in_step: true, loop_steps: 65_535, draws: subgroup_size < 16, ..any }
            }
            vk::DriverId::GOOGLE_SWIFTSHADER => DeviceTraits { lanes_in_step: true, ..any },
            _ => any,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offering(device_type: vk::PhysicalDeviceType, texels: u32, bits: u32) -> vk::PhysicalDeviceProperties {
        let limits = vk::PhysicalDeviceLimits {
            max_texel_buffer_elements: texels,
            sub_pixel_precision_bits: bits,
            ..vk::PhysicalDeviceLimits::default()
        };
        vk::PhysicalDeviceProperties { device_type, limits, ..vk::PhysicalDeviceProperties::default() }
    }

    #[test]
    fn what_is_not_known_is_not_relied_on() {
        let cpu = offering(vk::PhysicalDeviceType::CPU, 1 << 27, 8);
        let lavapipe = DeviceTraits::of(&cpu, vk::DriverId::MESA_LLVMPIPE, 8);
        assert!(lavapipe.software && lavapipe.lanes_in_step && lavapipe.draws);
        assert!(!DeviceTraits::of(&cpu, vk::DriverId::MESA_LLVMPIPE, 16).draws);
        let unknown = DeviceTraits::of(&cpu, vk::DriverId::from_raw(9999), 4);
        assert_eq!(unknown, DeviceTraits { software: true, ..DeviceTraits::GPU });
        let gpu = offering(vk::PhysicalDeviceType::DISCRETE_GPU, 1 << 27, 8);
        assert_eq!(DeviceTraits::of(&gpu, vk::DriverId::NVIDIA_PROPRIETARY, 32), DeviceTraits::GPU);
    }

    #[test]
    fn the_least_limits_are_met_in_another_way() {
        let least = offering(vk::PhysicalDeviceType::DISCRETE_GPU, 1 << 16, 4);
        let traits = DeviceTraits::of(&least, vk::DriverId::from_raw(9999), 32);
        assert_eq!(traits, DeviceTraits { texels_in_storage: true, plane_depths: true, ..DeviceTraits::GPU });
    }
}
