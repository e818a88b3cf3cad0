//! The settled light on finer texels of the same surfaces, for whoever takes it off the device: direct light by shadow rays at each of them, so that shadows are sharper than
//! the maps, and the rest looked up in the maps as pixels do it, so that no light comes through what cuts their cells.

use super::aim::Lit;
use super::formats::FLOATS4;
use super::options::LightmapsOptions;
use super::texels::{LightTexels, placed, texels_asked};
use crate::frame::rays::TracedScene;
use crate::frame::stored_light::StoredLight;
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::lightmaps::{Detail, DetailPush};

/// Finer texels at most: of many, fewer lie along a side.
const MOST: u32 = 1 << 25;

/// Declares the passes. `diffuse`: what the maps show; `caustics`: what photons bring; `detail`: texels along a side of the maps' own.
pub(super) fn in_detail(
    graph: &mut Graph<'_>,
    scene: &TracedScene,
    texels: &LightTexels,
    (diffuse, caustics): (BufferRef<[f32; 4]>, Option<BufferRef<[f32; 4]>>),
    (options, detail): (&LightmapsOptions, u32),
) -> StoredLight {
    let fits = |detail: &u32| texels.map.count.saturating_mul(detail * detail) <= MOST;
    let fitting = (1..=detail).rev().find(fits).unwrap_or(1);
    if fitting < detail {
        tracing::warn!(
            "light maps have {} texels: light is taken at {fitting}, not {detail}, along a side of each",
            texels.map.count
        );
    }
    let map = scene.finer_lightmap(texels_asked(options), fitting);
    let count = map.count as usize;
    let (group, valid, places) = placed(graph, &texels.rays, &map, ["lightmaps.detail", "diffuse/lightmaps/detail"]);
    let direct = graph.buffer::<[f32; 4]>("lightmaps.detail.direct", count);
    let lit = Lit { map: &map, rays: &texels.rays, group: &group };
    lit.declare(graph, scene, direct, options, "diffuse/lightmaps/detail/direct");

    let mut look_up = |name: &str, light: BufferRef<[f32; 4]>, [stride, offset]: [u32; 2]| {
        let found = graph.buffer::<[f32; 4]>(&format!("lightmaps.detail.{name}"), count);
        let pass = Detail {
            scene_rays: texels.rays.clone(),
            lightmap: texels.group.clone(),
            placed: group.lightmap_texels.clone(),
            places: places.clone(),
            light: light.texels(FLOATS4),
            found: found.write(),
            push: DetailPush { texel_count: map.count, stride, offset },
        };
        graph.pass(&format!("diffuse/lightmaps/detail/{name}"), pass).threads([map.count, 1, 1]);
        found
    };
    let diffuse = look_up("diffuse", diffuse, [1, 0]);
    let caustics = caustics.map(|caustics| look_up("caustics", caustics, [1, 0]));
    let mut arrivals = |name, offset| look_up(name, texels.arrivals, [2, offset]);
    let arrivals = scene.facts.specular.then(|| [arrivals("lamps", 0), arrivals("sky", 1)]);
    StoredLight { map, valid, direct, caustics, arrivals, diffuse }
}
