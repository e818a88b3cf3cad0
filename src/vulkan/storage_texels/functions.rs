//! Functions that fetch texels, each copied for the buffers that it is given.

use std::collections::HashMap;

use rspirv::dr::{Function, Instruction, Operand};
use rspirv::spirv::{Op, Word};

use super::rewritten::Rewritten;

impl Rewritten {
    /// Replaces all functions by those that the entry points call, directly or not.
    pub(super) fn replace_functions(&mut self) -> Result<(), String> {
        let originals: HashMap<Word, Function> = std::mem::take(&mut self.module.functions)
            .into_iter()
            .filter_map(|function| Some((function.def.as_ref()?.result_id?, function)))
            .collect();
        let entry_points: Vec<Word> =
            self.module.entry_points.iter().filter_map(|it| it.operands[1].id_ref_any()).collect();
        let mut waiting: Vec<(Word, Vec<Word>)> = Vec::new();
        for entry_point in entry_points {
            self.copies.insert((entry_point, Vec::new()), entry_point);
            waiting.push((entry_point, Vec::new()));
        }
        while let Some(call) = waiting.pop() {
            let original = originals.get(&call.0).ok_or_else(|| format!("it calls what is no function: {}", call.0))?;
            let function = self.copy(original, &call, &mut waiting)?;
            self.module.functions.push(function);
        }
        Ok(())
    }

    /// The function that a call of `original` with these buffers calls now.
    fn copy_for(&mut self, call: (Word, Vec<Word>), waiting: &mut Vec<(Word, Vec<Word>)>) -> Word {
        if let Some(known) = self.copies.get(&call) {
            return *known;
        }
        let id = if call.1.is_empty() { call.0 } else { self.id() };
        self.copies.insert(call.clone(), id);
        waiting.push(call);
        id
    }

    /// One copy. Its ids are its own, unless it is the only one.
    fn copy(
        &mut self,
        original: &Function,
        call: &(Word, Vec<Word>),
        waiting: &mut Vec<(Word, Vec<Word>)>,
    ) -> Result<Function, String> {
        let mut function = original.clone();
        let takes_texels = |parameter: &Instruction, made: &Rewritten| {
            parameter.result_type.is_some_and(|ty| made.pointers.contains(&ty))
        };
        let mut names: HashMap<Word, Word> = HashMap::new();
        if !call.1.is_empty() {
            let given = function.parameters.iter().filter(|parameter| takes_texels(parameter, self));
            names.extend(given.filter_map(|parameter| parameter.result_id).zip(call.1.iter().copied()));
            function.parameters.retain(|parameter| !takes_texels(parameter, self));
            let inside: Vec<Word> = function.all_inst_iter().filter_map(|it| it.result_id).collect();
            for id in inside {
                let new = if id == call.0 { self.copies[call] } else { self.id() };
                names.insert(id, new);
            }
            self.copy_annotations(&names);
            self.retype(&mut function);
        }
        let mut fetched_from: HashMap<Word, Word> = HashMap::new();
        for parameter in function.parameters.iter_mut().chain(&mut function.def) {
            rename(parameter, &names);
        }
        for block in &mut function.blocks {
            if let Some(label) = &mut block.label {
                rename(label, &names);
            }
            let mut instructions = Vec::with_capacity(block.instructions.len());
            for mut instruction in std::mem::take(&mut block.instructions) {
                rename(&mut instruction, &names);
                self.replace(instruction, &mut fetched_from, waiting, &mut instructions)?;
            }
            block.instructions = instructions;
        }
        Ok(function)
    }

    /// What stands in place of an instruction.
    fn replace(
        &mut self,
        mut instruction: Instruction,
        fetched_from: &mut HashMap<Word, Word>,
        waiting: &mut Vec<(Word, Vec<Word>)>,
        out: &mut Vec<Instruction>,
    ) -> Result<(), String> {
        let operand = |place: usize| instruction.operands.get(place).and_then(Operand::id_ref_any);
        let first = operand(0).unwrap_or(0);
        let result = (instruction.result_id.unwrap_or(0), instruction.result_type.unwrap_or(0));
        match instruction.class.opcode {
            Op::Load if self.variables.contains_key(&first) => drop(fetched_from.insert(result.0, first)),
            Op::ImageFetch if fetched_from.contains_key(&first) => {
                let index = operand(1).ok_or("a fetch has no coordinate")?;
                out.extend(self.fetch(fetched_from[&first], index, result));
            }
            Op::ImageQuerySize if fetched_from.contains_key(&first) => {
                out.extend(self.count(fetched_from[&first], result));
            }
            Op::FunctionCall => {
                let arguments = instruction.operands.split_off(1);
                let is_texels = |operand: &Operand, made: &Rewritten| {
                    operand.id_ref_any().filter(|id| made.variables.contains_key(id))
                };
                let given = arguments.iter().filter_map(|argument| is_texels(argument, self)).collect();
                let callee = self.copy_for((first, given), waiting);
                instruction.operands = vec![Operand::IdRef(callee)];
                instruction.operands.extend(arguments.into_iter().filter(|it| is_texels(it, self).is_none()));
                out.push(instruction);
            }
            op => {
                let names = |id: &Word| self.variables.contains_key(id) || fetched_from.contains_key(id);
                if instruction.operands.iter().filter_map(Operand::id_ref_any).any(|id| names(&id)) {
                    return Err(format!("it does more with a texel buffer than to fetch from it ({op:?})"));
                }
                out.push(instruction);
            }
        }
        Ok(())
    }

    /// What decorates an id decorates its copy: `precise` is one of these.
    fn copy_annotations(&mut self, names: &HashMap<Word, Word>) {
        let copies: Vec<Instruction> = self
            .module
            .annotations
            .iter()
            .filter(|it| it.operands[0].id_ref_any().is_some_and(|id| names.contains_key(&id)))
            .map(|it| {
                let mut copy = it.clone();
                rename(&mut copy, names);
                copy
            })
            // Parameters that became variables have those of the variables.
            .filter(|it| it.operands[0].id_ref_any().is_some_and(|id| !self.variables.contains_key(&id)))
            .collect();
        self.module.annotations.extend(copies);
    }

    /// Gives a function the type that its parameters have now.
    fn retype(&mut self, function: &mut Function) {
        let Some(definition) = &mut function.def else { return };
        let result = definition.result_type.unwrap_or(0);
        let parameters = function.parameters.iter().filter_map(|parameter| parameter.result_type);
        let operands = std::iter::once(result).chain(parameters).map(Operand::IdRef).collect();
        let ty = self.global(Op::TypeFunction, None, operands);
        if let Some(last) = definition.operands.last_mut() {
            *last = Operand::IdRef(ty);
        }
    }
}

fn rename(instruction: &mut Instruction, names: &HashMap<Word, Word>) {
    let new = |id: Word| names.get(&id).copied().unwrap_or(id);
    instruction.result_id = instruction.result_id.map(new);
    for operand in &mut instruction.operands {
        if let Some(id) = operand.id_ref_any_mut() {
            *id = new(*id);
        }
    }
}
