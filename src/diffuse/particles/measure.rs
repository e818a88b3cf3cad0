//! What particles stand for: facets, and by them areas and albedos.

use super::formats::{FLOAT, FLOATS4, WORD, WORDS2, WORDS4};
use super::moved::{AgainList, Moved, groups_of_list};
use super::place::Placed;
use super::stage::Stage;
use crate::graph::Graph;
use crate::graph::bindings::BufferRef;
use crate::shaders::particles::{
    Catch, CatchPush, Facets, FacetsPush, Matter, MatterPush, TouchedFacets, TouchedFacetsPush,
};

/// Albedo and area of each particle; where some have one, the albedo of broad specular lobes behind those of all.
pub(super) fn measure(graph: &mut Graph<'_>, stage: &Stage) -> BufferRef<[f32; 4]> {
    let Stage { particle_count, broad_lobes, placed, kept, moved, lost } = stage;
    let (particle_count, broad_lobes, triangle_count) = (*particle_count, *broad_lobes, placed.triangle_count);
    let (homes, tallies, key) = (kept.homes, kept.tallies, kept.key());
    let room = homes.count() as u32;
    cut(graph, stage);
    if moved.is_none() {
        graph.fill_buffer("diffuse/particles/measure/clear", tallies, 0);
    }
    let again = moved.as_ref().map(|moved| touched_facets(graph, placed, kept.facets, (moved, homes)));
    let [head, list] = AgainList::bind(again);
    let pass = Catch {
        broad_lobes,
        scene_rays: placed.rays.clone(),
        particles: placed.group.clone(),
        facets: kept.facets.texels(WORDS2),
        tallies: tallies.read_write(),
        lost: lost.read_write(),
        homes: if again.is_some() { homes.read_write() } else { homes.start_then_read() },
        head,
        again: list,
        facet_size: kept.facet_size.uniform(),
        areas: placed.areas.texels(FLOAT),
        push: CatchPush { triangle_count, again: u32::from(again.is_some()) },
    };
    let pass = graph.pass("diffuse/particles/measure/catch", pass).leaves(homes, key).leaves(tallies, key);
    let pass = pass.count("lost", *lost, 0);
    match again {
        Some(AgainList { head, .. }) => pass.count("facets", head, 3).threads_indirect(head, 0),
        None => pass.count("facets", kept.facets, 2 * triangle_count as usize).groups(groups_of_list(room)),
    }
    let matter = graph.buffer::<[f32; 4]>("particles.matter", ((1 + broad_lobes) * particle_count) as usize);
    let pass = Matter {
        broad_lobes,
        tallies: tallies.texels(WORDS4),
        facet_size: kept.facet_size.uniform(),
        matter: matter.write(),
        push: MatterPush { particle_count },
    };
    graph.pass("diffuse/particles/measure/matter", pass).threads(stage.threads());
    matter
}

/// Cuts cells into facets.
fn cut(graph: &mut Graph<'_>, Stage { placed, kept, .. }: &Stage) {
    let (triangle_count, key) = (placed.triangle_count, kept.cut_key());
    let pass = Facets {
        adaptive: placed.cells.adaptive,
        cells: placed.cells.records.texels(WORDS2),
        weights: placed.cells.weights.texels(WORDS2),
        sizes: placed.cells.sizes.texels(FLOATS4),
        spacing: placed.spacing.texels(FLOAT),
        facets: kept.facets.write(),
        facet_size: kept.facet_size.write(),
        push: FacetsPush { triangle_count, room: kept.homes.count() as u32 },
    };
    let pass = graph.pass("diffuse/particles/measure/facets", pass);
    pass.leaves(kept.facets, key).leaves(kept.facet_size, key).groups([1, 1, 1]);
}

/// The facets whose particle may be another one.
fn touched_facets(
    graph: &mut Graph<'_>,
    placed: &Placed,
    facets: BufferRef<u32>,
    (moved, homes): (&Moved, BufferRef<u32>),
) -> AgainList {
    let most = homes.count() as u32;
    let room = AgainList::room(graph, "measure", most);
    AgainList::declare(graph, ("measure", 0), room, most, |graph, AgainList { head, list }, capacity| {
        let pass = TouchedFacets {
            homes: homes.texels(WORD),
            touched: moved.touched.texels(WORD),
            head: head.read_write(),
            again: list.start(),
            facets: facets.texels(WORDS2),
            push: TouchedFacetsPush { triangle_count: placed.triangle_count, capacity },
        };
        graph.pass("diffuse/particles/measure/touched", pass).unordered().groups(groups_of_list(most));
    })
}
