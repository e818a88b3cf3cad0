//! Running a declared frame: memory, barriers, commands, timings.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use ash::vk;

use super::bindings::{Access, BufferUse, ImageUse};
use super::demand::{Needs, Verdict, Version, decide};
use super::needs::{READ_ONLY_DEPTH, layout_of, merged_needs};
use super::pass::{ClearColor, DrawList, Draws, Pass, Targets, Work};
use super::store::{MAX_COUNTERS, MAX_PASSES};
use super::timing::{PassTiming, Timing};
use super::{Body, Graph};
use crate::vulkan::program::{BindingKind, ImageDim};
use crate::vulkan::{
    Attachment, Attachments, Barriers, Buffer, Descriptor, Image, ImageBarrier, Pipeline, Scope, SubresourceView,
    TargetFormats, VulkanError, pipeline_stages,
};

/// The number of a read-back in [`Executed::read_back`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ReadBack(pub(super) usize);

/// A buffer that was too small: its name, what it held and what it needed, in elements.
pub(crate) type Outgrown = (String, [usize; 2]);

/// What a frame did and what it cost.
pub(crate) struct Executed {
    pub(crate) passes: Vec<PassTiming>,
    pub(crate) gpu_ms: f64,
    pub(crate) pipeline_ms: f64,
    /// Buffers that were too small. What was made of them is wrong; the next frame gives them enough.
    pub(crate) outgrown: Vec<Outgrown>,
    read_backs: Vec<Vec<u8>>,
}

impl Executed {
    /// The bytes of a read-back, rows close together.
    pub(crate) fn take(&mut self, read_back: ReadBack) -> Vec<u8> {
        std::mem::take(&mut self.read_backs[read_back.0])
    }
}

/// A word of the counter buffer, and what it means.
struct PendingCounter {
    pass: usize,
    name: String,
    /// Three words of an indirect dispatch: their product times the local size.
    invocations_of_group: Option<u64>,
    slot: u64,
}

