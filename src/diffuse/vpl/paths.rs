//! Further bounces: paths from VPL to VPL through the scene's hierarchy (Keller 1997).
//!
//! Of the VPLs of a bounce a fixed share sends a path on, so that their number falls as the light does, and what is left of them
//! carries all of the flux that the scene reflects. A path ends in a VPL of the surface's diffuse lobe; what a specular lobe there would send on is
//! left out.

use ash::vk;

use super::options::VplOptions;
use super::visibility::Visibility;
use crate::graph::bindings::BufferRef;
use crate::method::FrameCx;
use crate::shaders::types;
use crate::shaders::vpl::{Copy, CopyPush, PathHits, PathHitsPush, PathVpls, PathVplsPush};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// p̄, about what the surfaces of a room reflect: VPLs of the next bounce for those of one, so that all carry like flux.
const SHARE: [u32; 2] = [2, 3];

/// VPLs of each bounce.
fn counts(first: u32, bounces: u32) -> Vec<u32> {
    (0..bounces)
        .scan(first, |count, _| Some(std::mem::replace(count, (*count * SHARE[0]).div_ceil(SHARE[1]))))
        .collect()
}

/// VPLs of all bounces.
pub(super) fn count_of_all(options: &VplOptions) -> u32 {
    counts(options.count, options.bounces).iter().sum()
}

/// Declares the passes that add the bounces beyond the first to `first_bounce`; returns the VPLs of all.
pub(super) fn with_bounces(
    cx: &mut FrameCx<'_, '_>,
    options: &VplOptions,
    visibility: &Visibility,
    first_bounce: BufferRef<[f32; 4]>,
) -> BufferRef<[f32; 4]> {
    if cx.rays().is_none() || options.bounces <= 1 {
        return first_bounce;
    }
    let graph = &mut *cx.graph;
    let counts = counts(options.count, options.bounces);
    let all: u32 = counts.iter().sum();
    let vpls = graph.buffer::<[f32; 4]>("vpl.all", 2 * all as usize);
    let texel_count = 2 * counts[0];
    let pass = Copy { first_bounce: first_bounce.texels(FLOATS), vpls: vpls.start(), push: CopyPush { texel_count } };
    graph.pass("diffuse/vpl/paths/copy", pass).threads([texel_count, 1, 1]);

    let mut parents = 0;
    for (number, pair) in (2..).zip(counts.windows(2)) {
        let [parent_count, child_count] = [pair[0], pair[1]];
        let children = parents + parent_count;
        let bounce = types::Bounce { parents, parent_count, children, child_count, number };
        let hits = graph.buffer::<[f32; 4]>(&format!("vpl.path_hits.{number}"), child_count as usize);
        let pass = PathHits {
            vpls: vpls.texels(FLOATS),
            scene_rays: visibility.scene.clone(),
            vpl_visibility: visibility.group.clone(),
            hits: hits.write(),
            push: PathHitsPush { bounce },
        };
        let name = format!("diffuse/vpl/paths/hits-{number}");
        graph.pass(&name, pass).note("rays", u64::from(child_count)).threads([child_count, 1, 1]);
        let pass = PathVpls {
            hits: hits.texels(FLOATS),
            scene_rays: visibility.scene.clone(),
            vpl_visibility: visibility.group.clone(),
            vpls: vpls.read_write(),
            push: PathVplsPush { bounce },
        };
        let name = format!("diffuse/vpl/paths/vpls-{number}");
        graph.pass(&name, pass).note("VPLs", u64::from(child_count)).threads([child_count, 1, 1]);
        parents = children;
    }
    vpls
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_lights_falls_by_a_third_a_bounce() {
        assert_eq!(counts(256, 4), [256, 171, 114, 76]);
        assert_eq!(counts(1, 3), [1, 1, 1]);
        assert!(counts(65536, 16).iter().sum::<u32>() < 200_000);
        assert_eq!(counts(5, 1), [5]);
    }
}
