//! Shaders that read lists as texels, made to read storage buffers.
//!
//! Inner loops read lists through texel buffers, which the software driver of Mesa reads several times faster. A device need offer no more than
//! 65,536 texels, too few for most scenes. There the same SPIR-V reads the same bytes out of storage buffers: a variable of
//! `samplerBuffer` becomes a block that holds an array, a fetch becomes a load and what the format makes of it. Functions that are given such
//! variables get a copy for each one that they are given, since pointers to storage buffers cannot be handed on.

mod fetch;
mod functions;
mod rewritten;

use std::collections::{BTreeMap, HashSet};

use ash::vk;
use rspirv::binary::Assemble as _;
use rspirv::dr::{self, Instruction, Module, Operand};
use rspirv::spirv::{Capability, Decoration, Dim, ExecutionMode, Op, StorageClass, Word};

use rewritten::Rewritten;

/// Words before the first instruction.
const HEADER: usize = 5;

/// Formats of the texel buffers that a program reads, by their numbers in set 0.
pub(crate) type TexelFormats = BTreeMap<u32, vk::Format>;

/// The module that reads storage buffers in place of texel buffers of these formats.
///
/// # Errors
/// Says what of the module is not understood.
pub(crate) fn read_storage(words: &[u32], formats: &TexelFormats) -> Result<Vec<u32>, String> {
    let module = load(words)?;
    let pointers = texel_pointers(&module);
    if pointers.is_empty() {
        return Ok(words.to_vec());
    }
    let mut rewritten = Rewritten::new(module, pointers);
    rewritten.replace_variables(formats)?;
    rewritten.replace_functions()?;
    rewritten.drop_what_nothing_names();
    Ok(rewritten.module.assemble())
}

/// rspirv takes an `OpExecutionModeId`, which says the size of a work group, for a part of a function: it is kept out of its sight.
fn load(words: &[u32]) -> Result<Module, String> {
    let mut rest = words.get(HEADER..).unwrap_or_default();
    let mut others = words[..HEADER.min(words.len())].to_vec();
    let mut modes = Vec::new();
    while let [first, ..] = rest {
        let (instruction, after) = rest.split_at((*first >> 16).clamp(1, rest.len() as u32) as usize);
        match instruction {
            [first, entry_point, mode, ids @ ..] if first & 0xFFFF == Op::ExecutionModeId as u32 => {
                let mode = ExecutionMode::from_u32(*mode).ok_or("it has an unknown execution mode")?;
                let operands = [Operand::IdRef(*entry_point), Operand::ExecutionMode(mode)].into_iter();
                let operands = operands.chain(ids.iter().map(|id| Operand::IdRef(*id))).collect();
                modes.push(Instruction::new(Op::ExecutionModeId, None, None, operands));
            }
            _ => others.extend(instruction),
        }
        rest = after;
    }
    let mut module = dr::load_words(&others).map_err(|error| format!("its SPIR-V is not understood: {error}"))?;
    module.execution_modes.extend(modes);
    Ok(module)
}

/// The types of pointers to texel buffers.
fn texel_pointers(module: &Module) -> HashSet<Word> {
    let of_op = |op: Op| module.types_global_values.iter().filter(move |instruction| instruction.class.opcode == op);
    let is_texels = |image: &&Instruction| image.operands[1] == Operand::Dim(Dim::DimBuffer);
    let images: HashSet<Word> = of_op(Op::TypeImage).filter(is_texels).filter_map(|image| image.result_id).collect();
    let to_images = |pointer: &&Instruction| pointer.operands[1].id_ref_any().is_some_and(|it| images.contains(&it));
    of_op(Op::TypePointer).filter(to_images).filter_map(|pointer| pointer.result_id).collect()
}

impl Rewritten {
    /// The texel buffers become blocks of the same names, sets and bindings.
    fn replace_variables(&mut self, formats: &TexelFormats) -> Result<(), String> {
        let is_texels = |it: &Instruction, pointers: &HashSet<Word>| {
            it.class.opcode == Op::Variable && it.result_type.is_some_and(|pointer| pointers.contains(&pointer))
        };
        let pointers = self.pointers.clone();
        let (variables, others): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.module.types_global_values).into_iter().partition(|it| is_texels(it, &pointers));
        self.module.types_global_values = others;
        for variable in variables.into_iter().filter_map(|variable| variable.result_id) {
            let binding = self.binding_of(variable);
            let format = binding.and_then(|binding| formats.get(&binding));
            let format = *format.ok_or_else(|| format!("nothing is bound in place of texel buffer {binding:?}"))?;
            let layout = self.layout(format)?;
            let array = self.new_global(Op::TypeRuntimeArray, None, vec![Operand::IdRef(layout.element)]);
            self.decorate(array, Decoration::ArrayStride, Some(layout.stride));
            let block = self.new_global(Op::TypeStruct, None, vec![Operand::IdRef(array)]);
            self.decorate(block, Decoration::Block, None);
            self.decorate_member(block, Decoration::Offset, Some(0));
            self.decorate_member(block, Decoration::NonWritable, None);
            let class = Operand::StorageClass(StorageClass::StorageBuffer);
            let pointer = self.new_global(Op::TypePointer, None, vec![class.clone(), Operand::IdRef(block)]);
            let declaration = Instruction::new(Op::Variable, Some(pointer), Some(variable), vec![class]);
            self.module.types_global_values.push(declaration);
            self.variables.insert(variable, layout);
        }
        Ok(())
    }

    fn binding_of(&self, variable: Word) -> Option<u32> {
        let mut annotations = self.module.annotations.iter();
        annotations.find_map(|it| match it.operands[..] {
            [Operand::IdRef(id), Operand::Decoration(Decoration::Binding), Operand::LiteralBit32(number)]
                if id == variable && it.class.opcode == Op::Decorate =>
            {
                Some(number)
            }
            _ => None,
        })
    }

    /// Names and decorations of functions that are gone; the kinds of images that are.
    fn drop_what_nothing_names(&mut self) {
        let Module { types_global_values, functions, capabilities, debug_names, annotations, .. } = &mut self.module;
        types_global_values.retain(|it| it.result_id.is_none_or(|id| !self.pointers.contains(&id)));
        capabilities.retain(|it| it.operands[0] != Operand::Capability(Capability::SampledBuffer));
        types_global_values
            .retain(|it| it.class.opcode != Op::TypeImage || it.operands[1] != Operand::Dim(Dim::DimBuffer));
        let gone = |it: &Instruction| {
            it.class.opcode == Op::TypeFunction
                && it.operands.iter().any(|operand| operand.id_ref_any().is_some_and(|id| self.pointers.contains(&id)))
        };
        types_global_values.retain(|it| !gone(it));
        let mut defined: HashSet<Word> = types_global_values.iter().filter_map(|it| it.result_id).collect();
        for function in functions.iter() {
            defined.extend(function.all_inst_iter().filter_map(|it| it.result_id));
        }
        let names_what_is = |it: &Instruction| it.operands[0].id_ref_any().is_some_and(|id| defined.contains(&id));
        debug_names.retain(names_what_is);
        annotations.retain(names_what_is);
        if let Some(header) = &mut self.module.header {
            header.bound = self.next_id;
        }
    }
}
