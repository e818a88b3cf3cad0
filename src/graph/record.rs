//! The commands of a pass: barriers, label, timestamps, its work, its crash marker.

use std::collections::HashMap;
use std::sync::Arc;

use ash::vk;

use super::bind::clear_value;
use super::bindings::Access;
use super::declare::Graph;
use super::needs::merged_needs;
use super::pass::{DrawList, Draws, Pass, Work};
use super::report::PendingCounter;
use super::resource::Body;
use super::store::stamp_of_pass;
use super::timing::Timing;
use crate::vulkan::{Barriers, Buffer, Image, ImageBarrier, Pipeline, Scope, VulkanError, pipeline_stages};

impl Graph<'_> {
    pub(super) fn record_pass(
        &mut self,
        index: usize,
        slot: u32,
        timing: Timing,
        counters: &mut Vec<PendingCounter>,
    ) -> Result<(), VulkanError> {
        #[cfg(test)]
        self.note_program(index);
        let images = self.images_of(index);
        let barriers = self.barriers_before(index, &images);
        let recorder = &self.store.recorder;
        let pass = &self.passes[index];
        recorder.begin_label(&pass.full_name());
        let serialised = timing == Timing::Passes;
        let statistics = serialised && pass.raster.is_some();
        if serialised {
            recorder.full_barrier();
            recorder.timestamp(&self.store.queries, stamp_of_pass(slot));
            recorder.full_barrier();
        }
        recorder.barriers(&barriers);
        self.fill_wholes(index);
        if statistics {
            recorder.begin_statistics(&self.store.queries, slot);
        }
        self.record_work(pass)?;
        if statistics {
            recorder.end_statistics(&self.store.queries, slot);
        }
        if serialised {
            recorder.full_barrier();
            recorder.timestamp(&self.store.queries, stamp_of_pass(slot) + 1);
            recorder.full_barrier();
            self.record_counters(index, counters);
        }
        self.record_marker(pass, slot);
        recorder.end_label();
        self.keep_wholes(index)
    }

    /// Notes on the device that the pass has finished.
    fn record_marker(&self, pass: &Pass, slot: u32) {
        let stages = match (&pass.work, pass.program) {
            (Work::Draw(_), _) => vk::PipelineStageFlags2::ALL_GRAPHICS,
            (_, Some(program)) => pipeline_stages(program),
            _ => vk::PipelineStageFlags2::ALL_TRANSFER,
        };
        self.store.recorder.mark(&self.store.markers, slot, stages);
    }

    pub(super) fn holds_depth(&self, id: usize) -> bool {
        match &self.resources[id].body {
            Body::Image(info) => info.aspect() != vk::ImageAspectFlags::COLOR,
            _ => false,
        }
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
        for (resource, place, need) in merged_needs(pass, stages, |id| self.holds_depth(id)) {
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
                    let Some(found) = stored.states[place as usize].transition(need) else { continue };
                    let scope = Scope {
                        from_stages: found.from_stages,
                        from_access: found.from_access,
                        to_stages: found.to_stages,
                        to_access: found.to_access,
                    };
                    let (old_layout, new_layout) = (found.old_layout, found.new_layout);
                    let [mip, layer] = images[&resource].info.level_and_layer(place);
                    barriers.images.push(ImageBarrier {
                        image: &images[&resource],
                        mip,
                        layers: layer..layer + 1,
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
            Work::ClearImage { image, part, value } => {
                let image = self.memory_of_image(*image);
                for place in part.places() {
                    recorder.clear_image(&image, image.info.level_and_layer(place), clear_value(*value));
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
}
