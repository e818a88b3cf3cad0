//! The sentence that declares a pass.

use ash::vk;

use super::bindings::{BindingSet, BufferRef, BufferUse, ImageRef, ImageUse};
use super::declare::Graph;
use super::pass::{ClearColor, Counter, DrawList, Draws, Pass, Targets, Work};
use crate::vulkan::RasterState;

impl<'s> Graph<'s> {
    /// A compute pass. `name` is `slot/method/level/pass`, or `piece/pass` for what methods share: timer, debug label and crash marker.
    pub(crate) fn pass<B: BindingSet>(&mut self, name: &str, bindings: B) -> PassBuilder<'_, 's> {
        PassBuilder::new(self, name, &bindings, None)
    }

    /// A raster pass.
    pub(crate) fn raster<B: BindingSet>(&mut self, name: &str, bindings: B, state: RasterState) -> PassBuilder<'_, 's> {
        PassBuilder::new(self, name, &bindings, Some(state))
    }
}

/// A pass being declared; a method that says how much work it has ends the sentence.
#[must_use = "a pass without its amount of work is not added"]
pub(crate) struct PassBuilder<'g, 's> {
    graph: &'g mut Graph<'s>,
    pass: Pass,
}

impl<'g, 's> PassBuilder<'g, 's> {
    fn new<B: BindingSet>(
        graph: &'g mut Graph<'s>,
        name: &str,
        bindings: &B,
        raster: Option<RasterState>,
    ) -> PassBuilder<'g, 's> {
        debug_assert_eq!(B::SET, 0, "materials are bound by draws");
        let mut pass = Pass::new(name, Work::Dispatch([0; 3]));
        pass.program = Some(B::PROGRAM);
        pass.constants = bindings.constants();
        pass.push = bindings.push_bytes().to_vec();
        bindings.visit(&mut |binding, access| {
            let access = access.unwrap_or_else(|| graph.nothing(B::PROGRAM.binding(binding)));
            pass.bindings.push((binding, access));
        });
        pass.raster = raster.map(|state| (state, Targets::default()));
        PassBuilder { graph, pass }
    }

    /// Notes a count that the host knows.
    pub(crate) fn note(mut self, name: &str, count: u64) -> Self {
        self.pass.notes.insert(name.to_owned(), count);
        self
    }

    /// Reports the word at `index` of `buffer` after the pass as a work counter.
    pub(crate) fn count(mut self, name: &str, buffer: BufferRef<u32>, index: usize) -> Self {
        self.graph.resources[buffer.id].buffer_usage |= vk::BufferUsageFlags::TRANSFER_SRC;
        self.pass.counters.push(Counter { name: name.to_owned(), buffer: buffer.id, offset: index as u64 * 4 });
        self
    }

    /// Says that what the pass writes is in another order each time it runs, as atomics leave it, though the same in what it holds. It then never meets
    /// what came of another order.
    pub(crate) fn unordered(mut self) -> Self {
        self.pass.needs.unordered = true;
        self
    }

    /// Names what the pass leaves in a buffer, in place of a key made of all that it reads: for contents that several ways lead to, the whole work or a part of it
    /// on what memory holds ([`Graph::carry_on`], `super::carried`). All of them have to leave the same under one key, which has to name all that it depends on.
    pub(crate) fn leaves<T>(mut self, buffer: BufferRef<T>, key: u64) -> Self {
        self.pass.named.push((buffer.id, key));
        self
    }

    fn targets(&mut self) -> &mut Targets {
        &mut self.pass.raster.as_mut().expect("only raster passes have attachments").1
    }

    /// The next colour output. `clear` is the value that it starts from; `None` keeps what it holds.
    pub(crate) fn color(mut self, image: ImageRef, clear: Option<ClearColor>) -> Self {
        let access = image.access(ImageUse::Color { keep: clear.is_none() });
        self.pass.others.push(access.clone());
        self.targets().extent = image.size();
        self.targets().colors.push(Some((access, clear)));
        self
    }

    /// The next colour output, if somebody takes it.
    pub(crate) fn color_if(mut self, image: Option<ImageRef>, clear: Option<ClearColor>) -> Self {
        match image {
            Some(image) => self.color(image, clear),
            None => {
                self.targets().colors.push(None);
                self
            }
        }
    }

