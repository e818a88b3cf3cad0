//! Animation of node transforms: keyframes and their interpolation (glTF 2.0, 3.11 and appendix C).

use super::NodeId;
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// A named set of channels. All animations of a scene play at once.
#[derive(Clone, Debug, Default)]
pub struct Animation {
    /// Name in the file; empty if it has none.
    pub name: String,
    /// What moves.
    pub channels: Vec<Channel>,
}

impl Animation {
    /// Time of the last keyframe in seconds.
    pub fn duration(&self) -> f64 {
        self.channels
            .iter()
            .filter_map(|channel| channel.times.last())
            .fold(0.0, |longest, &time| longest.max(time.into()))
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
        let after = self.times.partition_point(|&time| f64::from(time) <= seconds);
        let last = self.times.len().checked_sub(1)?;
        let key = after.saturating_sub(1);
        if after == 0 || key == last || self.interpolation == Interpolation::Step {
            return self.value(key);
        }
        let (start, end) = (f64::from(self.times[key]), f64::from(self.times[key + 1]));
        let (length, t) = (end - start, (seconds - start) / (end - start));
        let (from, to) = (self.value(key)?, self.value(key + 1)?);
        if self.interpolation == Interpolation::CubicSpline {
            let out_tangent = self.triple(key, 2)?;
            let in_tangent = self.triple(key + 1, 0)?;
            let (t2, t3) = (t * t, t * t * t);
            return Some(std::array::from_fn(|lane| {
                (2.0 * t3 - 3.0 * t2 + 1.0) * from[lane]
                    + length * (t3 - 2.0 * t2 + t) * out_tangent[lane]
                    + (3.0 * t2 - 2.0 * t3) * to[lane]
                    + length * (t3 - t2) * in_tangent[lane]
            }));
        }
        if self.property == Property::Rotation {
            // glam takes the shortest arc.
            return Some(unit_quaternion(from).slerp(unit_quaternion(to), t).to_array());
        }
        Some(std::array::from_fn(|lane| from[lane] + (to[lane] - from[lane]) * t))
    }

    fn value(&self, key: usize) -> Option<[f64; 4]> {
        if self.interpolation == Interpolation::CubicSpline {
            self.triple(key, 1)
        } else {
            self.values.get(key).map(widen)
        }
    }

    fn triple(&self, key: usize, part: usize) -> Option<[f64; 4]> {
        self.values.get(key * 3 + part).map(widen)
    }
}

fn widen(value: &[f32; 4]) -> [f64; 4] {
    value.map(f64::from)
}
