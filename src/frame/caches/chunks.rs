//! How many groups of lights one pass takes: on some devices the steps that loops of an invocation may take are bounded.

use super::lights::AreaLights;
use super::settings::CacheSight;

/// Invocations of a work group that is one map's, one cache's or one sample's of the surfaces.
pub(crate) const LANES: u32 = 64;
/// Steps of their loops for a ray to a group, and of a cone over voxels along one axis at most.
const RAY_STEPS: u32 = 341;
const CONE_STEPS: u32 = 3;

/// Some groups of lights, which one pass takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Chunk {
    number: u32,
    pub(crate) first_group: i32,
    pub(crate) end_group: i32,
}

impl Chunk {
    /// Of the pass that takes it: the first one's is `name`.
    pub(crate) fn name(&self, name: &str) -> String {
        if self.number == 0 { name.to_owned() } else { format!("{name}-{}", self.number + 1) }
    }
}

impl AreaLights {
    /// All groups, in one chunk at least. `steps`: of loops, for each group besides its visibility; `lanes`: invocations that share the groups, of which each may take `loop_steps`.
    pub(crate) fn chunks(
        &self,
        sight: CacheSight,
        steps: u32,
        (lanes, loop_steps): (u32, u32),
    ) -> impl Iterator<Item = Chunk> {
        let count = self.group_count;
        let most = groups_at_once(sight, steps, (lanes, loop_steps));
        (0..).zip((0..count.max(1)).step_by(most as usize)).map(move |(number, first)| {
            let end = first.saturating_add(most).min(count);
            Chunk { number, first_group: first.cast_signed(), end_group: end.cast_signed() }
        })
    }
}

impl CacheSight {
    /// Of loops, for what a cache sees of a group.
    pub(crate) fn steps(self) -> u32 {
        match self {
            CacheSight::Open => 0,
            CacheSight::Rays => RAY_STEPS,
            CacheSight::Cones(voxels) => CONE_STEPS * voxels.resolution,
        }
    }
}

fn groups_at_once(sight: CacheSight, steps: u32, (lanes, loop_steps): (u32, u32)) -> u32 {
    let of_group = steps + sight.steps();
    lanes.saturating_mul((loop_steps.saturating_add(1) / of_group).max(1)).min(i32::MAX.cast_unsigned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loops_stay_within_their_bound() {
        let most = groups_at_once(CacheSight::Rays, 8, (LANES, 32768));
        assert_eq!(most, 64 * 93);
        assert!(most / LANES * (8 + RAY_STEPS) <= 32768);
        assert_eq!(groups_at_once(CacheSight::Rays, 8, (8, 32768)), 8 * 93, "as long loops of fewer");
        assert_eq!(groups_at_once(CacheSight::Rays, 20_000, (LANES, 1000)), LANES, "one for each lane at least");
        assert_eq!(groups_at_once(CacheSight::Open, 1, (LANES, u32::MAX)), i32::MAX.cast_unsigned());
    }
}