    /// The next colour output, of which only what the pass draws will be read: the rest is neither kept nor cleared.
    pub(crate) fn color_fresh(mut self, image: ImageRef) -> Self {
        let access = image.access(ImageUse::Color { keep: false });
        self.pass.others.push(access.clone());
        self.targets().extent = image.size();
        self.targets().colors.push(Some((access, None)));
        self
    }

    /// The depth attachment, only tested against.
    pub(crate) fn depth_test(mut self, image: ImageRef) -> Self {
        let access = image.access(ImageUse::DepthTest);
        self.pass.others.push(access.clone());
        self.targets().extent = image.size();
        self.targets().depth = Some((access, None));
        self
    }

    /// The depth attachment, written; `clear` as for colours. Comes before [`PassBuilder::stencil`].
    pub(crate) fn depth(mut self, image: ImageRef, clear: Option<f32>) -> Self {
        let access = image.access(ImageUse::Depth { keep: clear.is_none() });
        self.pass.others.push(access.clone());
        self.targets().extent = image.size();
        self.targets().depth = Some((access, clear));
        self
    }

    /// The stencil attachment; `clear` as for colours. Without clearing and without writes it is only tested. Of an image
    /// that holds depth too, the depth is kept, unless the pass clears it as its depth attachment.
    pub(crate) fn stencil(mut self, image: ImageRef, clear: Option<u32>) -> Self {
        let tests = self
            .pass
            .raster
            .as_ref()
            .and_then(|(state, _)| state.stencil)
            .is_some_and(|stencil| stencil.pass == vk::StencilOp::KEEP);
        let clears_depth = self.targets().depth.as_ref().is_some_and(|(_, clear)| clear.is_some());
        let written = self.graph.is_written(image);
        let holds_depth = written && image.info.aspect().contains(vk::ImageAspectFlags::DEPTH);
        let keep = clear.is_none() || (holds_depth && !clears_depth);
        let usage = if clear.is_none() && tests && self.targets().depth.is_none() {
            ImageUse::DepthTest
        } else {
            ImageUse::Depth { keep }
        };
        let access = image.access(usage);
        self.pass.others.push(access.clone());
        self.targets().extent = image.size();
        self.targets().stencil = Some((access, clear));
        self
    }

    /// The area of a raster pass that has no attachments.
    pub(crate) fn area(mut self, extent: [u32; 2]) -> Self {
        self.targets().extent = extent;
        self
    }

    fn add(self, work: Work) {
        let mut pass = self.pass;
        pass.work = work;
        self.graph.add_pass(pass);
    }

    /// Runs `groups` work groups.
    pub(crate) fn groups(self, groups: [u32; 3]) {
        self.add(Work::Dispatch(groups));
    }

    /// Runs at least `threads` invocations: the shader's local size says how many groups that takes.
    pub(crate) fn threads(self, threads: [u32; 3]) {
        let local = self.pass.program.map_or([1; 3], |program| program.local_size);
        self.groups([0, 1, 2].map(|axis| threads[axis].div_ceil(local[axis])));
    }

    /// Runs one group for each block of 8×8 pixels.
    pub(crate) fn pixels(self, size: [u32; 2]) {
        self.groups([size[0].div_ceil(8), size[1].div_ceil(8), 1]);
    }

    /// Runs as many groups as the three words at `index` of `arguments` say.
    pub(crate) fn threads_indirect(mut self, arguments: BufferRef<u32>, index: usize) {
        self.pass.others.push(arguments.access(BufferUse::Indirect));
        self.graph.resources[arguments.id].buffer_usage |= vk::BufferUsageFlags::TRANSFER_SRC;
        self.add(Work::DispatchIndirect { buffer: arguments.id, offset: index as u64 * 4 });
    }

    /// Draws the scene.
    pub(crate) fn draw(mut self, list: DrawList) {
        self.pass.dependence = list.dependence;
        self.add(Work::Draw(Draws::Meshes(Box::new(list))));
    }

    /// Draws `vertices` vertices without vertex buffers, `instances` times.
    pub(crate) fn vertices(self, vertices: u32, instances: u32) {
        self.add(Work::Draw(Draws::Vertices { vertices, instances }));
    }

    /// Draws as the `count` commands at word `index` of `arguments` say.
    pub(crate) fn draw_indirect(mut self, arguments: BufferRef<u32>, index: usize, count: u32) {
        self.pass.others.push(arguments.access(BufferUse::Indirect));
        self.add(Work::Draw(Draws::Indirect { buffer: arguments.id, offset: index as u64 * 4, count }));
    }
}
