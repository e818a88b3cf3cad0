//! What emissive surfaces send out where alpha or a texture lets them: mean radiance triangle by triangle, and where in a triangle it
//! comes from, for whatever draws points on emitters. It is found on the host from the finest texels, by points so dense that each texel
//! holds several of them, and says nothing of where a primitive stands: moving a node leaves it as it is.

use rayon::prelude::*;

use super::cutout::{Cutout, cutout};
use super::emission_points::{EmissionPoints, TrianglePoints, luminance};
use super::mesh::Primitive;
use super::triangle_cells::{Cell, cells, middles, strip};
use super::{Material, Texture};

/// Cells of a primitive's triangles together, and of one edge, at most.
const CELLS: u32 = 1 << 13;
const LARGEST_SIDE: u32 = 64;
/// Points at which a primitive is looked at, about.
const POINTS: u32 = 1 << 19;
/// Points an edge of a texel and of a triangle, where there are enough.
const POINTS_OF_TEXEL: f32 = 4.0;
const POINTS_OF_TRIANGLE: f32 = 128.0;
/// Cells of a triangle that texture coordinates do not tell from others (vertex colours alone decide), an edge.
const PLAIN_SIDE: u32 = 16;
/// What a cell that shines at none of its points, but may between them, counts as: a share of the mean of those that may shine.
const DOUBT: f32 = 1.0 / 32.0;
/// A triangle whose cells differ less is drawn from evenly.
const EVEN: f32 = 2.0;

/// What a primitive sends out.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Emission {
    /// Nothing at any of its points.
    Dark,
    /// The radiance of its material at every point.
    Even,
    /// What each triangle says.
    Uneven(Vec<TriangleEmission>),
}

/// What one triangle sends out.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct TriangleEmission {
    /// Mean over its whole area, W/(m² sr). Not 0 where it might shine between the points that were looked at.
    pub(crate) radiance: [f32; 3],
    /// The share of its area that shines.
    pub(crate) covered: f32,
    /// Points an edge, of a cell or without cells of the triangle, at which it was looked at.
    pub(crate) points: u32,
    /// Where its light comes from, if not evenly from everywhere.
    pub(crate) cells: Option<EmissiveCells>,
}

/// Where a triangle's light comes from, cell by cell (`triangle_cells`).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EmissiveCells {
    /// Cells an edge.
    pub(crate) side: u32,
    /// Mean luminance of a cell over that of the triangle.
    pub(crate) light: Vec<f32>,
    /// Density of points to draw over the mean density, on average 1; above 0 wherever there may be light.
    pub(crate) density: Vec<f32>,
}

impl Emission {
    /// Of triangle `index`, in the primitive's order; `None`: of the material's radiance, evenly.
    pub(crate) fn of_triangle(&self, index: usize) -> Option<&TriangleEmission> {
        static DARK: TriangleEmission = TriangleEmission { radiance: [0.0; 3], covered: 0.0, points: 1, cells: None };
        match self {
            Emission::Dark => Some(&DARK),
            Emission::Even => None,
            Emission::Uneven(triangles) => triangles.get(index),
        }
    }
}

impl TriangleEmission {
    /// The mean radiance as far as points show it.
    pub(super) fn surely(&self) -> [f32; 3] {
        if self.covered > 0.0 { self.radiance } else { [0.0; 3] }
    }

    /// The weights of corners 1 and 2 at a point that `shines`, drawn by light from two numbers between 0 and 1: the first chooses
    /// how far from corner 0, the second where along there.
    pub(super) fn place(&self, [u, v]: [f64; 2], shines: impl Fn([f64; 2]) -> bool) -> [f64; 2] {
        let whole = EmissiveCells { side: 1, light: vec![1.0], density: Vec::new() };
        let cells = self.cells.as_ref().unwrap_or(&whole);
        let (cell, [u, v]) = cells.draw(u, v);
        let root = u.sqrt();
        let place = cell.place(cells.side, [root * (1.0 - v), root * v]);
        if shines(place) {
            return place;
        }
        let distance = |other: &[f64; 2]| (other[0] - place[0]).powi(2) + (other[1] - place[1]).powi(2);
        let others = middles(self.points).map(|middle| cell.place(cells.side, middle)).filter(|place| shines(*place));
        others.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(place)
    }
}

impl EmissiveCells {
    /// A cell by its light, and what is left of the two numbers that chose it.
    fn draw(&self, u: f64, v: f64) -> (Cell, [f64; 2]) {
        let light = |cell: Cell| f64::from(self.light[cell.number(self.side)]);
        let of_strip = |index: u32| strip(index).map(light).sum::<f64>();
        let (index, u) = pick(0..self.side, of_strip, u).unwrap_or((0, u));
        let (cell, v) = pick(strip(index), light, v).unwrap_or((Cell { column: index, row: 0, upper: false }, v));
        (cell, [u, v])
    }
}

