//! Which barrier must stand before a use of a resource, given what was done to it before: a state machine without any
//! Vulkan call, tested by itself, since synchronization validation misses most hazards between dispatches.

use ash::vk::{AccessFlags2 as Access, ImageLayout, PipelineStageFlags2 as Stages};

/// What one use demands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Need {
    pub(crate) stages: Stages,
    pub(crate) access: Access,
    /// `UNDEFINED` for buffers, which have no layout.
    pub(crate) layout: ImageLayout,
    pub(crate) writes: bool,
    /// Whether the content before this use is of no interest.
    pub(crate) discards: bool,
}

/// What was last done to a buffer, or to one mip level of an image.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct State {
    layout: ImageLayout,
    /// The last write: where, and the caches it may still lie in.
    write_stages: Stages,
    write_access: Access,
    /// Uses that already see that write.
    seen: Vec<(Stages, Access)>,
    /// Reads since the write, which a later write must wait for.
    read_stages: Stages,
}

/// A dependency from earlier to later commands, with a change of layout for images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Dependency {
    pub(crate) from_stages: Stages,
    pub(crate) from_access: Access,
    pub(crate) to_stages: Stages,
    pub(crate) to_access: Access,
    pub(crate) old_layout: ImageLayout,
    pub(crate) new_layout: ImageLayout,
}

impl State {
    /// The barrier that must stand before `need`, if any; afterwards the state is that after the use.
    pub(crate) fn transition(&mut self, need: Need) -> Option<Dependency> {
        let relayout = need.layout != self.layout;
        let old_layout = if need.discards { ImageLayout::UNDEFINED } else { self.layout };
        let dependency = |from_stages, from_access| Dependency {
            from_stages,
            from_access,
            to_stages: need.stages,
            to_access: need.access,
            old_layout: if relayout { old_layout } else { self.layout },
            new_layout: need.layout,
        };
        if need.writes || relayout {
            // Everything before must be done: reads (write after read) and the write (write after write). A change of
            // layout is a write of its own.
            let from = self.write_stages | self.read_stages;
            let barrier = (relayout || from != Stages::NONE).then(|| dependency(from, self.write_access));
            *self = if need.writes {
                State {
                    layout: need.layout,
                    write_stages: need.stages,
                    write_access: need.access & WRITES,
                    ..State::default()
                }
            } else {
                // The transition made the content available, and visible to this use; others wait for its stages.
                let seen = vec![(need.stages, need.access)];
                State {
                    layout: need.layout,
                    write_stages: need.stages,
                    seen,
                    read_stages: need.stages,
                    ..State::default()
                }
            };
            return barrier;
        }
        let seen =
            self.seen.iter().any(|(stages, access)| stages.contains(need.stages) && access.contains(need.access));
        let barrier =
            (self.write_stages != Stages::NONE && !seen).then(|| dependency(self.write_stages, self.write_access));
        if barrier.is_some() {
            self.seen.push((need.stages, need.access));
        }
        self.read_stages |= need.stages;
        barrier
    }
}

const WRITES: Access = Access::from_raw(
    Access::SHADER_WRITE.as_raw()
        | Access::SHADER_STORAGE_WRITE.as_raw()
        | Access::COLOR_ATTACHMENT_WRITE.as_raw()
        | Access::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw()
        | Access::TRANSFER_WRITE.as_raw()
        | Access::HOST_WRITE.as_raw(),
);

#[cfg(test)]
mod tests {
    use super::*;

    const COMPUTE: Stages = Stages::COMPUTE_SHADER;
    const FRAGMENT: Stages = Stages::FRAGMENT_SHADER;
    const SAMPLED: ImageLayout = ImageLayout::SHADER_READ_ONLY_OPTIMAL;

    fn buffer_read(stages: Stages) -> Need {
        Need {
            stages,
            access: Access::SHADER_STORAGE_READ,
            layout: ImageLayout::UNDEFINED,
            writes: false,
            discards: false,
        }
    }

    fn buffer_write(stages: Stages) -> Need {
        Need {
            stages,
            access: Access::SHADER_STORAGE_WRITE,
            layout: ImageLayout::UNDEFINED,
            writes: true,
            discards: true,
        }
    }

    fn storage_image(stages: Stages, discards: bool) -> Need {
        let access = Access::SHADER_STORAGE_READ | Access::SHADER_STORAGE_WRITE;
        Need { stages, access, layout: ImageLayout::GENERAL, writes: true, discards }
    }

    fn sampled(stages: Stages) -> Need {
        Need { stages, access: Access::SHADER_SAMPLED_READ, layout: SAMPLED, writes: false, discards: false }
    }

    #[test]
    fn read_after_write_waits_once_per_reading_stage() {
        let mut state = State::default();
        assert_eq!(state.transition(buffer_write(COMPUTE)), None, "nothing came before");
        let first = state.transition(buffer_read(COMPUTE)).expect("read after write");
        assert_eq!((first.from_stages, first.from_access), (COMPUTE, Access::SHADER_STORAGE_WRITE));
        assert_eq!((first.to_stages, first.to_access), (COMPUTE, Access::SHADER_STORAGE_READ));
        assert_eq!(state.transition(buffer_read(COMPUTE)), None, "already visible there");
        let other = state.transition(buffer_read(FRAGMENT)).expect("not yet visible in the other stage");
        assert_eq!((other.from_stages, other.from_access), (COMPUTE, Access::SHADER_STORAGE_WRITE));
        assert_eq!(state.transition(buffer_read(FRAGMENT)), None);
    }

