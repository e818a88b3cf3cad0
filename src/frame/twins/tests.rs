//! The twins against closed forms, and against each other.

use super::*;
use std::f32::consts::PI;

/// Points spread evenly over the unit sphere (spherical Fibonacci).
fn directions(count: u32) -> impl Iterator<Item = Vec3> {
    (0..count).map(move |i| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let azimuth = f64::from(i) * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let radius = (1.0 - z * z).sqrt();
        Vec3::new((radius * azimuth.cos()) as f32, (radius * azimuth.sin()) as f32, z as f32)
    })
}

fn assert_close(actual: f64, expected: f64, relative: f64) {
    assert!((actual - expected).abs() <= relative * expected.abs(), "{actual} is not {expected} within {relative}");
}

#[test]
fn packed_directions_stay_within_their_error_bounds() {
    for direction in directions(20_000) {
        let error = unpack_direction(pack_direction(direction)).distance(direction);
        assert!(error < 7e-5, "{direction}: {error}");
        let word = pack_direction_in_float(direction);
        assert!(word.is_normal() && word.is_sign_positive(), "{direction}: {word}");
        let error = unpack_direction_in_float_unnormalized(word).normalize().distance(direction);
        assert!(error < 1.2e-4, "{direction}: {error}");
    }
}

#[test]
fn axes_survive_packing_exactly() {
    for axis in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
        assert_eq!(unpack_direction(pack_direction(axis)), axis);
        assert_eq!(unpack_direction_in_float_unnormalized(pack_direction_in_float(axis)), axis);
    }
}

#[test]
fn hilbert_curve_visits_every_texel_of_a_tile_in_steps_of_one() {
    for orientation in 0..4 {
        let path: Vec<IVec2> = (0..256).map(|index| hilbert_decode(index, orientation)).collect();
        assert!(path.windows(2).all(|pair| (pair[1] - pair[0]).abs().element_sum() == 1));
        let mut seen = [[false; 16]; 16];
        path.iter().for_each(|cell| seen[cell.y as usize][cell.x as usize] = true);
        assert!(seen.iter().flatten().all(|&seen| seen));
    }
}

#[test]
fn texels_of_a_cube_face_cover_a_sixth_of_the_sphere() {
    for size in [8_u32, 64, 512] {
        let step = 2.0 / size as f32;
        let sum: f64 = (0..size * size)
            .map(|i| Vec2::new((i % size) as f32 + 0.5, (i / size) as f32 + 0.5) * step - 1.0)
            .map(|tangent| f64::from(solid_angle_of_texel(tangent, step)))
            .sum();
        assert_close(sum, 4.0 * std::f64::consts::PI / 6.0, 1e-6);
    }
}

#[test]
fn a_texel_far_off_the_axis_shrinks_with_the_cube_of_the_cosine() {
    let step = 1e-3_f32;
    for tangent in [Vec2::ZERO, Vec2::new(1.0, 1.0), Vec2::new(3.7, -2.0), Vec2::new(40.0, 0.0)] {
        let cosine = f64::from(1.0 + tangent.length_squared()).sqrt().recip();
        let expected = f64::from(step) * f64::from(step) * cosine.powi(3);
        assert_close(f64::from(solid_angle_of_texel(tangent, step)), expected, 1e-5);
    }
}

/// ∫ I dω = 2π((1 − cos i) + (cos i − cos o)/3) for glTF's squared linear falloff between the cones.
#[test]
fn the_texels_of_a_spot_view_add_up_to_its_power() {
    for (inner, outer) in [(10.0_f32, 15.0_f32), (20.0, 45.0), (0.0, 60.0), (74.0, 75.0)] {
        let (inner, outer) = (inner.to_radians(), outer.to_radians());
        let (scale, offset) = spot_scale_and_offset(inner, outer);
        let size = 512_u32;
        let step = 2.0 * outer.tan() * 1.02 / size as f32;
        let sum: f64 = (0..size * size)
            .map(|i| (Vec2::new((i % size) as f32 + 0.5, (i / size) as f32 + 0.5) - size as f32 / 2.0) * step)
            .map(|tangent| {
                let cosine = (1.0 + tangent.length_squared()).sqrt().recip();
                f64::from(spot_attenuation(cosine, scale, offset) * solid_angle_of_texel(tangent, step))
            })
            .sum();
        let (cos_inner, cos_outer) = (f64::from(inner.cos()), f64::from(outer.cos()));
        let power = 2.0 * std::f64::consts::PI * ((1.0 - cos_inner) + (cos_inner - cos_outer) / 3.0);
        assert_close(sum, power, 0.005);
    }
}

