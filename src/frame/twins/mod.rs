//! The functions of `glsl/lib/` that hold non-trivial mathematics, once more on the CPU and under the same names.
//!
//! They serve the tests: closed forms are checked here where a debugger reaches, and a test can run a kernel and its twin on the
//! same random inputs. Each doc comment names the shader file, where the derivation stands. Arithmetic is `f32` as on the
//! device unless a function says otherwise, so that agreement to a few ulp is a fair demand.

use std::f32::consts::{FRAC_1_PI, PI};

use glam::{IVec2, UVec2, UVec4, Vec2, Vec2Swizzles as _, Vec3, Vec4, Vec4Swizzles as _};

pub(crate) use crate::frame::octahedral::{octahedral_encode, pack_direction, sign_not_zero};

#[cfg(test)]
mod tests;

/// The smallest GGX α that the shaders evaluate (`lib/brdf.glsl`).
pub(crate) const MINIMUM_ALPHA: f32 = 1e-3;

/// Luminance weights of Rec. 709 (`lib/color.glsl`).
#[must_use]
pub(crate) fn luminance(color: Vec3) -> f32 {
    color.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

/// The sRGB curve, IEC 61966-2-1 (`lib/color.glsl`).
#[must_use]
pub(crate) fn srgb_encode(linear: Vec3) -> Vec3 {
    let encode = |x: f32| {
        if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
    };
    Vec3::new(encode(linear.x), encode(linear.y), encode(linear.z))
}

/// The point of the octahedron: its components' absolute values sum to one (`lib/octahedral.glsl`).
#[must_use]
pub(crate) fn octahedral_decode_unnormalized(square: Vec2) -> Vec3 {
    let z = 1.0 - square.x.abs() - square.y.abs();
    let folded = square - sign_not_zero(square) * (-z).max(0.0);
    folded.extend(z)
}

/// The unit vector of [`octahedral_encode`]'s coordinates (`lib/octahedral.glsl`).
#[must_use]
pub(crate) fn octahedral_decode(square: Vec2) -> Vec3 {
    octahedral_decode_unnormalized(square).normalize()
}

/// The inverse of [`pack_direction`] (`lib/octahedral.glsl`).
#[must_use]
pub(crate) fn unpack_direction(bits: u32) -> Vec3 {
    let snorm16 = |half: u32| (f32::from((half as u16).cast_signed()) / 32767.0).max(-1.0);
    octahedral_decode(Vec2::new(snorm16(bits & 0xFFFF), snorm16(bits >> 16)))
}

/// A unit vector in the bits of a positive, normal, finite float (`lib/octahedral.glsl`).
#[must_use]
pub(crate) fn pack_direction_in_float(direction: Vec3) -> f32 {
    let square = octahedral_encode(direction);
    let x = (32768 + (square.x * 32767.0).round() as i32).cast_unsigned();
    let y = (16384 + (square.y * 16255.0).round() as i32).cast_unsigned();
    f32::from_bits(y << 16 | x)
}

/// The inverse of [`pack_direction_in_float`], not of unit length (`lib/octahedral.glsl`).
#[must_use]
pub(crate) fn unpack_direction_in_float_unnormalized(word: f32) -> Vec3 {
    let bits = word.to_bits();
    octahedral_decode_unnormalized(Vec2::new(
        ((bits & 0xFFFF) as f32 - 32768.0) / 32767.0,
        ((bits >> 16) as f32 - 16384.0) / 16255.0,
    ))
}

/// The cell of an index along Hilbert's curve through 16×16 cells (`lib/hilbert.glsl`).
#[must_use]
pub(crate) fn hilbert_decode(index: u32, orientation: u32) -> IVec2 {
    let (mut cell, mut rest) = (UVec2::ZERO, index);
    for side in [1, 2, 4, 8] {
        let right = rest >> 1 & 1;
        let below = (rest ^ right) & 1;
        if below == 0 {
            cell = if right == 1 { UVec2::splat(side - 1) - cell } else { cell };
            cell = cell.yx();
        }
        cell += side * UVec2::new(right, below);
        rest >>= 2;
    }
    cell = if orientation & 2 != 0 { UVec2::splat(15) - cell } else { cell };
    (if orientation & 1 != 0 { cell.yx() } else { cell }).as_ivec2()
}

/// Solid angle, in sr, of the square of side `extent` around `tangent` in the plane at distance 1 (`lib/solid_angle.glsl`).
///
/// Valid while `extent` is at most a quarter: the arc tangent is a series.
#[must_use]
pub(crate) fn solid_angle_of_texel(tangent: Vec2, extent: f32) -> f32 {
    let low = tangent - 0.5 * extent;
    let high = tangent + 0.5 * extent;
    let low_high = Vec2::new(low.x, high.y);
    let high_low = Vec2::new(high.x, low.y);
    let half_angle = |a: Vec2, b: Vec2, c: Vec2| {
        let length = |v: Vec2| (v.dot(v) + 1.0).sqrt();
        let denominator = length(a) * length(b) * length(c)
            + (a.dot(b) + 1.0) * length(c)
            + (a.dot(c) + 1.0) * length(b)
            + (b.dot(c) + 1.0) * length(a);
        let x = extent * extent / denominator;
        let x2 = x * x;
        x * (1.0 - x2 * (1.0 / 3.0 - 0.2 * x2))
    };
    2.0 * (half_angle(low, high_low, high) + half_angle(low, high, low_high))
}

/// glTF's angular falloff of a spot light (`lib/lights.glsl`).
#[must_use]
pub(crate) fn spot_attenuation(cosine: f32, scale: f32, offset: f32) -> f32 {
    let attenuation = (cosine * scale + offset).clamp(0.0, 1.0);
    attenuation * attenuation
}

/// The scale and offset of [`spot_attenuation`] for the cones' half angles in radians, as KHR_lights_punctual proposes.
#[must_use]
pub(crate) fn spot_scale_and_offset(inner_angle: f32, outer_angle: f32) -> (f32, f32) {
    let scale = 1.0 / (inner_angle.cos() - outer_angle.cos()).max(1e-3);
    (scale, -outer_angle.cos() * scale)
}

/// The window that takes a light with a range to zero at that range; 0 is no range (`lib/lights.glsl`).
#[must_use]
pub(crate) fn range_window(distance: f32, range: f32) -> f32 {
    let ratio = if range > 0.0 { distance / range } else { 0.0 };
    (1.0 - ratio.powi(4)).clamp(0.0, 1.0)
}

/// Number of the largest component: 0 … 5 for +x, −x, +y, −y, +z, −z (`lib/lights.glsl`).
#[must_use]
pub(crate) fn major_axis_face(v: Vec3) -> u32 {
    let size = v.abs();
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    2 * axis + u32::from(v[axis as usize] < 0.0)
}

/// What scatters at a point of a surface (`Surface` of `lib/brdf.glsl`, without the position and the triangle's normal).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scatterer {
    /// Unit shading normal on the viewer's side.
    pub normal: Vec3,
    /// Albedo of the diffuse lobe.
    pub diffuse_albedo: Vec3,
    /// Specular reflectance at normal incidence.
    pub f0: Vec3,
    /// Specular reflectance at grazing incidence.
    pub f90: f32,
    /// Perceptual roughness; α is its square.
    pub roughness: f32,
}

