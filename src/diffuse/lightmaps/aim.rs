//! The approximated illumination map: what texels receive of the lights, and along links of each other.

use super::formats::{FLOATS4, WORDS2};
use super::lamps::Lamps;
use super::options::LightmapsOptions;
use super::texels::LightTexels;
use crate::frame::rays::{Lightmap, TracedScene};
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::shaders::groups::{Lightmap as LightmapGroup, SceneRays};
use crate::shaders::lightmaps::{Bounce, BouncePush, Direct, DirectPush};

/// Bounces at most.
const MOST_BOUNCES: u32 = 64;

/// What the AIM is made of.
pub(super) struct Approximated {
    /// Of the lights alone, W/m².
    pub(super) direct: BufferRef<[f32; 4]>,
    /// Bounces along links.
    pub(super) bounces: u32,
    sky: [f32; 3],
    /// How many maps there are, one behind the other, and which one is that of the rest; `maps`: none is.
    maps: u32,
    rest: u32,
}

/// Flux that the bounces leave, at most. What is left makes no texel renew itself when the bounces go on later (glsl/lightmaps/rank.comp).
const LEFT: f64 = 0.002;

/// Bounces after which so little is left, if surfaces reflect `albedo` of what they receive.
fn bounces_for(albedo: f64) -> u32 {
    ((LEFT.ln() / albedo.clamp(1e-3, 0.99).ln()).ceil() as u32).clamp(1, MOST_BOUNCES)
}

/// Texels that lights shine on.
pub(super) struct Lit<'a> {
    pub(super) map: &'a Lightmap,
    pub(super) rays: &'a SceneRays,
    pub(super) group: &'a LightmapGroup,
    pub(super) lamps: &'a Lamps,
}

impl Lit<'_> {
    /// Declares the pass that finds what comes of the lights.
    pub(super) fn declare(
        &self,
        graph: &mut Graph<'_>,
        scene: &TracedScene,
        direct: BufferRef<[f32; 4]>,
        options: &LightmapsOptions,
        name: &str,
    ) {
        let emissive = scene.emissive_count > 0;
        let sky = scene.sky.iter().any(|&channel| channel > 0.0);
        let sample_count = if emissive { options.samples } else { 0 };
        let direction_count = if emissive || sky { options.samples } else { 0 };
        let pass = Direct {
            scene_rays: self.rays.clone(),
            scene_lights: self.lamps.lights.clone(),
            lightmap: self.group.clone(),
            direct: direct.write(),
            push: DirectPush {
                texel_count: self.map.count,
                light_count: self.lamps.punctual_count,
                emitter_count: scene.emissive_count,
                sample_count,
                direction_count,
                density_scale: scene.emissive_density_scale,
                sky: scene.sky,
                own_maps: self.lamps.own,
                rest: u32::from(self.lamps.rest),
            },
        };
        // A punctual light takes one from each quarter of a texel, and where these are, one asks beforehand.
        let punctual_count = self.lamps.punctual_count;
        let quarters = if punctual_count > 0 { 4 * (1 + punctual_count) } else { 0 };
        let rays = u64::from(quarters + sample_count + direction_count) * self.map.used.len() as u64;
        graph.pass(name, pass).note("rays", rays).threads([self.map.count, 1, 1]);
    }
}

impl Approximated {
    /// Declares the pass that finds what comes of the lights.
    pub(super) fn declare(
        graph: &mut Graph<'_>,
        scene: &TracedScene,
        (texels, lamps): (&LightTexels, &Lamps),
        options: &LightmapsOptions,
    ) -> Approximated {
        let direct = graph.buffer::<[f32; 4]>("lightmaps.direct", texels.count() * lamps.maps() as usize);
        let lit = Lit { map: &texels.map, rays: &texels.rays, group: &texels.group, lamps };
        lit.declare(graph, scene, direct, options, "diffuse/lightmaps/aim/direct");
        let bounces =
            options.bounces.map_or_else(|| bounces_for(scene.greatest_albedo()), |bounces| bounces.max(1) - 1);
        Approximated { direct, bounces, sky: scene.sky, maps: lamps.maps(), rest: lamps.own }
    }

    /// After all bounces, from nothing; `caustics`: what photons bring.
    pub(super) fn settled(
        &self,
        graph: &mut Graph<'_>,
        texels: &LightTexels,
        caustics: Option<BufferRef<[f32; 4]>>,
    ) -> BufferRef<[f32; 4]> {
        self.bounced(graph, texels, (self.direct, caustics), self.bounces, None)
    }

    /// After more bounces of what was there `before`; the last of them may write into a buffer that is there.
    pub(super) fn bounced(
        &self,
        graph: &mut Graph<'_>,
        texels: &LightTexels,
        (before, caustics): (BufferRef<[f32; 4]>, Option<BufferRef<[f32; 4]>>),
        bounces: u32,
        last: Option<BufferRef<[f32; 4]>>,
    ) -> BufferRef<[f32; 4]> {
        let mut light = before;
        for number in 0..bounces {
            let after = match last.filter(|_| number + 1 == bounces) {
                Some(last) => last,
                None => {
                    let count = texels.count() * self.maps as usize;
                    graph.buffer::<[f32; 4]>(&format!("lightmaps.bounced.{number}"), count)
                }
            };
            let pass = Bounce {
                direct: self.direct.texels(FLOATS4),
                links: texels.links.texels(WORDS2),
                before: light.texels(FLOATS4),
                has_caustics: u32::from(caustics.is_some()),
                caustics: caustics.map_or(TexelBuffer::absent(), |caustics| caustics.texels(FLOATS4)),
                arrivals: texels.arrivals.texels(FLOATS4),
                after: after.write(),
                push: BouncePush {
                    texel_count: texels.map.count,
                    link_count: texels.link_count,
                    sky: self.sky,
                    maps: self.maps,
                    rest: self.rest,
                },
            };
            let pass = graph.pass(&format!("diffuse/lightmaps/aim/bounce.{number}"), pass);
            pass.threads([self.maps * texels.map.count, 1, 1]);
            light = after;
        }
        light
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounces_leave_little() {
        for albedo in [0.2, 0.5, 0.73, 0.9] {
            let bounces = bounces_for(albedo);
            assert!(albedo.powi(bounces as i32) <= LEFT && albedo.powi(bounces as i32 - 1) > LEFT, "{albedo}");
        }
        assert_eq!((bounces_for(0.0), bounces_for(1.0)), (1, MOST_BOUNCES));
    }
}
