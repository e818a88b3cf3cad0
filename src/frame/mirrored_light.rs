//! Light at points that mirrors and glass show: of lamps, of emissive surfaces and of the sky, by rays.

use super::mirrored::MirroredList;
use super::rays::TracedScene;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ReadWriteBuffer};
use crate::shaders::groups::{Lobes, SceneLights, SceneRays};
use crate::shaders::mirrored::{Emitters, EmittersPush, Punctual, PunctualPush, Sky, SkyPush};

/// Of the points' own lobes: the light that they reflect.
const REFLECTION: Lobes = Lobes { specular_lobes: 1, transmissive: 0 };

/// What shines on the points of one list.
pub(crate) struct Shining<'a> {
    /// Of the passes, and the list's number.
    names: (String, usize),
    list: MirroredList,
    scene: &'a TracedScene,
    rays: SceneRays,
    lights: SceneLights,
    /// Whether some points are first surfaces.
    has_first: bool,
    /// What of it pixels see at each point.
    pub(crate) light: BufferRef<[f32; 4]>,
}

impl<'a> Shining<'a> {
    pub(crate) fn new(
        graph: &mut Graph<'_>,
        scene: &'a TracedScene,
        list: MirroredList,
        (level, number): (&str, usize),
        has_first: bool,
    ) -> Shining<'a> {
        let name = level.trim_start_matches("specular/").replace('/', ".");
        let light = graph.buffer(&format!("{name}.{number}"), list.points.count());
        let (rays, lights) = (scene.rays(graph), scene.lights(graph));
        Shining { names: (level.to_owned(), number), list, scene, rays, lights, has_first, light }
    }

    /// The light of punctual lights: it is without noise. Returns whether there are any.
    pub(crate) fn find_punctual(&self, graph: &mut Graph<'_>) -> bool {
        let shines = self.scene.punctual_count > 0;
        match shines {
            true => self.punctual(graph, &self.name("punctual")),
            false => graph.skip(&self.name("punctual"), "no punctual light"),
        }
        shines
    }

    /// That of emissive surfaces and the sky, added to what was `found`.
    pub(crate) fn find_others(&self, graph: &mut Graph<'_>, found: bool, samples: u32) {
        let emissive = self.scene.emissive_count > 0;
        match emissive {
            true => self.emitters(graph, &self.name("emitters"), found, samples),
            false => graph.skip(&self.name("emitters"), "no emissive surface"),
        }
        match self.scene.sky.iter().any(|&channel| channel > 0.0) {
            true => self.sky(graph, &self.name("sky"), found || emissive, samples),
            false => graph.skip(&self.name("sky"), "no sky"),
        }
    }

    fn name(&self, kind: &str) -> String {
        format!("{}/{kind}.{}", self.names.0, self.names.1)
    }

    fn sum(&self, found: bool) -> ReadWriteBuffer<[f32; 4]> {
        if found { self.light.read_write() } else { self.light.start_then_read() }
    }

    fn punctual(&self, graph: &mut Graph<'_>, name: &str) {
        let pass = Punctual {
            scene_rays: self.rays.clone(),
            scene_lights: self.lights.clone(),
            mirrored: self.list.group(),
            lobes: REFLECTION,
            adds_light: 0,
            light: self.sum(false),
            push: PunctualPush { light_count: self.scene.punctual_count },
        };
        graph.pass(name, pass).threads_indirect(self.list.arguments, 0);
    }

    fn emitters(&self, graph: &mut Graph<'_>, name: &str, found: bool, samples: u32) {
        let pass = Emitters {
            scene_rays: self.rays.clone(),
            scene_lights: self.lights.clone(),
            mirrored: self.list.group(),
            lobes: REFLECTION,
            adds_light: u32::from(found),
            has_first: u32::from(self.has_first),
            light: self.sum(found),
            push: EmittersPush {
                emitter_count: self.scene.emissive_count,
                sample_count: samples,
                density_scale: self.scene.emissive_density_scale,
            },
        };
        graph.pass(name, pass).threads_indirect(self.list.arguments, 0);
    }

    fn sky(&self, graph: &mut Graph<'_>, name: &str, found: bool, samples: u32) {
        let pass = Sky {
            scene_rays: self.rays.clone(),
            mirrored: self.list.group(),
            lobes: REFLECTION,
            adds_light: u32::from(found),
            light: self.sum(found),
            push: SkyPush { sky: self.scene.sky, sample_count: samples },
        };
        graph.pass(name, pass).threads_indirect(self.list.arguments, 0);
    }
}
