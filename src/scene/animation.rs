//! Animation of node transforms and of lights: keyframes and their interpolation (glTF 2.0, 3.11 and appendix C; KHR_animation_pointer).

use super::{LightId, NodeId};
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// A named set of channels. All animations of a scene play at once.
#[derive(Clone, Debug, Default)]
pub struct Animation {
    /// Name in the file; empty if it has none.
    pub name: String,
    /// What moves.
    pub channels: Vec<Channel>,
    /// Lights that change.
    pub lights: Vec<LightChannel>,
}

impl Animation {
    /// Time of the last keyframe in seconds.
    pub fn duration(&self) -> f64 {
        let moved = self.channels.iter().filter_map(|channel| channel.times.last());
        let changed = self.lights.iter().filter_map(|channel| channel.times.last());
        moved.chain(changed).fold(0.0, |longest, &time| longest.max(time.into()))
    }
}

/// Keyframes of how strong a punctual light is.
#[derive(Clone, Debug)]
pub struct LightChannel {
    /// The light that changes.
    pub light: LightId,
    /// Its colour: what the values are multiplied by. Linear RGB, finite, at least 0.
    pub color: [f32; 3],
    /// How to get from one keyframe to the next.
    pub interpolation: Interpolation,
    /// Seconds, finite, strictly growing, at least one.
    pub times: Vec<f32>,
    /// One value a keyframe, W/sr or W/m², all finite; for cubic splines three: in-tangent, value, out-tangent. Below 0 counts as 0.
    pub values: Vec<f32>,
}

impl LightChannel {
    /// The light's intensity at a time. `None` without keyframes.
    pub(super) fn intensity(&self, seconds: f64) -> Option<[f32; 3]> {
        let value = |index: usize| self.values.get(index).map(|value| [f64::from(*value), 0.0, 0.0, 0.0]);
        let [strength, ..] = sample(&self.times, self.interpolation, false, value, seconds)?;
        Some(self.color.map(|channel| (f64::from(channel) * strength.max(0.0)) as f32))
    }
}

/// Keyframes of one property of one node.
#[derive(Clone, Debug)]
pub struct Channel {
    /// The node that moves.
    pub node: NodeId,
    /// The part of its transform that moves.
    pub property: Property,
    /// How to get from one keyframe to the next.
    pub interpolation: Interpolation,
    /// Seconds, finite, strictly growing, at least one.
    pub times: Vec<f32>,
    /// One value a keyframe (`[x, y, z, _]`, or a quaternion `[x, y, z, w]`), all finite; for cubic splines three: in-tangent,
    /// value, out-tangent.
    pub values: Vec<[f32; 4]>,
}

/// A part of a node's transform.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Property {
    /// Metres in the parent's space.
    Translation,
    /// A unit quaternion.
    Rotation,
    /// Factors along the node's axes.
    Scale,
}

/// How values between keyframes are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Interpolation {
    /// Straight, or along the shortest arc for rotations.
    Linear,
    /// The earlier keyframe's value.
    Step,
    /// Cubic Hermite spline.
    CubicSpline,
}

/// A transform in the three parts that animations move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub(super) translation: DVec3,
    pub(super) rotation: DQuat,
    pub(super) scale: DVec3,
}

impl Pose {
    /// The parts of a transform. Shear is lost: glTF forbids animating nodes that have any.
    pub(super) fn of(transform: &DAffine3) -> Self {
        let matrix = transform.matrix3;
        let (scale, rotation, translation) = if matrix.determinant() == 0.0 {
            (
                DVec3::new(matrix.x_axis.length(), matrix.y_axis.length(), matrix.z_axis.length()),
                DQuat::IDENTITY,
                transform.translation,
            )
        } else {
            transform.to_scale_rotation_translation()
        };
        Pose { translation, rotation, scale }
    }

    pub(super) fn transform(&self) -> DAffine3 {
        DAffine3 {
            matrix3: DMat3::from_quat(self.rotation) * DMat3::from_diagonal(self.scale),
            translation: self.translation,
        }
    }

    pub(super) fn apply(&mut self, channel: &Channel, seconds: f64) {
        let Some(value) = channel.sample(seconds) else {
            return;
        };
        let vector = DVec3::new(value[0], value[1], value[2]);
        match channel.property {
            Property::Translation => self.translation = vector,
            Property::Scale => self.scale = vector,
            Property::Rotation => self.rotation = unit_quaternion(value),
        }
    }
}

/// The nearest rotation; the identity if there is none.
pub(super) fn unit_quaternion(value: [f64; 4]) -> DQuat {
    let quaternion = DQuat::from_array(value);
    if quaternion.length_squared().is_normal() { quaternion.normalize() } else { DQuat::IDENTITY }
}

impl Channel {
    /// The value at a time; before the first and after the last keyframe, theirs. `None` without keyframes.
    fn sample(&self, seconds: f64) -> Option<[f64; 4]> {
        let value = |index: usize| self.values.get(index).map(|value| value.map(f64::from));
        sample(&self.times, self.interpolation, self.property == Property::Rotation, value, seconds)
    }
}

/// The value at a time between keyframes, whose `values` are those of glTF's accessors; before the first and after the last keyframe, theirs.
fn sample(
    times: &[f32],
    interpolation: Interpolation,
    rotates: bool,
    values: impl Fn(usize) -> Option<[f64; 4]>,
    seconds: f64,
) -> Option<[f64; 4]> {
    let triple = |key: usize, part: usize| values(key * 3 + part);
    let value = |key: usize| if interpolation == Interpolation::CubicSpline { triple(key, 1) } else { values(key) };
    let after = times.partition_point(|&time| f64::from(time) <= seconds);
    let last = times.len().checked_sub(1)?;
    let key = after.saturating_sub(1);
    if after == 0 || key == last || interpolation == Interpolation::Step {
        return value(key);
    }
    let (start, end) = (f64::from(times[key]), f64::from(times[key + 1]));
    let (length, t) = (end - start, (seconds - start) / (end - start));
    let (from, to) = (value(key)?, value(key + 1)?);
    if interpolation == Interpolation::CubicSpline {
        let (out_tangent, in_tangent) = (triple(key, 2)?, triple(key + 1, 0)?);
        return Some(std::array::from_fn(|lane| {
            hermite([from[lane], to[lane]], [length * out_tangent[lane], length * in_tangent[lane]], t)
        }));
    }
    if rotates {
        // glam takes the shortest arc.
        return Some(unit_quaternion(from).slerp(unit_quaternion(to), t).to_array());
    }
    Some(std::array::from_fn(|lane| from[lane] + (to[lane] - from[lane]) * t))
}

/// The cubic from one end to the other that has these slopes there; `t` from 0 to 1.
pub(super) fn hermite([from, to]: [f64; 2], [out_slope, in_slope]: [f64; 2], t: f64) -> f64 {
    let (t2, t3) = (t * t, t * t * t);
    (2.0 * t3 - 3.0 * t2 + 1.0) * from
        + (t3 - 2.0 * t2 + t) * out_slope
        + (3.0 * t2 - 2.0 * t3) * to
        + (t3 - t2) * in_slope
}
