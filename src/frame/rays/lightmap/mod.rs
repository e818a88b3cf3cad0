//! Light maps of all surfaces that answer to diffuse light (glsl/lightmaps/lookup.glsl): surfaces by their triangles (`charts.rs`), on each a lattice of texels
//! (`lattice.rs`). Texels go by triangles and weights of their corners, so that they stand while things move.

mod charts;
mod lattice;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use rayon::prelude::*;

use self::charts::{Chart, charts};
use self::lattice::Lattice;
use super::motion::Part;
use super::triangles::TracedTriangle;
use super::uploaded::{FLOAT, WORDS};
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::graph::{Dependence, Graph, hash_of};

/// No texel.
const NONE: u32 = u32::MAX;
/// The side in the number of a texel's triangle.
const BACK: u32 = 1 << 31;
/// Sizes of texels over that of a surface of mean area, at least and at most.
const RELATIVE: [f64; 2] = [0.25, 2.0];
/// Texels at most, over those that the area alone asks for: many small surfaces take more.
const MOST: u64 = 2;

/// Steps towards coarser texels, at most, for that and where there may not be more: each makes them 1.2 times as large.
const COARSER: u32 = 24;
const COARSEST: u32 = 200;

/// The light maps of a scene.
pub(crate) struct Lightmap {
    /// Texels, those that nobody reads included.
    pub(crate) count: u32,
    pub(crate) surface_count: u32,
    /// Numbers of the texels that are read.
    pub(crate) used: Vec<u32>,
    records: Arc<[u8]>,
    places: Arc<[u8]>,
    /// How much of its surface is nearest to each texel, m².
    areas: Vec<f32>,
    /// Names all of it.
    pub(crate) key: u64,
    /// How the names of its lists begin.
    lists: &'static str,
}

/// Where a triangle lies on its surface's map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TriangleChart {
    /// Of its corners, counter-clockwise as seen from its front, in texels: these lie on whole numbers, borders included.
    pub(crate) corners: [[f32; 2]; 3],
    /// The first texels of the front's and of the back's map, for sides that have one; row by row.
    pub(crate) firsts: [Option<u32>; 2],
    pub(crate) size: [u32; 2],
    pub(crate) surface: u32,
}

/// How finely a light map is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Texels {
    /// Of each, m; 0: as `count` says.
    pub(crate) size: f64,
    /// On the area of all surfaces.
    pub(crate) count: u32,
    /// There are never more, unless there are more surfaces: texels are larger for it.
    pub(crate) most: u32,
}

/// What of the triangles takes light.
pub(super) struct Taking<'a> {
    /// Sides of each material with a diffuse lobe.
    pub(super) sides: &'a [u32],
    /// Bits of one-sided triangles whose backs are seen.
    pub(super) backs: &'a [u32],
    /// Of each triangle, 0 if it does not matter.
    pub(super) areas: &'a [f32],
}

impl Taking<'_> {
    fn sides(&self, triangles: &[TracedTriangle], number: usize) -> u32 {
        let area = self.areas[number];
        let of_material = self.sides[triangles[number].material as usize];
        if !(area > 0.0 && area.is_finite()) || of_material == 0 {
            return 0;
        }
        let seen = self.backs.get(number / 32).is_some_and(|word| word >> (number % 32) & 1 == 1);
        of_material.max(1 + u32::from(seen))
    }
}

/// The size of a texel on each surface, m. Where their number is asked for, it follows the fourth root of the surface's area: a wide ground outside does not take
/// all texels of the room.
fn sizes(charts: &[Chart], triangles: &[TracedTriangle], texels: Texels) -> Vec<f64> {
    let area = |chart: &Chart| -> f64 { chart.triangles.iter().map(|&number| triangles[number as usize].area()).sum() };
    let areas: Vec<f64> = charts.iter().map(area).collect();
    let mean = areas.iter().map(|area| area * area).sum::<f64>() / areas.iter().sum::<f64>().max(1e-300);
    let relative: Vec<f64> =
        areas.iter().map(|area| (area / mean).powf(0.25).clamp(RELATIVE[0], RELATIVE[1])).collect();
    let count = |sizes: &[f64]| -> u64 {
        let lattices = charts.iter().zip(sizes);
        lattices.map(|(chart, texel)| u64::from(chart.sides) * Lattice::of(chart, *texel).node_count()).sum()
    };
    // Each step takes three in ten texels of surfaces that have many.
    let coarsened = |mut sizes: Vec<f64>, most: u64, steps: u32| {
        for _ in 0..steps {
            if count(&sizes) <= most {
                break;
            }
            sizes.iter_mut().for_each(|size| *size *= 1.2);
        }
        sizes
    };
    let wanted = u64::from(texels.count.clamp(1, texels.most));
    let sizes = if texels.size > 0.0 {
        vec![texels.size; charts.len()]
    } else {
        let shares = charts.iter().zip(&areas).zip(&relative);
        let shares = shares.map(|((chart, area), size)| f64::from(chart.sides) * area / (size * size));
        let size = (shares.sum::<f64>() / wanted as f64).sqrt().max(1e-30);
        coarsened(relative.iter().map(|relative| relative * size).collect(), MOST * wanted, COARSER)
    };
    coarsened(sizes, u64::from(texels.most), COARSEST)
}

impl Lightmap {
    pub(super) fn new(triangles: &[TracedTriangle], parts: &[Part], taking: &Taking<'_>, texels: Texels) -> Lightmap {
        Lightmap::made(triangles, parts, taking, (texels, 1), "traced.lightmap")
    }

