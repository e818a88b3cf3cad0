//! What does not change from frame to frame: where a map's texels lie, and what a specular lobe reflects of a uniform light.

use std::f64::consts::{FRAC_PI_4, PI};
use std::sync::LazyLock;

use glam::{DVec2, DVec3};

/// Nodes of the table of albedos along each axis (glsl/radiance_maps/apply.comp).
const ALBEDO_SIDE: u32 = 16;
/// Half vectors that an albedo is averaged over, along each axis.
const SAMPLES: u32 = 24;
/// As glsl/lib/brdf.glsl has it.
const MINIMUM_ALPHA: f64 = 1e-3;

static ALBEDOS: LazyLock<Vec<[f32; 4]>> = LazyLock::new(albedos);

/// Of each texel of a map with all its levels its middle h, and W in sr (glsl/radiance_maps/map.glsl); then the directional albedos of GGX.
pub(super) fn tables(size: u32) -> Vec<[f32; 4]> {
    let sides = (0..=size.ilog2()).map(|level| size >> level);
    let texels = sides.flat_map(|side| (0..side * side).map(move |texel| texel_at(side, [texel % side, texel / side])));
    texels.chain(ALBEDOS.iter().copied()).collect()
}

/// The direction in the middle of a texel of a level with so many along an edge.
pub(crate) fn direction_of_texel(side: u32, place: [u32; 2]) -> DVec3 {
    direction_of_square(DVec2::from(place.map(|place| 2.0 * (f64::from(place) + 0.5) / f64::from(side) - 1.0)))
}

fn texel_at(side: u32, place: [u32; 2]) -> [f32; 4] {
    let h = direction_of_texel(side, place).as_vec3();
    [h.x, h.y, h.z, solid_angle_at(side, place) as f32]
}

/// The direction at a place of the square from −1 to 1 (Shirley & Chiu 1997, and z = 1 − r²).
fn direction_of_square(place: DVec2) -> DVec3 {
    let wide = place.x.abs() >= place.y.abs();
    let (across, along) = if wide { (place.x, place.y) } else { (place.y, place.x) };
    let angle = if across == 0.0 { 0.0 } else { FRAC_PI_4 * along / across };
    let disc = across * DVec2::new(angle.cos(), angle.sin());
    let disc = if wide { disc } else { DVec2::new(disc.y, disc.x) };
    let squared = across * across;
    (disc * (2.0 - squared).sqrt()).extend(1.0 - squared)
}

/// W = ∫ 4 z dω_h over a texel. In the square dω_h = π/2 du dv and z = 1 − max(u², v²).
fn solid_angle_at(side: u32, place: [u32; 2]) -> f64 {
    let step = 2.0 / f64::from(side);
    let least = place.map(|place| {
        let low = step * f64::from(place) - 1.0;
        low.abs().min((low + step).abs())
    });
    let [low, high] = [least[0].min(least[1]), least[0].max(least[1])];
    let squares = match side {
        1 => 0.5,
        // On the diagonal.
        _ if high - low < 0.5 * step => low * low + 4.0 / 3.0 * low * step + 0.5 * step * step,
        _ => high * high + high * step + step * step / 3.0,
    };
    2.0 * PI * step * step * (1.0 - squares)
}

/// ∫ f·cos dω for Fresnel terms of 1 − (1 − v·h)⁵ and of (1 − v·h)⁵, by √(n·v) and roughness: the mean of G/G₁(v) over visible normals (Heitz 2014).
fn albedos() -> Vec<[f32; 4]> {
    let node = |index: u32| f64::from(index) / f64::from(ALBEDO_SIDE - 1);
    let albedo = |index: u32| {
        let cosine = node(index % ALBEDO_SIDE).powi(2).max(1e-4);
        let alpha = node(index / ALBEDO_SIDE).powi(2).max(MINIMUM_ALPHA);
        let viewer = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
        let (mut whole, mut grazing) = (0.0, 0.0);
        for sample in 0..SAMPLES * SAMPLES {
            let random =
                [sample % SAMPLES, sample / SAMPLES].map(|place| (f64::from(place) + 0.5) / f64::from(SAMPLES));
            let middle = visible_normal(viewer, alpha, random);
            let facing = viewer.dot(middle).max(0.0);
            let toward = 2.0 * facing * middle - viewer;
            if toward.z > 0.0 {
                let [of_viewer, of_light] = [viewer.z, toward.z].map(|cosine| smith_lambda(cosine, alpha));
                let share = (1.0 + of_viewer) / (1.0 + of_viewer + of_light);
                whole += share;
                grazing += share * (1.0 - facing).powi(5);
            }
        }
        let count = f64::from(SAMPLES * SAMPLES);
        [((whole - grazing) / count) as f32, (grazing / count) as f32, 0.0, 0.0]
    };
    (0..ALBEDO_SIDE * ALBEDO_SIDE).map(albedo).collect()
}

