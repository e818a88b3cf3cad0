//! What next-event estimation and light paths draw lights from: one alias table over punctual lights and emissive triangles, by power
//! (glsl/lib/emitters.glsl).

use std::f64::consts::PI;

use super::triangles::TracedTriangle;
use crate::scene::{LightKind, Material, PlacedLight};

const TRIANGLE: u32 = 1 << 31;

/// The table, and what it means for triangles.
pub(super) struct EmitterTable {
    /// Threshold, alias, what, probability; empty if nothing but the sky shines.
    pub(super) records: Vec<[u32; 4]>,
    /// For each triangle the density with which a point of it is drawn, 1/m²; 0 if none is.
    pub(super) light_densities: Vec<f32>,
    /// What all entries send out, W (luminance).
    pub(super) power: f64,
    /// The same for emissive triangles alone.
    pub(super) triangle_records: Vec<[u32; 4]>,
    /// What those send out, W (luminance).
    pub(super) triangle_power: f64,
}

struct Entry {
    what: u32,
    /// W, luminance.
    power: f64,
}

/// The table of a scene within a sphere of `radius` metres.
pub(super) fn emitter_table(
    triangles: &[TracedTriangle],
    materials: &[Material],
    lights: &[PlacedLight],
    radius: f64,
) -> EmitterTable {
    let mut entries: Vec<Entry> = (0..)
        .zip(lights)
        .map(|(what, light)| Entry { what, power: luminance(light.intensity) * extent_of(light, radius) })
        .collect();
    let radiance: Vec<f64> = materials
        .iter()
        .map(|material| {
            let sides = if material.double_sided { 2.0 } else { 1.0 };
            if material.emits() { luminance(material.emissive) * sides * PI } else { 0.0 }
        })
        .collect();
    entries.extend((0_u32..).zip(triangles).filter_map(|(index, triangle)| {
        let power = radiance[triangle.material as usize] * triangle.area();
        (power > 0.0 && power.is_finite()).then_some(Entry { what: TRIANGLE | index, power })
    }));
    entries.retain(|entry| entry.power > 0.0);
    let total: f64 = entries.iter().map(|entry| entry.power).sum();
    let mut light_densities = vec![0.0; triangles.len()];
    for entry in entries.iter().filter(|entry| entry.what & TRIANGLE != 0) {
        let index = (entry.what & !TRIANGLE) as usize;
        light_densities[index] = (entry.power / total / triangles[index].area()) as f32;
    }
    let records = alias_table(&entries, total);
    entries.retain(|entry| entry.what & TRIANGLE != 0);
    let triangle_power = entries.iter().map(|entry| entry.power).sum();
    let triangle_records = alias_table(&entries, triangle_power);
    EmitterTable { records, light_densities, power: total, triangle_records, triangle_power }
}

/// What an intensity times this is power.
fn extent_of(light: &PlacedLight, radius: f64) -> f64 {
    match light.kind {
        LightKind::Point => 4.0 * PI,
        LightKind::Spot { outer_angle, .. } => 2.0 * PI * (1.0 - f64::from(outer_angle).cos()),
        LightKind::Directional => PI * radius * radius,
    }
}

fn luminance(color: [f32; 3]) -> f64 {
    0.2126 * f64::from(color[0]) + 0.7152 * f64::from(color[1]) + 0.0722 * f64::from(color[2])
}

/// Vose 1991: every place holds one entry up to a threshold and another above it.
fn alias_table(entries: &[Entry], total: f64) -> Vec<[u32; 4]> {
    let count = entries.len();
    let mut shares: Vec<f64> = entries.iter().map(|entry| entry.power / total * count as f64).collect();
    let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..count).rev().partition(|&place| shares[place] < 1.0);
    let mut records: Vec<[u32; 4]> = (0_u32..)
        .zip(entries)
        .map(|(place, entry)| [1.0_f32.to_bits(), place, entry.what, ((entry.power / total) as f32).to_bits()])
        .collect();
    while let (Some(poor), Some(&rich)) = (small.pop(), large.last()) {
        records[poor][0] = (shares[poor] as f32).to_bits();
        records[poor][1] = u32::try_from(rich).unwrap_or(0);
        shares[rich] -= 1.0 - shares[poor];
        if shares[rich] < 1.0 {
            large.pop();
            small.push(rich);
        }
    }
    records
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_entry_is_drawn_by_its_power() {
        let powers = [3.0, 0.5, 1.0, 7.5, 1e-3];
        let entries: Vec<Entry> = (0..).zip(powers).map(|(what, power)| Entry { what, power }).collect();
        let total: f64 = powers.iter().sum();
        let records = alias_table(&entries, total);
        let mut drawn = [0.0; 5];
        for (place, record) in records.iter().enumerate() {
            let threshold = f64::from(f32::from_bits(record[0]));
            drawn[place] += threshold / 5.0;
            drawn[record[1] as usize] += (1.0 - threshold) / 5.0;
        }
        for (drawn, power) in drawn.iter().zip(powers) {
            assert!((drawn - power / total).abs() < 1e-7, "{drawn} {power}");
        }
    }

    #[test]
    fn equal_entries_keep_their_order() {
        let entries: Vec<Entry> = (0..4).map(|what| Entry { what, power: 2.0 }).collect();
        for (place, record) in alias_table(&entries, 8.0).iter().enumerate() {
            assert!(record[0] == 1.0_f32.to_bits() || record[1] as usize == place);
        }
    }
}