#[test]
fn a_range_ends_the_light_there_and_none_never_does() {
    assert_eq!(range_window(5.0, 0.0), 1.0);
    assert_eq!(range_window(0.0, 5.0), 1.0);
    assert_eq!(range_window(5.0, 5.0), 0.0);
    assert_eq!(range_window(9.0, 5.0), 0.0);
}

#[test]
fn every_axis_has_its_own_face() {
    let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    for (face, axis) in (0..).zip(axes) {
        assert_eq!(major_axis_face(axis), face);
    }
}

/// ∫ f cosθ dω over a stratified hemisphere of half vectors, for a light seen from `cos_eye`: at most 1 for white, as GGX
/// with single scattering loses light and gains none.
fn white_specular_albedo(roughness: f32, cos_eye: f32) -> f64 {
    let surface = Scatterer { normal: Vec3::Z, diffuse_albedo: Vec3::ZERO, f0: Vec3::ONE, f90: 1.0, roughness };
    let to_eye = Vec3::new((1.0 - cos_eye * cos_eye).sqrt(), 0.0, cos_eye);
    let alpha = (roughness * roughness).max(MINIMUM_ALPHA);
    let strata = 200_u32;
    // Half vectors by their GGX density D·(n·h), so that sharp lobes are met: light pdf = D·(n·h)/(4·v·h).
    let sum: f64 = (0..strata * strata)
        .map(|i| {
            let u = ((i % strata) as f32 + 0.5) / strata as f32;
            let azimuth = ((i / strata) as f32 + 0.5) / strata as f32 * 2.0 * PI;
            let tan2 = alpha * alpha * u / (1.0 - u);
            let cosine = (1.0 + tan2).sqrt().recip();
            let sine = tan2.sqrt() * cosine;
            let middle = Vec3::new(sine * azimuth.cos(), sine * azimuth.sin(), cosine);
            let to_light = 2.0 * to_eye.dot(middle) * middle - to_eye;
            let v_dot_h = to_eye.dot(middle);
            if to_light.z <= 0.0 || v_dot_h <= 0.0 {
                return 0.0;
            }
            let spread = alpha * alpha * cosine * cosine + sine * sine;
            let density = alpha * alpha / (PI * spread * spread) * cosine / (4.0 * v_dot_h);
            f64::from(specular_brdf(&surface, to_light, to_eye).x * to_light.z / density)
        })
        .sum();
    sum / f64::from(strata * strata)
}

#[test]
fn a_white_specular_lobe_reflects_at_most_what_arrives() {
    for roughness in [0.05, 0.2, 0.5, 0.8, 1.0] {
        for cos_eye in [0.1, 0.5, 1.0] {
            let albedo = white_specular_albedo(roughness, cos_eye);
            assert!(albedo < 1.001 && albedo > 0.3, "roughness {roughness}, cosine {cos_eye}: {albedo}");
        }
    }
    assert_close(white_specular_albedo(0.05, 1.0), 1.0, 0.001);
}

#[test]
fn the_brdf_is_reciprocal_and_finite_down_to_a_mirror() {
    let surface = |roughness| Scatterer {
        normal: Vec3::Z,
        diffuse_albedo: Vec3::splat(0.5),
        f0: Vec3::splat(0.04),
        f90: 1.0,
        roughness,
    };
    let upper: Vec<Vec3> = directions(200).filter(|d| d.z > 0.01).collect();
    for &l in &upper {
        for &v in &upper {
            let (there, back) = (surface_brdf(&surface(0.4), l, v), surface_brdf(&surface(0.4), v, l));
            assert!(there.abs_diff_eq(back, 1e-4 * there.x), "{l} {v}: {there} {back}");
            assert!(surface_brdf(&surface(0.0), l, v).is_finite());
        }
    }
    assert!(specular_brdf(&surface(0.0), Vec3::NEG_Z, Vec3::Z).is_finite());
}

