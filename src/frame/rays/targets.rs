//! Where light paths are sent: to the triangles whose glossy lobes gather light, by how much of it each may get (glsl/path/mis.glsl).
//!
//! A point y of triangle t is drawn with the density p(y) = w_t/(Σ w A_t), whatever light the path starts at,
//!
//!   w_t = Σ_x F(θ_y) I(x → y)/Φ |cosθ_y| A_t/d²
//!
//! over some points x of the lights that stand for equal shares of their power Φ. That ignores what is in between: any density is
//! right, since some paths go wherever the light goes.

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use super::emitters::{Entry, TRIANGLE, luminance, records_of};
use super::triangles::TracedTriangle;
use crate::scene::{LightKind, Material, PlacedLight, is_glossy};

/// Points of lights.
const SOURCES: usize = 16;
/// The share of the paths that is sent to triangles.
const SHARE: f64 = 0.8;
/// What a side that light hardly meets first, the back of a closed surface, counts.
const BACK: f64 = 0.1;

/// Triangles that light paths are sent to.
#[derive(Default)]
pub(super) struct Targets {
    /// As those of lights: threshold, alias, triangle, probability.
    pub(super) records: Vec<[u32; 4]>,
    /// p(y) of each triangle of the scene up to a factor, 1/m², exact in half the digits of a float; empty if there are no targets.
    pub(super) densities: Vec<f32>,
    pub(super) shares: TargetShares,
}

/// How light paths are shared out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TargetShares {
    pub(crate) count: u32,
    /// That go where the light goes.
    pub(crate) anywhere: f64,
    /// That are sent to targets, and the factor of [`Targets::densities`] besides.
    pub(crate) targeted: f64,
    /// What a path that is sent to a target carries on the average, over what it would carry otherwise.
    pub(crate) flux: f64,
}

impl Default for TargetShares {
    fn default() -> TargetShares {
        TargetShares { count: 0, anywhere: 1.0, targeted: 0.0, flux: 1.0 }
    }
}

/// A point that light leaves.
enum Source {
    Point(DVec3),
    Spot {
        position: DVec3,
        axis: DVec3,
        inner_angle: f64,
        outer_angle: f64,
    },
    /// Parallel light of this direction through a disc of this area.
    Beam {
        direction: DVec3,
        area: f64,
    },
    Patch {
        position: DVec3,
        normal: DVec3,
        both_sides: bool,
    },
}

impl Source {
    fn of(
        what: u32,
        triangles: &[TracedTriangle],
        materials: &[Material],
        lights: &[PlacedLight],
        reach: Reach,
    ) -> Source {
        if what & TRIANGLE != 0 {
            let triangle = &triangles[(what & !TRIANGLE) as usize];
            let both_sides = materials[triangle.material as usize].double_sided;
            return Source::Patch { position: triangle.middle(), normal: triangle.normal(), both_sides };
        }
        let light = &lights[what as usize];
        let position = light.position - reach.origin;
        match light.kind {
            LightKind::Point => Source::Point(position),
            LightKind::Spot { inner_angle, outer_angle } => Source::Spot {
                position,
                axis: light.direction,
                inner_angle: f64::from(inner_angle),
                outer_angle: f64::from(outer_angle),
            },
            LightKind::Directional => {
                Source::Beam { direction: light.direction, area: PI * reach.radius * reach.radius }
            }
        }
    }

