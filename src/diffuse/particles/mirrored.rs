//! The light of particles at points that mirrors and glass show: their particles are marked with those of the picture, so that they gather too, and each point
//! reads the list of its own.

use super::formats::{FLOATS4, WORD};
use super::geometry::ParticleSpace;
use crate::frame::mirrored::{MirroredLight, MirroredList, MirroredPoints};
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::particles::{Mirrored, MirroredHomes};

/// Finds and marks the particle of each point; returns them, list by list.
pub(super) fn mark(
    graph: &mut Graph<'_>,
    space: &ParticleSpace,
    points: &MirroredPoints,
    marks: BufferRef<u32>,
) -> Vec<BufferRef<u32>> {
    let home = |(number, list): (usize, &MirroredList)| {
        let homes = graph.buffer::<u32>(&format!("particles.mirrored_homes.{number}"), list.points.count());
        let pass = MirroredHomes {
            scene_rays: space.rays.clone(),
            particles: space.group.clone(),
            mirrored: list.group(),
            homes: homes.start(),
            marks: marks.read_write(),
        };
        let pass = graph.pass(&format!("diffuse/particles/find/mirrored.{number}"), pass);
        pass.threads_indirect(list.arguments, 0);
        homes
    };
    points.lists.iter().enumerate().map(home).collect()
}

/// The irradiance at the points, once their particles have gathered.
pub(super) fn light(
    graph: &mut Graph<'_>,
    space: &ParticleSpace,
    points: &MirroredPoints,
    homes: &[BufferRef<u32>],
    irradiance: BufferRef<[f32; 4]>,
) -> MirroredLight {
    let received = |(number, (list, homes)): (usize, (&MirroredList, &BufferRef<u32>))| {
        let received = graph.buffer::<[f32; 4]>(&format!("particles.mirrored.{number}"), list.points.count());
        let pass = Mirrored {
            turns: space.turns,
            particles: space.group.clone(),
            mirrored: list.group(),
            homes: homes.texels(WORD),
            list_lengths: space.list_lengths.texels(WORD),
            lists: space.lists.texels(WORD),
            irradiance: irradiance.texels(FLOATS4),
            received: received.start(),
        };
        let pass = graph.pass(&format!("diffuse/particles/mirrored.{number}"), pass);
        pass.threads_indirect(list.arguments, 0);
        received
    };
    MirroredLight { irradiance: points.lists.iter().zip(homes).enumerate().map(received).collect() }
}