/// The one among several that a number between 0 and 1 falls on, each as wide as its weight, and where within it.
fn pick<T: Copy>(all: impl Iterator<Item = T> + Clone, weight: impl Fn(T) -> f64, number: f64) -> Option<(T, f64)> {
    let total: f64 = all.clone().map(&weight).sum();
    let mut left = number * total;
    let mut found = None;
    for one in all {
        let width = weight(one);
        if width > 0.0 {
            found = Some((one, (left / width).clamp(0.0, 1.0)));
            if left < width {
                break;
            }
        }
        left -= width;
    }
    found
}

/// What a primitive of this material sends out.
pub(super) fn emission_of(primitive: &Primitive, material: &Material, textures: &[Texture]) -> Emission {
    let cut = cutout(material, textures, primitive.colors.is_some());
    if !material.emits() || cut == Cutout::Nothing || primitive.indices.is_empty() {
        return Emission::Dark;
    }
    if cut == Cutout::Everything && material.emissive_texture.is_none() {
        return Emission::Even;
    }
    let points = EmissionPoints::new(primitive, material, textures, cut == Cutout::PerPoint);
    if points.all_dark() {
        return Emission::Dark;
    }
    let triangles = primitive.indices.par_chunks_exact(3);
    let count = u32::try_from(triangles.len()).unwrap_or(u32::MAX);
    let found: Vec<TriangleEmission> =
        triangles.map(|vertices| emission_of_triangle(&points.of_triangle(vertices), count)).collect();
    if found.iter().all(|triangle| triangle.radiance == [0.0; 3]) {
        return Emission::Dark;
    }
    Emission::Uneven(found)
}

fn emission_of_triangle(surface: &TrianglePoints<'_>, triangle_count: u32) -> TriangleEmission {
    let texels = surface.texels();
    let largest_side = (CELLS / triangle_count).isqrt().clamp(1, LARGEST_SIDE);
    let wanted = texels.map_or(PLAIN_SIDE, |texels| texels.ceil().clamp(1.0, 1e6) as u32);
    let side = wanted.clamp(1, largest_side);
    let all: Vec<Cell> = cells(side).collect();
    let may_shine: Vec<bool> = all.iter().map(|cell| surface.may_shine(cell.corners(side))).collect();
    let shining = may_shine.iter().filter(|may| **may).count();
    if shining == 0 {
        return TriangleEmission::default();
    }
    let wanted = POINTS_OF_TRIANGLE.max(texels.unwrap_or(0.0) * POINTS_OF_TEXEL) / side as f32;
    let affordable = (POINTS / triangle_count / u32::try_from(shining).unwrap_or(u32::MAX)).isqrt();
    let points = (wanted.ceil().clamp(1.0, 1e6) as u32).clamp(2, affordable.max(2));
    let of_cells: Vec<([f32; 3], f32)> = all
        .iter()
        .zip(&may_shine)
        .map(|(cell, may)| if *may { mean_of_cell(surface, *cell, side, points) } else { ([0.0; 3], 0.0) })
        .collect();
    let count = all.len() as f64;
    let mean = |values: &mut dyn Iterator<Item = f32>| (values.map(f64::from).sum::<f64>() / count) as f32;
    let mut radiance = [0, 1, 2].map(|channel| mean(&mut of_cells.iter().map(|(radiance, _)| radiance[channel])));
    let covered = mean(&mut of_cells.iter().map(|(_, covered)| *covered));
    if covered <= 0.0 {
        // Whatever there is lies between the points.
        let share = shining as f32 / (all.len() as f32 * 4.0 * (points * points) as f32);
        radiance = surface.brightest().map(|channel| channel * share);
    }
    let brightest = luminance(surface.brightest());
    let light: Vec<f32> = of_cells.iter().map(|(mean, _)| luminance(*mean) / brightest).collect();
    let cells = emissive_cells(side, light, &may_shine, shining);
    TriangleEmission { radiance, covered, points: if cells.is_some() { points } else { side * points }, cells }
}

/// Mean radiance of a cell, and the share of it that shines.
fn mean_of_cell(surface: &TrianglePoints<'_>, cell: Cell, side: u32, points: u32) -> ([f32; 3], f32) {
    let (mut sum, mut shining) = ([0.0_f64; 3], 0_u32);
    for middle in middles(points) {
        if let Some(radiance) = surface.radiance(cell.place(side, middle)) {
            sum = [0, 1, 2].map(|channel| sum[channel] + f64::from(radiance[channel]));
            shining += 1;
        }
    }
    let count = f64::from(points * points);
    (sum.map(|channel| (channel / count) as f32), (f64::from(shining) / count) as f32)
}

