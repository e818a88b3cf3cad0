//! Links: what particles see of each other.

use super::formats::{FLOATS4, WORD, WORDS4};
use super::kept::{Chunk, Kept};
use super::moved::{AgainList, Moved};
use super::options::ParticlesOptions;
use super::place::Placed;
use super::stage::Stage;
use crate::frame::rays::TracedScene;
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::groups::Lobes;
use crate::shaders::particles::{
    ArrivalsAgain, ArrivalsAgainPush, Links, LinksPush, Strata, StrataPush, TouchedLinks, TouchedLinksPush,
};

/// Those that mirrors and glass have.
pub(super) fn lobes_of(scene: &TracedScene) -> Lobes {
    let facts = &scene.facts;
    Lobes { specular_lobes: u32::from(facts.specular), transmissive: u32::from(facts.transmissive) }
}

/// Invocations that look at the links of one particle, as in glsl/particles/touched_links.comp.
const SHARES: u32 = 8;

/// Traces them, chunk by chunk.
pub(super) fn link(graph: &mut Graph<'_>, scene: &TracedScene, options: &ParticlesOptions, stage: &Stage) {
    let Stage { placed, kept, moved, lost, .. } = stage;
    let Kept { chunks, scatter_links, arrivals, .. } = kept;
    let (gather_side, scatter_side, key) = (options.gather, options.scatter, kept.key());
    if moved.is_none() {
        graph.fill_buffer("diffuse/particles/link/clear", *arrivals, 0);
    }
    let strata = moved.as_ref().map(|_| strata(graph, gather_side));
    let most = chunks.iter().map(|chunk| chunk.count).max().unwrap_or(0) * gather_side * gather_side;
    let room = moved.as_ref().map(|_| AgainList::room(graph, "link", most));
    for (number, &Chunk { first, count, links }) in chunks.iter().enumerate() {
        let again = moved.as_ref().zip(room).zip(strata).map(|((moved, room), strata)| {
            let chunk = (number, &chunks[number], room);
            touched_links(graph, scene, (placed, kept, moved), chunk, ([gather_side, scatter_side], strata))
        });
        let [head, list] = AgainList::bind(again);
        let pass = Links {
            scene_rays: placed.rays.clone(),
            scene_lights: scene.lights(graph),
            particles: placed.group.clone(),
            links: if again.is_some() { links.read_write() } else { links.start_then_read() },
            scatter_links: if number == 0 && again.is_none() {
                scatter_links.start_then_read()
            } else {
                scatter_links.read_write()
            },
            arrivals: arrivals.read_write(),
            has_emitters: u32::from(scene.emissive_count > 0),
            event_levels: kept.sky_levels.told_apart,
            lobes: lobes_of(scene),
            lost: lost.read_write(),
            head,
            again: list,
            facets: kept.facets.read(),
            homes: kept.homes.read(),
            push: LinksPush {
                first,
                count,
                gather_side,
                scatter_side,
                second_ends: kept.second_ends,
                sky_shines: u32::from(kept.sky_shines),
                density_scale: scene.emissive_density_scale,
                emitter_samples: options.emitter_samples as f32,
                greatest_radiance: scene.greatest_radiance,
                again: u32::from(again.is_some()),
                particle_count: stage.particle_count,
            },
        };
        let mut pass = graph.pass(&format!("diffuse/particles/link/trace.{number}"), pass).leaves(links, key);
        if number + 1 == chunks.len() {
            pass = pass.leaves(*scatter_links, key).leaves(*arrivals, key);
        }
        let link_count = gather_side * gather_side;
        let pass = pass.note("links", u64::from(count) * u64::from(link_count)).count("lost", *lost, 1);
        match again {
            Some(AgainList { head, .. }) => pass.count("rays", head, 3).threads_indirect(head, 0),
            None => {
                let rays = u64::from(count) * u64::from(link_count);
                pass.note("rays", rays).threads([link_count, count, 1]);
            }
        }
    }
}

/// Cones around the strata that links go through.
fn strata(graph: &mut Graph<'_>, side: u32) -> BufferRef<[f32; 4]> {
    let strata = graph.buffer("particles.strata", (side * side) as usize);
    let pass = Strata { strata: strata.write(), push: StrataPush { side } };
    graph.pass("diffuse/particles/link/strata", pass).threads([side * side, 1, 1]);
    strata
}

/// The links of a chunk that may be others.
fn touched_links(
    graph: &mut Graph<'_>,
    scene: &TracedScene,
    (placed, kept, moved): (&Placed, &Kept, &Moved),
    (number, chunk, room): (usize, &Chunk, BufferRef<u32>),
    ([gather_side, scatter_side], strata): ([u32; 2], BufferRef<[f32; 4]>),
) -> AgainList {
    let &Chunk { first, count, links } = chunk;
    let states = graph.buffer::<u32>(&format!("particles.link_states.{number}"), count as usize);
    graph.fill_buffer(&format!("diffuse/particles/link/clear-states.{number}"), states, 0);
    let emits = scene.emissive_count > 0;
    let brings = emits || (kept.sky_shines && scene.facts.specular);
    let link_count = count * gather_side * gather_side;
    let again =
        AgainList::declare(graph, ("link", number), room, link_count, |graph, AgainList { head, list }, capacity| {
            for (lights, name) in [(0, "touched"), (1, "touched-lights")].into_iter().take(1 + usize::from(brings)) {
                let pass = TouchedLinks {
                    particles: placed.group.clone(),
                    lobes: lobes_of(scene),
                    moved_triangles: moved.triangles.texels(WORD),
                    boxes: moved.boxes.texels(FLOATS4),
                    touched: moved.touched.texels(WORD),
                    links: links.texels(WORDS4),
                    strata: strata.texels(FLOATS4),
                    states: states.read_write(),
                    head: head.read_write(),
                    again: if lights == 0 { list.start() } else { list.modify() },
                    push: TouchedLinksPush {
                        first,
                        count,
                        gather_side,
                        scatter_side,
                        before_count: moved.before_count,
                        box_count: moved.box_count,
                        capacity,
                        lights,
                    },
                };
                let pass = graph.pass(&format!("diffuse/particles/link/{name}.{number}"), pass).unordered();
                pass.threads([SHARES * count, 1, 1]);
            }
        });
    let pass = ArrivalsAgain {
        has_emitters: u32::from(emits),
        event_levels: kept.sky_levels.told_apart,
        head: again.head.texels(WORD),
        states: states.texels(WORD),
        arrivals: kept.arrivals.read_write(),
        push: ArrivalsAgainPush { first, count, particle_count: kept.list_lengths.count() as u32 },
    };
    graph.pass(&format!("diffuse/particles/link/arrivals.{number}"), pass).threads([count, 1, 1]);
    again
}