impl Graph<'_> {
    /// Whether each pass runs.
    pub(super) fn verdicts(&self) -> Vec<Verdict> {
        let needs: Vec<Needs> = self.passes.iter().map(|pass| pass.needs.clone()).collect();
        let stored = |(resource, mip): (usize, u32)| {
            let resource = &self.resources[resource];
            match &resource.body {
                // The host writes them before the frame; the scene's stand anyway.
                Body::Upload(_) | Body::ExternalBuffer(_) | Body::ExternalImage(_) => {
                    Some(resource.content[mip as usize].0)
                }
                Body::Image(info) if self.store.fits(resource) => self.store.image_key(&resource.name, info, mip),
                Body::Buffer { bytes } if self.store.fits(resource) => self.store.buffer_key(&resource.name, *bytes),
                Body::Image(_) | Body::Buffer { .. } => None,
            }
        };
        decide(&needs, &self.wanted, stored)
    }

    /// Runs the passes that are needed and waits for them.
    ///
    /// # Errors
    /// A lost device and exhausted memory name the last pass that finished.
    pub(crate) fn run(mut self, timing: Timing) -> Result<Executed, VulkanError> {
        let verdicts = self.verdicts();
        let result = self.execute(&verdicts, timing);
        if result.is_err() {
            // Whatever was recorded may not have run.
            self.store.forget();
        }
        result
    }

    fn execute(&mut self, verdicts: &[Verdict], timing: Timing) -> Result<Executed, VulkanError> {
        self.provide_memory(verdicts)?;
        let running = verdicts.iter().filter(|verdict| **verdict == Verdict::Run).count();
        if running as u64 > u64::from(MAX_PASSES) {
            return Err(VulkanError::TooLarge {
                what: "the frame".to_owned(),
                asked: format!("{running} passes"),
                limit: MAX_PASSES.to_string(),
            });
        }
        let read_back = self.provide_read_back()?;
        self.store.queries.reset();
        self.store.markers.write(0, &vec![0; MAX_PASSES as usize * 4]);
        let _ = self.store.pipelines.take_spent();
        self.store.recorder.begin(u32::try_from(running).unwrap_or(MAX_PASSES))?;
        let mut counters = Vec::new();
        self.store.recorder.full_barrier();
        self.store.recorder.timestamp(&self.store.queries, 0);
        self.store.recorder.full_barrier();
        let mut order = Vec::new();
        for (index, verdict) in verdicts.iter().enumerate() {
            if *verdict == Verdict::Run {
                let slot = u32::try_from(order.len()).unwrap_or(0);
                order.push(index);
                self.record_pass(index, slot, timing, &mut counters)?;
            }
        }
        self.store.recorder.full_barrier();
        self.store.recorder.timestamp(&self.store.queries, 1);
        self.store.recorder.full_barrier();
        self.record_read_backs(&read_back);
        let pipeline_ms = self.store.pipelines.take_spent().as_secs_f64() * 1e3;
        if let Err(error) = self.store.recorder.finish() {
            return Err(error.after_pass(self.last_finished(&order).as_deref()));
        }
        for &index in &order {
            self.note_contents(index);
        }
        let passes = self.report(verdicts, &order, timing, &counters)?;
        let stamps = self.store.queries.read_timestamps(2)?;
        let gpu_ms = match stamps[..] {
            [Some(start), Some(end)] => self.store.queries.milliseconds(start, end),
            _ => 0.0,
        };
        let declared: Vec<&str> = self.resources.iter().map(|resource| resource.name.as_str()).collect();
        self.store.retain(|name| declared.contains(&name));
        let read_backs = self.copy_read_backs(&read_back);
        let outgrown = self.note_growth(&read_backs)?;
        Ok(Executed { passes, gpu_ms, pipeline_ms, outgrown, read_backs })
    }

    /// Remembers how much the buffers that were too small need, and a little more, so that not every change outgrows them again.
    fn note_growth(&mut self, read_backs: &[Vec<u8>]) -> Result<Vec<Outgrown>, VulkanError> {
        let mut outgrown = Vec::new();
        for growing in &self.growing {
            let words = read_backs[growing.needed.0].chunks_exact(4);
            let needed = words.skip(growing.index).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
            let needed = needed.take(1).sum::<u32>() as usize;
            if needed > growing.most {
                return Err(VulkanError::TooLarge {
                    what: growing.name.clone(),
                    asked: format!("{needed} elements"),
                    limit: growing.most.to_string(),
                });
            }
            if needed > growing.capacity {
                self.store.grown.insert(growing.name.clone(), needed + needed / 8);
                outgrown.push((growing.name.clone(), [growing.capacity, needed]));
            }
        }
        Ok(outgrown)
    }

    /// Allocates what the running passes touch, and fills what the host supplies.
    fn provide_memory(&mut self, verdicts: &[Verdict]) -> Result<(), VulkanError> {
        let mut used = vec![false; self.resources.len()];
        for (pass, verdict) in self.passes.iter().zip(verdicts) {
            if *verdict == Verdict::Run {
                for access in pass.accesses() {
                    used[resource_of(access)] = true;
                }
            }
        }
        for (resource, _) in self.resources.iter().zip(&used).filter(|(_, used)| **used) {
            self.store.provide(resource)?;
            let Body::Upload(data) = &resource.body else { continue };
            let stored = self.store.buffers.get_mut(&resource.name).expect("provided above");
            let key = resource.content[0].0;
            if stored.key != Some(key) {
                // The device is idle between frames, so nobody else holds the buffer.
                let written = Arc::get_mut(&mut stored.buffer).is_some_and(|buffer| buffer.write(0, data));
                debug_assert!(written, "upload memory is mapped and not shared");
                stored.key = Some(key);
            }
        }
        Ok(())
    }

    fn memory_of_image(&self, id: usize) -> Arc<Image> {
        match &self.resources[id].body {
            Body::ExternalImage(image) => image.clone(),
            _ => self.store.images[&self.resources[id].name].image.clone(),
        }
    }

    fn memory_of_buffer(&self, id: usize) -> Arc<Buffer> {
        match &self.resources[id].body {
            Body::ExternalBuffer(buffer) => buffer.clone(),
            _ => self.store.buffers[&self.resources[id].name].buffer.clone(),
        }
    }

    fn record_pass(
        &mut self,
        index: usize,
        slot: u32,
        timing: Timing,
        counters: &mut Vec<PendingCounter>,
    ) -> Result<(), VulkanError> {
        let images = self.images_of(index);
        let barriers = self.barriers_before(index, &images);
        let recorder = &self.store.recorder;
        let pass = &self.passes[index];
        recorder.begin_label(&pass.full_name());
        let serialised = timing == Timing::Passes;
        let statistics = serialised && pass.raster.is_some();
        if serialised {
            recorder.full_barrier();
            recorder.timestamp(&self.store.queries, 2 + 2 * slot);
            recorder.full_barrier();
        }
        recorder.barriers(&barriers);
        if statistics {
            recorder.begin_statistics(&self.store.queries, slot);
        }
        self.record_work(pass)?;
        if statistics {
            recorder.end_statistics(&self.store.queries, slot);
        }
        if serialised {
            recorder.full_barrier();
            recorder.timestamp(&self.store.queries, 3 + 2 * slot);
            recorder.full_barrier();
            self.record_counters(index, counters);
        }
        self.record_marker(pass, slot);
        recorder.end_label();
        Ok(())
    }

    /// Notes on the device that the pass has finished. The next pass does not wait for this.
    fn record_marker(&self, pass: &Pass, slot: u32) {
        let stages = match (&pass.work, pass.program) {
            (Work::Draw(_), _) => vk::PipelineStageFlags2::ALL_GRAPHICS,
            (_, Some(program)) => pipeline_stages(program),
            _ => vk::PipelineStageFlags2::ALL_TRANSFER,
        };
        let scope = Scope {
            from_stages: stages,
            from_access: vk::AccessFlags2::NONE,
            to_stages: vk::PipelineStageFlags2::ALL_TRANSFER,
            to_access: vk::AccessFlags2::NONE,
        };
        self.store.recorder.barriers(&Barriers { memory: Some(scope), images: Vec::new() });
        self.store.recorder.fill(&self.store.markers, u64::from(slot) * 4, 4, 1);
    }

    /// The name of the last pass whose marker was written.
    fn last_finished(&self, order: &[usize]) -> Option<String> {
        let words: &[u32] = bytemuck::try_cast_slice(self.store.markers.mapped()?).ok()?;
        let last = words.iter().take(order.len()).rposition(|word| *word != 0)?;
        Some(self.passes[order[last]].full_name())
    }

    fn images_of(&self, index: usize) -> HashMap<usize, Arc<Image>> {
        let ids = self.passes[index].accesses().filter_map(|access| match access {
            Access::Image { image, .. } => Some(*image),
            Access::Buffer { .. } => None,
        });
        ids.map(|id| (id, self.memory_of_image(id))).collect()
    }

    /// All dependencies of a pass on what came before, as one batch.
    fn barriers_before<'i>(&mut self, index: usize, images: &'i HashMap<usize, Arc<Image>>) -> Barriers<'i> {
        let mut barriers = Barriers::default();
        let pass = &self.passes[index];
        let stages = pass.program.map_or(vk::PipelineStageFlags2::ALL_TRANSFER, pipeline_stages);
        let holds_depth = |id: usize| match &self.resources[id].body {
            Body::Image(info) => info.aspect() != vk::ImageAspectFlags::COLOR,
            _ => false,
        };
        for (resource, mips, need) in merged_needs(pass, stages, holds_depth) {
            let body = &self.resources[resource];
            match &body.body {
                Body::ExternalBuffer(_) | Body::ExternalImage(_) => {}
                Body::Buffer { .. } | Body::Upload(_) => {
                    let stored = self.store.buffers.get_mut(&body.name).expect("provided before recording");
                    if let Some(found) = stored.state.transition(need) {
                        let memory = barriers.memory.get_or_insert(Scope::NONE);
                        memory.from_stages |= found.from_stages;
                        memory.from_access |= found.from_access;
                        memory.to_stages |= found.to_stages;
                        memory.to_access |= found.to_access;
                    }
                }
                Body::Image(_) => {
                    let stored = self.store.images.get_mut(&body.name).expect("provided before recording");
                    let Some(found) = stored.states[mips as usize].transition(need) else { continue };
                    let scope = Scope {
                        from_stages: found.from_stages,
                        from_access: found.from_access,
                        to_stages: found.to_stages,
                        to_access: found.to_access,
                    };
                    let (old_layout, new_layout) = (found.old_layout, found.new_layout);
                    barriers.images.push(ImageBarrier {
                        image: &images[&resource],
                        mip: mips,
                        scope,
                        old_layout,
                        new_layout,
                    });
                }
            }
        }
        barriers
    }

    fn record_work(&self, pass: &Pass) -> Result<(), VulkanError> {
        let recorder = &self.store.recorder;
        match &pass.work {
            Work::Skipped(_) => {}
            Work::ClearImage { image, mips, value } => {
                for mip in mips.clone() {
                    recorder.clear_image(&self.memory_of_image(*image), mip, clear_value(*value));
                }
            }
            Work::FillBuffer { buffer, word } => {
                recorder.fill(&self.memory_of_buffer(*buffer), 0, vk::WHOLE_SIZE, *word)
            }
            Work::Dispatch(groups) => {
                self.check_groups(pass, *groups)?;
                if !groups.contains(&0) {
                    self.bind(pass, None)?;
                    recorder.dispatch(*groups);
                }
            }
            Work::DispatchIndirect { buffer, offset } => {
                self.bind(pass, None)?;
                recorder.dispatch_indirect(&self.memory_of_buffer(*buffer), *offset);
            }
            Work::Draw(draws) => self.record_draws(pass, draws)?,
        }
        Ok(())
    }

    fn check_groups(&self, pass: &Pass, groups: [u32; 3]) -> Result<(), VulkanError> {
        let limits = self.store.device.limits().max_compute_work_group_count;
        if groups.iter().zip(limits).any(|(groups, limit)| *groups > limit) {
            return Err(VulkanError::TooLarge {
                what: format!("the dispatch of {}", pass.full_name()),
                asked: format!("{groups:?} groups"),
                limit: format!("{limits:?}"),
            });
        }
        Ok(())
    }

    fn bind(&self, pass: &Pass, targets: Option<&TargetFormats>) -> Result<Pipeline, VulkanError> {
        let program = pass.program.expect("transfers bind nothing");
        let pipelines = &self.store.pipelines;
        let recorder = &self.store.recorder;
        let pipeline = match (&pass.raster, targets) {
            (Some((state, _)), Some(targets)) => pipelines.raster(program, &pass.constants, state, targets)?,
            _ => pipelines.compute(program, &pass.constants)?,
        };
        recorder.bind_pipeline(pipeline);
        let mut descriptors = Vec::new();
        for (number, access) in &pass.bindings {
            let binding = program
                .bindings
                .iter()
                .find(|binding| (binding.set, binding.binding) == (0, *number))
                .expect("generated from the same SPIR-V");
            descriptors.push((*number, binding.kind, self.descriptor(access, binding.kind)?));
        }
        if !descriptors.is_empty() {
            let set = recorder.descriptor_set(pipelines.set_layout(program, 0)?, &descriptors)?;
            recorder.bind_set(pipeline, 0, set);
        }
        recorder.push_constants(pipeline, &pass.push);
        Ok(pipeline)
    }

    fn descriptor(&self, access: &Access, kind: BindingKind) -> Result<Descriptor, VulkanError> {
        Ok(match access {
            Access::Image { image, mips, usage } => {
                let image = self.memory_of_image(*image);
                let (BindingKind::SampledImage(dim) | BindingKind::StorageImage(dim)) = kind else {
                    unreachable!("typed by the generated bindings")
                };
                let aspect = image.info.aspect() & !vk::ImageAspectFlags::STENCIL;
                let aspect = if aspect.is_empty() { image.info.aspect() } else { aspect };
                let view =
                    image.view(&SubresourceView { dim, mips: mips.clone(), aspect, format: image.info.format })?;
                match usage {
                    ImageUse::Sampled(sampler) => {
                        let sampler = self.store.pipelines.sampler(*sampler)?;
                        let holds_depth = image.info.aspect() != vk::ImageAspectFlags::COLOR;
                        Descriptor::Image { view, layout: layout_of(*usage, holds_depth), sampler }
                    }
                    _ => Descriptor::Image { view, layout: vk::ImageLayout::GENERAL, sampler: vk::Sampler::null() },
                }
            }
            Access::Buffer { buffer, usage: BufferUse::Texels(format) } => {
                Descriptor::Texels(self.memory_of_buffer(*buffer).texels(*format)?)
            }
            Access::Buffer { buffer, .. } => Descriptor::Buffer(self.memory_of_buffer(*buffer).raw),
        })
    }

    fn record_draws(&self, pass: &Pass, draws: &Draws) -> Result<(), VulkanError> {
        let recorder = &self.store.recorder;
        let (_, targets) = pass.raster.as_ref().expect("draws belong to raster passes");
        let attachments = self.attachments(targets)?;
        let pipeline = self.bind(pass, Some(&attachments.formats))?;
        recorder.begin_rendering(&attachments);
        let [width, height] = attachments.extent;
        recorder.viewport([0.0, 0.0, width as f32, height as f32], [0, 0, width, height]);
        match draws {
            Draws::Vertices { vertices, instances } => recorder.draw(*vertices, *instances),
            Draws::Indirect { buffer, offset, count } => {
                recorder.draw_indirect(&self.memory_of_buffer(*buffer), *offset, *count)
            }
            Draws::Meshes(list) => self.record_meshes(pipeline, list),
        }
        recorder.end_rendering();
        Ok(())
    }

    fn record_meshes(&self, pipeline: Pipeline, list: &DrawList) {
        let recorder = &self.store.recorder;
        let vertices: Vec<&Buffer> = list.vertices.iter().map(|buffer| &**buffer).collect();
        recorder.bind_vertices(&vertices, Some(&list.indices));
        for group in &list.groups {
            if let Some((viewport, scissor)) = group.viewport {
                recorder.viewport(viewport, scissor);
            }
            if let Some(push) = &group.push {
                recorder.push_constants(pipeline, push);
            }
            if let (Some(materials), Some(material)) = (&list.materials, group.material) {
                recorder.bind_set(pipeline, 1, materials.get(material));
            }
            for call in &group.calls {
                recorder.draw_indexed(call.index_count, call.first_index, call.vertex_offset, call.instance);
            }
        }
    }

    fn attachments(&self, targets: &Targets) -> Result<Attachments, VulkanError> {
        let view = |access: &Access,
                    aspect: vk::ImageAspectFlags|
         -> Result<(vk::ImageView, vk::Format, vk::ImageLayout), VulkanError> {
            let Access::Image { image, mips, usage } = access else { unreachable!("attachments are images") };
            let image = self.memory_of_image(*image);
            // Attachments of an image that holds both depth and stencil share one view of both.
            let aspect = if aspect == vk::ImageAspectFlags::COLOR { aspect } else { image.info.aspect() };
            let what = SubresourceView {
                dim: ImageDim::D2,
                mips: mips.start..mips.start + 1,
                aspect,
                format: image.info.format,
            };
            Ok((image.view(&what)?, image.info.format, layout_of(*usage, true)))
        };
        let mut made = Attachments { extent: targets.extent, ..Attachments::default() };
        for color in &targets.colors {
            let Some((access, clear)) = color else {
                made.colors.push(None);
                made.formats.colors.push(vk::Format::UNDEFINED);
                continue;
            };
            let (view, format, layout) = view(access, vk::ImageAspectFlags::COLOR)?;
            let clear = clear.map(|value| vk::ClearValue { color: clear_value(value) });
            made.colors.push(Some(Attachment { view, layout, clear, store: true }));
            made.formats.colors.push(format);
        }
        if let Some((access, clear)) = &targets.depth {
            let (view, format, layout) = view(access, vk::ImageAspectFlags::DEPTH)?;
            let clear =
                clear.map(|depth| vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth, stencil: 0 } });
            made.depth = Some(Attachment { view, layout, clear, store: layout != READ_ONLY_DEPTH });
            made.formats.depth = format;
        }
        if let Some((access, clear)) = &targets.stencil {
            let (view, format, layout) = view(access, vk::ImageAspectFlags::STENCIL)?;
            let clear = clear
                .map(|stencil| vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: 0.0, stencil } });
            made.stencil = Some(Attachment { view, layout, clear, store: layout != READ_ONLY_DEPTH });
            made.formats.stencil = format;
        }
        Ok(made)
    }

    /// Copies what the pass counted to where the host reads it. Full barriers stand around this.
    fn record_counters(&self, index: usize, counters: &mut Vec<PendingCounter>) {
        let pass = &self.passes[index];
        let recorder = &self.store.recorder;
        let mut slot = counters
            .last()
            .map_or(0, |last: &PendingCounter| last.slot + if last.invocations_of_group.is_some() { 3 } else { 1 });
        let mut add = |name: &str, buffer: usize, offset: u64, invocations_of_group: Option<u64>| {
            let words = if invocations_of_group.is_some() { 3 } else { 1 };
            if slot + words <= MAX_COUNTERS {
                recorder.copy(&self.memory_of_buffer(buffer), offset, &self.store.counters, slot * 4, words * 4);
                counters.push(PendingCounter { pass: index, name: name.to_owned(), invocations_of_group, slot });
                slot += words;
            }
        };
        if let Work::DispatchIndirect { buffer, offset } = pass.work {
            let local: u64 =
                pass.program.map_or(1, |program| program.local_size.iter().map(|&length| u64::from(length)).product());
            add("invocations", buffer, offset, Some(local));
        }
        for counter in &pass.counters {
            add(&counter.name, counter.buffer, counter.offset, None);
        }
    }

    /// Remembers what the outputs of a pass that ran now hold.
    fn note_contents(&mut self, index: usize) {
        for &Version { place: (resource, mip), key } in &self.passes[index].needs.writes {
            let resource = &self.resources[resource];
            match &resource.body {
                Body::Image(_) => {
                    if let Some(stored) = self.store.images.get_mut(&resource.name) {
                        stored.keys[mip as usize] = Some(key);
                    }
                }
                _ => {
                    if let Some(stored) = self.store.buffers.get_mut(&resource.name) {
                        stored.key = Some(key);
                    }
                }
            }
        }
    }

    fn report(
        &self,
        verdicts: &[Verdict],
        order: &[usize],
        timing: Timing,
        counters: &[PendingCounter],
    ) -> Result<Vec<PassTiming>, VulkanError> {
        let stamps = match timing {
            Timing::Passes => self.store.queries.read_timestamps(2 + 2 * u32::try_from(order.len()).unwrap_or(0))?,
            Timing::Frame => Vec::new(),
        };
        let words: &[u32] =
            self.store.counters.mapped().and_then(|bytes| bytemuck::try_cast_slice(bytes).ok()).unwrap_or(&[]);
        let mut slots: HashMap<usize, usize> = HashMap::new();
        slots.extend(order.iter().enumerate().map(|(slot, &index)| (index, slot)));
        let mut rows = Vec::new();
        for (index, (pass, verdict)) in self.passes.iter().zip(verdicts).enumerate() {
            let mut work: BTreeMap<String, u64> = BTreeMap::new();
            let mut ms = None;
            if let Some(&slot) = slots.get(&index) {
                work.clone_from(&pass.notes);
                if let [Some(Some(start)), Some(Some(end))] = [stamps.get(2 + 2 * slot), stamps.get(3 + 2 * slot)] {
                    ms = Some(self.store.queries.milliseconds(*start, *end));
                }
                if let (Work::Dispatch(groups), Some(program)) = (&pass.work, pass.program) {
                    let product = |lengths: [u32; 3]| lengths.iter().map(|&length| u64::from(length)).product::<u64>();
                    work.insert("invocations".to_owned(), product(*groups) * product(program.local_size));
                }
                if pass.raster.is_some()
                    && timing == Timing::Passes
                    && let Some(statistics) = self.store.queries.read_statistics(u32::try_from(slot).unwrap_or(0))
                {
                    work.insert("vertices".to_owned(), statistics.vertices);
                    work.insert("triangles".to_owned(), statistics.triangles);
                    work.insert("fragments".to_owned(), statistics.fragments);
                }
            }
            for counter in counters.iter().filter(|counter| counter.pass == index) {
                let word = |offset: u64| {
                    usize::try_from(counter.slot + offset)
                        .ok()
                        .and_then(|slot| words.get(slot))
                        .map_or(0, |&word| u64::from(word))
                };
                let value =
                    counter.invocations_of_group.map_or_else(|| word(0), |local| word(0) * word(1) * word(2) * local);
                work.insert(counter.name.clone(), value);
            }
            rows.push(PassTiming {
                piece: pass.piece.clone(),
                pass: pass.name.clone(),
                ms,
                skipped: pass.skip_reason(*verdict),
                work,
            });
        }
        Ok(rows)
    }
}

impl Pass {
    pub(super) fn skip_reason(&self, verdict: Verdict) -> Option<String> {
        match (&self.work, verdict) {
            (Work::Skipped(reason), _) => Some(reason.clone()),
            (_, Verdict::Run) => None,
            (_, Verdict::Unchanged) => Some(self.dependence.reason()),
            (_, Verdict::NotAsked) => Some("nobody asks for its output".to_owned()),
        }
    }
}

fn clear_value(value: ClearColor) -> vk::ClearColorValue {
    match value {
        ClearColor::Float(float32) => vk::ClearColorValue { float32 },
        ClearColor::Uint(uint32) => vk::ClearColorValue { uint32 },
    }
}

fn resource_of(access: &Access) -> usize {
    match access {
        Access::Image { image, .. } => *image,
        Access::Buffer { buffer, .. } => *buffer,
    }
}
