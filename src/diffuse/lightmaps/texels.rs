//! Texels where they lie, which of them lie in the open, which cells are cut, and links. They stand while geometry and materials do.

use std::sync::Arc;

use super::formats::{WORD, WORDS4};
use super::options::LightmapsOptions;
use crate::frame::rays::{Lightmap, Texels, TracedScene};
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::shaders::groups::{Lightmap as LightmapGroup, Lobes, SceneRays};
use crate::shaders::lightmaps::{Cuts, CutsPush, Links, LinksPush, Place, PlacePush, Probe, ProbePush};

/// Links that a buffer holds: 128 MiB, which every device lets a kernel see of one.
const LINKS: u32 = (1 << 27) / 8;

/// Specular events of a link at most, where bounces have no limit.
const MOST_EVENTS: u32 = 7;

/// Texels of which a buffer holds so many links each.
pub(super) const fn most_texels(links: u32) -> u32 {
    LINKS / links
}

/// Texels to gather: groups of 64 in three words and how many there are; their numbers.
#[derive(Clone, Copy)]
pub(super) struct Chosen {
    pub(super) head: BufferRef<u32>,
    pub(super) list: BufferRef<u32>,
    /// There are no more.
    pub(super) most: u32,
}

/// The texels of a frame.
pub(super) struct LightTexels {
    pub(super) map: Arc<Lightmap>,
    pub(super) rays: SceneRays,
    /// Triangles of the hierarchy's leaves.
    pub(super) leaf_triangle_count: u32,
    pub(super) group: LightmapGroup,
    /// Those that are read: groups of 64 in three words, their number; and the numbers of all.
    pub(super) head: BufferRef<u32>,
    pub(super) used: BufferRef<u32>,
    /// Link i of all texels after link i − 1 of all.
    pub(super) links: BufferRef<[u32; 2]>,
    pub(super) link_count: u32,
    /// What comes of emissive surfaces and of the sky by way of mirrors.
    pub(super) arrivals: BufferRef<[f32; 4]>,
}

impl LightTexels {
    /// Declares the passes; `None` if no surface has texels.
    pub(super) fn declare(
        graph: &mut Graph<'_>,
        scene: &TracedScene,
        options: &LightmapsOptions,
    ) -> Option<LightTexels> {
        let map = scene.lightmap(texels_asked(options));
        let texel_count = map.count;
        if map.used.is_empty() {
            graph.skip("diffuse/lightmaps", "no surface that light falls on");
            return None;
        }
        let (threads, count) = ([texel_count, 1, 1], texel_count as usize);
        let rays = scene.rays(graph);
        let (mut group, valid, _) = placed(graph, &rays, &map, ["lightmaps", "diffuse/lightmaps/texels"]);
        let flags = graph.buffer::<u32>("lightmaps.flags", count);
        let counts = graph.buffer::<u32>("lightmaps.cut_counts", 2);
        graph.fill_buffer("diffuse/lightmaps/texels/clear", counts, 0);
        let pass = Cuts {
            scene_rays: rays.clone(),
            lightmap: group.clone(),
            valid: valid.texels(WORD),
            flags: flags.write(),
            counts: counts.read_write(),
            push: CutsPush { texel_count },
        };
        let pass = graph.pass("diffuse/lightmaps/texels/cuts", pass);
        pass.count("hidden", counts, 0).count("cut", counts, 1).threads(threads);
        group.lightmap_flags = flags.texels(WORD);

        // More surfaces than that have a texel each.
        let link_count = options.links.min(LINKS / texel_count).max(1);
        let links = graph.buffer::<[u32; 2]>("lightmaps.links", count * link_count as usize);
        let arrivals = graph.buffer::<[f32; 4]>("lightmaps.arrivals", 2 * count);
        let facts = &scene.facts;
        let pass = Links {
            scene_rays: rays.clone(),
            lightmap: group.clone(),
            lobes: Lobes { specular_lobes: u32::from(facts.specular), transmissive: u32::from(facts.transmissive) },
            links: links.write(),
            arrivals: arrivals.write(),
            push: LinksPush {
                texel_count,
                link_count,
                link_events: options.bounces.map_or(MOST_EVENTS, |bounces| bounces.saturating_sub(2)),
                arrival_events: options.bounces.map_or(MOST_EVENTS, |bounces| bounces.saturating_sub(1)),
            },
        };
        let pass = graph.pass("diffuse/lightmaps/texels/links", pass);
        pass.note("rays", map.used.len() as u64 * u64::from(link_count)).threads(threads);
        let used = map.used(graph);
        let number = map.used.len() as u32;
        let head = graph.upload(
            "lightmaps.used_head",
            &[number.div_ceil(64), 1, 1, number],
            crate::graph::Dependence::GEOMETRY,
        );
        let leaf_triangle_count = scene.leaf_triangle_count;
        Some(LightTexels { map, rays, leaf_triangle_count, group, head, used, links, link_count, arrivals })
    }

    pub(super) fn count(&self) -> usize {
        self.map.count as usize
    }

    /// All of them, to gather.
    pub(super) fn all(&self) -> Chosen {
        Chosen { head: self.head, list: self.used, most: self.map.used.len() as u32 }
    }

    pub(super) fn threads(&self) -> [u32; 3] {
        [self.map.count, 1, 1]
    }
}

/// How finely the options cut.
pub(super) fn texels_asked(options: &LightmapsOptions) -> Texels {
    Texels { size: options.texel, count: options.count, most: most_texels(options.links) }
}

/// Places texels, and finds those within geometry: the group that says where they are and which lie in the open, the latter by itself, and on which
/// triangles they are. Names: of buffers, of passes.
pub(super) fn placed(
    graph: &mut Graph<'_>,
    rays: &SceneRays,
    map: &Lightmap,
    [buffers, passes]: [&str; 2],
) -> (LightmapGroup, BufferRef<u32>, TexelBuffer) {
    let (texel_count, count) = (map.count, map.count as usize);
    let (charts, places) = (map.charts(graph), map.places(graph));
    let placed = graph.buffer::<[u32; 4]>(&format!("{buffers}.texels"), 2 * count);
    let pass = Place {
        scene_rays: rays.clone(),
        places: places.clone(),
        charts: charts.clone(),
        texels_out: placed.write(),
        push: PlacePush { texel_count },
    };
    let pass = graph.pass(&format!("{passes}/place"), pass).note("surfaces", u64::from(map.surface_count));
    pass.note("texels", map.used.len() as u64).threads([texel_count, 1, 1]);
    let valid = graph.buffer::<u32>(&format!("{buffers}.valid"), count);
    let group = LightmapGroup {
        lightmap_charts: charts,
        lightmap_texels: placed.texels(WORDS4),
        lightmap_flags: valid.texels(WORD),
    };
    let pass = Probe {
        scene_rays: rays.clone(),
        lightmap: group.clone(),
        valid: valid.write(),
        push: ProbePush { texel_count },
    };
    graph.pass(&format!("{passes}/probe"), pass).threads([texel_count, 1, 1]);
    (group, valid, places)
}
