//! Whether light from a VPL may be blocked: not at all, by imperfect shadow maps, or by rays.

use glam::DVec3;

use super::inputs::VplInputs;
use super::ism::imperfect_shadow_maps;
use super::options::VplVisibility;
use crate::graph::bindings::{BufferRef, TexelBuffer, Uniform};
use crate::graph::{Dependence, Graph};
use crate::shaders::types::VplRays;

/// How far from a VPL's surface rays end or start, as a share of the scene's radius.
const OFFSET: f64 = 3e-5;

/// The kinds of glsl/vpl/visibility.glsl.
const NONE: u32 = 0;
const ISM: u32 = 1;
pub(super) const TRACED: u32 = 2;

/// What the kernels that gather bind for visibility (glsl/vpl/visibility.glsl).
#[derive(Clone)]
pub(super) struct Visibility {
    pub(super) kind: u32,
    pub(super) ism_resolution: u32,
    pub(super) ism_maps: TexelBuffer,
    pub(super) rays: Rays,
}

/// The scene as rays meet it, and where it lies from render space.
#[derive(Clone)]
pub(super) struct Rays {
    pub(super) rays: Uniform<VplRays>,
    pub(super) bvh_nodes: TexelBuffer,
    pub(super) bvh_triangles: TexelBuffer,
    pub(super) triangles: TexelBuffer,
    pub(super) corner_colors: TexelBuffer,
    pub(super) corner_texcoords: TexelBuffer,
    pub(super) materials: TexelBuffer,
    pub(super) material_textures: TexelBuffer,
    pub(super) texture_table: TexelBuffer,
    pub(super) texels: TexelBuffer,
    pub(super) sobol: TexelBuffer,
    pub(super) alpha_masks: u32,
    pub(super) vertex_colors: u32,
}

impl Rays {
    /// Nothing in a frame that traces none.
    pub(super) fn new(graph: &mut Graph<'_>, inputs: &VplInputs<'_>) -> Rays {
        let (radius, origin) = (inputs.data.radius, inputs.data.origin);
        let shift = inputs.traced.map_or(DVec3::ZERO, |traced| origin - traced.origin).as_vec3().to_array();
        let rays = VplRays { shift, offset: (radius * OFFSET) as f32, radius: radius as f32 };
        let rays = graph.upload("vpl.rays", &[rays], Dependence::GEOMETRY).uniform();
        match inputs.traced {
            Some(traced) => {
                let scene = traced.import(graph);
                Rays {
                    rays,
                    bvh_nodes: scene.bvh_nodes,
                    bvh_triangles: scene.bvh_triangles,
                    triangles: scene.triangles,
                    corner_colors: scene.corner_colors,
                    corner_texcoords: scene.corner_texcoords,
                    materials: scene.materials,
                    material_textures: scene.material_textures,
                    texture_table: scene.texture_table,
                    texels: scene.texels,
                    sobol: scene.sobol,
                    alpha_masks: u32::from(traced.facts.alpha_masked),
                    vertex_colors: u32::from(traced.facts.vertex_colors),
                }
            }
            None => Rays {
                rays,
                bvh_nodes: TexelBuffer::absent(),
                bvh_triangles: TexelBuffer::absent(),
                triangles: TexelBuffer::absent(),
                corner_colors: TexelBuffer::absent(),
                corner_texcoords: TexelBuffer::absent(),
                materials: TexelBuffer::absent(),
                material_textures: TexelBuffer::absent(),
                texture_table: TexelBuffer::absent(),
                texels: TexelBuffer::absent(),
                sobol: TexelBuffer::absent(),
                alpha_masks: 0,
                vertex_colors: 0,
            },
        }
    }
}

impl Visibility {
    /// As the settings say, for all of `vpls`.
    pub(super) fn new(
        graph: &mut Graph<'_>,
        inputs: &VplInputs<'_>,
        rays: Rays,
        vpls: BufferRef<[f32; 4]>,
    ) -> Visibility {
        let none = TexelBuffer::absent();
        let (kind, ism_resolution, ism_maps) = match inputs.options.visibility {
            VplVisibility::None => (NONE, 1, none),
            VplVisibility::Ism => {
                let maps = imperfect_shadow_maps(graph, inputs.data, inputs.geometry, vpls, inputs.options);
                (ISM, maps.resolution, maps.texels())
            }
            VplVisibility::Traced => (TRACED, 1, none),
        };
        Visibility { kind, ism_resolution, ism_maps, rays }
    }
}
