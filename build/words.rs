//! The words of SPIR-V: what an entry point statically uses, and a module without what it does not.
//!
//! Nothing here relies on an optimiser: a variable or specialisation constant is used if an instruction of a function that the entry point
//! calls, directly or not, names it.

use std::collections::{BTreeMap, BTreeSet};

use spirv::{Op, StorageClass};

/// Words before the first instruction.
const HEADER: usize = 5;

/// The instructions with their operands, in order.
pub(crate) fn instructions(words: &[u32]) -> Result<Vec<(Op, &[u32])>, String> {
    let mut found = Vec::new();
    let mut at = HEADER;
    while at < words.len() {
        let count = (words[at] >> 16) as usize;
        let Some(op) = Op::from_u32(words[at] & 0xffff) else {
            return Err("it holds an unknown instruction".to_owned());
        };
        if count == 0 || at + count > words.len() {
            return Err("its SPIR-V is cut short".to_owned());
        }
        found.push((op, &words[at + 1..at + count]));
        at += count;
    }
    Ok(found)
}

/// All ids that the entry points' functions name, and what these are made of.
pub(crate) fn static_use(words: &[u32]) -> Result<BTreeSet<u32>, String> {
    let mut bodies: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    let mut made_of: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    let mut waiting = Vec::new();
    let mut function = None;
    for (op, operands) in instructions(words)? {
        match (op, function) {
            (Op::EntryPoint, _) => waiting.push(operands[1]),
            // The size of the work group.
            (Op::ExecutionModeId, _) => waiting.extend(&operands[2..]),
            (Op::Function, _) => {
                function = Some(operands[1]);
                bodies.insert(operands[1], Vec::new());
            }
            (Op::FunctionEnd, _) => function = None,
            (_, Some(id)) => bodies.entry(id).or_default().extend(ids_of(op, operands)),
            (_, None) => drop(module_scope(op, operands).map(|(id, parts)| made_of.insert(id, parts))),
        }
    }
    let mut used = BTreeSet::new();
    while let Some(id) = waiting.pop() {
        if used.insert(id) {
            waiting.extend([&bodies, &made_of].into_iter().filter_map(|parts| parts.get(&id)).flatten());
        }
    }
    Ok(used)
}

/// What an instruction outside functions makes, and of which ids.
fn module_scope(op: Op, operands: &[u32]) -> Option<(u32, Vec<u32>)> {
    Some(match op {
        Op::TypeArray | Op::TypeStruct | Op::TypeRuntimeArray => (operands[0], operands[1..].to_vec()),
        Op::TypePointer => (operands[0], operands[2..].to_vec()),
        Op::Variable => (operands[1], [&operands[..1], &operands[3..]].concat()),
        // The third operand is the operation.
        Op::SpecConstantOp => (operands[1], operands[3..].to_vec()),
        Op::SpecConstantComposite | Op::ConstantComposite => (operands[1], operands[2..].to_vec()),
        _ => return None,
    })
}

/// The operands that are ids. Of instructions that are not listed all operands count: one that is a number may then pass for an id, so that
/// more seems used than is, never less.
fn ids_of(op: Op, operands: &[u32]) -> Vec<u32> {
    let numbers_from = |first: usize| operands[..first.min(operands.len())].to_vec();
    match op {
        Op::CompositeExtract | Op::ArrayLength => numbers_from(3),
        Op::CompositeInsert | Op::VectorShuffle => numbers_from(4),
        Op::Load => numbers_from(3),
        Op::Store => numbers_from(2),
        Op::SelectionMerge => numbers_from(1),
        Op::LoopMerge => numbers_from(2),
        Op::BranchConditional => numbers_from(3),
        Op::Variable => [&operands[..2], &operands[3..]].concat(),
        // Which of the set's instructions.
        Op::ExtInst => [&operands[..3], &operands[4..]].concat(),
        // Selector and default, then pairs of a number and a label.
        Op::Switch => operands.iter().enumerate().filter(|(at, _)| *at < 2 || at % 2 == 1).map(|(_, id)| *id).collect(),
        // A mask of what follows it.
        Op::ImageSampleImplicitLod | Op::ImageSampleExplicitLod | Op::ImageFetch | Op::ImageRead => masked(operands, 4),
        Op::ImageSampleDrefImplicitLod | Op::ImageSampleDrefExplicitLod | Op::ImageGather => masked(operands, 5),
        Op::ImageWrite => masked(operands, 3),
        _ => operands.to_vec(),
    }
}

fn masked(operands: &[u32], mask: usize) -> Vec<u32> {
    operands.iter().enumerate().filter(|(at, _)| *at != mask).map(|(_, id)| *id).collect()
}

/// The module without the resources that nothing uses: no driver and no validation layer then asks for them.
pub(crate) fn without_unused(words: &[u32], used: &BTreeSet<u32>) -> Result<Vec<u32>, String> {
    let resource = |class: u32| {
        let class = StorageClass::from_u32(class);
        class.is_some_and(|class| {
            matches!(class, StorageClass::UniformConstant | StorageClass::Uniform | StorageClass::StorageBuffer)
        })
    };
    let all = instructions(words)?;
    let unused: BTreeSet<u32> = all
        .iter()
        .filter(|(op, operands)| *op == Op::Variable && resource(operands[2]) && !used.contains(&operands[1]))
        .map(|(_, operands)| operands[1])
        .collect();
    let mut kept = words[..HEADER].to_vec();
    for (op, operands) in all {
        let mut operands = operands.to_vec();
        match op {
            Op::Name | Op::Decorate if unused.contains(&operands[0]) => continue,
            Op::Variable if unused.contains(&operands[1]) => continue,
            Op::EntryPoint => {
                // Model, function, a name that ends with a zero byte, then the variables.
                let name = operands[2..].iter().position(|word| word.to_le_bytes().contains(&0)).unwrap_or(0);
                let first = (3 + name).min(operands.len());
                let variables = operands.split_off(first);
                operands.extend(variables.into_iter().filter(|id| !unused.contains(id)));
            }
            _ => {}
        }
        let length = u32::try_from(operands.len() + 1).map_err(|_| "an instruction is too long".to_owned())?;
        kept.push(length << 16 | op as u32);
        kept.extend(operands);
    }
    Ok(kept)
}
