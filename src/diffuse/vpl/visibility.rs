//! Whether light from a VPL may be blocked: not at all, by imperfect shadow maps, or by rays.

use super::VplInputs;
use super::ism::{ImperfectShadowMaps, imperfect_shadow_maps};
use crate::graph::bindings::{BufferRef, Uniform};
use crate::graph::{Dependence, Graph};
use crate::reference::traced_scene::{TracedBindings, TracedScene};
use crate::renderer::VplVisibility;
use crate::shaders::types::VplRays;

/// How far from a VPL's surface rays end or start, as a share of the scene's radius.
const OFFSET: f64 = 3e-5;

/// The scene as rays meet it, and where it lies from render space.
pub(super) struct Rays {
    pub(super) scene: TracedBindings,
    pub(super) rays: Uniform<VplRays>,
    pub(super) alpha_masks: u32,
    pub(super) vertex_colors: u32,
}

impl Rays {
    pub(super) fn new(graph: &mut Graph<'_>, inputs: &VplInputs<'_>, traced: &TracedScene) -> Rays {
        let shift = (inputs.data.origin - traced.origin).as_vec3().to_array();
        let rays = VplRays { shift, offset: (traced.radius * OFFSET) as f32 };
        Rays {
            scene: traced.import(graph),
            rays: graph.upload("vpl.rays", &[rays], Dependence::GEOMETRY).uniform(),
            alpha_masks: u32::from(traced.facts.alpha_masked),
            vertex_colors: u32::from(traced.facts.vertex_colors),
        }
    }
}

/// What gathering asks for visibility.
pub(super) enum Visibility<'a> {
    None,
    Ism(ImperfectShadowMaps),
    Traced(&'a Rays),
}

impl Visibility<'_> {
    /// As the settings say, for the first `vpl_count` of `vpls`. `rays`: present where the frame traces any.
    pub(super) fn new<'a>(
        graph: &mut Graph<'_>,
        inputs: &VplInputs<'_>,
        rays: Option<&'a Rays>,
        vpls: BufferRef<[f32; 4]>,
        vpl_count: u32,
    ) -> Visibility<'a> {
        match (inputs.settings.visibility, rays) {
            (VplVisibility::Traced, Some(rays)) => Visibility::Traced(rays),
            (VplVisibility::Ism, _) => {
                let VplInputs { data, geometry, settings, .. } = inputs;
                Visibility::Ism(imperfect_shadow_maps(graph, data, geometry, vpls, vpl_count, settings))
            }
            _ => Visibility::None,
        }
    }
}
