//! The settled light on finer texels of the same surfaces, for whoever takes it off the device: direct light by shadow rays at each of them, so that shadows are sharper than
//! the maps, and the rest looked up in the maps as pixels do it, so that no light comes through what cuts their cells.

use super::aim::Lit;
use super::formats::FLOATS4;
use super::lamps::Lamps;
use super::options::LightmapsOptions;
use super::texels::{LightTexels, placed, texels_asked};
use crate::frame::rays::TracedScene;
use crate::frame::stored_light::StoredLight;
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::lightmaps::{Detail, DetailPush};

/// Finer texels at most, so that on any device 65,535 groups of 64 find them and 128 MiB hold what is known of each: of many, fewer lie along a side.
const MOST: u32 = 64 * 65_535;

/// Declares the passes. `diffuse`: what the maps show; `caustics`: what photons bring; `detail`: texels along a side of the maps' own.
pub(super) fn in_detail(
    graph: &mut Graph<'_>,
    scene: &TracedScene,
    (texels, lamps): (&LightTexels, &Lamps),
    (diffuse, caustics): (BufferRef<[f32; 4]>, Option<BufferRef<[f32; 4]>>),
    (options, detail): (&LightmapsOptions, u32),
) -> StoredLight {
    let mut detail = fitting(texels.map.count, detail);
    let mut map = scene.finer_lightmap(texels_asked(options), detail);
    // A side that has no second texel may have one more than so many times as many.
    while map.count > MOST && detail > 1 {
        detail -= 1;
        map = scene.finer_lightmap(texels_asked(options), detail);
    }
    let count = map.count as usize;
    let (group, valid, places) = placed(graph, &texels.rays, &map, ["lightmaps.detail", "diffuse/lightmaps/detail"]);
    let direct = graph.buffer::<[f32; 4]>("lightmaps.detail.direct", count);
    let lit = Lit { map: &map, rays: &texels.rays, group: &group, lamps };
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
    StoredLight { map, detail, valid, direct, caustics, arrivals, diffuse }
}

/// As many texels along a side of each of `count` as there is room for, and no more than are asked for.
fn fitting(count: u32, asked: u32) -> u32 {
    let fits = |detail: &u32| u64::from(count) * u64::from(*detail).pow(2) <= u64::from(MOST);
    (1..=asked).rev().find(fits).unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 524,288 texels are the most that light maps have.
    #[test]
    fn what_any_device_holds_is_asked_for() {
        assert_eq!([1000, 65_535, 65_536, 100_000, 524_288].map(|count| fitting(count, 8)), [8, 8, 7, 6, 2]);
        assert_eq!([fitting(100_000, 3), fitting(524_288, 3), fitting(u32::MAX, 8), fitting(0, 8)], [3, 2, 1, 8]);
        let bytes = u64::from(MOST) * size_of::<[[u32; 4]; 2]>() as u64;
        assert!(bytes <= 128 << 20, "{bytes}");
    }
}