    /// The direction in which light comes to `point`, and the share of the source's power through 1 m² across it there, for what has
    /// an area of `area`.
    fn arrival(&self, point: DVec3, area: f64) -> (DVec3, f64) {
        if let Source::Beam { direction, area } = *self {
            return (direction, 1.0 / area);
        }
        let (Source::Point(position) | Source::Spot { position, .. } | Source::Patch { position, .. }) = *self else {
            return (DVec3::ZERO, 0.0);
        };
        let way = point - position;
        let distance2 = way.length_squared().max(area);
        let direction = way.normalize_or_zero();
        let intensity = match *self {
            Source::Spot { axis, inner_angle, outer_angle, .. } => {
                // glTF's falloff, where the surface is nearest to the axis.
                let angle = (axis.angle_between(direction) - (area / distance2).sqrt()).max(0.0);
                let falloff = (angle.cos() - outer_angle.cos()) / (inner_angle.cos() - outer_angle.cos()).max(1e-3);
                falloff.clamp(0.0, 1.0).powi(2) / (2.0 * PI * (1.0 - outer_angle.cos())).max(1e-9)
            }
            Source::Patch { normal, both_sides, .. } => {
                let cosine = normal.dot(direction);
                if both_sides { 0.5 * cosine.abs() / PI } else { cosine.max(0.0) / PI }
            }
            _ => 0.25 / PI,
        };
        (direction, intensity / distance2)
    }
}

/// The sphere in render space through which parallel light comes.
#[derive(Clone, Copy)]
pub(super) struct Reach {
    pub(super) origin: DVec3,
    pub(super) radius: f64,
}

/// The targets of light paths. `emitters`: the records of the table that lights are drawn from.
pub(super) fn targets(
    triangles: &[TracedTriangle],
    materials: &[Material],
    lights: &[PlacedLight],
    emitters: &[[u32; 4]],
    reach: Reach,
) -> Targets {
    let glossy: Vec<bool> = materials.iter().map(is_glossy).collect();
    let sources: Vec<Source> =
        strata(emitters).map(|what| Source::of(what, triangles, materials, lights, reach)).collect();
    if sources.is_empty() || !glossy.contains(&true) {
        return Targets::default();
    }
    let gathered = |triangle: &TracedTriangle| {
        let material = &materials[triangle.material as usize];
        let (point, normal, area) = (triangle.middle(), triangle.normal(), triangle.area());
        let shares = sources.iter().map(|source| {
            let (direction, per_area) = source.arrival(point, area);
            let cosine = -normal.dot(direction);
            let side = if cosine > 0.0 { 1.0 } else { BACK };
            side * per_area * cosine.abs() * reflectance(material, cosine.abs())
        });
        let density = shares.sum::<f64>() / sources.len() as f64;
        if density.is_finite() && area > 0.0 { half_precision(density as f32) } else { 0.0 }
    };
    let densities: Vec<f32> = triangles
        .par_iter()
        .map(|triangle| if glossy[triangle.material as usize] { gathered(triangle) } else { 0.0 })
        .collect();
    let entries: Vec<Entry> = (0_u32..)
        .zip(triangles.iter().zip(&densities))
        .filter(|(_, (_, density))| **density > 0.0)
        .map(|(what, (triangle, density))| Entry { what, power: f64::from(*density) * triangle.area() })
        .collect();
    let total: f64 = entries.iter().map(|entry| entry.power).sum();
    if entries.is_empty() || !(total > 0.0 && total.is_finite()) {
        return Targets::default();
    }
    let shares = TargetShares {
        count: u32::try_from(entries.len()).unwrap_or(0),
        anywhere: 1.0 - SHARE,
        targeted: SHARE / total,
        flux: (total / SHARE).min(1.0),
    };
    Targets { records: records_of(&entries, total), densities, shares }
}

/// Lights that stand for equal shares of the power.
fn strata(emitters: &[[u32; 4]]) -> impl Iterator<Item = u32> {
    let mut below = 0.0;
    let mut drawn = 0;
    emitters.iter().flat_map(move |record| {
        below += f64::from(f32::from_bits(record[3]));
        let until = ((below * SOURCES as f64 + 0.5).floor() as usize).min(SOURCES);
        let count = until.saturating_sub(drawn);
        drawn = until.max(drawn);
        std::iter::repeat_n(record[2], count)
    })
}

/// How much a surface reflects or transmits specularly, without its textures (Schlick 1994).
fn reflectance(material: &Material, cosine: f64) -> f64 {
    let ior = f64::from(material.ior);
    let dielectric = ((ior - 1.0) / (ior + 1.0)).powi(2) * f64::from(material.specular);
    let metallic = f64::from(material.metallic);
    let [red, green, blue, _] = material.base_color;
    let color = luminance([red, green, blue]);
    let f0 = dielectric * (1.0 - metallic) + color * metallic;
    let fresnel = f0 + (1.0 - f0) * (1.0 - cosine.min(1.0)).powi(5);
    fresnel + (1.0 - fresnel) * (1.0 - metallic) * color * f64::from(material.transmission)
}

