//! What the part of a surface around each of its texels reflects and emits, on the mean: textures finer than texels blur here.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::atlas::Atlas;
use super::fill::fill;
use crate::frame::rays::TriangleChart;
use crate::scene::{Appearance, Instance, MaterialId, PointLook, Scene};

/// Points along a texel's side.
const STEPS: f32 = 6.0;
/// Triangles with fewer points have so many parts along each edge.
const LEAST: u32 = 4;
/// The same of those that look alike everywhere, at most: texels between take what their neighbours have.
const EVEN: f32 = 2048.0;

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

/// Points of an even grid, or the middles of small equal parts where it meets few, go to the texels that they are nearest to.
fn add_triangle(appearance: &Appearance<'_>, vertices: [u32; 3], chart: &TriangleChart, sums: &mut Sums) {
    let [a, b, c] = chart.corners;
    let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let area = 0.5 * twice.abs();
    let even = appearance.is_even().then(|| appearance.at(vertices, [1.0 / 3.0; 3]));
    let mut take = |weights: [f32; 3], weight: f32| {
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
    let mut points = 0;
    on_grid(chart.corners, |_| points += 1);
    if even.is_none() && points >= LEAST * LEAST {
        on_grid(chart.corners, |[x, y]| {
            let v = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / twice;
            let w = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / twice;
            take([1.0 - v - w, v, w], 1.0 / (STEPS * STEPS));
        });
        return;
    }
    let parts = (0.5 * STEPS * area.sqrt()).ceil().clamp(LEAST as f32, EVEN) as u32;
    let weight = (area / (parts * parts) as f32).max(f32::MIN_POSITIVE);
    let mut take = |row: u32, column: u32, third: f32| {
        let [u, v] = [column, row].map(|step| (step as f32 + third) / parts as f32);
        take([1.0 - u - v, u, v], weight);
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

/// The points within a triangle of a grid that has as many on each texel.
fn on_grid(corners: [[f32; 2]; 3], mut take: impl FnMut([f32; 2])) {
    // Those from one place to another, in steps.
    let steps = |from: f32, to: f32| (STEPS * from - 0.5).ceil() as i64..=(STEPS * to - 0.5).floor() as i64;
    let place = |step: i64| (step as f32 + 0.5) / STEPS;
    let edges = [0, 1, 2].map(|corner| [corners[corner], corners[(corner + 1) % 3]]);
    let ends = |values: &mut dyn Iterator<Item = f32>| {
        values.fold([f32::INFINITY, f32::NEG_INFINITY], |[least, most], value| [least.min(value), most.max(value)])
    };
    let [top, bottom] = ends(&mut corners.iter().map(|corner| corner[1]));
    for row in steps(top, bottom) {
        let y = place(row);
        let crossed = edges.iter().filter(|[from, to]| (from[1] <= y) != (to[1] <= y));
        let mut crossings = crossed.map(|[from, to]| from[0] + (y - from[1]) / (to[1] - from[1]) * (to[0] - from[0]));
        let [left, right] = ends(&mut crossings);
        if left <= right {
            steps(left, right).for_each(|column| take([place(column), y]));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Material, Mesh, Node, Primitive, Texture, TextureRef, Wrap};

    /// A strip of 200 by 2 texels with stripes across, whose triangles are long and thin.
    #[test]
    fn stripes_across_a_strip_stay_where_they_are() {
        let mut scene = Scene::empty("strip");
        let rgba8: Vec<u8> = (0..40_u8).flat_map(|column| [255 * (column % 2), 0, 0, 255]).collect();
        let (width, height, wrap) = (40, 1, [Wrap::Clamp; 2]);
        let texture = Texture { name: String::new(), width, height, rgba8, wrap, nearest: true, srgb: true };
        let texture = Some(TextureRef::new(scene.add_texture(texture).expect("sound")));
        let material = Material { base_color_texture: texture, specular: 0.0, ..Material::default() };
        let material = scene.add_material(material).expect("sound");
        let positions = vec![[0.0; 3], [199.0, 0.0, 0.0], [199.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let texcoords = [Some(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), None];
        let indices = vec![0, 1, 2, 0, 2, 3];
        let primitives = vec![Primitive { positions, texcoords, indices, material, ..Primitive::default() }];
        let mesh = scene.add_mesh(Mesh { name: String::new(), primitives }).expect("sound");
        scene.add_node(Node { mesh: Some(mesh), ..Node::default() }).expect("sound");
        let chart = |corners| Some(TriangleChart { corners, firsts: [Some(0), None], size: [200, 2], surface: 0 });
        let charts = [chart([[0.0, 0.0], [199.0, 0.0], [199.0, 1.0]]), chart([[0.0, 0.0], [199.0, 1.0], [0.0, 1.0]])];
        let looks = &looks_of_instance(&scene, &scene.instances()[0], &charts)[&0];
        assert!((looks.diffuse - 1.0).abs() < 1e-6);
        for (number, texel) in looks.texels.iter().enumerate() {
            let middle = (number % 200) as f32;
            // As much of the texel as is on red stripes.
            let points = (0..100).map(|point| (middle - 0.495 + 0.01 * point as f32) / 199.0);
            let of: Vec<f32> =
                points.filter(|at| (0.0..1.0).contains(at)).map(|at| ((at * 40.0) as u32 % 2) as f32).collect();
            let expected = of.iter().sum::<f32>() / of.len() as f32;
            assert!((texel[0] - expected).abs() < 0.12, "{number}: {} in place of {expected}", texel[0]);
        }
    }
}
