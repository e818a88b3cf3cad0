//! What next-event estimation and light paths draw lights from: one alias table over punctual lights and emissive triangles, by power
//! (glsl/lib/emitters.glsl).

use std::f64::consts::PI;

use super::alias_table::alias_table;
use super::emissive_cells::CellTables;
use super::triangles::TracedTriangle;
use crate::scene::{LightKind, PlacedLight, Scene};

pub(super) const TRIANGLE: u32 = 1 << 31;

/// The table, and what it means for triangles.
pub(super) struct EmitterTable {
    /// Threshold, alias, what, probability; empty if nothing but the sky shines.
    pub(super) records: Vec<[u32; 4]>,
    /// For each triangle the density with which a point of it is drawn, 1/m²; 0 if none is.
    pub(super) light_densities: Vec<f32>,
    /// Where on triangles such points are drawn.
    pub(super) cells: CellTables,
    /// What all entries send out, W (luminance).
    pub(super) power: f64,
    /// The same for emissive triangles alone.
    pub(super) triangle_records: Vec<[u32; 4]>,
    /// What those send out, W (luminance).
    pub(super) triangle_power: f64,
}

impl EmitterTable {
    /// From a triangle's density among all lights to that among emissive triangles.
    pub(super) fn density_scale(&self) -> f32 {
        if self.triangle_power > 0.0 { (self.power / self.triangle_power) as f32 } else { 1.0 }
    }
}

/// What can be drawn, with its share.
pub(super) struct Entry {
    pub(super) what: u32,
    /// W, luminance.
    pub(super) power: f64,
}

/// The table of a scene within a sphere of `radius` metres; `triangles` are those of its instances, one after the other.
pub(super) fn emitter_table(
    scene: &Scene,
    triangles: &[TracedTriangle],
    lights: &[PlacedLight],
    radius: f64,
) -> EmitterTable {
    let mut entries: Vec<Entry> = (0..)
        .zip(lights)
        .map(|(what, light)| Entry { what, power: luminance(light.intensity) * extent_of(light, radius) })
        .collect();
    let mut cells = CellTables::default();
    let mut first = 0;
    for instance in scene.instances() {
        let primitive = &scene.meshes()[instance.mesh.0].primitives[instance.primitive];
        let own = first..first + primitive.triangle_count();
        first = own.end;
        if !scene.shines(instance) {
            continue;
        }
        let (material, emission) = (&scene.materials()[primitive.material.0], scene.emission(instance));
        let sides = if material.double_sided { 2.0 } else { 1.0 };
        for (number, index) in own.enumerate() {
            let uneven = emission.of_triangle(number);
            let radiance = uneven.map_or(material.emissive, |emission| emission.radiance);
            let power = luminance(radiance) * sides * PI * triangles[index].area();
            if power > 0.0 && power.is_finite() {
                entries.push(Entry { what: TRIANGLE | u32::try_from(index).unwrap_or(0), power });
                if let Some(held) = uneven.and_then(|emission| emission.cells.as_ref()) {
                    cells.add(index, held, instance.flips_winding);
                }
            }
        }
    }
    entries.retain(|entry| entry.power > 0.0);
    let total: f64 = entries.iter().map(|entry| entry.power).sum();
    let mut light_densities = vec![0.0; triangles.len()];
    for entry in entries.iter().filter(|entry| entry.what & TRIANGLE != 0) {
        let index = (entry.what & !TRIANGLE) as usize;
        light_densities[index] = (entry.power / total / triangles[index].area()) as f32;
    }
    let records = records_of(&entries, total);
    entries.retain(|entry| entry.what & TRIANGLE != 0);
    let triangle_power = entries.iter().map(|entry| entry.power).sum();
    let triangle_records = records_of(&entries, triangle_power);
    EmitterTable { records, light_densities, cells, power: total, triangle_records, triangle_power }
}

/// What an intensity times this is power.
pub(super) fn extent_of(light: &PlacedLight, radius: f64) -> f64 {
    match light.kind {
        LightKind::Point => 4.0 * PI,
        LightKind::Spot { outer_angle, .. } => 2.0 * PI * (1.0 - f64::from(outer_angle).cos()),
        LightKind::Directional => PI * radius * radius,
    }
}

pub(super) fn luminance(color: [f32; 3]) -> f64 {
    0.2126 * f64::from(color[0]) + 0.7152 * f64::from(color[1]) + 0.0722 * f64::from(color[2])
}

/// Drawn by their power.
pub(super) fn records_of(entries: &[Entry], total: f64) -> Vec<[u32; 4]> {
    let powers: Vec<f64> = entries.iter().map(|entry| entry.power).collect();
    let places = alias_table(&powers, total).into_iter().zip(entries);
    places
        .map(|((threshold, alias), entry)| {
            [threshold.to_bits(), alias, entry.what, ((entry.power / total) as f32).to_bits()]
        })
        .collect()
}
