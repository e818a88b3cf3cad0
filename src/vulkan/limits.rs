//! What programs ask of a device against what it offers. Both are plain numbers: those of the programs the build reads from their SPIR-V.

use std::collections::BTreeMap;

use ash::vk;

use super::program::{Program, StageKind, StageNeeds};

/// What a device offers, as far as programs and images ask for it.
#[derive(Clone, Debug)]
pub(crate) struct Offer {
    pub(crate) sets: u32,
    /// Of one stage.
    pub(crate) of_stage: StageNeeds,
    /// Bindings of all kinds that one stage may have.
    pub(crate) stage_resources: u32,
    pub(crate) push_bytes: u32,
    pub(crate) invocations: u32,
    pub(crate) local_size: [u32; 3],
    pub(crate) subgroup_stages: vk::ShaderStageFlags,
    pub(crate) geometry_shaders: bool,
    /// What images with optimal tiling may serve for, of each format of [`FORMATS`].
    pub(crate) formats: BTreeMap<vk::Format, vk::FormatFeatureFlags>,
}

impl Offer {
    pub(crate) fn new(
        limits: &vk::PhysicalDeviceLimits,
        vulkan11: &vk::PhysicalDeviceVulkan11Properties<'_>,
        features: &vk::PhysicalDeviceFeatures,
        formats: BTreeMap<vk::Format, vk::FormatFeatureFlags>,
    ) -> Offer {
        Offer {
            sets: limits.max_bound_descriptor_sets,
            of_stage: StageNeeds {
                sampled_images: limits.max_per_stage_descriptor_sampled_images,
                samplers: limits.max_per_stage_descriptor_samplers,
                storage_images: limits.max_per_stage_descriptor_storage_images,
                uniform_buffers: limits.max_per_stage_descriptor_uniform_buffers,
                storage_buffers: limits.max_per_stage_descriptor_storage_buffers,
                shared_bytes: limits.max_compute_shared_memory_size,
                subgroup_operations: vulkan11.subgroup_supported_operations.as_raw(),
                clip_distances: features.shader_clip_distance == vk::TRUE,
            },
            stage_resources: limits.max_per_stage_resources,
            push_bytes: limits.max_push_constants_size,
            invocations: limits.max_compute_work_group_invocations,
            local_size: limits.max_compute_work_group_size,
            subgroup_stages: vulkan11.subgroup_supported_stages,
            geometry_shaders: features.geometry_shader == vk::TRUE,
            formats,
        }
    }

    /// What a program needs and the device lacks, in words.
    pub(crate) fn lacks(&self, program: &Program) -> Vec<String> {
        let mut faults = Vec::new();
        let mut more = |asked: u32, offered: u32, what: &str| {
            if asked > offered {
                faults.push(format!("{asked} {what} ({offered} are offered)"));
            }
        };
        let sets = program.bindings.iter().map(|binding| binding.set + 1).max().unwrap_or(0);
        more(sets, self.sets, "descriptor sets");
        more(program.push_size, self.push_bytes, "bytes of push constants");
        more(program.local_size.iter().product(), self.invocations, "invocations in a group");
        for (asked, offered) in program.local_size.into_iter().zip(self.local_size) {
            more(asked, offered, "invocations along a side of a group");
        }
        for stage in program.stages {
            let (needs, offer) = (&stage.needs, &self.of_stage);
            more(needs.sampled_images, offer.sampled_images, "sampled images and texel buffers in a stage");
            more(needs.samplers, offer.samplers, "samplers in a stage");
            more(needs.storage_images, offer.storage_images, "storage images in a stage");
            more(needs.uniform_buffers, offer.uniform_buffers, "uniform buffers in a stage");
            more(needs.storage_buffers, offer.storage_buffers, "storage buffers in a stage");
            more(needs.bindings(), self.stage_resources, "resources in a stage");
            more(needs.shared_bytes, offer.shared_bytes, "bytes of memory shared by a group");
        }
        if !self.geometry_shaders && program.stages.iter().any(|stage| stage.kind == StageKind::Geometry) {
            faults.push("geometry shaders".to_owned());
        }
        if !self.of_stage.clip_distances && program.stages.iter().any(|stage| stage.needs.clip_distances) {
            faults.push("clip distances".to_owned());
        }
        for stage in program.stages {
            let asked = stage.needs.subgroup_operations;
            let absent = vk::SubgroupFeatureFlags::from_raw(asked & !self.of_stage.subgroup_operations);
            if !absent.is_empty() {
                faults.push(format!("subgroup operations ({absent:?})").to_lowercase());
            }
            if asked != 0 && !self.subgroup_stages.contains(stage.kind.flag()) {
                faults.push(format!("subgroup operations in {:?} shaders", stage.kind).to_lowercase());
            }
        }
        faults
    }

    /// What images of a format may serve for.
    pub(crate) fn of_images(&self, format: vk::Format) -> vk::FormatFeatureFlags {
        self.formats.get(&format).copied().unwrap_or_default()
    }
}

