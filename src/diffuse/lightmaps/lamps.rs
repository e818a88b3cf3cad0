//! Lights that have maps of their own: the light of such a map is that of its light at an intensity of 1 in each channel, and what is shown of it is multiplied by the
//! light's intensity. So one that is dimmed, tinted or switched leaves all that is kept as it is. Emissive surfaces, the sky and all other lights share the last map.

use super::formats::{FLOATS4, WORDS4};
use super::options::LightmapsOptions;
use super::texels::LightTexels;
use crate::frame::rays::TracedScene;
use crate::graph::bindings::BufferRef;
use crate::graph::{Dependence, Graph, hash_of};
use crate::shaders::groups::SceneLights;
use crate::shaders::lightmaps::{Combine, CombinePush};
use crate::shaders::types;

/// The lights of a frame as the maps know them.
pub(super) struct Lamps {
    /// Punctual ones, those with maps of their own first, and emissive surfaces.
    pub(super) lights: SceneLights,
    pub(super) punctual_count: u32,
    /// How many have maps of their own.
    pub(super) own: u32,
    /// Whether there is a map of the rest.
    pub(super) rest: bool,
    /// What each map is multiplied by.
    pub(super) tints: BufferRef<[f32; 4]>,
    /// What all but the sky send out, W (luminance), as the maps know them.
    pub(super) power: f64,
    /// Names them.
    pub(super) key: u64,
}

impl Lamps {
    /// `options.per_light` of the scene's lights, by their order there: the same ones whatever they send out.
    pub(super) fn declare(graph: &mut Graph<'_>, scene: &TracedScene, options: &LightmapsOptions) -> Lamps {
        let lights = scene.lights(graph);
        let own = (options.per_light as usize).min(scene.lamps.len());
        if own == 0 {
            let key = hash_of(&(scene.key, scene.sky.map(f32::to_bits)));
            let (punctual_count, power) = (scene.punctual_count, scene.power);
            let tints = graph.upload("lightmaps.tints", &[[1.0_f32; 4]], Dependence::LIGHTS);
            return Lamps { lights, punctual_count, own: 0, rest: true, tints, power, key };
        }
        let sky = scene.sky.iter().any(|&channel| channel > 0.0);
        let (first, others) = scene.lamps.split_at(own);
        let others: Vec<_> = others.iter().filter(|lamp| lamp.luminance() > 0.0).collect();
        let mut punctual: Vec<types::Light> =
            first.iter().map(|lamp| types::Light { intensity: [1.0; 3], ..lamp.light }).collect();
        punctual.extend(others.iter().map(|lamp| lamp.light));
        let rest = !others.is_empty() || scene.emissive_count > 0 || sky;
        let tint = |[red, green, blue]: [f32; 3]| [red, green, blue, 0.0];
        let mut tints: Vec<[f32; 4]> = first.iter().map(|lamp| tint(lamp.light.intensity)).collect();
        tints.extend(rest.then_some([1.0; 4]));
        let power = first.iter().map(|lamp| lamp.extent).sum::<f64>()
            + others.iter().map(|lamp| lamp.luminance() * lamp.extent).sum::<f64>()
            + scene.emissive_power;
        let words: &[u32] = bytemuck::cast_slice(&punctual);
        let key = hash_of(&(scene.surfaces_key(), words, scene.sky.map(f32::to_bits)));
        let punctual_lights = graph.upload("lightmaps.lamps", words, Dependence::LIGHTS).texels(WORDS4);
        let tints = graph.upload("lightmaps.tints", &tints, Dependence::LIGHTS);
        let (punctual_count, own) = (punctual.len() as u32, own as u32);
        Lamps { lights: SceneLights { punctual_lights, ..lights }, punctual_count, own, rest, tints, power, key }
    }

    /// How many maps there are.
    pub(super) fn maps(&self) -> u32 {
        self.own + u32::from(self.rest)
    }

    /// The light of all maps together.
    pub(super) fn combined(
        &self,
        graph: &mut Graph<'_>,
        texels: &LightTexels,
        (light, name): (BufferRef<[f32; 4]>, &str),
    ) -> BufferRef<[f32; 4]> {
        if self.own == 0 {
            return light;
        }
        let combined = graph.buffer::<[f32; 4]>(&format!("lightmaps.combined.{name}"), texels.count());
        let pass = Combine {
            light: light.texels(FLOATS4),
            tints: self.tints.texels(FLOATS4),
            combined: combined.write(),
            push: CombinePush { texel_count: texels.map.count, maps: self.maps() },
        };
        graph.pass(&format!("diffuse/lightmaps/shade/combine.{name}"), pass).threads(texels.threads());
        combined
    }
}
