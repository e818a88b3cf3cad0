//! Light views: shadow maps, and reflective shadow maps where a method asks for reflected flux (Dachsbacher & Stamminger
//! 2005): depth, normal, flux by the exact solid angle of each texel, specular mask. All views of all lights share one
//! atlas, drawn in one pass.

use ash::vk;

use super::geometry::{Attributes, DrawView, Geometry, draw_list};
use super::light_set::LightSet;
use super::plane_depth;
use super::scene_data::{DrawnInstance, SceneData};
use crate::graph::bindings::{ImageRef, SampledImage};
use crate::graph::{ClearColor, Dependence, Graph};
use crate::shaders::{groups, light_views, types};

/// Of which lights there are views.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Views {
    #[default]
    None,
    /// Of punctual ones alone, not of samples of emissive surfaces and of the sky.
    Punctual,
    All,
}

impl Views {
    /// How many of the set's views: punctual lights come first.
    fn count(self, set: &LightSet) -> usize {
        match self {
            Views::None => 0,
            Views::Punctual => set.views_of(true).len(),
            Views::All => set.views_of(false).len(),
        }
    }
}

/// The lights and their views on the device.
#[derive(Clone)]
pub(crate) struct LightViews {
    pub(crate) light_count: u32,
    /// As passes bind them; normals and flux are absent unless they are asked for.
    pub(crate) group: groups::LightViews,
    /// Reverse-Z depth of each view in its rectangle.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) depth: ImageRef,
    /// The same as it was rasterised, to test against.
    pub(crate) drawn_depth: ImageRef,
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it back"))]
    pub(crate) reflective: Option<ReflectiveViews>,
}

/// What the lights' texels reflect.
#[derive(Clone, Copy)]
pub(crate) struct ReflectiveViews {
    /// The surface's own normal on the light's side, octahedral.
    pub(crate) normal: ImageRef,
    /// Reflected flux over the view's flux scale; alpha is the specular mask. In 32 bits: some drivers truncate to half floats
    /// instead of rounding, which takes 0.03 % off every light.
    pub(crate) flux: ImageRef,
}

/// Declares the views: of which lights depth is wanted, and of which normals and flux besides.
pub(crate) fn light_views(
    graph: &mut Graph<'_>,
    data: &SceneData,
    geometry: &Geometry,
    set: &LightSet,
    (depth_of, flux_of): (Views, Views),
) -> LightViews {
    let size = set.atlas.size.map(|side| side.max(1));
    let records: Vec<types::LightView> = set.atlas.views.iter().map(|view| view.record).collect();
    let lights = graph.upload("light_views.lights", &set.lights, Dependence::LIGHTS);
    let views = graph.upload("light_views.views", &records, Dependence::LIGHTS);
    let depth = graph.image("light_views.depth", vk::Format::D32_SFLOAT, size);
    let reflective_count = flux_of.count(set);
    let reflective = (flux_of == Views::All || reflective_count > 0).then(|| ReflectiveViews {
        normal: graph.image("light_views.normal", vk::Format::R32_UINT, size),
        flux: graph.image("light_views.flux", vk::Format::R32G32B32A32_SFLOAT, size),
    });
    let group = groups::LightViews {
        lights: lights.texels(vk::Format::R32G32B32A32_UINT),
        views: views.texels(vk::Format::R32G32B32A32_UINT),
        light_depth: depth.sampled(),
        light_normal: SampledImage::of(reflective.map(|views| views.normal)),
        light_flux: SampledImage::of(reflective.map(|views| views.flux)),
    };
    let mut made = LightViews { light_count: lights.count() as u32, group, depth, drawn_depth: depth, reflective };
    let mut draw_views = draw_views(set);
    draw_views.truncate(depth_of.max(flux_of).count(set));
    let (reflecting, others) = draw_views.split_at(reflective_count);
    if let Some(targets) = reflective {
        draw_reflective(graph, data, geometry, &made, targets, reflecting);
    }
    if reflective.is_none() || !others.is_empty() {
        draw_depth(graph, data, geometry, &made, others);
    }
    let drawn = (&made.group, &draw_views[..]);
    made.depth = plane_depth::of_lights(graph, data, geometry, drawn, depth);
    made.group.light_depth = made.depth.sampled();
    made
}

