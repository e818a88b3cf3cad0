//! Where the picture reads the irradiance of particles: at its pixels, or at regions of several sizes (frame/regions) with interpolation between them.

use ash::vk;

use super::formats::{FLOATS4, WORD};
use super::geometry::ParticleSpace;
use super::options::{ParticlesOptions, ParticlesReceivers};
use crate::frame::gbuffer::GBuffer;
use crate::frame::regions::{self, Pyramid, RegionRule, flattened_size, signed};
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::graph::{ClearColor, Graph};
use crate::shaders::particles::{
    Homes, HomesPush, Near as LookNear, NearPush, RegionHomes, RegionHomesPush, RegionLight, RegionLightPush, Shade,
    ShadePush,
};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// Regions that one group takes.
const REGIONS_PER_GROUP: u32 = 64;
/// Sizes of regions at most: of 1, 2, 4, 8 pixels a side.
const LEVELS: u32 = 4;
const RULE: RegionRule =
    RegionRule { piece: "diffuse/particles", depth_threshold: 2e-4, normal_threshold: 0.1, slope_threshold: 0.08 };

/// What irradiance is read for, each with the particle that stands for it.
pub(super) enum Receivers {
    Pixels(ImageRef),
    Regions(Pyramid, BufferRef<u32>),
}

impl Receivers {
    /// Finds and marks the particle of each.
    pub(super) fn find(
        graph: &mut Graph<'_>,
        surface: &GBuffer,
        space: &ParticleSpace,
        shift: [f32; 3],
        options: &ParticlesOptions,
        marks: BufferRef<u32>,
    ) -> Receivers {
        let level_count = regions::level_count(surface.size, LEVELS);
        // Levels of a very wide image do not fit beside each other.
        let fits = level_count > 1 && flattened_size(surface.size)[0] <= graph.longest_side();
        if options.receivers == ParticlesReceivers::Pixels || !fits {
            let homes = graph.image("particles.homes", vk::Format::R32_UINT, surface.size);
            let pass = Homes {
                scene_rays: space.rays.clone(),
                particles: space.group.clone(),
                surface: surface.group.clone(),
                homes: homes.write(),
                marks: marks.read_write(),
                push: HomesPush { shift },
            };
            graph.pass("diffuse/particles/find/homes", pass).pixels(surface.size);
            return Receivers::Pixels(homes);
        }
        let pyramid = regions::pyramid(graph, surface, &RULE, level_count, Some(REGIONS_PER_GROUP));
        let pixel_count = surface.size[0] as usize * surface.size[1] as usize;
        let homes = graph.buffer::<u32>("particles.region_homes", pixel_count);
        if let Some(list) = pyramid.list {
            let pass = RegionHomes {
                scene_rays: space.rays.clone(),
                particles: space.group.clone(),
                surface: surface.group.clone(),
                regions: list.texels(WORD),
                planes: pyramid.planes.sampled(),
                homes: homes.start(),
                marks: marks.read_write(),
                push: RegionHomesPush { shift, size: signed(surface.size), level_count: level_count.cast_signed() },
            };
            let pass = graph.pass("diffuse/particles/find/homes", pass).count("regions", list, 3);
            pass.threads_indirect(list, 0);
        }
        Receivers::Regions(pyramid, homes)
    }

    /// These can look for themselves at what is near.
    pub(super) fn are_regions(&self) -> bool {
        matches!(self, Receivers::Regions(..))
    }

    /// The slot, once particles have gathered.
    pub(super) fn light(
        &self,
        graph: &mut Graph<'_>,
        (surface, shift): (&GBuffer, [f32; 3]),
        space: &ParticleSpace,
        irradiance: BufferRef<[f32; 4]>,
        near: Option<Near>,
    ) -> ImageRef {
        let diffuse = graph.image("particles.diffuse", FLOATS, surface.size);
        let (pyramid, homes) = match self {
            Receivers::Regions(pyramid, homes) => (pyramid, homes),
            Receivers::Pixels(homes) => {
                let pass = Shade {
                    turns: space.turns,
                    particles: space.group.clone(),
                    surface: surface.group.clone(),
                    homes: homes.sampled(),
                    list_lengths: space.list_lengths.texels(WORD),
                    lists: space.lists.texels(WORD),
                    irradiance: irradiance.texels(FLOATS4),
                    diffuse: diffuse.write(),
                    push: ShadePush { shift },
                };
                graph.pass("diffuse/particles/shade", pass).pixels(surface.size);
                return diffuse;
            }
        };
        let received = graph.image("particles.regions_irradiance", FLOATS, flattened_size(surface.size));
        graph.clear_image("diffuse/particles/shade/clear", received, ClearColor::Float([0.0; 4]));
        if let Some(list) = pyramid.list {
            let (size, level_count) = (signed(surface.size), pyramid.level_count.cast_signed());
            let read = |graph: &mut Graph<'_>, name: &str, irradiance: BufferRef<[f32; 4]>, image: ImageRef| {
                let pass = RegionLight {
                    turns: space.turns,
                    particles: space.group.clone(),
                    surface: surface.group.clone(),
                    regions: list.texels(WORD),
                    planes: pyramid.planes.sampled(),
                    homes: homes.texels(WORD),
                    list_lengths: space.list_lengths.texels(WORD),
                    lists: space.lists.texels(WORD),
                    irradiance: irradiance.texels(FLOATS4),
                    regions_irradiance: image.read_write(),
                    push: RegionLightPush { shift, size, level_count },
                };
                graph.pass(name, pass).threads_indirect(list, 0);
            };
            read(graph, "diffuse/particles/shade/regions", irradiance, received);
            if let Some(near) = near {
                let far = graph.image("particles.regions_far", FLOATS, flattened_size(surface.size));
                graph.clear_image("diffuse/particles/shade/clear-far", far, ClearColor::Float([0.0; 4]));
                read(graph, "diffuse/particles/shade/far", near.far, far);
                let pass = LookNear {
                    particles: space.group.clone(),
                    scene_rays: space.rays.clone(),
                    surface: surface.group.clone(),
                    regions: list.texels(WORD),
                    planes: pyramid.planes.sampled(),
                    radiance: near.radiance.texels(FLOATS4),
                    far: far.read(),
                    regions_irradiance: received.read_write(),
                    facets: space.facets.read(),
                    homes: space.homes.read(),
                    push: NearPush { shift, size, level_count, side: near.side },
                };
                graph.pass("diffuse/particles/shade/near", pass).threads_indirect(list, 0);
            }
        }
        regions::interpolate(graph, surface, &RULE, pyramid, received, diffuse);
        diffuse
    }
}

/// What receivers look at what is near with.
#[derive(Clone, Copy)]
pub(super) struct Near {
    /// Irradiance of particles by what is far.
    pub(super) far: BufferRef<[f32; 4]>,
    /// Of particles.
    pub(super) radiance: BufferRef<[f32; 4]>,
    /// Rays a side.
    pub(super) side: u32,
}
