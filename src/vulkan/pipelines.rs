//! Pipelines, made when first used and kept; descriptor set layouts; samplers.

#![allow(unsafe_code, reason = "creation and destruction of pipelines and samplers")]

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use ash::vk;

use super::device::Device;
use super::error::{Called, VulkanError};
use super::program::{BindingKind, ImageDim, Program, StageKind};
use super::storage_texels::{TexelFormats, read_storage};

/// Textures that a material binds (glsl/geometry/material_textures.glsl).
const MATERIAL_TEXTURES: u32 = 7;

/// How an image is filtered and continued beyond its edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum SamplerKind {
    NearestClamp,
    #[allow(dead_code, reason = "volumes and filtered maps of the methods to come")]
    LinearClamp,
    /// A texture of the scene.
    Texture {
        wrap: [vk::SamplerAddressMode; 2],
        nearest: bool,
    },
}

/// One attribute of a vertex: the shader's location, and where its data lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct VertexAttribute {
    pub(crate) location: u32,
    pub(crate) buffer: u32,
    pub(crate) format: vk::Format,
}

/// The vertex buffers of a draw: a stride for each, and the attributes in them.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct VertexLayout {
    pub(crate) strides: Vec<u32>,
    pub(crate) attributes: Vec<VertexAttribute>,
}

/// Depth test and write; reverse-Z, so that nearer means greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct DepthState {
    pub(crate) compare: vk::CompareOp,
    pub(crate) write: bool,
}

/// Stencil test and write, the same for both faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct StencilState {
    pub(crate) compare: vk::CompareOp,
    pub(crate) pass: vk::StencilOp,
    pub(crate) reference: u32,
}

/// The fixed-function state of a raster pass. No face is culled: every surface blocks light from both sides.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct RasterState {
    pub(crate) vertices: VertexLayout,
    pub(crate) topology: vk::PrimitiveTopology,
    pub(crate) depth: Option<DepthState>,
    pub(crate) stencil: Option<StencilState>,
    /// Whether colours are added to what the attachments hold.
    pub(crate) additive: bool,
}

/// The formats that a raster pass writes; `UNDEFINED` for an output that nobody takes.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct TargetFormats {
    pub(crate) colors: Vec<vk::Format>,
    pub(crate) depth: vk::Format,
    pub(crate) stencil: vk::Format,
}

/// A pipeline and what binding to it needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pipeline {
    pub(crate) raw: vk::Pipeline,
    pub(crate) layout: vk::PipelineLayout,
    pub(crate) bind_point: vk::PipelineBindPoint,
    pub(crate) stages: vk::ShaderStageFlags,
}

#[derive(Clone, PartialEq, Eq, Hash)]
struct Key {
    program: &'static str,
    constants: Vec<u32>,
    raster: Option<(RasterState, TargetFormats)>,
    /// Where texels are read from storage buffers.
    texels: TexelFormats,
}

#[derive(Clone, Copy)]
struct Layouts {
    sets: [vk::DescriptorSetLayout; 2],
    pipeline: vk::PipelineLayout,
}

/// All pipelines of a device. They outlast what uses them: what one renderer had compiled, the next one finds.
pub(crate) struct Pipelines {
    device: Arc<Device>,
    layouts: Mutex<HashMap<&'static str, Layouts>>,
    pipelines: Mutex<HashMap<Key, Pipeline>>,
    samplers: Mutex<HashMap<SamplerKind, vk::Sampler>>,
    spent: Mutex<Duration>,
}

impl Pipelines {
    pub(crate) fn new(device: &Arc<Device>) -> Arc<Pipelines> {
        Arc::new(Pipelines {
            device: device.clone(),
            layouts: Mutex::default(),
            pipelines: Mutex::default(),
            samplers: Mutex::default(),
            spent: Mutex::default(),
        })
    }

    pub(crate) fn device(&self) -> &Arc<Device> {
        &self.device
    }

    /// Time spent creating pipelines since this was last asked.
    pub(crate) fn take_spent(&self) -> Duration {
        std::mem::take(&mut *self.spent.lock().unwrap_or_else(PoisonError::into_inner))
    }

