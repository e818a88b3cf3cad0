//! What each kind of use demands of a barrier: stages, access, layout.

use ash::vk;

use super::barriers::Need;
use super::bindings::{Access, BufferUse, ImageUse};
use super::pass::Pass;

pub(super) const READ_ONLY_DEPTH: vk::ImageLayout = vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL;

/// A depth image that is sampled is in the layout in which it can be tested against too.
pub(super) fn layout_of(usage: ImageUse, holds_depth: bool) -> vk::ImageLayout {
    match usage {
        ImageUse::Sampled(_) if holds_depth => READ_ONLY_DEPTH,
        ImageUse::Sampled(_) => vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        ImageUse::StorageRead | ImageUse::StorageWrite | ImageUse::StorageStart | ImageUse::StorageModify => {
            vk::ImageLayout::GENERAL
        }
        ImageUse::Color { .. } => vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
        ImageUse::Depth { .. } => vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        ImageUse::DepthTest => READ_ONLY_DEPTH,
        ImageUse::Clear => vk::ImageLayout::TRANSFER_DST_OPTIMAL,
    }
}

/// What each place that a pass touches demands; several uses of one place by one pass are merged.
pub(super) fn merged_needs(
    pass: &Pass,
    shaders: vk::PipelineStageFlags2,
    holds_depth: impl Fn(usize) -> bool,
) -> Vec<(usize, u32, Need)> {
    let mut merged: Vec<(usize, u32, Need)> = Vec::new();
    for access in pass.accesses() {
        let (resource, places, need) = match access {
            Access::Image { image, part, usage } => {
                (*image, part.places().collect(), image_need(*usage, shaders, holds_depth(*image)))
            }
            Access::Buffer { buffer, usage } => (*buffer, vec![0], buffer_need(*usage, shaders)),
        };
        for place in places {
            match merged.iter_mut().find(|(known, known_place, _)| (*known, *known_place) == (resource, place)) {
                Some((_, _, known)) => {
                    known.stages |= need.stages;
                    known.access |= need.access;
                    known.writes |= need.writes;
                    known.discards &= need.discards;
                }
                None => merged.push((resource, place, need)),
            }
        }
    }
    merged
}

/// The image that a pass would need in two layouts at a time, if there is one.
pub(super) fn two_layouts(pass: &Pass, holds_depth: impl Fn(usize) -> bool) -> Option<usize> {
    let mut layouts: Vec<(usize, u32, vk::ImageLayout)> = Vec::new();
    for access in pass.accesses() {
        let Access::Image { image, part, usage } = access else { continue };
        let layout = layout_of(*usage, holds_depth(*image));
        for place in part.places() {
            match layouts.iter().find(|(known, at, _)| (*known, *at) == (*image, place)) {
                Some((.., known)) if *known != layout => return Some(*image),
                Some(_) => {}
                None => layouts.push((*image, place, layout)),
            }
        }
    }
    None
}

fn image_need(usage: ImageUse, shaders: vk::PipelineStageFlags2, holds_depth: bool) -> Need {
    use vk::AccessFlags2 as A;
    use vk::PipelineStageFlags2 as S;
    let depth_stages = S::EARLY_FRAGMENT_TESTS | S::LATE_FRAGMENT_TESTS;
    let (stages, access, writes, discards) = match usage {
        ImageUse::Sampled(_) => (shaders, A::SHADER_SAMPLED_READ, false, false),
        ImageUse::StorageRead => (shaders, A::SHADER_STORAGE_READ, false, false),
        ImageUse::StorageWrite | ImageUse::StorageStart => (shaders, A::SHADER_STORAGE_WRITE, true, true),
        ImageUse::StorageModify => (shaders, A::SHADER_STORAGE_READ | A::SHADER_STORAGE_WRITE, true, false),
        ImageUse::Color { keep } => {
            (S::COLOR_ATTACHMENT_OUTPUT, A::COLOR_ATTACHMENT_READ | A::COLOR_ATTACHMENT_WRITE, true, !keep)
        }
        ImageUse::Depth { keep } => {
            (depth_stages, A::DEPTH_STENCIL_ATTACHMENT_READ | A::DEPTH_STENCIL_ATTACHMENT_WRITE, true, !keep)
        }
        ImageUse::DepthTest => (depth_stages, A::DEPTH_STENCIL_ATTACHMENT_READ, false, false),
        ImageUse::Clear => (S::ALL_TRANSFER, A::TRANSFER_WRITE, true, true),
    };
    Need { stages, access, layout: layout_of(usage, holds_depth), writes, discards }
}

fn buffer_need(usage: BufferUse, shaders: vk::PipelineStageFlags2) -> Need {
    use vk::AccessFlags2 as A;
    use vk::PipelineStageFlags2 as S;
    let (stages, access, writes) = match usage {
        BufferUse::Uniform => (shaders, A::UNIFORM_READ, false),
        BufferUse::Read => (shaders, A::SHADER_STORAGE_READ, false),
        // Devices with small texel buffers read storage buffers in their place.
        BufferUse::Texels(_) => (shaders, A::SHADER_SAMPLED_READ | A::SHADER_STORAGE_READ, false),
        BufferUse::Write | BufferUse::Start => (shaders, A::SHADER_STORAGE_WRITE, true),
        // Validation knows nothing of what a program is specialised to, and takes this for a write.
        BufferUse::Absent | BufferUse::Modify => (shaders, A::SHADER_STORAGE_READ | A::SHADER_STORAGE_WRITE, true),
        BufferUse::Indirect => (S::DRAW_INDIRECT, A::INDIRECT_COMMAND_READ, false),
        BufferUse::Clear => (S::ALL_TRANSFER, A::TRANSFER_WRITE, true),
    };
    Need { stages, access, layout: vk::ImageLayout::UNDEFINED, writes, discards: false }
}
