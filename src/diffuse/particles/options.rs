//! Options of `particles`.

use crate::method::{OptionKind, choices, options};

/// Scattering steps at most.
pub(crate) const MOST_BOUNCES: u32 = 64;

choices! {
    /// Where the picture reads the particles' irradiance.
    ParticlesReceivers {
        /// At regions of several sizes, flat ones, with interpolation between them.
        Regions = "regions",
        /// At every pixel.
        Pixels = "pixels",
        /// At the vertices of a tessellation of the surfaces that the picture shows, with interpolation between them: the paper.
        Mesh = "mesh",
    }
}

choices! {
    /// How densely particles lie.
    ParticleDensity {
        /// Equally everywhere: the paper.
        Even = "even",
        /// Farther apart where other surfaces are far away, or where nothing is seen at all.
        Adaptive = "adaptive",
    }
}

choices! {
    /// Which radiance particles have estimation lists.
    ParticleLists {
        /// All of them, made with the geometry: the paper.
        All = "all",
        /// Those that the picture reads.
        Used = "used",
    }
}

choices! {
    /// How light goes from particle to particle before the last gathering.
    ParticleTransport {
        /// Scattered forwards, one link a particle from the second step on: the paper.
        TwoWay = "two-way",
        /// Gathered by all particles through all their links, bounce by bounce: what the paper compares with.
        GatherOnly = "gather-only",
    }
}

options! {
    /// Options of the `particles` diffuse method (Chang, Park & Ihm). Preset `paper`: its section 5, with the count of three of its six scenes, the bounces of two.
    ParticlesOptions, "particles":
    /// Area particles on all diffuse surfaces; 0: 20,000 to 200,000 by the scene's area.
    count: u32 = 0, draft = 20_000, paper = 150_000; OptionKind::Integer(0, 600_000), "particles", "linear";
    /// How densely particles lie, at the same number. `adaptive` is `even` without a sky or a sun, in scenes with an animation and with `receivers=mesh`; what moves otherwise makes everything anew.
    density: ParticleDensity = ParticleDensity::Adaptive, paper = ParticleDensity::Even; OptionKind::Choice(ParticleDensity::NAMES), "", "";
    /// Scattering steps, the first one included, or gathering steps in their place; the last gathering step is one more. Reflections and refractions count as steps. None: until less than a hundredth of the flux is left.
    bounces: Option<u32> = None, paper = Some(8); OptionKind::Limit(0, MOST_BOUNCES), "scatterings", "linear";
    /// How light goes from particle to particle. Bounces mean the same light paths either way.
    transport: ParticleTransport = ParticleTransport::TwoWay; OptionKind::Choice(ParticleTransport::NAMES), "", "";
    /// Links a side of the square of directions that the first scattering step takes.
    scatter: u32 = 4; OptionKind::OneOf(&[1, 2, 4, 8]), "links", "quadratic";
    /// Links a side of the square of directions that irradiance is gathered by.
    gather: u32 = 16, draft = 8; OptionKind::OneOf(&[8, 16, 24, 32]), "links", "quadratic";
    /// Parts of the links that particles are gathered by: 4: each takes a quarter, its neighbours the others.
    interleave: u32 = 1; OptionKind::OneOf(&[1, 4]), "parts", "falls";
    /// Where the picture reads the particles' irradiance.
    receivers: ParticlesReceivers = ParticlesReceivers::Regions, paper = ParticlesReceivers::Mesh; OptionKind::Choice(ParticlesReceivers::NAMES), "", "";
    /// With `receivers=mesh` how far radiance particles are apart at most; 0: as area particles on average.
    spacing: f64 = 0.0; OptionKind::Number(0.0, 1e6), "metres", "falls with the square";
    /// With `receivers=mesh` which radiance particles have estimation lists.
    lists: ParticleLists = ParticleLists::Used, paper = ParticleLists::All; OptionKind::Choice(ParticleLists::NAMES), "", "";
    /// With `receivers=regions` rays a side of the square of directions in which each region that has something near looks for itself at what is nearer than two spacings of the closest particles; 0: none.
    near: u32 = 0; OptionKind::OneOf(&[0, 2, 4, 8, 16]), "rays", "quadratic";
    /// Photons from lights to mirrors and glass, and on to the first diffuse surface.
    photons: u32 = 200_000, draft = 40_000, high = 1_000_000; OptionKind::Integer(0, 8_000_000), "photons", "linear";
    /// Points of emissive surfaces that each particle sends a ray to.
    emitter_samples: u32 = 8, draft = 4, high = 32; OptionKind::Integer(1, 1024), "rays", "linear";
}