/// Schlick's Fresnel reflectance (`lib/brdf.glsl`).
#[must_use]
pub(crate) fn schlick_fresnel(f0: Vec3, f90: f32, cosine: f32) -> Vec3 {
    f0 + (Vec3::splat(f90) - f0) * (1.0 - cosine).clamp(0.0, 1.0).powi(5)
}

/// The diffuse lobe under its specular layer, in 1/sr (`lib/brdf.glsl`).
#[must_use]
pub(crate) fn diffuse_brdf(surface: &Scatterer, v_dot_h: f32) -> Vec3 {
    let fresnel = schlick_fresnel(surface.f0, surface.f90, v_dot_h).max_element();
    surface.diffuse_albedo * (FRAC_1_PI * (1.0 - fresnel))
}

/// GGX with Smith's height-correlated masking and Schlick's Fresnel, in 1/sr (`lib/brdf.glsl`).
#[must_use]
pub(crate) fn specular_brdf(surface: &Scatterer, to_light: Vec3, to_eye: Vec3) -> Vec3 {
    let middle = (to_light + to_eye).try_normalize().unwrap_or(surface.normal);
    let n_dot_l = surface.normal.dot(to_light).max(1e-4);
    let n_dot_v = surface.normal.dot(to_eye).max(1e-4);
    let n_dot_h = surface.normal.dot(middle).clamp(0.0, 1.0);
    let alpha = (surface.roughness * surface.roughness).max(MINIMUM_ALPHA);
    let alpha2 = alpha * alpha;
    let spread = alpha2 * n_dot_h * n_dot_h + surface.normal.cross(middle).length_squared();
    let distribution = alpha2 / (PI * spread * spread);
    let visibility = 0.5
        / (n_dot_l * (n_dot_v * n_dot_v * (1.0 - alpha2) + alpha2).sqrt()
            + n_dot_v * (n_dot_l * n_dot_l * (1.0 - alpha2) + alpha2).sqrt());
    schlick_fresnel(surface.f0, surface.f90, to_eye.dot(middle)) * (distribution * visibility)
}

