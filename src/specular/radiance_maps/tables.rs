//! What does not change from frame to frame: where a map's texels lie, and beside it what a specular lobe reflects of a uniform light.

use std::f64::consts::{FRAC_PI_4, PI};

use glam::{DVec2, DVec3};

use crate::frame::lobe_albedos::lobe_albedos;

/// Of each texel of a map with all its levels its middle h, and W in sr (glsl/radiance_maps/map.glsl); then the directional albedos of GGX.
pub(super) fn tables(size: u32) -> Vec<[f32; 4]> {
    let sides = (0..=size.ilog2()).map(|level| size >> level);
    let texels = sides.flat_map(|side| (0..side * side).map(move |texel| texel_at(side, [texel % side, texel / side])));
    texels.chain(lobe_albedos().iter().copied()).collect()
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
}