    #[test]
    fn a_stage_and_an_access_seen_apart_are_not_seen_together() {
        let mut state = State::default();
        state.transition(buffer_write(COMPUTE));
        state.transition(buffer_read(COMPUTE));
        state.transition(Need { access: Access::UNIFORM_READ, ..buffer_read(FRAGMENT) });
        assert!(state.transition(buffer_read(FRAGMENT)).is_some(), "storage reads are visible in compute only");
    }

    #[test]
    fn write_after_read_waits_for_all_readers() {
        let mut state = State::default();
        state.transition(buffer_write(COMPUTE));
        state.transition(buffer_read(COMPUTE));
        state.transition(buffer_read(FRAGMENT));
        let barrier = state.transition(buffer_write(COMPUTE)).expect("write after read");
        assert!(barrier.from_stages.contains(COMPUTE | FRAGMENT));
    }

    #[test]
    fn write_after_write_waits_and_makes_available() {
        let mut state = State::default();
        state.transition(buffer_write(COMPUTE));
        let barrier = state.transition(buffer_write(FRAGMENT)).expect("write after write");
        assert_eq!((barrier.from_stages, barrier.from_access), (COMPUTE, Access::SHADER_STORAGE_WRITE));
    }

    #[test]
    fn first_use_of_an_image_leaves_the_undefined_layout() {
        let mut state = State::default();
        let barrier = state.transition(storage_image(COMPUTE, true)).expect("images start undefined");
        assert_eq!((barrier.old_layout, barrier.new_layout), (ImageLayout::UNDEFINED, ImageLayout::GENERAL));
        assert_eq!(barrier.from_stages, Stages::NONE);
    }

    #[test]
    fn a_changed_layout_is_a_write_that_later_readers_wait_for() {
        let mut state = State::default();
        state.transition(storage_image(COMPUTE, true));
        let relayout = state.transition(sampled(FRAGMENT)).expect("general to sampled");
        assert_eq!((relayout.old_layout, relayout.new_layout), (ImageLayout::GENERAL, SAMPLED));
        assert_eq!((relayout.from_stages, relayout.to_stages), (COMPUTE, FRAGMENT));
        assert!(relayout.from_access.contains(Access::SHADER_STORAGE_WRITE));
        assert_eq!(state.transition(sampled(FRAGMENT)), None);
        let chained = state.transition(sampled(COMPUTE)).expect("must come after the transition");
        assert_eq!((chained.from_stages, chained.to_stages), (FRAGMENT, COMPUTE));
        assert_eq!((chained.old_layout, chained.new_layout), (SAMPLED, SAMPLED));
    }

    #[test]
    fn discarded_content_is_not_preserved_but_still_waited_for() {
        let mut state = State::default();
        state.transition(storage_image(COMPUTE, true));
        state.transition(sampled(FRAGMENT));
        let barrier = state.transition(storage_image(COMPUTE, true)).expect("write after read");
        assert_eq!(barrier.old_layout, ImageLayout::UNDEFINED);
        assert_eq!(barrier.from_stages, FRAGMENT);
        state.transition(sampled(FRAGMENT));
        let kept = state.transition(storage_image(COMPUTE, false)).expect("write after read");
        assert_eq!(kept.old_layout, SAMPLED);
    }

    #[test]
    fn repeated_storage_writes_in_one_layout_keep_it() {
        let mut state = State::default();
        state.transition(storage_image(COMPUTE, false));
        let barrier = state.transition(storage_image(COMPUTE, false)).expect("write after write");
        assert_eq!((barrier.old_layout, barrier.new_layout), (ImageLayout::GENERAL, ImageLayout::GENERAL));
    }

    /// Whatever the order of uses, a read is never reachable from the last write without a chain of barriers.
    #[test]
    fn random_sequences_leave_no_hazard() {
        use rand_pcg::rand_core::Rng;
        let mut random = rand_pcg::Pcg32::new(7, 11);
        let stages = [COMPUTE, FRAGMENT, Stages::VERTEX_SHADER];
        for _ in 0..2000 {
            let mut state = State::default();
            // Per stage: whether the last write is visible to storage reads; and whether the next write is ordered.
            let (mut last_write, mut visible, mut unordered) = (None::<Stages>, Stages::NONE, Stages::NONE);
            for _ in 0..12 {
                let stage = stages[random.next_u32() as usize % 3];
                let write = random.next_u32().is_multiple_of(3);
                let barrier = state.transition(if write { buffer_write(stage) } else { buffer_read(stage) });
                if write {
                    let waits = barrier.map_or(Stages::NONE, |barrier| barrier.from_stages);
                    assert!(waits.contains(unordered), "a write overtakes an earlier use");
                    (last_write, visible, unordered) = (Some(stage), Stages::NONE, stage);
                } else {
                    if let Some(barrier) = barrier {
                        assert!(last_write.is_some_and(|write| barrier.from_stages.contains(write)));
                        visible |= barrier.to_stages;
                    }
                    assert!(last_write.is_none() || visible.contains(stage), "a read does not see the last write");
                    unordered |= stage;
                }
            }
        }
    }
}
