//! What a stage asks of a device besides bindings: memory that a work group shares, operations over subgroups, clipping by distances of its own.

use std::collections::BTreeMap;

use spirv::{Capability, Op, StorageClass};

use super::words::instructions;

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct StageNeeds {
    pub(crate) shared_bytes: u32,
    /// As Vulkan's `VkSubgroupFeatureFlags` count them.
    pub(crate) subgroup_operations: u32,
    pub(crate) clip_distances: bool,
}

/// Capabilities of SPIR-V, and the bit of the operations that they stand for.
const OPERATIONS: [(Capability, u32); 8] = [
    (Capability::GroupNonUniform, 1),
    (Capability::GroupNonUniformVote, 1 << 1),
    (Capability::GroupNonUniformArithmetic, 1 << 2),
    (Capability::GroupNonUniformBallot, 1 << 3),
    (Capability::GroupNonUniformShuffle, 1 << 4),
    (Capability::GroupNonUniformShuffleRelative, 1 << 5),
    (Capability::GroupNonUniformClustered, 1 << 6),
    (Capability::GroupNonUniformQuad, 1 << 7),
];

/// Reads one stage.
///
/// # Errors
/// SPIR-V that is cut short.
pub(crate) fn needs(words: &[u32]) -> Result<StageNeeds, String> {
    let mut sizes: BTreeMap<u32, u32> = BTreeMap::new();
    let mut pointees: BTreeMap<u32, u32> = BTreeMap::new();
    let mut constants: BTreeMap<u32, u32> = BTreeMap::new();
    let mut found = StageNeeds::default();
    for (op, operands) in instructions(words)? {
        let size = |id: u32| sizes.get(&id).copied();
        match op {
            Op::Capability => {
                let known = OPERATIONS.iter().find(|(capability, _)| *capability as u32 == operands[0]);
                found.subgroup_operations |= known.map_or(0, |(_, bit)| *bit);
                found.clip_distances |= operands[0] == Capability::ClipDistance as u32;
            }
            Op::Constant | Op::SpecConstant => drop(constants.insert(operands[1], operands[2])),
            Op::TypeBool => drop(sizes.insert(operands[0], 4)),
            Op::TypeInt | Op::TypeFloat => drop(sizes.insert(operands[0], operands[1] / 8)),
            Op::TypeVector | Op::TypeMatrix => {
                sizes.extend(size(operands[1]).map(|each| (operands[0], each * operands[2])));
            }
            Op::TypeArray => {
                let whole = size(operands[1]).zip(constants.get(&operands[2])).map(|(each, count)| each * count);
                sizes.extend(whole.map(|whole| (operands[0], whole)));
            }
            Op::TypeStruct => {
                let whole = operands[1..].iter().map(|member| size(*member)).sum::<Option<u32>>();
                sizes.extend(whole.map(|whole| (operands[0], whole)));
            }
            Op::TypePointer => drop(pointees.insert(operands[0], operands[2])),
            Op::Variable if operands[2] == StorageClass::Workgroup as u32 => {
                let bytes = pointees.get(&operands[0]).and_then(|pointee| size(*pointee));
                // A size that specialisation works out counts for nothing.
                found.shared_bytes += bytes.unwrap_or(0);
            }
            _ => {}
        }
    }
    Ok(found)
}
