//! Options of `volumes`.

use crate::method::{OptionKind, choices, options};

choices! {
    /// Whether light on its way to a cache may be blocked.
    VolumesVisibility {
        /// It never is.
        None = "none",
        /// One ray for each group of lights and cache.
        Rays = "rays",
    }
}
choices! {
    /// Where caches lie.
    VolumesPlacement {
        /// On the nodes of the grid: the paper.
        Grid = "grid",
        /// Those behind the surfaces that ask for them, in front of these.
        Visible = "visible",
    }
}
choices! {
    /// What caches count by beside their distances.
    VolumesWeights {
        /// Nothing: the paper.
        Trilinear = "trilinear",
        /// Whether they are seen: a ray from each pixel to each of its caches.
        Rays = "rays",
    }
}
choices! {
    /// What a virtual area light's area A adds to the squared distance d².
    VolumesVal {
        /// A: the paper.
        Paper = "paper",
        /// A/π, a disc's irradiance on its axis.
        Disc = "disc",
    }
}

options! {
    /// Options of the `volumes` diffuse method (Reich 2015).
    VolumesOptions, "volumes":
    /// The light views are reduced to the square of this many virtual area lights, all together, or as near to it as blocks of whole powers of two come.
    lights: u32 = 64, draft = 32, high = 128, paper = 64; OptionKind::OneOf(&[16, 32, 64, 128, 256, 512]), "", "quadratic";
    /// Address volumes around the camera; cells of each are twice as large as those of the one before it.
    cascades: u32 = 4; OptionKind::Integer(1, 8), "volumes", "";
    /// Nodes along an edge of an address volume. Where cells follow from the scene, more make them smaller.
    resolution: u32 = 64, draft = 32, high = 128, paper = 32; OptionKind::OneOf(&[16, 32, 64, 128]), "nodes", "quadratic";
    /// Cell of the finest volume. 0: so large that the last volume holds the scene wherever the camera is in it. Doubled until it does.
    cell: f64 = 0.0; OptionKind::Number(0.0, 1e9), "m", "falls";
    /// Bands of spherical harmonics.
    bands: u32 = 3, paper = 2; OptionKind::OneOf(&[2, 3]), "bands", "linear";
    /// Whether light may be blocked on its way to a cache.
    visibility: VolumesVisibility = VolumesVisibility::Rays, paper = VolumesVisibility::None; OptionKind::Choice(VolumesVisibility::NAMES), "", "";
    /// 4 to this power of lights share one visibility.
    lod: u32 = 1, draft = 2, paper = 2; OptionKind::Integer(0, 4), "", "falls";
    /// Where caches lie.
    placement: VolumesPlacement = VolumesPlacement::Visible, paper = VolumesPlacement::Grid; OptionKind::Choice(VolumesPlacement::NAMES), "", "";
    /// What caches count by, beside their distances, for a pixel between them.
    weights: VolumesWeights = VolumesWeights::Trilinear, high = VolumesWeights::Rays; OptionKind::Choice(VolumesWeights::NAMES), "", "";
    /// What the area of a virtual area light adds to the squared distance.
    val: VolumesVal = VolumesVal::Disc, paper = VolumesVal::Paper; OptionKind::Choice(VolumesVal::NAMES), "", "";
}
