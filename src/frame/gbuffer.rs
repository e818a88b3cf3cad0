//! The G-buffer: depth, normals and lobes of the first visible surface, and what it emits.

use ash::vk;

use super::geometry::{Attributes, DrawView, Geometry, draw_list};
use super::plane_depth;
use super::scene_data::SceneData;
use crate::graph::bindings::{ImageRef, SampledImage, Uniform};
use crate::graph::{ClearColor, Dependence, Graph};
use crate::scene::Facts;
use crate::shaders::groups::Surface;
use crate::shaders::{gbuffer, types};

/// What later passes read of the first visible surface. Texels as in glsl/lib/surface_packing.glsl.
#[derive(Clone)]
pub(crate) struct GBuffer {
    pub(crate) size: [u32; 2],
    /// All of it but what is emitted, as passes bind it.
    pub(crate) group: Surface,
    /// Reverse-Z, 0 where there is no surface.
    pub(crate) depth: ImageRef,
    pub(crate) surface: ImageRef,
    /// F0 and F90; absent in a scene without specular lobes.
    specular: Option<ImageRef>,
    /// Radiance; the sky where there is no surface. Absent where nothing emits or nobody asks.
    pub(crate) emission: Option<ImageRef>,
}

/// Declares the passes. `emission`: whether the emitted radiance is wanted.
pub(crate) fn gbuffer(
    graph: &mut Graph<'_>,
    data: &SceneData,
    geometry: &Geometry,
    facts: &Facts,
    view: &View,
) -> GBuffer {
    let size = view.size;
    let camera = graph.upload("camera", &[view.camera], Dependence::CAMERA).uniform();
    let depth = graph.image("gbuffer.depth", vk::Format::D32_SFLOAT, size);
    let surface = graph.image("gbuffer.surface", vk::Format::R32G32B32A32_UINT, size);
    let specular = facts.specular.then(|| graph.image("gbuffer.specular", vk::Format::R16G16B16A16_SFLOAT, size));
    let mut buffer = GBuffer {
        size,
        group: Surface {
            camera: camera.clone(),
            depth: depth.sampled(),
            surface: surface.sampled(),
            specular: SampledImage::of(specular),
            has_specular: u32::from(specular.is_some()),
        },
        depth,
        surface,
        specular,
        emission: view.emission.then(|| graph.image("gbuffer.emission", vk::Format::R32G32B32A32_SFLOAT, size)),
    };
    let [red, green, blue] = view.sky;
    let clear = Clears {
        surface: ClearColor::Uint([0; 4]),
        specular: ClearColor::Float([0.0; 4]),
        emission: ClearColor::Float([red, green, blue, 1.0]),
    };
    let draw_view = [DrawView::new(&view.camera.view_projection, None, None)];

    let plain = gbuffer::Plain { geometry: geometry.clone(), camera: camera.clone() };
    let list = draw_list(data, Attributes::Plain, &draw_view, |drawn| !drawn.textured);
    let pass = graph.raster("gbuffer/plain", plain, Attributes::Plain.raster_state(data));
    pass.depth(buffer.depth, Some(0.0))
        .color(buffer.surface, Some(clear.surface))
        .color_if(buffer.specular, Some(clear.specular))
        .color_if(buffer.emission, Some(clear.emission))
        .draw(list);

    draw_textured(graph, data, geometry, &buffer, (&camera, &draw_view));
    buffer.depth = plane_depth::of_camera(graph, data, geometry, (camera, &draw_view), buffer.depth);
    buffer.group.depth = buffer.depth.sampled();
    buffer
}

fn draw_textured(
    graph: &mut Graph<'_>,
    data: &SceneData,
    geometry: &Geometry,
    buffer: &GBuffer,
    (camera, draw_view): (&Uniform<types::Camera>, &[DrawView]),
) {
    if !data.textured() {
        graph.skip("gbuffer/textured", "no textured surface");
        return;
    }
    // Opaque surfaces first: those with holes are then often hidden, and a shader without `discard` tests depth early.
    for (name, masked) in [("gbuffer/textured", false), ("gbuffer/textured-masked", true)] {
        let takes = |drawn: &super::scene_data::DrawnInstance| drawn.textured && drawn.masked == masked;
        if !data.drawn.iter().any(takes) {
            graph.skip(name, if masked { "no surface cut out by its alpha" } else { "no opaque textured surface" });
            continue;
        }
        let textured = gbuffer::Textured {
            geometry: geometry.clone(),
            camera: camera.clone(),
            textures: data.texture_kinds(takes),
            alpha_mask: u32::from(masked),
        };
        let list = draw_list(data, Attributes::Textured, draw_view, takes);
        let pass = graph.raster(name, textured, Attributes::Textured.raster_state(data));
        pass.depth(buffer.depth, None)
            .color(buffer.surface, None)
            .color_if(buffer.specular, None)
            .color_if(buffer.emission, None)
            .draw(list);
    }
}

/// From where the G-buffer is drawn.
pub(crate) struct View {
    pub(crate) camera: types::Camera,
    pub(crate) size: [u32; 2],
    /// Radiance where there is no surface, W/(m² sr).
    pub(crate) sky: [f32; 3],
    pub(crate) emission: bool,
}

struct Clears {
    surface: ClearColor,
    specular: ClearColor,
    emission: ClearColor,
}