/// Both lobes, in 1/sr (`lib/brdf.glsl`).
#[must_use]
pub(crate) fn surface_brdf(surface: &Scatterer, to_light: Vec3, to_eye: Vec3) -> Vec3 {
    let middle = (to_light + to_eye).try_normalize().unwrap_or(surface.normal);
    diffuse_brdf(surface, to_eye.dot(middle)) + specular_brdf(surface, to_light, to_eye)
}

/// The mean of (1 − v·h)⁵ over both directions, cosine-weighted (`lib/brdf.glsl`).
const MEAN_HALF_FRESNEL: f32 = 0.003_685;

/// What a virtual point light reflects and a receiver of indirect light answers with (`lib/brdf.glsl`).
#[must_use]
pub(crate) fn indirect_diffuse_albedo(diffuse_albedo: Vec3, f0: Vec3, f90: f32) -> Vec3 {
    diffuse_albedo * (1.0 - f0.lerp(Vec3::splat(f90), MEAN_HALF_FRESNEL).max_element())
}

/// The two texels of a virtual point light: reflected flux in W, the area in m² that it stands for (`lib/vpl.glsl`).
#[must_use]
pub(crate) fn pack_vpl(position_rs: Vec3, normal: Vec3, flux: Vec3, area: f32) -> [Vec4; 2] {
    let word = pack_direction_in_float(normal);
    let length = unpack_direction_in_float_unnormalized(word).length();
    [position_rs.extend((area * FRAC_1_PI).max(1e-16)), (flux * (FRAC_1_PI / length)).extend(word)]
}

/// The reflected flux, in W, of a virtual point light's two texels: the inverse of what [`pack_vpl`] did to it.
#[must_use]
pub(crate) fn vpl_flux(vpl: [Vec4; 2]) -> Vec3 {
    vpl[1].xyz() * (PI * unpack_direction_in_float_unnormalized(vpl[1].w).length())
}

/// Irradiance in W/m² at a point from a virtual point light, a small Lambertian disc (`lib/vpl.glsl`).
#[must_use]
pub(crate) fn vpl_irradiance(vpl: [Vec4; 2], position_rs: Vec3, normal: Vec3) -> Vec3 {
    let difference = vpl[0].xyz() - position_rs;
    let squared = difference.length_squared() + 1e-20;
    let light_normal = unpack_direction_in_float_unnormalized(vpl[1].w);
    let cosines = (-light_normal.dot(difference)).max(0.0) * normal.dot(difference).max(0.0);
    vpl[1].xyz() * (cosines / (squared * (squared + vpl[0].w)))
}

/// A texel of the G-buffer's surface target: normals, albedo and roughness (`lib/surface_packing.glsl`).
///
/// Returns shading normal, geometric normal, albedo and roughness.
#[must_use]
pub(crate) fn unpack_surface(texel: UVec4) -> (Vec3, Vec3, Vec3, f32) {
    let albedo = Vec3::new(half_to_float(texel.z), half_to_float(texel.z >> 16), half_to_float(texel.w));
    (unpack_direction(texel.x), unpack_direction(texel.y), albedo, (texel.w >> 16) as f32 / 65535.0)
}

/// Narkowicz's fit of the ACES curve (`lib/tonemap.glsl`).
#[must_use]
pub(crate) fn tonemap_aces(color: Vec3) -> Vec3 {
    let x = color.min(Vec3::splat(1e4));
    (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)
}

/// Drago's display luminance over scene luminance, both in units of the adaptation luminance (`lib/tonemap.glsl`).
#[must_use]
pub(crate) fn tonemap_drago_scale(scaled_luminance: f32, scaled_maximum: f32, bias: f32) -> f32 {
    let l = scaled_luminance.max(1e-6);
    let m = scaled_maximum.max(l);
    let exponent = bias.ln() / 0.5_f32.ln();
    (l + 1.0).ln() / (2.0 + 8.0 * (l / m).powf(exponent)).ln() / (m + 1.0).log10() / l
}

/// The low 16 bits as an IEEE half; only the positive finite ones that albedos are.
fn half_to_float(bits: u32) -> f32 {
    let exponent = bits >> 10 & 0x1F;
    let mantissa = (bits & 0x3FF) as f32;
    if exponent == 0 {
        mantissa * 2.0_f32.powi(-24)
    } else {
        (1.0 + mantissa / 1024.0) * 2.0_f32.powi(exponent as i32 - 15)
    }
}