    pub(crate) fn compute(
        &self,
        program: &'static Program,
        constants: &[u32],
        texels: TexelFormats,
    ) -> Result<Pipeline, VulkanError> {
        self.pipeline(program, constants, None, texels)
    }

    pub(crate) fn raster(
        &self,
        program: &'static Program,
        constants: &[u32],
        (state, targets): (&RasterState, &TargetFormats),
        texels: TexelFormats,
    ) -> Result<Pipeline, VulkanError> {
        self.pipeline(program, constants, Some((state.clone(), targets.clone())), texels)
    }

    fn pipeline(
        &self,
        program: &'static Program,
        constants: &[u32],
        raster: Option<(RasterState, TargetFormats)>,
        texels: TexelFormats,
    ) -> Result<Pipeline, VulkanError> {
        let texels = if self.device.traits().texels_in_storage { texels } else { TexelFormats::new() };
        let key = Key { program: program.name, constants: constants.to_vec(), raster, texels };
        let mut pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = pipelines.get(&key) {
            return Ok(*pipeline);
        }
        let start = Instant::now();
        if key.raster.is_some() {
            self.device.check_draws()?;
        }
        let layouts = self.layouts(program)?;
        let raw = self.create(program, &key, layouts.pipeline)?;
        self.device.set_name(raw, program.name);
        let bind_point =
            if program.is_compute() { vk::PipelineBindPoint::COMPUTE } else { vk::PipelineBindPoint::GRAPHICS };
        let pipeline = Pipeline { raw, layout: layouts.pipeline, bind_point, stages: program.stage_flags() };
        pipelines.insert(key, pipeline);
        *self.spent.lock().unwrap_or_else(PoisonError::into_inner) += start.elapsed();
        Ok(pipeline)
    }

    pub(crate) fn set_layout(
        &self,
        program: &'static Program,
        set: u32,
    ) -> Result<vk::DescriptorSetLayout, VulkanError> {
        Ok(self.layouts(program)?.sets[set as usize])
    }

