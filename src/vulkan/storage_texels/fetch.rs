//! What lies in a buffer of each format, and how a texel is made of it.

use ash::vk;
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{GlslStd450Op, Op, StorageClass, Word};

use super::rewritten::{Kind, Layout, Rewritten};

impl Rewritten {
    pub(super) fn layout(&mut self, format: vk::Format) -> Result<Layout, String> {
        use vk::Format as F;
        let kind = match format {
            F::R32_SFLOAT | F::R32_UINT => Kind::Components(1),
            F::R32G32_SFLOAT | F::R32G32_UINT => Kind::Components(2),
            F::R32G32B32A32_SFLOAT | F::R32G32B32A32_UINT => Kind::Components(4),
            F::R8G8B8A8_UNORM => Kind::Unorm8x4,
            F::R16G16B16A16_SFLOAT => Kind::Half4,
            other => return Err(format!("texels of the format {other:?} cannot be read from a storage buffer")),
        };
        let floats = matches!(format, F::R32_SFLOAT | F::R32G32_SFLOAT | F::R32G32B32A32_SFLOAT);
        let component = if floats { self.float() } else { self.word() };
        let (element, stride) = match kind {
            Kind::Components(1) => (component, 4),
            Kind::Components(count) => (self.vector(component, count), 4 * count),
            Kind::Unorm8x4 => (component, 4),
            Kind::Half4 => (self.vector(component, 2), 8),
        };
        Ok(Layout { element, stride, kind })
    }

    fn float(&mut self) -> Word {
        self.global(Op::TypeFloat, None, vec![Operand::LiteralBit32(32)])
    }

    pub(super) fn word(&mut self) -> Word {
        self.global(Op::TypeInt, None, vec![Operand::LiteralBit32(32), Operand::LiteralBit32(0)])
    }

    fn vector(&mut self, component: Word, count: u32) -> Word {
        self.global(Op::TypeVector, None, vec![Operand::IdRef(component), Operand::LiteralBit32(count)])
    }

    fn constant(&mut self, ty: Word, bits: u32) -> Word {
        self.global(Op::Constant, Some(ty), vec![Operand::LiteralBit32(bits)])
    }

    /// The instructions that make `texel`, of the type `texel_type`, of element `index` of a buffer.
    pub(super) fn fetch(&mut self, variable: Word, index: Word, (texel, texel_type): (Word, Word)) -> Vec<Instruction> {
        let layout = self.variables[&variable];
        let word = self.word();
        let first = self.constant(word, 0);
        let class = Operand::StorageClass(StorageClass::StorageBuffer);
        let pointer_type = self.global(Op::TypePointer, None, vec![class, Operand::IdRef(layout.element)]);
        let mut code = Code { instructions: Vec::new() };
        let pointer = self.id();
        code.push(Op::AccessChain, pointer_type, pointer, &[variable, first, index]);
        let whole = matches!(layout.kind, Kind::Components(4));
        let loaded = if whole { texel } else { self.id() };
        code.push(Op::Load, layout.element, loaded, &[pointer]);
        match layout.kind {
            Kind::Components(4) => {}
            Kind::Components(count) => {
                let component = self.component_of(layout, count);
                let (zero, one) = (self.constant(component, 0), self.one(component));
                let rest = std::iter::repeat_n(zero, 3 - count as usize);
                let parts: Vec<Word> = std::iter::once(loaded).chain(rest).chain([one]).collect();
                code.push(Op::CompositeConstruct, texel_type, texel, &parts);
            }
            Kind::Unorm8x4 => self.extended(&mut code, GlslStd450Op::UnpackUnorm4x8, texel_type, (texel, loaded)),
            Kind::Half4 => {
                let float = self.float();
                let pair = self.vector(float, 2);
                let mut halves = [0; 2];
                for (place, half) in (0..).zip(&mut halves) {
                    let (bits, unpacked) = (self.id(), self.id());
                    let operands = vec![Operand::IdRef(loaded), Operand::LiteralBit32(place)];
                    code.instructions.push(Instruction::new(Op::CompositeExtract, Some(word), Some(bits), operands));
                    self.extended(&mut code, GlslStd450Op::UnpackHalf2x16, pair, (unpacked, bits));
                    *half = unpacked;
                }
                code.push(Op::CompositeConstruct, texel_type, texel, &halves);
            }
        }
        code.instructions
    }

    /// The number of texels, as an integer of the type `count_type`.
    pub(super) fn count(&mut self, variable: Word, (count, count_type): (Word, Word)) -> Vec<Instruction> {
        let (word, length) = (self.word(), self.id());
        let operands = vec![Operand::IdRef(variable), Operand::LiteralBit32(0)];
        vec![
            Instruction::new(Op::ArrayLength, Some(word), Some(length), operands),
            Instruction::new(Op::Bitcast, Some(count_type), Some(count), vec![Operand::IdRef(length)]),
        ]
    }

    fn component_of(&mut self, layout: Layout, count: u32) -> Word {
        let of_vector = |it: &&Instruction| it.result_id == Some(layout.element);
        let element = self.module.types_global_values.iter().find(of_vector);
        let component = element.and_then(|it| it.operands[0].id_ref_any());
        if count == 1 { layout.element } else { component.unwrap_or(layout.element) }
    }

    fn one(&mut self, component: Word) -> Word {
        let bits = if component == self.float() { 1.0_f32.to_bits() } else { 1 };
        self.constant(component, bits)
    }

    fn extended(&mut self, code: &mut Code, op: GlslStd450Op, ty: Word, (result, operand): (Word, Word)) {
        let is_glsl = |it: &&Instruction| it.operands[0] == Operand::LiteralString("GLSL.std.450".to_owned());
        let known = self.module.ext_inst_imports.iter().find(is_glsl).and_then(|it| it.result_id);
        let set = known.unwrap_or_else(|| {
            let id = self.id();
            let name = vec![Operand::LiteralString("GLSL.std.450".to_owned())];
            self.module.ext_inst_imports.push(Instruction::new(Op::ExtInstImport, None, Some(id), name));
            id
        });
        let operands = vec![Operand::IdRef(set), Operand::LiteralExtInstInteger(op as u32), Operand::IdRef(operand)];
        code.instructions.push(Instruction::new(Op::ExtInst, Some(ty), Some(result), operands));
    }
}

struct Code {
    instructions: Vec<Instruction>,
}

impl Code {
    fn push(&mut self, op: Op, ty: Word, result: Word, operands: &[Word]) {
        let operands = operands.iter().map(|id| Operand::IdRef(*id)).collect();
        self.instructions.push(Instruction::new(op, Some(ty), Some(result), operands));
    }
}
