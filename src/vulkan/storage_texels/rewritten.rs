//! A module while it is rewritten.

use std::collections::{HashMap, HashSet};

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op, Word};

/// The array in place of a texel buffer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    pub(super) element: Word,
    /// Bytes.
    pub(super) stride: u32,
    pub(super) kind: Kind,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    /// As many floats or words.
    Components(u32),
    /// 8 bits each, 0 to 1.
    Unorm8x4,
    Half4,
}

/// A module on its way.
pub(super) struct Rewritten {
    pub(super) module: Module,
    pub(super) pointers: HashSet<Word>,
    /// The variables that were texel buffers.
    pub(super) variables: HashMap<Word, Layout>,
    /// Functions as they are called now: the original, the variables that it is given.
    pub(super) copies: HashMap<(Word, Vec<Word>), Word>,
    pub(super) next_id: Word,
}

impl Rewritten {
    pub(super) fn new(module: Module, pointers: HashSet<Word>) -> Rewritten {
        let next_id = module.header.as_ref().map_or(0, |header| header.bound);
        Rewritten { module, pointers, variables: HashMap::new(), copies: HashMap::new(), next_id }
    }

    pub(super) fn id(&mut self) -> Word {
        self.next_id += 1;
        self.next_id - 1
    }

    /// The declaration of a type or constant, made if there is none.
    pub(super) fn global(&mut self, op: Op, result_type: Option<Word>, operands: Vec<Operand>) -> Word {
        let known = self
            .module
            .types_global_values
            .iter()
            .find(|it| it.class.opcode == op && it.result_type == result_type && it.operands == operands);
        known.and_then(|known| known.result_id).unwrap_or_else(|| self.new_global(op, result_type, operands))
    }

    /// Aggregates and variables may be declared alike more than once.
    pub(super) fn new_global(&mut self, op: Op, result_type: Option<Word>, operands: Vec<Operand>) -> Word {
        let id = self.id();
        self.module.types_global_values.push(Instruction::new(op, result_type, Some(id), operands));
        id
    }

    pub(super) fn decorate(&mut self, id: Word, decoration: Decoration, number: Option<u32>) {
        let operands =
            [Some(Operand::IdRef(id)), Some(Operand::Decoration(decoration)), number.map(Operand::LiteralBit32)];
        let operands = operands.into_iter().flatten().collect();
        self.module.annotations.push(Instruction::new(Op::Decorate, None, None, operands));
    }

    pub(super) fn decorate_member(&mut self, id: Word, decoration: Decoration, number: Option<u32>) {
        let what = [Operand::IdRef(id), Operand::LiteralBit32(0), Operand::Decoration(decoration)];
        let operands = what.into_iter().chain(number.map(Operand::LiteralBit32)).collect();
        self.module.annotations.push(Instruction::new(Op::MemberDecorate, None, None, operands));
    }
}
