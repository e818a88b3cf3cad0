//! Imperfect shadow maps (Ritschel et al. 2008): a small paraboloid depth map for each VPL, drawn from points that stand for the scene's surfaces.
//!
//! Points depend on geometry alone: sets of them, each spread evenly over the scene's area (glsl/ism/points.comp). Map k is drawn from
//! set k modulo their number, so that the holes and the coarseness of neighbouring VPLs' maps lie in different places. Holes are filled by pull and
//! push. The atlas is a buffer: texel buffers are what the software driver gathers fastest.

use ash::vk;

use super::options::VplOptions;
use super::sample::vpl_count;
use crate::frame::geometry::Geometry;
use crate::frame::scene_data::SceneData;
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::graph::{Dependence, Graph};
use crate::shaders::ism::{
    Areas, AreasPush, Fill, FillPush, Points, PointsPush, Pull, PullPush, Push, PushPush, Scan, ScanPush, Splat,
    SplatPush,
};

const BLOCK_TRIANGLES: u32 = 256;
/// Work groups of a pass that steps through what is beyond them.
const MOST_GROUPS: u32 = 32768;
/// Points of all sets together, unless one set has more.
const POINTS: u32 = 1 << 16;
const MOST_SETS: u32 = 32;
/// Texels of all maps together: 128 MiB, which any device binds.
const MOST_TEXELS: u32 = 1 << 25;
/// Holes are filled from levels down to this side.
const COARSEST_SIDE: u32 = 4;

const FLOAT: vk::Format = vk::Format::R32_SFLOAT;
const FLOATS2: vk::Format = vk::Format::R32G32_SFLOAT;
const FLOATS4: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// The maps of all VPLs, `resolution`² inverse distances [1/m] each (glsl/ism/lookup.glsl).
#[derive(Clone, Copy)]
pub(crate) struct ImperfectShadowMaps {
    maps: BufferRef<f32>,
    pub(crate) resolution: u32,
}

impl ImperfectShadowMaps {
    pub(crate) fn texels(&self) -> TexelBuffer {
        self.maps.texels(FLOAT)
    }
}

/// Points that stand for the scene's surfaces, in sets.
struct SurfacePoints {
    points: BufferRef<[f32; 4]>,
    area_before: BufferRef<f32>,
    block_count: u32,
    points_of_set: u32,
    set_count: u32,
}

/// Side of the maps of so many VPLs, texels.
pub(super) fn resolution_for(vpl_count: u32, options: &VplOptions) -> u32 {
    options.ism_resolution.min((MOST_TEXELS / vpl_count.max(1)).isqrt()).max(1)
}

/// Declares the passes that make a map for each of `vpls` (glsl/lib/vpl.glsl).
pub(crate) fn imperfect_shadow_maps(
    graph: &mut Graph<'_>,
    data: &SceneData,
    geometry: &Geometry,
    vpls: BufferRef<[f32; 4]>,
    options: &VplOptions,
) -> ImperfectShadowMaps {
    let vpl_count = vpl_count(vpls);
    let surfaces = surface_points(graph, data, geometry, options.ism_points);
    let side = resolution_for(vpl_count, options);
    let count = |side: u32| vpl_count as usize * side as usize * side as usize;
    let drawn = graph.buffer::<u32>("ism.drawn", count(side));
    graph.fill_buffer("diffuse/vpl/visibility/ism-clear", drawn, 0);
    let pass = Splat {
        vpls: vpls.texels(FLOATS4),
        points: surfaces.points.texels(FLOATS4),
        area_before: surfaces.area_before.texels(FLOAT),
        drawn: drawn.read_write(),
        in_step: u32::from(graph.traits().lanes_in_step),
        push: SplatPush {
            vpl_count,
            points_of_set: surfaces.points_of_set,
            set_count: surfaces.set_count,
            resolution: side,
            block_count: surfaces.block_count,
        },
    };
    let points = u64::from(vpl_count) * u64::from(surfaces.points_of_set);
    let rows = vpl_count.min(MOST_GROUPS);
    graph.pass("diffuse/vpl/visibility/ism-splat", pass).note("points", points).groups([
        surfaces.points_of_set.div_ceil(64),
        rows,
        1,
    ]);

    let groups = |side: u32| [(side * side).div_ceil(64), rows, 1];
    let mut sides = vec![side, side.div_ceil(2)];
    while sides[sides.len() - 1] > COARSEST_SIDE {
        sides.push(sides[sides.len() - 1].div_ceil(2));
    }
    let levels: Vec<BufferRef<[f32; 2]>> =
        (1..sides.len()).map(|level| graph.buffer(&format!("ism.pulled.{level}"), count(sides[level]))).collect();
    for level in 1..sides.len() {
        let [fine_side, coarse_side] = [sides[level - 1], sides[level]];
        let fine = if level == 1 { drawn.texels(FLOAT) } else { levels[level - 2].texels(FLOATS2) };
        let coarse = levels[level - 1].write();
        let push = PullPush { vpl_count, fine_side, coarse_side };
        let pass = Pull { fine, coarse, from_drawn: u32::from(level == 1), push };
        graph.pass(&format!("diffuse/vpl/visibility/ism-pull-{level}"), pass).groups(groups(coarse_side));
    }
    let mut coarse = levels[levels.len() - 1];
    for level in (1..sides.len() - 1).rev() {
        let pushed = graph.buffer::<[f32; 2]>(&format!("ism.pushed.{level}"), count(sides[level]));
        let push = PushPush { vpl_count, side: sides[level], coarse_side: sides[level + 1] };
        let pass = Push {
            pulled: levels[level - 1].texels(FLOATS2),
            coarse: coarse.texels(FLOATS2),
            pushed: pushed.write(),
            push,
        };
        graph.pass(&format!("diffuse/vpl/visibility/ism-push-{level}"), pass).groups(groups(sides[level]));
        coarse = pushed;
    }
    let maps = graph.buffer::<f32>("ism.maps", count(side));
    let SurfacePoints { area_before, points_of_set, block_count, .. } = surfaces;
    let pass = Fill {
        drawn: drawn.texels(FLOAT),
        coarse: coarse.texels(FLOATS2),
        area_before: area_before.texels(FLOAT),
        maps: maps.write(),
        push: FillPush { vpl_count, side, coarse_side: sides[1], points_of_set, block_count },
    };
    graph.pass("diffuse/vpl/visibility/ism-fill", pass).groups(groups(side));
    ImperfectShadowMaps { maps, resolution: side }
}

