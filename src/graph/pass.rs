//! Passes: what they bind and what they do.

use std::collections::BTreeMap;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

use super::bindings::{Access, Part};
use super::demand::{Needs, Verdict};
use super::dependence::Dependence;
use super::piece::{joined, split};
use crate::vulkan::program::Program;
use crate::vulkan::{Buffer, MaterialSets, RasterState};

/// One indexed draw of one instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct DrawCall {
    pub(crate) index_count: u32,
    pub(crate) first_index: u32,
    pub(crate) vertex_offset: i32,
    pub(crate) instance: u32,
}

/// Draws that share viewport, push constants and material set.
#[derive(Clone, Debug, Default)]
pub(crate) struct DrawGroup {
    /// Viewport `x, y, width, height` and the scissor that cuts it; the whole target if `None`.
    pub(crate) viewport: Option<([f32; 4], [u32; 4])>,
    /// In place of the pass's own push constants.
    pub(crate) push: Option<Vec<u8>>,
    /// The index of its material set.
    pub(crate) material: Option<usize>,
    pub(crate) calls: Vec<DrawCall>,
}

/// The scene's geometry as one pass draws it.
pub(crate) struct DrawList {
    pub(crate) vertices: Vec<Arc<Buffer>>,
    pub(crate) indices: Arc<Buffer>,
    pub(crate) materials: Option<Arc<MaterialSets>>,
    pub(crate) groups: Vec<DrawGroup>,
    /// Names what is drawn: buffers, calls and viewports.
    pub(crate) key: u64,
    pub(crate) dependence: Dependence,
}

pub(super) enum Draws {
    Meshes(Box<DrawList>),
    Vertices { vertices: u32, instances: u32 },
    Indirect { buffer: usize, offset: u64, count: u32 },
}

pub(super) enum Work {
    Skipped(String),
    Dispatch([u32; 3]),
    DispatchIndirect { buffer: usize, offset: u64 },
    Draw(Draws),
    ClearImage { image: usize, part: Part, value: ClearColor },
    FillBuffer { buffer: usize, word: u32 },
}

/// Attachments of a raster pass and the values that they are cleared to.
#[derive(Default)]
pub(super) struct Targets {
    /// The area drawn to; needed where there is no attachment.
    pub(super) extent: [u32; 2],
    /// `None`: an output that nobody takes.
    pub(super) colors: Vec<Option<(Access, Option<ClearColor>)>>,
    pub(super) depth: Option<(Access, Option<f32>)>,
    pub(super) stencil: Option<(Access, Option<u32>)>,
}

/// The value that a colour attachment starts from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ClearColor {
    Float([f32; 4]),
    Uint([u32; 4]),
}

/// A counter that a pass leaves in a buffer.
pub(super) struct Counter {
    pub(super) name: String,
    pub(super) buffer: usize,
    pub(super) offset: u64,
}

pub(super) struct Pass {
    pub(super) piece: String,
    /// Within its piece.
    pub(super) name: String,
    pub(super) program: Option<&'static Program>,
    pub(super) constants: Vec<u32>,
    pub(super) push: Vec<u8>,
    pub(super) bindings: Vec<(u32, Access)>,
    /// Accesses that are no bindings: attachments, indirect arguments, transfers.
    pub(super) others: Vec<Access>,
    pub(super) raster: Option<(RasterState, Targets)>,
    pub(super) work: Work,
    /// Buffers whose content it names itself, with the key.
    pub(super) named: Vec<(usize, u64)>,
    pub(super) needs: Needs,
    pub(super) dependence: Dependence,
    pub(super) counters: Vec<Counter>,
    pub(super) notes: BTreeMap<String, u64>,
}

impl Pass {
    pub(super) fn new(name: &str, work: Work) -> Pass {
        let (piece, pass) = split(name);
        Pass {
            piece: piece.to_owned(),
            name: pass.to_owned(),
            program: None,
            constants: Vec::new(),
            push: Vec::new(),
            bindings: Vec::new(),
            others: Vec::new(),
            raster: None,
            work,
            named: Vec::new(),
            needs: Needs::default(),
            dependence: Dependence::NONE,
            counters: Vec::new(),
            notes: BTreeMap::new(),
        }
    }

    pub(super) fn skipped(name: &str, reason: &str) -> Pass {
        Pass::new(name, Work::Skipped(reason.to_owned()))
    }

    pub(super) fn transfer(name: &str, access: Access, value: Vec<u8>, work: Work) -> Pass {
        Pass { push: value, others: vec![access], ..Pass::new(name, work) }
    }

    pub(super) fn full_name(&self) -> String {
        joined(&self.piece, &self.name)
    }

    pub(super) fn accesses(&self) -> impl Iterator<Item = &Access> {
        self.bindings.iter().map(|(_, access)| access).chain(&self.others)
    }

    /// Everything that decides about its outputs, apart from what it reads.
    pub(super) fn hash_work(&self, hasher: &mut impl Hasher) {
        (&self.piece, &self.name, self.program.map(|program| program.name), &self.constants, &self.push).hash(hasher);
        match &self.work {
            Work::Dispatch(groups) => groups.hash(hasher),
            Work::Draw(Draws::Meshes(list)) => list.key.hash(hasher),
            Work::Draw(Draws::Vertices { vertices, instances }) => (vertices, instances).hash(hasher),
            Work::Draw(Draws::Indirect { offset, count, .. }) => (offset, count).hash(hasher),
            Work::DispatchIndirect { offset, .. } => offset.hash(hasher),
            Work::Skipped(_) | Work::ClearImage { .. } | Work::FillBuffer { .. } => {}
        }
        if let Some((state, targets)) = &self.raster {
            state.hash(hasher);
            targets.extent.hash(hasher);
            // Which images they are, the accesses say.
            let colors: Vec<_> = targets.colors.iter().map(|color| color.as_ref().map(|(_, clear)| clear)).collect();
            let depth = targets.depth.as_ref().map(|(_, clear)| clear);
            let stencil = targets.stencil.as_ref().map(|(_, clear)| clear);
            format!("{colors:?} {depth:?} {stencil:?}").hash(hasher);
        }
    }

    pub(super) fn skip_reason(&self, verdict: Verdict) -> Option<String> {
        match (&self.work, verdict) {
            (Work::Skipped(reason), _) => Some(reason.clone()),
            (_, Verdict::Run) => None,
            (_, Verdict::Unchanged) => Some(self.dependence.reason()),
            (_, Verdict::NotAsked) => Some("nobody asks for its output".to_owned()),
        }
    }
}
