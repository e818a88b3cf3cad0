//! Specular events as bounces (glsl/particles/events.glsl): what is told apart where their number is limited.

use super::options::ParticlesOptions;
use crate::frame::rays::TracedScene;

/// In a row at most, as in glsl/particles/specular.glsl.
const MOST_SPECULAR: u32 = 8;

/// How light is told apart by the specular events that it met on its way to a particle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Levels {
    /// Sums of light of 0, 1, … events; 0: one sum of all.
    pub(super) told_apart: u32,
}

impl Levels {
    /// Those that so many scattering steps can tell apart: none where bounces are not limited or nothing is specular.
    pub(super) fn new(scene: &TracedScene, options: &ParticlesOptions) -> Levels {
        let limit = options.bounces.filter(|_| scene.facts.specular);
        Levels { told_apart: limit.map_or(0, |steps| 1 + steps.min(MOST_SPECULAR)) }
    }

    /// How many times the particles light is kept of all of them.
    pub(super) fn count(self) -> u32 {
        self.told_apart.max(1)
    }

    /// Those of light that met specular surfaces, where any of it is kept apart.
    pub(super) fn late(self) -> u32 {
        self.count() - 1
    }

    /// Steps or bounces of which something is still to be read or added to at the same time, out of so many.
    pub(super) fn ring(self, steps: u32) -> u32 {
        steps.min(MOST_SPECULAR + 2)
    }
}