/// Declares the passes that place the points; they run when geometry changes.
fn surface_points(graph: &mut Graph<'_>, data: &SceneData, geometry: &Geometry, points_of_set: u32) -> SurfacePoints {
    let mut first_triangles = vec![0_u32];
    for instance in &data.drawn {
        let before = first_triangles[first_triangles.len() - 1];
        first_triangles.push(before.saturating_add(instance.index_count / 3));
    }
    let (instance_count, triangle_count) = (data.drawn.len() as u32, first_triangles[data.drawn.len()]);
    let block_count = triangle_count.div_ceil(BLOCK_TRIANGLES);
    let set_count = (POINTS / points_of_set).clamp(1, MOST_SETS);
    let first_triangles = graph.upload("ism.first_triangles", &first_triangles, Dependence::GEOMETRY);
    let area_sums = graph.buffer::<f32>("ism.area_sums", triangle_count as usize);
    let block_areas = graph.buffer::<f32>("ism.block_areas", block_count as usize);
    let area_before = graph.buffer::<f32>("ism.area_before", block_count as usize + 1);
    let points = graph.buffer::<[f32; 4]>("ism.points", points_of_set as usize * set_count as usize);

    let pass = Areas {
        geometry: geometry.clone(),
        first_triangles: first_triangles.texels(vk::Format::R32_UINT),
        area_sums: area_sums.write(),
        block_areas: block_areas.write(),
        push: AreasPush {
            instance_count,
            triangle_count,
            block_count,
            reach: data.reach as f32,
            middle_rs: data.middle_rs.as_vec3().to_array(),
        },
    };
    let groups = [block_count.min(MOST_GROUPS), 1, 1];
    graph.pass("diffuse/vpl/visibility/ism-areas", pass).note("triangles", u64::from(triangle_count)).groups(groups);
    let pass =
        Scan { block_areas: block_areas.read(), area_before: area_before.write(), push: ScanPush { block_count } };
    graph.pass("diffuse/vpl/visibility/ism-scan", pass).groups([1, 1, 1]);
    let pass = Points {
        geometry: geometry.clone(),
        first_triangles: first_triangles.texels(vk::Format::R32_UINT),
        area_sums: area_sums.texels(FLOAT),
        area_before: area_before.texels(FLOAT),
        points: points.write(),
        push: PointsPush { instance_count, triangle_count, block_count, points_of_set, set_count },
    };
    let all = points_of_set * set_count;
    graph.pass("diffuse/vpl/visibility/ism-points", pass).note("points", u64::from(all)).threads([all, 1, 1]);
    SurfacePoints { points, area_before, block_count, points_of_set, set_count }
}
