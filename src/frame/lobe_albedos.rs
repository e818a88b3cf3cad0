//! What a specular lobe reflects of a uniform light.

use std::f64::consts::PI;
use std::sync::LazyLock;

use glam::DVec3;

/// Nodes of the table along each axis (glsl/lib/directional_albedo.glsl).
const SIDE: u32 = 16;
/// Half vectors that an albedo is averaged over, along each axis.
const SAMPLES: u32 = 24;
/// As glsl/lib/brdf.glsl has it.
const MINIMUM_ALPHA: f64 = 1e-3;

static ALBEDOS: LazyLock<Vec<[f32; 4]>> = LazyLock::new(albedos);

/// The directional albedos of GGX, by √(n·v) and roughness, as glsl/lib/directional_albedo.glsl reads them.
pub(crate) fn lobe_albedos() -> &'static [[f32; 4]] {
    &ALBEDOS
}

/// ∫ f·cos dω for Fresnel terms of 1 − (1 − v·h)⁵ and of (1 − v·h)⁵, by √(n·v) and roughness: the mean of G/G₁(v) over visible normals (Heitz 2014).
fn albedos() -> Vec<[f32; 4]> {
    let node = |index: u32| f64::from(index) / f64::from(SIDE - 1);
    let albedo = |index: u32| {
        let cosine = node(index % SIDE).powi(2).max(1e-4);
        let alpha = node(index / SIDE).powi(2).max(MINIMUM_ALPHA);
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
    (0..SIDE * SIDE).map(albedo).collect()
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