#[test]
fn the_indirect_albedo_is_the_mean_of_the_diffuse_lobe_over_both_directions() {
    let (diffuse_albedo, f0) = (Vec3::ONE, Vec3::splat(0.04));
    let surface = Scatterer { normal: Vec3::Z, diffuse_albedo, f0, f90: 1.0, roughness: 0.5 };
    let cosines: Vec<f32> = (0..100).map(|i| ((i as f32 + 0.5) / 100.0).sqrt()).collect();
    let turns: Vec<f32> = (0..100).map(|i| (i as f32 + 0.5) / 100.0 * PI).collect();
    let direction = |cosine: f32, turn: f32| {
        let sine = (1.0 - cosine * cosine).sqrt();
        Vec3::new(sine * turn.cos(), sine * turn.sin(), cosine)
    };
    let mut mean = 0.0;
    for &from in &cosines {
        let to_eye = direction(from, 0.0);
        for &to in &cosines {
            for &turn in &turns {
                let middle = (direction(to, turn) + to_eye).normalize();
                mean += f64::from(diffuse_brdf(&surface, to_eye.dot(middle)).x * PI) / 1e6;
            }
        }
    }
    let albedo = indirect_diffuse_albedo(Vec3::ONE, Vec3::splat(0.04), 1.0);
    assert_close(f64::from(albedo.x), mean, 2e-4);
}

#[test]
fn a_virtual_light_far_away_is_a_point_and_near_by_a_disc() {
    let (flux, area) = (Vec3::new(1.0, 2.0, 3.0), 0.5_f32);
    let vpl = pack_vpl(Vec3::ZERO, Vec3::Z, flux, area);
    assert!(vpl_flux(vpl).abs_diff_eq(flux, 1e-6));
    for distance in [0.01_f32, 0.1, 1.0, 10.0, 1000.0] {
        let irradiance = vpl_irradiance(vpl, Vec3::Z * distance, Vec3::NEG_Z);
        // The disc's exact irradiance on its axis: πL·R²/(R² + d²) with L = Φ/(πA), A = πR².
        let radius2 = area / PI;
        let expected = flux * (radius2 / (area * (radius2 + distance * distance)));
        assert!(irradiance.abs_diff_eq(expected, 1e-5 * expected.z), "{distance}: {irradiance} {expected}");
    }
    assert_eq!(vpl_irradiance(vpl, Vec3::ZERO, Vec3::Z), Vec3::ZERO);
    assert_eq!(vpl_irradiance(vpl, Vec3::NEG_Z, Vec3::Z), Vec3::ZERO);
}

#[test]
fn a_virtual_light_of_any_direction_keeps_its_flux() {
    for normal in directions(500) {
        let vpl = pack_vpl(Vec3::ONE, normal, Vec3::splat(2.0), 1e-3);
        assert!(vpl_flux(vpl).abs_diff_eq(Vec3::splat(2.0), 1e-5));
        let facing = vpl_irradiance(vpl, Vec3::ONE + 3.0 * normal, -normal);
        let expected = 2.0 * FRAC_1_PI / (9.0 + 1e-3 * FRAC_1_PI);
        assert!((facing.x - expected).abs() < 1e-4 * expected, "{normal}: {} {expected}", facing.x);
    }
}

#[test]
fn a_surface_texel_unpacks() {
    let half_of_one_half = 0x3800_u32;
    let half_of_one = 0x3C00_u32;
    let texel = UVec4::new(
        pack_direction(Vec3::Y),
        pack_direction(Vec3::NEG_Z),
        half_of_one << 16 | half_of_one_half,
        0xFFFF_0000 | half_of_one_half,
    );
    assert_eq!(unpack_surface(texel), (Vec3::Y, Vec3::NEG_Z, Vec3::new(0.5, 1.0, 0.5), 1.0));
}

#[test]
fn tone_curves_rise_and_end_at_white() {
    let mut last = (0.0, 0.0);
    for i in 1..=1000 {
        let l = 0.05 * i as f32;
        let (aces, drago) = (tonemap_aces(Vec3::splat(l)).x, l * tonemap_drago_scale(l, 50.0, 0.85));
        assert!(aces >= last.0 && drago >= last.1, "{l}: {aces} {drago}");
        last = (aces, drago);
    }
    // Drago 2003: the brightest pixel shows the display's full luminance, 1 at 100 cd/m².
    assert_close(f64::from(last.1), 1.0, 1e-5);
    assert!(tonemap_drago_scale(0.0, 0.0, 0.85).is_finite());
    assert!(tonemap_aces(Vec3::splat(f32::MAX)).is_finite());
}

#[test]
fn srgb_meets_its_fixed_points() {
    let encoded = srgb_encode(Vec3::new(0.0, 0.214_041_14, 1.0));
    assert!(encoded.abs_diff_eq(Vec3::new(0.0, 0.5, 1.0), 1e-6), "{encoded}");
}

#[test]
fn luminance_of_white_is_one() {
    assert!((luminance(Vec3::ONE) - 1.0).abs() < 1e-6);
}
