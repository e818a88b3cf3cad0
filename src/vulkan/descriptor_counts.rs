//! How much a descriptor pool must hold: what the programs of a recording bind.

use std::collections::BTreeMap;

use ash::vk;

use super::program::Program;

/// How many descriptors sets hold, kind by kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct DescriptorCounts {
    sets: u32,
    of_kinds: BTreeMap<vk::DescriptorType, u32>,
}

impl DescriptorCounts {
    fn add(&mut self, program: &Program) {
        // What materials bind for their draws has a pool of its own.
        let own = || program.bindings.iter().filter(|binding| binding.set == 0);
        self.sets += u32::from(own().next().is_some());
        for binding in own() {
            *self.of_kinds.entry(binding.kind.descriptor_type()).or_default() += 1;
        }
    }

    pub(super) fn sets(&self) -> u32 {
        self.sets
    }

    pub(super) fn holds(&self, wanted: &DescriptorCounts) -> bool {
        let held = |kind| self.of_kinds.get(kind).copied().unwrap_or(0);
        self.sets >= wanted.sets && wanted.of_kinds.iter().all(|(kind, count)| held(kind) >= *count)
    }

    /// Room for what is held and what is wanted, and some more, so that not every larger frame needs a pool of its own.
    pub(super) fn grown_to(mut self, wanted: &DescriptorCounts) -> DescriptorCounts {
        let grown = |held: u32, wanted: u32| if wanted > held { wanted + wanted / 4 } else { held };
        self.sets = grown(self.sets, wanted.sets);
        for (kind, count) in &wanted.of_kinds {
            let held = self.of_kinds.entry(*kind).or_default();
            *held = grown(*held, *count);
        }
        self
    }

    /// `texels_in_storage`: lists that shaders read as texels are storage buffers (traits.rs).
    pub(super) fn pool_sizes(&self, texels_in_storage: bool) -> Vec<vk::DescriptorPoolSize> {
        let size = |(kind, count): (&vk::DescriptorType, &u32)| {
            let moved = texels_in_storage && *kind == vk::DescriptorType::UNIFORM_TEXEL_BUFFER;
            let ty = if moved { vk::DescriptorType::STORAGE_BUFFER } else { *kind };
            vk::DescriptorPoolSize { ty, descriptor_count: *count }
        };
        self.of_kinds.iter().map(size).collect()
    }
}

impl FromIterator<&'static Program> for DescriptorCounts {
    fn from_iter<T: IntoIterator<Item = &'static Program>>(programs: T) -> DescriptorCounts {
        programs.into_iter().fold(DescriptorCounts::default(), |mut counts, program| {
            counts.add(program);
            counts
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::program::{Binding, BindingKind};
    use super::*;

    const TEXELS: Binding = Binding { set: 0, binding: 0, kind: BindingKind::TexelBuffer, integers: false };

    fn program(bindings: &'static [Binding]) -> &'static Program {
        Box::leak(Box::new(Program {
            name: "test",
            stages: &[],
            bindings,
            push_size: 0,
            constants: &[],
            local_size: [1; 3],
        }))
    }

    #[test]
    fn pools_hold_what_programs_bind() {
        // Far more texel buffers a set than any fixed share would be.
        const OWN: &[Binding] = &[TEXELS; 16];
        const MATERIALS: &[Binding] = &[Binding { set: 1, ..TEXELS }];
        let wanted: DescriptorCounts = [program(OWN), program(OWN), program(MATERIALS)].into_iter().collect();
        assert_eq!((wanted.sets(), wanted.of_kinds[&vk::DescriptorType::UNIFORM_TEXEL_BUFFER]), (2, 32));
        let pool = DescriptorCounts::default().grown_to(&wanted);
        assert!(pool.holds(&wanted) && !DescriptorCounts::default().holds(&wanted));
        let sizes = pool.pool_sizes(false);
        assert_eq!(sizes.len(), 1, "a pool has no size of zero");
        assert!(sizes[0].descriptor_count >= 32);
        assert_eq!(pool.pool_sizes(true)[0].ty, vk::DescriptorType::STORAGE_BUFFER);
        // As many sets, but of another kind.
        let other: DescriptorCounts =
            [program(const { &[Binding { kind: BindingKind::Storage, ..TEXELS }] })].into_iter().collect();
        assert!(!pool.holds(&other) && pool.clone().grown_to(&other).holds(&other));
        assert!(pool.clone().grown_to(&other).holds(&wanted));
    }
}
