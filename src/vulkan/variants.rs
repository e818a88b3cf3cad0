//! What is done in another way on devices that offer no more than Vulkan promises.

use ash::vk;

/// Names how lists are read, `texels` or `storage`, where the device's limits shall not decide it.
const LISTS: &str = "IRRADIA_LISTS";
/// Names which depths are read, `rasterised` or `planes`, likewise.
const DEPTHS: &str = "IRRADIA_DEPTHS";

/// Fewer texels than this in a texel buffer are too few: a vertex takes three, a path as many as eight.
const ENOUGH_TEXELS: u32 = 1 << 26;
/// With fewer bits a vertex is moved so far to the grid of sub-pixels that depths are not those of planes at pixels' centres.
const ENOUGH_SUB_PIXEL_BITS: u32 = 8;

/// Which variants a device runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Variants {
    /// Lists that shaders read as texels are storage buffers (storage_texels).
    pub(crate) texels_in_storage: bool,
    /// Depths are those of the triangles' planes (src/frame/plane_depth.rs).
    pub(crate) plane_depths: bool,
}

impl Variants {
    pub(crate) fn of(limits: &vk::PhysicalDeviceLimits) -> Variants {
        Variants {
            texels_in_storage: match std::env::var(LISTS).as_deref() {
                Ok("storage") => true,
                Ok("texels") => false,
                _ => limits.max_texel_buffer_elements < ENOUGH_TEXELS,
            },
            plane_depths: match std::env::var(DEPTHS).as_deref() {
                Ok("planes") => true,
                Ok("rasterised") => false,
                _ => limits.sub_pixel_precision_bits < ENOUGH_SUB_PIXEL_BITS,
            },
        }
    }
}
