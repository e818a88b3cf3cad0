//! The last stage: which particles the picture shows, their irradiance, and the picture. It follows the camera.

use super::formats::{FLOATS4, WORD};
use super::geometry::ParticleSpace;
use super::mesh::{self, MeshReceivers};
use super::mirrored;
use super::options::{ParticlesOptions, ParticlesReceivers};
use super::receivers::{Near, Receivers};
use crate::frame::mirrored::MirroredPoints;
use crate::frame::rays::TracedScene;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef, ReadWriteBuffer};
use crate::method::FrameCx;
use crate::shaders::particles::{Gather, GatherPush, Used, UsedPush};

/// Declares the stage; returns the slot.
pub(super) fn shade(
    cx: &mut FrameCx<'_, '_>,
    scene: &TracedScene,
    space: &ParticleSpace,
    shift: [f32; 3],
    options: &ParticlesOptions,
    radiance: BufferRef<[f32; 4]>,
) -> ImageRef {
    let surface = cx.frame.surface;
    let (offers, points) = (&cx.frame.offers, cx.frame.offers.get::<MirroredPoints>());
    let graph = &mut *cx.graph;
    let marks = graph.buffer::<u32>("particles.marks", space.count as usize);
    graph.fill_buffer("diffuse/particles/find/clear", marks, 0);
    let used = graph.buffer::<u32>("particles.used", space.count as usize);
    let counts = graph.buffer::<u32>("particles.used_counts", 2);
    graph.fill_buffer("diffuse/particles/find/clear-used", used, 0);
    graph.fill_buffer("diffuse/particles/find/clear-counts", counts, 0);
    if options.receivers == ParticlesReceivers::Mesh {
        if options.near > 0 {
            graph.skip("diffuse/particles/shade/near", "radiance particles are read, not regions");
        }
        let seen = (surface, shift, points.as_deref());
        let receivers = MeshReceivers::find(graph, scene, space, seen, options, marks);
        receivers.mark_used(graph, used, counts);
        mark_used(graph, space, marks, (used, counts));
        let Gathered { irradiance, .. } = gather(graph, space, (options, false), used, radiance);
        let (diffuse, mirrored) = mesh::light(graph, space, &receivers, seen, irradiance);
        mirrored.into_iter().for_each(|light| offers.put(light));
        return diffuse;
    }
    let receivers = Receivers::find(graph, surface, space, shift, options, marks);
    let mirrored_homes = points.as_ref().map(|points| mirrored::mark(graph, space, points, marks));
    mark_used(graph, space, marks, (used, counts));
    let near = options.near > 0 && receivers.are_regions();
    if options.near > 0 && !near {
        graph.skip("diffuse/particles/shade/near", "pixels are read, not regions");
    }
    let Gathered { irradiance, far } = gather(graph, space, (options, near), used, radiance);
    if let (Some(points), Some(homes)) = (&points, &mirrored_homes) {
        offers.put(mirrored::light(graph, space, points, homes, irradiance));
    }
    let near = far.map(|far| Near { far, radiance, side: options.near });
    receivers.light(graph, (surface, shift), space, irradiance, near)
}

/// Marks the particles in the lists of those that are marked.
fn mark_used(
    graph: &mut Graph<'_>,
    space: &ParticleSpace,
    marks: BufferRef<u32>,
    (used, counts): (BufferRef<u32>, BufferRef<u32>),
) {
    let pass = Used {
        marks: marks.texels(WORD),
        list_lengths: space.list_lengths.texels(WORD),
        lists: space.lists.texels(WORD),
        used: used.read_write(),
        counts: counts.read_write(),
        push: UsedPush { particle_count: space.count },
    };
    let pass = graph.pass("diffuse/particles/find/used", pass).count("homes", counts, 0).count("particles", counts, 1);
    pass.threads([space.count, 1, 1]);
}

/// The irradiance of those that are used.
struct Gathered {
    irradiance: BufferRef<[f32; 4]>,
    /// By what is not near (glsl/particles/gather.comp).
    far: Option<BufferRef<[f32; 4]>>,
}

fn gather(
    graph: &mut Graph<'_>,
    space: &ParticleSpace,
    (options, near): (&ParticlesOptions, bool),
    used: BufferRef<u32>,
    radiance: BufferRef<[f32; 4]>,
) -> Gathered {
    let particle_count = space.count;
    let texels = ((1 + space.turns) * particle_count) as usize;
    let irradiance = graph.buffer::<[f32; 4]>("particles.irradiance", texels);
    let far = near.then(|| graph.buffer::<[f32; 4]>("particles.far", texels));
    for (number, chunk) in space.chunks.iter().enumerate() {
        let into = |whole: BufferRef<[f32; 4]>| if number == 0 { whole.start_then_read() } else { whole.read_write() };
        let pass = Gather {
            turns: space.turns,
            near: u32::from(near),
            particles: space.group.clone(),
            used: used.texels(WORD),
            links: chunk.links.texels(WORD),
            radiance: radiance.texels(FLOATS4),
            matter: space.matter.texels(FLOATS4),
            irradiance: into(irradiance),
            far: far.map_or(ReadWriteBuffer::absent(), into),
            push: GatherPush {
                first: chunk.first,
                count: chunk.count,
                particle_count,
                gather_side: options.gather,
                parts: options.interleave,
            },
        };
        graph.pass(&format!("diffuse/particles/gather.{number}"), pass).threads([chunk.count, 1, 1]);
    }
    Gathered { irradiance, far }
}