    /// The same surfaces, numbered alike, with texels of the `detail`-th part of the size.
    pub(super) fn finer(
        triangles: &[TracedTriangle],
        parts: &[Part],
        taking: &Taking<'_>,
        finer: (Texels, u32),
    ) -> Lightmap {
        Lightmap::made(triangles, parts, taking, finer, "traced.finer_lightmap")
    }

    fn made(
        triangles: &[TracedTriangle],
        parts: &[Part],
        taking: &Taking<'_>,
        (texels, detail): (Texels, u32),
        lists: &'static str,
    ) -> Lightmap {
        let sides = |number: usize| taking.sides(triangles, number);
        let charts: Vec<Chart> =
            parts.par_iter().flat_map_iter(|part| charts(triangles, part.triangles(), sides)).collect();
        let texels: Vec<f64> =
            sizes(&charts, triangles, texels).into_iter().map(|size| size / f64::from(detail.max(1))).collect();
        let lattices: Vec<Lattice> =
            charts.iter().zip(&texels).map(|(chart, texel)| Lattice::of(chart, *texel)).collect();
        let areas: Vec<Vec<f32>> =
            charts.par_iter().zip(&lattices).map(|(chart, lattice)| lattice.areas(chart, triangles)).collect();
        let nodes: Vec<_> =
            charts.par_iter().zip(&lattices).map(|(chart, lattice)| lattice.nodes(chart, triangles)).collect();
        let mut records = vec![[0, 0, 0, 0, 0, 0, NONE, NONE, 0, 0, 0, 0]; triangles.len()];
        let mut places: Vec<[u32; 4]> = Vec::new();
        let (mut used, mut texel_areas) = (Vec::new(), Vec::new());
        for (number, ((chart, lattice), nodes)) in (0..).zip(charts.iter().zip(&lattices).zip(&nodes)) {
            let firsts = [0, 1].map(|side| match side < chart.sides {
                true => places.len() as u32 + side * nodes.len() as u32,
                false => NONE,
            });
            for &triangle in &chart.triangles {
                let [a, b, c] =
                    lattice.coordinates(chart, &triangles[triangle as usize]).map(|at| at.map(f32::to_bits));
                let ([width, height], texel) = (lattice.size(), (lattice.texel() as f32).to_bits());
                records[triangle as usize] =
                    [a[0], a[1], b[0], b[1], c[0], c[1], firsts[0], firsts[1], width, height, texel, number];
            }
            for side in 0..chart.sides {
                texel_areas.extend(&areas[number as usize]);
                for node in nodes {
                    if node.is_some() {
                        used.push(places.len() as u32);
                    }
                    places.push(node.map_or([NONE, 0, 0, 0], |node| {
                        let [u, v] = node.place.map(f32::to_bits);
                        [node.triangle | (side * BACK), u, v, 2 * number + side]
                    }));
                }
            }
        }
        let bytes = |words: &[u32]| -> Arc<[u8]> { bytemuck::cast_slice(words).into() };
        let records: Arc<[u8]> = bytes(records.as_flattened());
        places.push([NONE, 0, 0, 0]);
        let places: Arc<[u8]> = bytes(places.as_flattened());
        Lightmap {
            count: (places.len() / 16 - 1) as u32,
            surface_count: charts.len() as u32,
            used,
            areas: texel_areas,
            key: hash_of(&("lightmap", &records, &places)),
            lists,
            records,
            places,
        }
    }

    /// Where a triangle lies; `None` if neither of its sides has texels.
    pub(crate) fn chart(&self, triangle: usize) -> Option<TriangleChart> {
        let bytes = self.records.get(triangle * size_of::<[u32; 12]>()..)?.get(..size_of::<[u32; 12]>())?;
        let [ax, ay, bx, by, cx, cy, front, back, width, height, _, surface]: [u32; 12] =
            bytemuck::pod_read_unaligned(bytes);
        let firsts = [front, back].map(|first| Some(first).filter(|&first| first != NONE));
        let corners = [[ax, ay], [bx, by], [cx, cy]].map(|corner| corner.map(f32::from_bits));
        let chart = TriangleChart { corners, firsts, size: [width, height], surface };
        firsts.iter().any(Option::is_some).then_some(chart)
    }

    /// Of each triangle where its corners lie on the map.
    pub(crate) fn charts(&self, graph: &mut Graph<'_>) -> TexelBuffer {
        let records = self.records.clone();
        graph
            .upload_shared::<u32>(&format!("{}_charts", self.lists), records, self.key, Dependence::GEOMETRY)
            .texels(WORDS)
    }

    /// Of each texel its triangle and where on it it lies.
    pub(crate) fn places(&self, graph: &mut Graph<'_>) -> TexelBuffer {
        let places = self.places.clone();
        graph
            .upload_shared::<u32>(&format!("{}_places", self.lists), places, self.key, Dependence::GEOMETRY)
            .texels(WORDS)
    }

    /// How much of its surface is nearest to each texel, m².
    pub(crate) fn areas(&self, graph: &mut Graph<'_>) -> TexelBuffer {
        graph.upload(&format!("{}_areas", self.lists), &self.areas, Dependence::GEOMETRY).texels(FLOAT)
    }

    /// The texels that are read.
    pub(crate) fn used(&self, graph: &mut Graph<'_>) -> BufferRef<u32> {
        graph.upload(&format!("{}_used", self.lists), &self.used, Dependence::GEOMETRY)
    }
}
