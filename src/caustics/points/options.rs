//! Options of `points`.

use crate::method::{OptionKind, choices, options};

choices! {
    /// Where points are filtered.
    PointFilter {
        /// On the screen, over 7×7 pixels: the paper.
        Screen = "screen",
        /// On the surface, over so many metres.
        World = "world",
    }
}
choices! {
    /// Which tiles of the screen are filtered.
    PointTiles {
        /// Those that photons reach, out of a list that the device makes.
        List = "list",
        /// All of them.
        All = "all",
    }
}

options! {
    /// Options of the `points` caustics method (Larsen & Christensen 2004, section 5).
    PointOptions, "points":
    /// Photons towards the specular surfaces which lights see; buffers of 128 MiB hold 2.1 million over `bounces`. All of them are sent.
    photons: u32 = 10_000, draft = 2_500, high = 40_000; OptionKind::Integer(0, 1 << 20), "photons", "linear";
    /// Frames over which all of them are sent again where something changed; caustics trail behind what moves by as many. The first frame sends all.
    frames: u32 = 8; OptionKind::Integer(1, 64), "frames", "inverse, of a frame in which something moves";
    /// Specular reflections and refractions of a photon at most; 0: no caustics.
    bounces: u32 = 2, high = 4; OptionKind::Integer(0, 16), "scatterings", "linear";
    /// Where points are filtered.
    filter: PointFilter = PointFilter::World, paper = PointFilter::Screen; OptionKind::Choice(PointFilter::NAMES), "", "";
    /// Radius of the filter `world` on the surface; 0: of each photon its own ellipse, as wide as its neighbours land apart.
    radius: f64 = 0.0; OptionKind::Number(0.0, 1e4), "m", "quadratic";
    /// Which tiles of 8×8 pixels are filtered. The light is the same.
    tiles: PointTiles = PointTiles::List; OptionKind::Choice(PointTiles::NAMES), "", "";
}