/// Without the last 16 bits, as paths carry it along.
fn half_precision(density: f32) -> f32 {
    f32::from_bits(density.to_bits() & 0xFFFF_0000)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{LightId, NodeId};
    use glam::Vec3;

    const REACH: Reach = Reach { origin: DVec3::ZERO, radius: 10.0 };

    fn mirror() -> Material {
        Material { metallic: 1.0, roughness: 0.0, ..Material::default() }
    }

    /// Of these materials, half a square metre each, facing up, at these places.
    fn triangles(places: &[(u32, Vec3)]) -> Vec<TracedTriangle> {
        places
            .iter()
            .map(|&(material, place)| {
                TracedTriangle::flat([Vec3::ZERO, Vec3::Z, Vec3::X].map(|corner| place + corner), material)
            })
            .collect()
    }

    fn light(kind: LightKind) -> PlacedLight {
        PlacedLight {
            node: NodeId(0),
            light: LightId(0),
            position: DVec3::new(0.0, 4.0, 0.0),
            direction: DVec3::NEG_Y,
            kind,
            intensity: [1.0; 3],
            range: None,
        }
    }

    fn targets_of(triangles: &[TracedTriangle], materials: &[Material], kind: LightKind) -> Targets {
        let emitters = [[1.0_f32.to_bits(), 0, 0, 1.0_f32.to_bits()]];
        targets(triangles, materials, &[light(kind)], &emitters, REACH)
    }

    #[test]
    fn densities_are_those_of_the_table() {
        let places = [(0, Vec3::ZERO), (0, Vec3::new(3.0, 0.0, 1.0)), (0, Vec3::new(-1.0, 2.0, 0.0))];
        let triangles = triangles(&places);
        for kind in [LightKind::Point, LightKind::Directional] {
            let found = targets_of(&triangles, &[mirror()], kind);
            assert_eq!(found.shares.count, 3);
            let mut sum = 0.0;
            for record in &found.records {
                let triangle = record[2] as usize;
                let probability = f64::from(f32::from_bits(record[3]));
                let density = f64::from(found.densities[triangle]) * found.shares.targeted / SHARE;
                assert!((density * triangles[triangle].area() / probability - 1.0).abs() < 1e-6, "{record:?}");
                assert_eq!(found.densities[triangle].to_bits() & 0xFFFF, 0, "paths carry half of it");
                sum += probability;
            }
            assert!((sum - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn paths_are_sent_to_what_is_glossy_and_lit() {
        let far = Vec3::new(6.0, 0.0, 0.0);
        let triangles = triangles(&[(0, Vec3::ZERO), (1, Vec3::ZERO), (0, far)]);
        let matt = Material { specular: 0.0, ..Material::default() };
        let spot = LightKind::Spot { inner_angle: 0.1, outer_angle: 0.5 };
        let found = targets_of(&triangles, &[mirror(), matt.clone()], spot);
        assert!(found.densities[0] > 0.0);
        assert_eq!(found.densities[1..], [0.0, 0.0], "matt; beside the cone");
        let none = targets_of(&triangles[1..2], &[mirror(), matt], spot);
        assert_eq!((none.shares.count, none.shares.anywhere), (0, 1.0));
    }

    #[test]
    fn sources_stand_for_equal_shares_of_the_power() {
        let record = |what, share: f32| [0, 0, what, share.to_bits()];
        let drawn: Vec<u32> = strata(&[record(7, 0.25), record(5, 0.01), record(9, 0.74)]).collect();
        let count = |what| drawn.iter().filter(|&&source| source == what).count();
        assert_eq!((drawn.len(), count(7), count(5), count(9)), (SOURCES, 4, 0, 12));
    }
}
