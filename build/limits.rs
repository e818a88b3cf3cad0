//! What a program may bind: no more than every device with Vulkan 1.3 offers, but for the listed exceptions.

use std::collections::BTreeSet;

use super::generate::{CompiledStage, Program};
use super::reflect::{BindingKind, Stage};

/// Programs that need more than every device offers, and why.
pub(crate) const EXCEPTIONS: &[Exception] = &[
    storage_buffers("particle/emit", 5, "a path's state, in arrays of its own types, and the queue that it joins"),
    Exception {
        program: "path/light",
        limit: Limit::SampledImages,
        count: 17,
        reason: "a path's state, and of a point on an emitter radiance and alpha: its textures, texture coordinates, vertex colours",
    },
    storage_buffers("path/generate", 5, "a path's state, in arrays of its own types, and the queue that it joins"),
    storage_buffers(
        "particles/links",
        6,
        "both kinds of links and what they bring of light, and by which particles their ends are found",
    ),
    storage_buffers(
        "photon_splat/project",
        5,
        "discs, their places in cells, and what cells and grid sum up by atomics",
    ),
    storage_buffers(
        "photons/land",
        7,
        "a photon may both land and go on, and each of the two leaves a record, a beam and a count",
    ),
    storage_buffers("photons/land_traced", 7, "as photons/land"),
    storage_buffers("selftest/texel_layouts", 6, "a test that reads every list both as a struct and as texels"),
];

const fn storage_buffers(program: &'static str, count: usize, reason: &'static str) -> Exception {
    Exception { program, limit: Limit::StorageBuffers, count, reason }
}

/// A program that binds more of a kind than every device offers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exception {
    /// `piece/pass`.
    pub(crate) program: &'static str,
    pub(crate) limit: Limit,
    /// As many as it binds: another number fails the build, as does a program that is within the limit.
    pub(crate) count: usize,
    #[allow(dead_code, reason = "for those who read the list")]
    pub(crate) reason: &'static str,
}

/// What is counted: of a program descriptor sets, of each stage the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Limit {
    /// Devices bind four; GPU-assisted validation takes one.
    Sets,
    /// Texel buffers count among them.
    SampledImages,
    StorageImages,
    UniformBuffers,
    StorageBuffers,
}

impl Limit {
    const ALL: [Limit; 5] =
        [Limit::Sets, Limit::SampledImages, Limit::StorageImages, Limit::UniformBuffers, Limit::StorageBuffers];

    /// What every device offers, and what Vulkan calls that.
    fn most(self) -> (usize, &'static str) {
        match self {
            Limit::Sets => (3, "maxBoundDescriptorSets is 4, one of which validation takes"),
            Limit::SampledImages => (16, "maxPerStageDescriptorSampledImages"),
            Limit::StorageImages => (4, "maxPerStageDescriptorStorageImages"),
            Limit::UniformBuffers => (12, "maxPerStageDescriptorUniformBuffers"),
            Limit::StorageBuffers => (4, "maxPerStageDescriptorStorageBuffers"),
        }
    }

    fn what(self) -> &'static str {
        match self {
            Limit::Sets => "descriptor sets",
            Limit::SampledImages => "sampled images and texel buffers",
            Limit::StorageImages => "storage images",
            Limit::UniformBuffers => "uniform buffers",
            Limit::StorageBuffers => "storage buffers",
        }
    }

    fn counts(self, kind: &BindingKind) -> bool {
        match kind {
            BindingKind::SampledImage(_) | BindingKind::TexelBuffer => self == Limit::SampledImages,
            BindingKind::StorageImage { .. } => self == Limit::StorageImages,
            BindingKind::Uniform(_) => self == Limit::UniformBuffers,
            BindingKind::Storage { .. } => self == Limit::StorageBuffers,
        }
    }

    fn count(self, stages: &[CompiledStage]) -> usize {
        let of_stage = |stage: &Stage| stage.bindings.iter().filter(|binding| self.counts(&binding.kind)).count();
        match self {
            Limit::Sets => {
                let sets = stages.iter().flat_map(|stage| &stage.stage.bindings).map(|binding| binding.set);
                // Those below the highest are bound too.
                sets.collect::<BTreeSet<u32>>().last().map_or(0, |highest| *highest as usize + 1)
            }
            _ => stages.iter().map(|stage| of_stage(&stage.stage)).max().unwrap_or(0),
        }
    }
}

/// Checks all programs.
///
/// # Errors
/// Says which programs bind how many of what, and which exceptions are none, a line each.
pub(crate) fn check(programs: &[Program], exceptions: &[Exception]) -> Result<(), String> {
    let mut faults = Vec::new();
    for program in programs {
        let name = format!("{}/{}", program.piece, program.pass);
        for limit in Limit::ALL {
            let listed = exceptions.iter().find(|it| it.program == name && it.limit == limit).map(|it| it.count);
            let (count, (most, why), what) = (limit.count(&program.stages), limit.most(), limit.what());
            faults.extend(match listed {
                None if count > most => Some(format!(
                    "glsl/{name} binds {count} {what}; not every device offers more than {most} ({why}). An exception needs \
                     a reason in build/limits.rs"
                )),
                Some(_) if count <= most => Some(format!(
                    "glsl/{name} binds {count} {what}, which every device offers: build/limits.rs lists it for nothing"
                )),
                Some(listed) if count != listed => {
                    Some(format!("glsl/{name} binds {count} {what}; build/limits.rs lists {listed}"))
                }
                _ => None,
            });
        }
    }
    let exists = |it: &&Exception| programs.iter().any(|known| format!("{}/{}", known.piece, known.pass) == it.program);
    let gone = exceptions.iter().filter(|it| !exists(it));
    faults.extend(gone.map(|it| format!("build/limits.rs lists glsl/{}, which does not exist", it.program)));
    if faults.is_empty() { Ok(()) } else { Err(faults.join("\n")) }
}