fn emissive_cells(side: u32, mut light: Vec<f32>, may_shine: &[bool], shining: usize) -> Option<EmissiveCells> {
    let total: f32 = light.iter().sum();
    let least = DOUBT * if total > 0.0 { total / shining as f32 } else { 1.0 };
    let weight = |(light, may): (&f32, &bool)| if *may { light.max(least) } else { 0.0 };
    let mut density: Vec<f32> = light.iter().zip(may_shine).map(weight).collect();
    let (low, high) = density.iter().fold((f32::INFINITY, 0.0_f32), |(low, high), &it| (low.min(it), high.max(it)));
    if high <= EVEN * low {
        return None;
    }
    let scale = density.len() as f32 / density.iter().sum::<f32>();
    density.iter_mut().for_each(|density| *density *= scale);
    let scale = if total > 0.0 { light.len() as f32 / total } else { 0.0 };
    light.iter_mut().for_each(|light| *light *= scale);
    Some(EmissiveCells { side, light, density })
}

#[cfg(test)]
mod tests {
    use super::super::material::Wrap;
    use super::super::{Alpha, MaterialId, TextureId, TextureRef};
    use super::*;

    /// Texels of no pattern, most of them dark or cut away.
    fn texture(width: u32, height: u32, seed: u32, wrap: [Wrap; 2], nearest: bool) -> Texture {
        let byte = |index: u32| {
            let mixed = (index ^ seed).wrapping_mul(0x9E37_79B9) >> 8;
            if mixed.is_multiple_of(3) { (mixed >> 5) as u8 | 128 } else { 0 }
        };
        let rgba8 = (0..4 * width * height).map(byte).collect();
        Texture { name: String::new(), width, height, rgba8, wrap, nearest, srgb: true }
    }

    fn primitive(reach: f32) -> Primitive {
        let corners = vec![[0.1, 0.2], [reach, 0.3], [0.4, reach]];
        Primitive {
            positions: vec![[0.0; 3]; 3],
            indices: vec![0, 1, 2],
            texcoords: [Some(corners.clone()), Some(corners.iter().map(|[u, v]| [1.0 - v, *u]).collect())],
            colors: Some(vec![[1.0; 4], [1.0, 1.0, 1.0, 0.9], [1.0, 1.0, 1.0, 0.7]]),
            material: MaterialId(0),
            ..Primitive::default()
        }
    }

    /// Where a point shines points are drawn, and the mean is that of many points elsewhere than those that were looked at.
    #[test]
    fn every_point_that_shines_may_be_drawn() {
        for (case, wrap) in (0..).zip([Wrap::Repeat, Wrap::Mirror, Wrap::Clamp]) {
            for (reach, nearest) in [(0.9, true), (1.7, false), (-2.3, true), (0.35, false)] {
                let textures =
                    [texture(13, 9, case, [wrap, Wrap::Repeat], nearest), texture(8, 16, case + 9, [wrap; 2], nearest)];
                let material = Material {
                    emissive: [1.0, 2.0, 3.0],
                    alpha: Alpha::Mask { cutoff: 0.6 },
                    base_color_texture: Some(TextureRef::new(TextureId(0))),
                    emissive_texture: Some(TextureRef { texcoord: 1, ..TextureRef::new(TextureId(1)) }),
                    ..Material::default()
                };
                let primitive = primitive(reach);
                let Emission::Uneven(found) = emission_of(&primitive, &material, &textures) else { continue };
                let points = EmissionPoints::new(&primitive, &material, &textures, true);
                let surface = points.of_triangle(&primitive.indices);
                let mut sum = 0.0;
                const SIDE: u32 = 173;
                for place in middles(SIDE) {
                    let light = surface.radiance(place).map_or(0.0, luminance);
                    sum += f64::from(light);
                    let Some(cells) = found[0].cells.as_ref().filter(|_| light > 0.0) else { continue };
                    let [x, y] = place.map(|place| place * f64::from(cells.side));
                    let upper = x.fract() + y.fract() > 1.0;
                    let cell = Cell { column: x as u32, row: y as u32, upper };
                    assert!(cells.density[cell.number(cells.side)] > 0.0, "{wrap:?} {reach}: {cell:?} shines");
                }
                let mean = sum / f64::from(SIDE * SIDE);
                let held = f64::from(luminance(found[0].radiance));
                let shines = found[0].covered > 0.0 || mean > 0.0;
                assert!(
                    !shines || (held - mean).abs() < 0.02 * mean,
                    "{wrap:?} {reach} {nearest}: {held} in place of {mean}"
                );
                if let Some(cells) = &found[0].cells {
                    let all: f32 = cells.density.iter().sum();
                    assert!((all / cells.density.len() as f32 - 1.0).abs() < 1e-3, "{all}");
                }
            }
        }
    }
}
