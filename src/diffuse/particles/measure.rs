//! What particles stand for: areas and albedos.

use super::formats::{FLOAT, WORD, WORDS4};
use super::kept::POINTS;
use super::moved::{AgainList, Moved};
use super::place::backs_of;
use super::stage::Stage;
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::particles::{Catch, CatchPush, Matter, MatterPush, TouchedPoints, TouchedPointsPush};

/// Albedo and area of each particle; where some have one, the albedo of broad specular lobes behind those of all.
pub(super) fn measure(graph: &mut Graph<'_>, stage: &Stage) -> BufferRef<[f32; 4]> {
    let Stage { particle_count, broad_lobes, placed, kept, moved, lost } = stage;
    let (particle_count, broad_lobes, triangle_count) = (*particle_count, *broad_lobes, placed.triangle_count);
    let (homes, tallies, key) = (kept.homes, kept.tallies, kept.key());
    let point_count = POINTS * particle_count;
    if moved.is_none() {
        graph.fill_buffer("diffuse/particles/measure/clear", tallies, 0);
    }
    let again = moved.as_ref().map(|moved| touched_points(graph, moved, homes, point_count));
    let [head, list] = AgainList::bind(again);
    let pass = Catch {
        broad_lobes,
        scene_rays: placed.rays.clone(),
        particles: placed.group.clone(),
        sums: placed.sums.texels(FLOAT),
        tallies: tallies.read_write(),
        lost: lost.read_write(),
        homes: if again.is_some() { homes.read_write() } else { homes.start_then_read() },
        head,
        again: list,
        has_backs: u32::from(placed.backs.is_some()),
        backs: backs_of(placed.backs),
        push: CatchPush { triangle_count, point_count, again: u32::from(again.is_some()) },
    };
    let pass = graph.pass("diffuse/particles/measure/catch", pass).leaves(homes, key).leaves(tallies, key);
    let pass = pass.count("lost", *lost, 0);
    match again {
        Some(AgainList { head, .. }) => pass.count("points", head, 3).threads_indirect(head, 0),
        None => pass.note("points", u64::from(point_count)).threads([point_count, 1, 1]),
    }
    let matter = graph.buffer::<[f32; 4]>("particles.matter", ((1 + broad_lobes) * particle_count) as usize);
    let pass = Matter {
        broad_lobes,
        tallies: tallies.texels(WORDS4),
        sums: placed.sums.texels(FLOAT),
        matter: matter.write(),
        push: MatterPush { triangle_count, point_count, particle_count },
    };
    graph.pass("diffuse/particles/measure/matter", pass).threads(stage.threads());
    matter
}

/// The points whose particle may be another one.
fn touched_points(graph: &mut Graph<'_>, moved: &Moved, homes: BufferRef<u32>, point_count: u32) -> AgainList {
    let room = AgainList::room(graph, "measure", point_count);
    AgainList::declare(graph, ("measure", 0), room, point_count, |graph, AgainList { head, list }, capacity| {
        let pass = TouchedPoints {
            homes: homes.texels(WORD),
            touched: moved.touched.texels(WORD),
            head: head.read_write(),
            again: list.start(),
            push: TouchedPointsPush { point_count, capacity },
        };
        graph.pass("diffuse/particles/measure/touched", pass).unordered().threads([point_count, 1, 1]);
    })
}
