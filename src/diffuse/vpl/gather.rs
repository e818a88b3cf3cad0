//! Irradiance from all VPLs, at pixels or at regions.

use ash::vk;

use super::VplInputs;
use super::visibility::Visibility;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::shaders::vpl::{
    GatherPixels, GatherPixelsIsm, GatherPixelsIsmPush, GatherPixelsPush, GatherPixelsTraced, GatherPixelsTracedPush,
};

/// The slot, gathered at every pixel.
pub(super) fn gather_pixels(
    graph: &mut Graph<'_>,
    inputs: &VplInputs<'_>,
    vpls: BufferRef<[f32; 4]>,
    visibility: &Visibility<'_>,
    diffuse: ImageRef,
) {
    let buffer = inputs.buffer;
    let vpl_count = inputs.settings.count;
    let (specular, has_specular) = buffer.specular();
    let camera = buffer.camera.clone();
    let (depth, surface, specular) = (buffer.depth.sampled(), buffer.surface.sampled(), specular.sampled());
    let lights = vpls.texels(vk::Format::R32G32B32A32_SFLOAT);
    let diffuse = diffuse.write();
    let pass = match visibility {
        Visibility::None => {
            let push = GatherPixelsPush { vpl_count, has_specular };
            let pass = GatherPixels { camera, depth, surface, specular, vpls: lights, diffuse, push };
            graph.pass("diffuse/vpl/gather-pixels", pass)
        }
        Visibility::Ism(maps) => {
            let pass = GatherPixelsIsm {
                camera,
                depth,
                surface,
                specular,
                vpls: lights,
                diffuse,
                ism_maps: maps.texels(),
                ism_resolution: maps.resolution,
                push: GatherPixelsIsmPush { vpl_count, has_specular },
            };
            graph.pass("diffuse/vpl/gather-pixels-ism", pass)
        }
        Visibility::Traced(rays) => {
            let scene = &rays.scene;
            let pass = GatherPixelsTraced {
                eye: camera.clone(),
                camera,
                depth,
                surface,
                specular,
                vpls: lights,
                diffuse,
                bvh_nodes: scene.bvh_nodes.clone(),
                bvh_triangles: scene.bvh_triangles.clone(),
                rays: rays.rays.clone(),
                triangles: scene.triangles.clone(),
                corner_colors: scene.corner_colors.clone(),
                corner_texcoords: scene.corner_texcoords.clone(),
                materials: scene.materials.clone(),
                material_textures: scene.material_textures.clone(),
                texture_table: scene.texture_table.clone(),
                texels: scene.texels.clone(),
                alpha_masks: rays.alpha_masks,
                vertex_colors: rays.vertex_colors,
                push: GatherPixelsTracedPush { vpl_count, has_specular },
            };
            graph.pass("diffuse/vpl/gather-pixels-traced", pass)
        }
    };
    let [width, height] = buffer.size;
    let terms = u64::from(width) * u64::from(height) * u64::from(vpl_count);
    pass.note("VPL terms", terms).groups([
        width.div_ceil(16),
        height.div_ceil(8),
        1,
    ]);
}
