//! What the part of a surface around each of its texels reflects and emits, on the mean: textures finer than texels blur here.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::atlas::Atlas;
use super::fill::fill;
use crate::frame::rays::TriangleChart;
use crate::scene::{Appearance, Instance, MaterialId, PointLook, Scene};

/// Points on a texel's area, and along a triangle's edges at least and at most.
const POINTS: f32 = 36.0;
const EDGE: (f32, f32) = (4.0, 2048.0);

/// Of one texel: albedo, and radiance that is emitted on the front.
pub(super) type Look = [f32; 6];

/// Of one surface.
#[derive(Clone)]
pub(super) struct SurfaceLooks {
    /// Row by row.
    pub(super) texels: Vec<Look>,
    /// Whether its back emits as its front does.
    pub(super) emits_back: bool,
    pub(super) material: MaterialId,
    /// The share of what it reflects and lets through that is diffuse, its varnish aside: the rest is metal and glass.
    pub(super) diffuse: f32,
}

impl SurfaceLooks {
    /// Baked light stands for the diffuse lobe alone: what is rather metal or glass would be a black slab.
    pub(super) fn keep_the_material(&self) -> bool {
        self.diffuse < 0.5
    }
}

/// Of each surface.
pub(super) fn mean_looks(scene: &Scene, charts: &[Option<TriangleChart>], atlas: &Atlas) -> Vec<SurfaceLooks> {
    let mut starts = Vec::new();
    let mut end = 0;
    for instance in scene.instances() {
        starts.push((instance, end));
        end += scene.meshes()[instance.mesh.0].primitives[instance.primitive].triangle_count();
    }
    // The triangles of a surface belong to one instance.
    let found: Vec<BTreeMap<u32, SurfaceLooks>> =
        starts.into_par_iter().map(|(instance, start)| looks_of_instance(scene, instance, &charts[start..])).collect();
    let none = SurfaceLooks { texels: Vec::new(), emits_back: false, material: MaterialId(0), diffuse: 1.0 };
    let mut looks = vec![none; atlas.surface_count()];
    found.into_iter().flatten().for_each(|(surface, of_surface)| looks[surface as usize] = of_surface);
    looks
}

/// What points add to a texel.
#[derive(Clone, Copy, Default)]
struct Sum {
    look: Look,
    weight: f32,
}

/// What they add to a surface.
struct Sums {
    size: [u32; 2],
    texels: Vec<Sum>,
    /// [`SurfaceLooks::diffuse`] times area, and area.
    diffuse: [f64; 2],
}

fn looks_of_instance(
    scene: &Scene,
    instance: &Instance,
    charts: &[Option<TriangleChart>],
) -> BTreeMap<u32, SurfaceLooks> {
    let primitive = &scene.meshes()[instance.mesh.0].primitives[instance.primitive];
    let appearance = scene.appearance(instance);
    let mut sums: BTreeMap<u32, Sums> = BTreeMap::new();
    for (indices, chart) in primitive.indices.chunks_exact(3).zip(charts) {
        let Some(chart) = chart else { continue };
        let [width, height] = chart.size;
        let texels = || vec![Sum::default(); width as usize * height as usize];
        let empty = || Sums { size: chart.size, texels: texels(), diffuse: [0.0; 2] };
        let sums = sums.entry(chart.surface).or_insert_with(empty);
        let order = if instance.flips_winding { [0, 2, 1] } else { [0, 1, 2] };
        add_triangle(&appearance, order.map(|corner| indices[corner]), chart, sums);
    }
    let material = primitive.material;
    let emits_back = scene.materials()[material.0].double_sided;
    let looks = |Sums { size, texels, diffuse: [diffuse, area] }: Sums| {
        let diffuse = if area > 0.0 { (diffuse / area) as f32 } else { 1.0 };
        SurfaceLooks { texels: means(&texels, size), emits_back, material, diffuse }
    };
    sums.into_iter().map(|(surface, found)| (surface, looks(found))).collect()
}

/// Small equal parts of the triangle go to the texels that their middles are nearest to.
fn add_triangle(appearance: &Appearance<'_>, vertices: [u32; 3], chart: &TriangleChart, sums: &mut Sums) {
    let [a, b, c] = chart.corners;
    let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
    let even = appearance.is_even().then(|| appearance.at(vertices, [1.0 / 3.0; 3]));
    let points = if even.is_some() { POINTS / 4.0 } else { POINTS };
    let parts = (points * area).sqrt().ceil().clamp(EDGE.0, EDGE.1) as u32;
    let weight = (area / (parts * parts) as f32).max(f32::MIN_POSITIVE);
    let mut take = |row: u32, column: u32, third: f32| {
        let [u, v] = [column, row].map(|step| (step as f32 + third) / parts as f32);
        let weights = [1.0 - u - v, u, v];
        let look = even.unwrap_or_else(|| appearance.at(vertices, weights));
        let Some(PointLook { albedo, emitted, diffuse }) = look else { return };
        let index = |axis: usize| {
            let at = weights[0] * a[axis] + weights[1] * b[axis] + weights[2] * c[axis];
            ((at + 0.5).max(0.0) as u32).min(chart.size[axis] - 1)
        };
        sums.diffuse[0] += f64::from(weight * diffuse);
        sums.diffuse[1] += f64::from(weight);
        let sum = &mut sums.texels[(index(1) * chart.size[0] + index(0)) as usize];
        sum.weight += weight;
        let [red, green, blue] = albedo;
        for (sum, value) in sum.look.iter_mut().zip([red, green, blue, emitted[0], emitted[1], emitted[2]]) {
            *sum += weight * value;
        }
    };
    for row in 0..parts {
        for column in 0..parts - row {
            take(row, column, 1.0 / 3.0);
            if column + row + 1 < parts {
                take(row, column, 2.0 / 3.0);
            }
        }
    }
}

fn means(sums: &[Sum], size: [u32; 2]) -> Vec<Look> {
    let mut known: Vec<bool> = sums.iter().map(|sum| sum.weight > 0.0).collect();
    let mean = |sum: &Sum| if sum.weight > 0.0 { sum.look.map(|it| it / sum.weight) } else { Look::default() };
    let mut looks: Vec<Look> = sums.iter().map(mean).collect();
    fill(&mut looks, &mut known, size);
    looks
}