    fn layouts(&self, program: &'static Program) -> Result<Layouts, VulkanError> {
        let mut layouts = self.layouts.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = layouts.get(program.name) {
            return Ok(*found);
        }
        let raw = &self.device.raw;
        let stages = program.stage_flags();
        let mut sets = [vk::DescriptorSetLayout::null(); 2];
        for (set, place) in (0..).zip(&mut sets) {
            let declared = program
                .bindings
                .iter()
                .filter(|binding| binding.set == set)
                .map(|binding| (binding.binding, binding.kind));
            // One set per material fits every program, also one that reads but some of the textures.
            let textures =
                (0..MATERIAL_TEXTURES).map(|binding| (binding, BindingKind::SampledImage(ImageDim::D2Array)));
            let bindings: Vec<(u32, BindingKind)> =
                if set == 1 && program.has_set(1) { textures.collect() } else { declared.collect() };
            let bindings: Vec<_> = bindings
                .into_iter()
                .map(|(binding, kind)| {
                    let layout = vk::DescriptorSetLayoutBinding::default();
                    layout
                        .binding(binding)
                        .descriptor_type(self.device.descriptor_type(kind))
                        .descriptor_count(1)
                        .stage_flags(stages)
                })
                .collect();
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            // SAFETY: the device is alive.
            *place = unsafe { raw.create_descriptor_set_layout(&info, None) }.called("vkCreateDescriptorSetLayout")?;
        }
        let push = [vk::PushConstantRange { stage_flags: stages, offset: 0, size: program.push_size }];
        let push = if program.push_size > 0 { &push[..] } else { &[] };
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets).push_constant_ranges(push);
        // SAFETY: the set layouts were just made.
        let pipeline = unsafe { raw.create_pipeline_layout(&info, None) }.called("vkCreatePipelineLayout")?;
        let made = Layouts { sets, pipeline };
        layouts.insert(program.name, made);
        Ok(made)
    }

    fn create(
        &self,
        program: &'static Program,
        key: &Key,
        layout: vk::PipelineLayout,
    ) -> Result<vk::Pipeline, VulkanError> {
        let raw = &self.device.raw;
        let entries: Vec<_> = (0..)
            .zip(program.constants)
            .map(|(index, &id)| vk::SpecializationMapEntry { constant_id: id, offset: index * 4, size: 4 })
            .collect();
        let specialisation =
            vk::SpecializationInfo::default().map_entries(&entries).data(bytemuck::cast_slice(&key.constants));
        let mut modules = Vec::new();
        let mut stages = Vec::new();
        for (stage, mut words) in program.stages.iter().zip(program.spirv()?) {
            if self.device.traits().texels_in_storage {
                words = read_storage(&words, &key.texels)
                    .map_err(|error| VulkanError::Shader(format!("{}: {error}", program.name)))?;
            }
            let info = vk::ShaderModuleCreateInfo::default().code(&words);
            // SAFETY: the code is glslang's, for this version of Vulkan.
            let module = unsafe { raw.create_shader_module(&info, None) }
                .called(&format!("vkCreateShaderModule for {}", program.name))?;
            modules.push(module);
            let info =
                vk::PipelineShaderStageCreateInfo::default().stage(stage.kind.flag()).module(module).name(c"main");
            stages.push(info.specialization_info(&specialisation));
        }
        let result = match &key.raster {
            None => {
                let info = [vk::ComputePipelineCreateInfo::default().stage(stages[0]).layout(layout)];
                // SAFETY: stage and layout belong to the same program.
                unsafe { raw.create_compute_pipelines(vk::PipelineCache::null(), &info, None) }
            }
            Some((state, targets)) => self.create_raster(&stages, layout, state, targets),
        };
        for module in modules {
            // SAFETY: pipelines do not need their modules once made.
            unsafe { raw.destroy_shader_module(module, None) };
        }
        let made = result.map_err(|(_, result)| result).called(&format!("pipeline creation for {}", program.name))?;
        Ok(made[0])
    }

    fn create_raster(
        &self,
        stages: &[vk::PipelineShaderStageCreateInfo<'_>],
        layout: vk::PipelineLayout,
        state: &RasterState,
        targets: &TargetFormats,
    ) -> Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)> {
        let bindings: Vec<_> = (0..)
            .zip(&state.vertices.strides)
            .map(|(binding, &stride)| vk::VertexInputBindingDescription {
                binding,
                stride,
                input_rate: vk::VertexInputRate::VERTEX,
            })
            .collect();
        let attributes: Vec<_> = state
            .vertices
            .attributes
            .iter()
            .map(|attribute| vk::VertexInputAttributeDescription {
                location: attribute.location,
                binding: attribute.buffer,
                format: attribute.format,
                offset: 0,
            })
            .collect();
        let vertices = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(&bindings)
            .vertex_attribute_descriptions(&attributes);
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(state.topology);
        let viewports = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default()
            .polygon_mode(vk::PolygonMode::FILL)
            .cull_mode(vk::CullModeFlags::NONE)
            .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
            .line_width(1.0);
        let samples =
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let stencil = state.stencil.map_or_else(vk::StencilOpState::default, |stencil| vk::StencilOpState {
            fail_op: vk::StencilOp::KEEP,
            pass_op: stencil.pass,
            depth_fail_op: vk::StencilOp::KEEP,
            compare_op: stencil.compare,
            compare_mask: 0xff,
            write_mask: 0xff,
            reference: stencil.reference,
        });
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(state.depth.is_some())
            .depth_write_enable(state.depth.is_some_and(|depth| depth.write))
            .depth_compare_op(state.depth.map_or(vk::CompareOp::ALWAYS, |depth| depth.compare))
            .stencil_test_enable(state.stencil.is_some())
            .front(stencil)
            .back(stencil);
        let blend = vk::PipelineColorBlendAttachmentState {
            blend_enable: state.additive.into(),
            src_color_blend_factor: vk::BlendFactor::ONE,
            dst_color_blend_factor: vk::BlendFactor::ONE,
            color_blend_op: vk::BlendOp::ADD,
            src_alpha_blend_factor: vk::BlendFactor::ONE,
            dst_alpha_blend_factor: vk::BlendFactor::ONE,
            alpha_blend_op: vk::BlendOp::ADD,
            color_write_mask: vk::ColorComponentFlags::RGBA,
        };
        let unwritten = vk::PipelineColorBlendAttachmentState::default();
        let blends: Vec<_> = targets
            .colors
            .iter()
            .map(|format| if *format == vk::Format::UNDEFINED { unwritten } else { blend })
            .collect();
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let dynamic_states = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic_states);
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(&targets.colors)
            .depth_attachment_format(targets.depth)
            .stencil_attachment_format(targets.stencil);
        let info = [vk::GraphicsPipelineCreateInfo::default()
            .stages(stages)
            .vertex_input_state(&vertices)
            .input_assembly_state(&assembly)
            .viewport_state(&viewports)
            .rasterization_state(&rasterization)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout)
            .push_next(&mut rendering)];
        // SAFETY: stages and layout belong to the same program; everything `info` points to lives on the stack above.
        unsafe { self.device.raw.create_graphics_pipelines(vk::PipelineCache::null(), &info, None) }
    }

    pub(crate) fn sampler(&self, kind: SamplerKind) -> Result<vk::Sampler, VulkanError> {
        let mut samplers = self.samplers.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(sampler) = samplers.get(&kind) {
            return Ok(*sampler);
        }
        let (filter, [u, v]) = match kind {
            SamplerKind::NearestClamp => (vk::Filter::NEAREST, [vk::SamplerAddressMode::CLAMP_TO_EDGE; 2]),
            SamplerKind::LinearClamp => (vk::Filter::LINEAR, [vk::SamplerAddressMode::CLAMP_TO_EDGE; 2]),
            SamplerKind::Texture { wrap, nearest } => {
                (if nearest { vk::Filter::NEAREST } else { vk::Filter::LINEAR }, wrap)
            }
        };
        let texture = matches!(kind, SamplerKind::Texture { .. });
        let anisotropic = texture
            && filter == vk::Filter::LINEAR
            && self.device.survey.features.core.sampler_anisotropy == vk::TRUE
            && !self.device.traits().software;
        let mode =
            if filter == vk::Filter::NEAREST { vk::SamplerMipmapMode::NEAREST } else { vk::SamplerMipmapMode::LINEAR };
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(filter)
            .min_filter(filter)
            .mipmap_mode(mode)
            .address_mode_u(u)
            .address_mode_v(v)
            .address_mode_w(vk::SamplerAddressMode::CLAMP_TO_EDGE)
            .anisotropy_enable(anisotropic)
            .max_anisotropy(if anisotropic { self.device.limits().max_sampler_anisotropy.min(8.0) } else { 1.0 })
            .max_lod(vk::LOD_CLAMP_NONE);
        // SAFETY: the device is alive; anisotropy is on only where the device has it.
        let sampler = unsafe { self.device.raw.create_sampler(&info, None) }.called("vkCreateSampler")?;
        samplers.insert(kind, sampler);
        Ok(sampler)
    }
}

