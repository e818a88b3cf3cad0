//! Whether light from a VPL may be blocked: not at all, by imperfect shadow maps, or by rays.

use glam::DVec3;

use super::ism::imperfect_shadow_maps;
use super::options::{VplOptions, VplVisibility as Setting};
use crate::graph::Dependence;
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::method::FrameCx;
use crate::shaders::groups::{SceneRays, VplVisibility};
use crate::shaders::types::VplRays;

/// The kinds of glsl/groups/vpl_visibility.glsl.
const NONE: u32 = 0;
const ISM: u32 = 1;
pub(super) const TRACED: u32 = 2;

/// What kernels bind that ask whether light is blocked, or send paths on (glsl/vpl/visibility.glsl).
#[derive(Clone)]
pub(super) struct Visibility {
    pub(super) group: VplVisibility,
    /// The scene as rays meet it; absent in a frame that traces none.
    pub(super) scene: SceneRays,
}

impl Visibility {
    /// Of a frame in which nothing is blocked yet.
    pub(super) fn new(cx: &mut FrameCx<'_, '_>) -> Visibility {
        let (radius, origin, traced) = (cx.frame.data.radius, cx.frame.data.origin, cx.rays());
        let graph = &mut *cx.graph;
        let shift = traced.map_or(DVec3::ZERO, |traced| origin - traced.origin).as_vec3().to_array();
        let rays = VplRays { shift, radius: radius as f32 };
        let vpl_rays = graph.upload("vpl.rays", &[rays], Dependence::GEOMETRY).uniform();
        let ism_maps = TexelBuffer::absent();
        Visibility {
            group: VplVisibility { ism_maps, vpl_rays, visibility: NONE, ism_resolution: 1 },
            scene: traced.map_or_else(SceneRays::absent, |traced| traced.rays(graph)),
        }
    }

    /// As the settings say, for all of `vpls`.
    pub(super) fn of(
        mut self,
        cx: &mut FrameCx<'_, '_>,
        options: &VplOptions,
        vpls: BufferRef<[f32; 4]>,
    ) -> Visibility {
        match options.visibility {
            Setting::None => {}
            Setting::Ism => {
                let maps = imperfect_shadow_maps(cx.graph, cx.frame.data, cx.frame.geometry, vpls, options);
                self.group.visibility = ISM;
                self.group.ism_resolution = maps.resolution;
                self.group.ism_maps = maps.texels();
            }
            Setting::Traced => self.group.visibility = TRACED,
        }
        self
    }
}
