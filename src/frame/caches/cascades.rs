//! How large the cells of the cascades are (glsl/caches/cascades.glsl).

use glam::DVec3;

use crate::shaders::types;

/// What is asked of the cascades.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CascadeRule {
    pub(crate) count: u32,
    /// Nodes along an edge of each.
    pub(crate) resolution: u32,
    /// Of the finest, metres; 0: from the scene.
    pub(crate) cell: f64,
}

impl CascadeRule {
    /// The cascades around an eye, such that the last one's boundary holds all within `reach` of `middle`. A cell that nobody chose is so large that it does from anywhere
    /// within `radius`. Where that is not enough, all cells are doubled until it is: a cell does not change while the camera moves nearby.
    pub(crate) fn around(&self, eye: DVec3, middle: DVec3, radius: f64, reach: f64) -> types::Cascades {
        let half_width = f64::from(self.resolution / 2 - 1) * f64::from(1_u32 << (self.count - 1));
        let chosen = if self.cell > 0.0 { self.cell } else { 2.0 * radius / half_width };
        let mut cell = chosen.max(f64::from(f32::MIN_POSITIVE));
        let farthest = eye.distance(middle) + reach;
        while cell * half_width < farthest {
            cell *= 2.0;
        }
        types::Cascades {
            anchor_rs: middle.as_vec3().to_array(),
            cell: cell as f32,
            eye: (eye - middle).as_vec3().to_array(),
            resolution: self.resolution.cast_signed(),
            count: self.count.cast_signed(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_cascade_holds_the_scene_from_wherever_it_is_seen() {
        let rule = CascadeRule { count: 4, resolution: 32, cell: 0.0 };
        let cell = |eye: f64| f64::from(rule.around(DVec3::X * eye, DVec3::ZERO, 1.0, 1.0).cell);
        assert_eq!(cell(0.0), cell(0.99), "it stands while the camera is within the scene");
        for eye in [0.0, 0.5, 1.5, 10.0, 1e6] {
            assert!(cell(eye) * 15.0 * 8.0 >= (eye + 1.0) * (1.0 - 1e-6), "from {eye} m");
            assert!(cell(eye) <= cell(0.0) || cell(eye) * 15.0 * 4.0 < eye + 1.0, "no larger than needed");
        }
        assert_eq!(f64::from(CascadeRule { cell: 0.25, ..rule }.around(DVec3::ZERO, DVec3::ZERO, 1.0, 1.0).cell), 0.25);
    }
}
