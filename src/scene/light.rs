//! Punctual lights, and the short notation in which a command line adds them.

use super::{LightId, NodeId};
use glam::DVec3;
use std::f32::consts::FRAC_PI_2;
use std::f64::consts::PI;

/// A light without area. It shines along the local -Z of the node that places it.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Name in the file; empty if it has none.
    pub name: String,
    /// Shape of the light.
    pub kind: LightKind,
    /// Linear RGB, at least 0: W/sr for points and spots (on the axis), W/m² across the light's direction for directional ones.
    pub intensity: [f32; 3],
    /// Distance in metres beyond which the file says the light may be ignored. A hint: physically light goes on.
    pub range: Option<f32>,
}

impl Light {
    /// Says which number is out of range, if any is.
    pub(super) fn fault(&self) -> Option<String> {
        if !self.intensity.iter().all(|channel| channel.is_finite() && *channel >= 0.0) {
            return Some("its intensity is negative or not finite".into());
        }
        match self.kind {
            LightKind::Spot { inner_angle, outer_angle }
                if !(inner_angle >= 0.0
                    && inner_angle <= outer_angle
                    && outer_angle > 0.0
                    && outer_angle <= FRAC_PI_2) =>
            {
                Some(format!(
                    "its half angles {inner_angle} and {outer_angle} rad are not 0 ≤ inner ≤ outer ≤ π/2, outer above 0"
                ))
            }
            _ => None,
        }
    }
}

/// Shape of a light without area.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LightKind {
    /// Shines alike in all directions.
    Point,
    /// Full intensity within `inner_angle`, none outside `outer_angle`; between them glTF's smooth falloff,
    /// `clamp((cos θ − cos outer)/(cos inner − cos outer), 0, 1)²`.
    Spot {
        /// Half angle in radians, 0 to `outer_angle`.
        inner_angle: f32,
        /// Half angle in radians, above 0 to π/2.
        outer_angle: f32,
    },
    /// Parallel rays from infinitely far away.
    Directional,
}

/// A light in world space.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedLight {
    /// The node that places it.
    pub node: NodeId,
    /// The light.
    pub light: LightId,
    /// Where it is; without meaning for directional lights.
    pub position: DVec3,
    /// Unit vector along which the light travels on its axis; without meaning for point lights.
    pub direction: DVec3,
    /// Shape.
    pub kind: LightKind,
    /// As [`Light::intensity`].
    pub intensity: [f32; 3],
    /// As [`Light::range`].
    pub range: Option<f32>,
}

/// A light written on a command line, with its place in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct LightSpec {
    /// The light, named after its notation.
    pub light: Light,
    /// Where it stands; the origin for a sun.
    pub position: DVec3,
    /// Unit vector along which its light travels; -Y for a point light.
    pub direction: DVec3,
}

impl LightSpec {
    /// Reads one of
    /// - `sun:AZIMUTH,ELEVATION[,W/m²]`: where the sun stands, in degrees: azimuth clockwise from north (-Z; east is +X),
    ///   elevation above the horizon. Without a strength it is π W/m², which gives a white matt surface facing it radiance 1.
    /// - `point:X,Y,Z,W/sr`
    /// - `spot:X,Y,Z,DX,DY,DZ,ANGLE,W/sr`: direction in which it shines, and its half angle in degrees, at most 90. The falloff
    ///   starts at nine tenths of the angle.
    ///
    /// The strength is one number for all channels or `R:G:B`.
    ///
    /// # Errors
    /// A sentence on what cannot be read and what belongs there.
    pub fn parse(spec: &str) -> Result<LightSpec, String> {
        let (kind, values) = spec.split_once(':').unwrap_or((spec, ""));
        let fields: Vec<&str> = values.split(',').map(str::trim).collect();
        let form = match kind {
            "sun" => "sun:AZIMUTH,ELEVATION[,W/m²]",
            "point" => "point:X,Y,Z,W/sr",
            "spot" => "spot:X,Y,Z,DX,DY,DZ,ANGLE,W/sr",
            _ => {
                return Err(format!("the light {spec:?} is of no known kind; write sun:…, point:… or spot:…"));
            }
        };
        let wrong = |what: &str| format!("the light {spec:?} {what}; write {form}");
        let number = |index: usize| {
            let value = fields[index].parse().ok().filter(|value: &f64| value.is_finite());
            value.ok_or_else(|| wrong(&format!("has {:?} where a number belongs", fields[index])))
        };
        let vector = |index: usize| Ok::<_, String>(DVec3::new(number(index)?, number(index + 1)?, number(index + 2)?));
        let strength = |index: usize| {
            let strength = parse_rgb(fields[index], ':');
            strength.ok_or_else(|| {
                wrong(&format!("has {:?} where a strength of at least 0, or R:G:B, belongs", fields[index]))
            })
        };
        let (kind, position, direction, intensity) = match (kind, fields.len()) {
            ("sun", 2 | 3) => {
                let (azimuth, elevation) = (number(0)?.to_radians(), number(1)?.to_radians());
                let to_sun =
                    DVec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), -azimuth.cos() * elevation.cos());
                let irradiance = if fields.len() == 3 { strength(2)? } else { [PI as f32; 3] };
                (LightKind::Directional, DVec3::ZERO, -to_sun, irradiance)
            }
            ("point", 4) => (LightKind::Point, vector(0)?, DVec3::NEG_Y, strength(3)?),
            ("spot", 8) => {
                let direction = vector(3)?.try_normalize().ok_or_else(|| wrong("shines in the direction 0,0,0"))?;
                let degrees = number(6)?;
                if !(degrees > 0.0 && degrees <= 90.0) {
                    return Err(wrong(&format!("has a half angle of {degrees}°, not above 0 and at most 90")));
                }
                let outer_angle = (degrees.to_radians() as f32).min(FRAC_PI_2);
                let kind = LightKind::Spot { inner_angle: 0.9 * outer_angle, outer_angle };
                (kind, vector(0)?, direction, strength(7)?)
            }
            (_, count) => return Err(wrong(&format!("has {count} values"))),
        };
        let light = Light { name: spec.to_owned(), kind, intensity, range: None };
        Ok(LightSpec { light, position, direction })
    }
}

/// Reads a sky's radiance `R,G,B`, or one number for all channels, in W/(m² sr), each at least 0.
///
/// # Errors
/// A sentence on what belongs there.
pub fn parse_sky(spec: &str) -> Result<[f32; 3], String> {
    parse_rgb(spec, ',')
        .ok_or_else(|| format!("the sky {spec:?} is not a radiance; write R,G,B, each a number of at least 0"))
}

fn parse_rgb(text: &str, separator: char) -> Option<[f32; 3]> {
    let channels: Option<Vec<f32>> = text
        .split(separator)
        .map(|channel| channel.trim().parse().ok().filter(|value: &f32| value.is_finite() && *value >= 0.0))
        .collect();
    match channels?[..] {
        [grey] => Some([grey; 3]),
        [r, g, b] => Some([r, g, b]),
        _ => None,
    }
}