/// As glsl/lib/microfacet.glsl draws them.
fn visible_normal(viewer: DVec3, alpha: f64, random: [f64; 2]) -> DVec3 {
    let stretched = DVec3::new(viewer.x * alpha, viewer.y * alpha, viewer.z).normalize();
    let azimuth = 2.0 * PI * random[0];
    let z = (1.0 - random[1]) * (1.0 + stretched.z) - stretched.z;
    let across = (1.0 - z * z).clamp(0.0, 1.0).sqrt();
    let middle = DVec3::new(across * azimuth.cos(), across * azimuth.sin(), z) + stretched;
    DVec3::new(middle.x * alpha, middle.y * alpha, middle.z.max(1e-9)).normalize()
}

fn smith_lambda(cosine: f64, alpha: f64) -> f64 {
    let tangent2 = (1.0 - cosine * cosine).max(0.0) / (cosine * cosine).max(1e-8);
    let scaled = alpha * alpha * tangent2;
    0.5 * scaled / (1.0 + (1.0 + scaled).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums over small steps.
    #[test]
    fn solid_angles_are_those_of_their_directions() {
        for side in [1_u32, 2, 4, 8] {
            let mut sum = 0.0;
            for texel in 0..side * side {
                let place = [texel % side, texel / side];
                let known = solid_angle_at(side, place);
                let step = 2.0 / f64::from(side) / 32.0;
                let at = |axis: usize, index: u32| {
                    // Never on a diagonal.
                    let within = if axis == 0 { 0.4 } else { 0.6 };
                    2.0 * f64::from(place[axis]) / f64::from(side) - 1.0 + step * (f64::from(index) + within)
                };
                let integral: f64 = (0..1024)
                    .map(|index| {
                        let place = DVec2::new(at(0, index % 32), at(1, index / 32));
                        let [h, u, v] =
                            [DVec2::ZERO, DVec2::X, DVec2::Y].map(|off| direction_of_square(place + 1e-5 * off));
                        let solid_angle = ((u - h) / 1e-5).cross((v - h) / 1e-5).length() * step * step;
                        assert!((h.length() - 1.0).abs() < 1e-12);
                        4.0 * h.z * solid_angle
                    })
                    .sum();
                assert!((known / integral - 1.0).abs() < 0.02, "{side}, {place:?}: {known} of {integral}");
                sum += known;
            }
            assert!((sum / (4.0 * PI) - 1.0).abs() < 1e-12, "all directions: {sum}");
        }
    }

    /// A smooth metal reflects all. At α = 1 and a viewer above, half vectors are cosine-distributed, ω·n even between −1 and 1, and G/G₁ = 2c/(1 + c): 1 − ln 2 is left.
    #[test]
    fn albedos_are_those_of_the_lobe() {
        let table = albedos();
        let at = |cosine: usize, roughness: usize| table[roughness * 16 + cosine].map(f64::from);
        for cosine in 3..16 {
            let [rest, grazing, ..] = at(cosine, 0);
            let expected = (1.0 - (cosine as f64 / 15.0).powi(2)).powi(5);
            assert!((rest + grazing - 1.0).abs() < 0.01 && (grazing - expected).abs() < 0.02, "{rest} {grazing}");
        }
        let [rest, grazing, ..] = at(15, 15);
        assert!((rest + grazing - (1.0 - 2.0_f64.ln())).abs() < 1e-3 && grazing < 0.01, "{rest} {grazing}");
    }
}