impl Drop for Pipelines {
    fn drop(&mut self) {
        fn inner<T>(mutex: &mut Mutex<T>) -> &mut T {
            mutex.get_mut().unwrap_or_else(PoisonError::into_inner)
        }
        let raw = &self.device.raw;
        // SAFETY: the last frame that used them has finished (module invariant).
        unsafe {
            for pipeline in inner(&mut self.pipelines).values() {
                raw.destroy_pipeline(pipeline.raw, None);
            }
            for layouts in inner(&mut self.layouts).values() {
                raw.destroy_pipeline_layout(layouts.pipeline, None);
                for set in layouts.sets {
                    raw.destroy_descriptor_set_layout(set, None);
                }
            }
            for sampler in inner(&mut self.samplers).values() {
                raw.destroy_sampler(*sampler, None);
            }
        }
    }
}

/// The stages in which a program runs, for barriers.
pub(crate) fn pipeline_stages(program: &Program) -> vk::PipelineStageFlags2 {
    program.stages.iter().fold(vk::PipelineStageFlags2::NONE, |flags, stage| {
        flags
            | match stage.kind {
                StageKind::Vertex => vk::PipelineStageFlags2::VERTEX_SHADER,
                StageKind::Geometry => vk::PipelineStageFlags2::GEOMETRY_SHADER,
                StageKind::Fragment => vk::PipelineStageFlags2::FRAGMENT_SHADER,
                StageKind::Compute => vk::PipelineStageFlags2::COMPUTE_SHADER,
            }
    })
}
