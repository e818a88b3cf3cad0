//! From the irradiance of area particles to that of radiance particles, and from these to pixels and to points that mirrors show.

use ash::vk;

use super::super::formats::{FLOATS4, WORD, WORDS4};
use super::super::geometry::ParticleSpace;
use super::receivers::MeshReceivers;
use super::spots::Seen;
use crate::frame::gbuffer::GBuffer;
use crate::frame::mirrored::{MirroredLight, MirroredPoints};
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::shaders::particles::{MeshLight, MeshLightPush, MeshMirrored, MeshShade, MeshShadePush};

/// The slot, and the light at what mirrors show, once area particles have gathered `irradiance`.
pub(crate) fn light(
    graph: &mut Graph<'_>,
    space: &ParticleSpace,
    mesh: &MeshReceivers,
    (surface, shift, points): Seen<'_>,
    irradiance: BufferRef<[f32; 4]>,
) -> (ImageRef, Option<MirroredLight>) {
    let lit = Lit::declare(graph, space, mesh, irradiance);
    let mirrored = points.map(|points| lit.mirrored(graph, space, mesh, points));
    (lit.shade(graph, space, mesh, (surface, shift)), mirrored)
}

/// What particles of both kinds receive, W/m².
struct Lit {
    area_particles: BufferRef<[f32; 4]>,
    radiance_particles: BufferRef<[f32; 4]>,
}

impl Lit {
    /// Estimates what the radiance particles that were found receive.
    fn declare(
        graph: &mut Graph<'_>,
        space: &ParticleSpace,
        mesh: &MeshReceivers,
        irradiance: BufferRef<[f32; 4]>,
    ) -> Lit {
        let capacity = mesh.particles.numbers.count();
        let received = graph.buffer::<[f32; 4]>("particles.received", (1 + space.turns as usize) * capacity);
        let pass = MeshLight {
            turns: space.turns,
            particles: space.group.clone(),
            numbers: mesh.particles.numbers.texels(WORD),
            found: mesh.particles.head.texels(WORD),
            starts: mesh.lists.starts.texels(WORD),
            entries: mesh.lists.entries.texels(WORD),
            irradiance: irradiance.texels(FLOATS4),
            received: received.start(),
            push: MeshLightPush { all_lists: u32::from(mesh.lists.of_all), capacity: capacity as u32 },
        };
        let pass = graph.pass("diffuse/particles/shade/radiance-particles", pass);
        pass.threads_indirect(mesh.particles.head, 0);
        Lit { area_particles: irradiance, radiance_particles: received }
    }

    /// The slot.
    fn shade(
        &self,
        graph: &mut Graph<'_>,
        space: &ParticleSpace,
        mesh: &MeshReceivers,
        (surface, shift): (&GBuffer, [f32; 3]),
    ) -> ImageRef {
        let diffuse = graph.image("particles.diffuse", vk::Format::R32G32B32A32_SFLOAT, surface.size);
        let pass = MeshShade {
            turns: space.turns,
            particles: space.group.clone(),
            surface: surface.group.clone(),
            spots: mesh.spots.pixels.sampled(),
            tessellation: mesh.tessellation.clone(),
            particle_marks: mesh.particles.marks.texels(WORD),
            marked_before: mesh.particles.starts.texels(WORD),
            radiance_particles: self.radiance_particles.texels(FLOATS4),
            list_lengths: space.list_lengths.texels(WORD),
            lists: space.lists.texels(WORD),
            irradiance: self.area_particles.texels(FLOATS4),
            diffuse: diffuse.write(),
            push: MeshShadePush { shift },
        };
        graph.pass("diffuse/particles/shade/pixels", pass).pixels(surface.size);
        diffuse
    }

    /// The irradiance at the points.
    fn mirrored(
        &self,
        graph: &mut Graph<'_>,
        space: &ParticleSpace,
        mesh: &MeshReceivers,
        points: &MirroredPoints,
    ) -> MirroredLight {
        let lists = points.lists.iter().zip(&mesh.spots.mirrored).enumerate();
        let received = lists.map(|(number, (list, spots))| {
            let received = graph.buffer::<[f32; 4]>(&format!("particles.mirrored.{number}"), list.points.count());
            let pass = MeshMirrored {
                turns: space.turns,
                particles: space.group.clone(),
                mirrored: list.group(),
                spots: spots.texels(WORDS4),
                tessellation: mesh.tessellation.clone(),
                particle_marks: mesh.particles.marks.texels(WORD),
                marked_before: mesh.particles.starts.texels(WORD),
                radiance_particles: self.radiance_particles.texels(FLOATS4),
                list_lengths: space.list_lengths.texels(WORD),
                lists: space.lists.texels(WORD),
                irradiance: self.area_particles.texels(FLOATS4),
                received: received.start(),
            };
            graph.pass(&format!("diffuse/particles/mirrored.{number}"), pass).threads_indirect(list.arguments, 0);
            received
        });
        MirroredLight { irradiance: received.collect() }
    }
}
