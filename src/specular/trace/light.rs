//! Light at the points that mirrors and glass show, and the sum of it at each pixel.

use ash::vk;

use super::options::TraceOptions;
use super::walk::{Band, Walked};
use crate::frame::mirrored::MirroredLight;
use crate::frame::rays::TracedScene;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef, ReadWriteBuffer, TexelBuffer};
use crate::shaders::groups::{Lobes, SceneLights, SceneRays};
use crate::shaders::trace::{Emitters, EmittersPush, Punctual, PunctualPush, Resolve, ResolvePush, Sky, SkyPush};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
/// Of the points' own lobes: the light that they reflect.
const REFLECTION: Lobes = Lobes { specular_lobes: 1, transmissive: 0 };

/// Declares the passes; returns the slot.
pub(super) fn light(
    graph: &mut Graph<'_>,
    scene: &TracedScene,
    walked: &Walked,
    diffuse: Option<&MirroredLight>,
    options: &TraceOptions,
) -> ImageRef {
    let size = walked.heads.size();
    let specular = graph.image("trace.specular", FLOATS, size);
    for (number, band) in walked.bands.iter().enumerate() {
        let light = Shining {
            number,
            band: *band,
            scene,
            rays: scene.rays(graph),
            lights: scene.lights(graph),
            light: graph.buffer(&format!("trace.light.{number}"), band.list.points.count()),
        };
        light.declare(graph, options.light_samples);
        let irradiance = diffuse.map(|diffuse| diffuse.irradiance[number]);
        let pass = Resolve {
            has_field: u32::from(irradiance.is_some()),
            heads: walked.heads.sampled(),
            shining: walked.shining.sampled(),
            points: band.list.points.texels(WORDS),
            light: light.light.texels(FLOATS),
            irradiance: irradiance.map_or(TexelBuffer::absent(), |irradiance| irradiance.texels(FLOATS)),
            specular: if number == 0 { specular.start() } else { specular.modify() },
            push: ResolvePush { first_row: band.first_row },
        };
        graph.pass(&format!("specular/trace/resolve.{number}"), pass).pixels([size[0], band.row_count]);
    }
    specular
}

/// What shines on the points of one band.
struct Shining<'a> {
    number: usize,
    band: Band,
    scene: &'a TracedScene,
    rays: SceneRays,
    lights: SceneLights,
    light: BufferRef<[f32; 4]>,
}

impl Shining<'_> {
    /// The passes that the scene's lights need: each adds to what the one before it found.
    fn declare(&self, graph: &mut Graph<'_>, samples: u32) {
        let mut found = false;
        let sky = self.scene.sky.iter().any(|&channel| channel > 0.0);
        let kinds: [(&str, bool, &str); 3] = [
            ("punctual", self.scene.punctual_count > 0, "no punctual light"),
            ("emitters", self.scene.emissive_count > 0, "no emissive surface"),
            ("sky", sky, "no sky"),
        ];
        for (kind, shines, reason) in kinds {
            let name = format!("specular/trace/light/{kind}.{}", self.number);
            if !shines {
                graph.skip(&name, reason);
                continue;
            }
            match kind {
                "punctual" => self.punctual(graph, &name, found),
                "emitters" => self.emitters(graph, &name, found, samples),
                _ => self.sky(graph, &name, found, samples),
            }
            found = true;
        }
    }

    fn sum(&self, found: bool) -> ReadWriteBuffer<[f32; 4]> {
        if found { self.light.read_write() } else { self.light.start_then_read() }
    }

    fn punctual(&self, graph: &mut Graph<'_>, name: &str, found: bool) {
        let pass = Punctual {
            scene_rays: self.rays.clone(),
            scene_lights: self.lights.clone(),
            mirrored: self.band.list.group(),
            lobes: REFLECTION,
            adds_light: u32::from(found),
            light: self.sum(found),
            push: PunctualPush { light_count: self.scene.punctual_count },
        };
        graph.pass(name, pass).threads_indirect(self.band.list.arguments, 0);
    }

    fn emitters(&self, graph: &mut Graph<'_>, name: &str, found: bool, samples: u32) {
        let pass = Emitters {
            scene_rays: self.rays.clone(),
            scene_lights: self.lights.clone(),
            mirrored: self.band.list.group(),
            lobes: REFLECTION,
            adds_light: u32::from(found),
            light: self.sum(found),
            push: EmittersPush {
                emitter_count: self.scene.emissive_count,
                sample_count: samples,
                density_scale: self.scene.emissive_density_scale,
            },
        };
        graph.pass(name, pass).threads_indirect(self.band.list.arguments, 0);
    }

    fn sky(&self, graph: &mut Graph<'_>, name: &str, found: bool, samples: u32) {
        let pass = Sky {
            scene_rays: self.rays.clone(),
            mirrored: self.band.list.group(),
            lobes: REFLECTION,
            adds_light: u32::from(found),
            light: self.sum(found),
            push: SkyPush { sky: self.scene.sky, sample_count: samples },
        };
        graph.pass(name, pass).threads_indirect(self.band.list.arguments, 0);
    }
}