/// The formats of which more is asked than every device offers.
pub(super) const FORMATS: &[vk::Format] =
    &[vk::Format::D32_SFLOAT, vk::Format::S8_UINT, vk::Format::R32G32B32A32_SFLOAT];

#[cfg(test)]
pub(crate) mod tests {
    use super::super::program::{Binding, BindingKind, Spirv, Stage};
    use super::*;

    /// More of everything than any program asks for.
    pub(crate) fn generous() -> Offer {
        let all = FORMATS.iter().map(|format| (*format, vk::FormatFeatureFlags::from_raw(u32::MAX)));
        Offer {
            sets: 8,
            of_stage: StageNeeds {
                sampled_images: 1000,
                samplers: 1000,
                storage_images: 1000,
                uniform_buffers: 1000,
                storage_buffers: 1000,
                shared_bytes: 1 << 16,
                subgroup_operations: u32::MAX,
                clip_distances: true,
            },
            stage_resources: 1000,
            push_bytes: 256,
            invocations: 1024,
            local_size: [1024; 3],
            subgroup_stages: vk::ShaderStageFlags::ALL,
            geometry_shaders: true,
            formats: all.collect(),
        }
    }

    #[test]
    fn each_limit_is_held_against_what_a_program_asks() {
        const NEEDS: StageNeeds = StageNeeds {
            sampled_images: 17,
            samplers: 3,
            storage_images: 5,
            uniform_buffers: 13,
            storage_buffers: 6,
            shared_bytes: 20_000,
            subgroup_operations: 0b1001,
            clip_distances: true,
        };
        const STAGES: &[Stage] = &[Stage { kind: StageKind::Compute, needs: NEEDS, spirv: Spirv(&[]) }];
        const BINDINGS: &[Binding] = &[Binding { set: 2, binding: 0, kind: BindingKind::Storage, integers: false }];
        let program = Program {
            name: "test/all",
            stages: STAGES,
            bindings: BINDINGS,
            push_size: 100,
            constants: &[],
            local_size: [8, 16, 1],
        };
        assert_eq!(generous().lacks(&program), Vec::<String>::new());
        let with = |change: fn(&mut Offer)| {
            let mut offer = generous();
            change(&mut offer);
            offer.lacks(&program).join("; ")
        };
        type Case = (fn(&mut Offer), &'static str);
        let cases: [Case; 13] = [
            (|offer| offer.sets = 2, "3 descriptor sets (2 are offered)"),
            (
                |offer| offer.of_stage.sampled_images = 16,
                "17 sampled images and texel buffers in a stage (16 are offered)",
            ),
            (|offer| offer.of_stage.samplers = 2, "3 samplers in a stage (2 are offered)"),
            (|offer| offer.of_stage.storage_images = 4, "5 storage images in a stage (4 are offered)"),
            (|offer| offer.of_stage.uniform_buffers = 12, "13 uniform buffers in a stage (12 are offered)"),
            (|offer| offer.of_stage.storage_buffers = 4, "6 storage buffers in a stage (4 are offered)"),
            (|offer| offer.stage_resources = 40, "41 resources in a stage (40 are offered)"),
            (
                |offer| offer.of_stage.shared_bytes = 16_384,
                "20000 bytes of memory shared by a group (16384 are offered)",
            ),
            (|offer| offer.push_bytes = 64, "100 bytes of push constants (64 are offered)"),
            (|offer| offer.invocations = 64, "128 invocations in a group (64 are offered)"),
            (|offer| offer.local_size = [1024, 8, 1], "16 invocations along a side of a group (8 are offered)"),
            (|offer| offer.of_stage.subgroup_operations = 1, "subgroup operations (ballot)"),
            (|offer| offer.of_stage.clip_distances = false, "clip distances"),
        ];
        for (change, expected) in cases {
            assert_eq!(with(change), expected);
        }
        let elsewhere = with(|offer| offer.subgroup_stages = vk::ShaderStageFlags::FRAGMENT);
        assert_eq!(elsewhere, "subgroup operations in compute shaders");
    }

    #[test]
    fn a_device_without_geometry_shaders_lacks_programs_that_have_one() {
        const NEEDS: StageNeeds = StageNeeds {
            sampled_images: 0,
            samplers: 0,
            storage_images: 0,
            uniform_buffers: 0,
            storage_buffers: 0,
            shared_bytes: 0,
            subgroup_operations: 0,
            clip_distances: false,
        };
        const STAGES: &[Stage] = &[Stage { kind: StageKind::Geometry, needs: NEEDS, spirv: Spirv(&[]) }];
        let program = Program {
            name: "test/geometry",
            stages: STAGES,
            bindings: &[],
            push_size: 0,
            constants: &[],
            local_size: [1; 3],
        };
        assert_eq!(generous().lacks(&program), Vec::<String>::new());
        assert_eq!(Offer { geometry_shaders: false, ..generous() }.lacks(&program), ["geometry shaders"]);
    }
}