/// All views as draws see them.
pub(crate) fn draw_views(set: &LightSet) -> Vec<DrawView> {
    (0_u32..).zip(&set.atlas.views).map(|(index, view)| draw_view(index, view)).collect()
}

fn draw_view(index: u32, view: &super::view_layout::LaidOutView) -> DrawView {
    let [x, y] = view.record.rect_origin.map(i32::cast_unsigned);
    let [width, height] = view.record.rect_size.map(i32::cast_unsigned);
    let viewport = [x as f32, y as f32, view.full_size[0] as f32, view.full_size[1] as f32];
    DrawView::new(
        &view.record.view_projection,
        Some((viewport, [x, y, width, height])),
        Some(index.to_le_bytes().to_vec()),
    )
}

/// Beside views with flux, which were drawn before, those without.
fn draw_depth(graph: &mut Graph<'_>, data: &SceneData, geometry: &Geometry, made: &LightViews, views: &[DrawView]) {
    let clear = made.reflective.is_none().then_some(0.0);
    let solid = |drawn: &DrawnInstance| !(drawn.masked && drawn.textured);
    let depth = light_views::Depth {
        geometry: geometry.clone(),
        light_views: made.group.clone(),
        push: types::DrawnLightView { view_index: 0 },
    };
    let list = draw_list(data, Attributes::Depth, views, solid);
    let pass = graph.raster("light-views/depth", depth, Attributes::Depth.raster_state(data));
    pass.note("views", views.len() as u64).depth(made.drawn_depth, clear).draw(list);
    if data.drawn.iter().all(solid) {
        graph.skip("light-views/depth-masked", "no surface cut out by its alpha");
        return;
    }
    let masked = light_views::DepthMasked {
        geometry: geometry.clone(),
        light_views: made.group.clone(),
        textures: data.texture_kinds(|drawn| !solid(drawn)),
        push: types::DrawnLightView { view_index: 0 },
    };
    let list = draw_list(data, Attributes::DepthMasked, views, |drawn| !solid(drawn));
    let pass = graph.raster("light-views/depth-masked", masked, Attributes::DepthMasked.raster_state(data));
    pass.depth(made.drawn_depth, None).draw(list);
}

fn draw_reflective(
    graph: &mut Graph<'_>,
    data: &SceneData,
    geometry: &Geometry,
    made: &LightViews,
    targets: ReflectiveViews,
    views: &[DrawView],
) {
    let plain = light_views::Reflective {
        geometry: geometry.clone(),
        light_views: made.group.clone(),
        push: types::DrawnLightView { view_index: 0 },
    };
    let list = draw_list(data, Attributes::Plain, views, |drawn| !drawn.textured);
    let pass = graph.raster("light-views/reflective", plain, Attributes::Plain.raster_state(data));
    pass.note("views", views.len() as u64)
        .depth(made.drawn_depth, Some(0.0))
        .color(targets.normal, Some(ClearColor::Uint([0; 4])))
        .color(targets.flux, Some(ClearColor::Float([0.0; 4])))
        .draw(list);
    if !data.textured() {
        graph.skip("light-views/reflective-textured", "no textured surface");
        return;
    }
    for (name, masked) in [("light-views/reflective-textured", false), ("light-views/reflective-masked", true)] {
        let takes = |drawn: &DrawnInstance| drawn.textured && drawn.masked == masked;
        if !data.drawn.iter().any(takes) {
            graph.skip(name, if masked { "no surface cut out by its alpha" } else { "no opaque textured surface" });
            continue;
        }
        let textured = light_views::ReflectiveTextured {
            geometry: geometry.clone(),
            light_views: made.group.clone(),
            textures: data.texture_kinds(takes),
            alpha_mask: u32::from(masked),
            push: types::DrawnLightView { view_index: 0 },
        };
        let list = draw_list(data, Attributes::ReflectiveTextured, views, takes);
        let pass = graph.raster(name, textured, Attributes::ReflectiveTextured.raster_state(data));
        pass.depth(made.drawn_depth, None).color(targets.normal, None).color(targets.flux, None).draw(list);
    }
}
