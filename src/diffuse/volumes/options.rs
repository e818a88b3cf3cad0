//! Options of `volumes`.

use crate::frame::caches::{CacheSettings, CacheSight, CascadeRule, LightRule, PlaceRule};
use crate::frame::voxels::{VoxelSettings, Voxelisation};
use crate::method::{OptionKind, choices, options};

choices! {
    /// Whether light on its way to a cache may be blocked.
    VolumesVisibility {
        /// It never is.
        None = "none",
        /// One ray for each group of lights and cache.
        Rays = "rays",
        /// One cone for each, through voxels: the paper.
        Cones = "cones",
    }
}
choices! {
    /// How triangles become voxels.
    VolumesVoxelisation {
        /// In compute, which was faster wherever it was measured.
        Auto = "auto",
        /// Each invocation looks through a tile of a triangle's columns.
        Compute = "compute",
        /// Drawn along their dominant axes, with geometry shaders: the paper. The same bits.
        Raster = "raster",
    }
}
choices! {
    /// What fills voxels.
    VolumesOccluders {
        /// Surfaces: the paper.
        Surfaces = "surfaces",
        /// Surfaces, and what closed meshes hold.
        Solids = "solids",
    }
}
choices! {
    /// The opacity that cones meet.
    VolumesOpacity {
        /// A mean over all directions: the paper.
        Mean = "mean",
        /// As it is seen along the cone.
        Axes = "axes",
    }
}
choices! {
    /// What cones do where nothing is.
    VolumesEmpty {
        /// Sample it: the paper.
        March = "march",
        /// Skip it, by the distance from what is nearest. The same light within rounding.
        Skip = "skip",
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
    /// How the light of emissive surfaces and of the sky gets to the surfaces that reflect it first.
    VolumesAreaLights {
        /// By views from a few samples of them: the paper.
        Views = "views",
        /// By rays from samples of all surfaces.
        Rays = "rays",
    }
}
choices! {
    /// Where virtual area lights are small.
    VolumesSpread {
        /// Alike in all light views: the paper.
        Views = "views",
        /// Where they light the picture: rays from some of its points weigh them.
        Picture = "picture",
    }
}
choices! {
    /// What a virtual area light is to a cache.
    VolumesVal {
        /// A point whose area A is added to the squared distance: the paper.
        Paper = "paper",
        /// A disc, exactly.
        Disc = "disc",
    }
}

options! {
    /// Options of the `volumes` diffuse method (Reich 2015).
    VolumesOptions, "volumes":
    /// The light views are reduced to the square of this many virtual area lights, all together, or as near to it as blocks of whole powers of two come.
    lights: u32 = 64, draft = 32, high = 128, paper = 64; OptionKind::OneOf(&[16, 32, 64, 128, 256, 512]), "", "quadratic";
    /// Which lights are small, and so many.
    spread: VolumesSpread = VolumesSpread::Picture, draft = VolumesSpread::Views, paper = VolumesSpread::Views; OptionKind::Choice(VolumesSpread::NAMES), "", "";
    /// Address volumes around the camera; cells of each are twice as large as those of the one before it.
    cascades: u32 = 4; OptionKind::Integer(1, 8), "volumes", "";
    /// Nodes along an edge of an address volume. Where cells follow from the scene, more make them smaller.
    resolution: u32 = 64, draft = 32, high = 128, paper = 32; OptionKind::OneOf(&[16, 32, 64, 128]), "nodes", "quadratic";
    /// Cell of the finest volume. 0: so large that the last volume holds the scene wherever the camera is in it. Doubled until it does.
    cell: f64 = 0.0; OptionKind::Number(0.0, 1e9), "m", "falls";
    /// Bands of spherical harmonics.
    bands: u32 = 3, paper = 2; OptionKind::OneOf(&[2, 3]), "bands", "linear";
    /// Bands in which caches keep colour; of those above they keep the luminance alone, in the colour of the first.
    chroma: u32 = 3; OptionKind::Integer(1, 3), "bands", "linear";
    /// Whether light may be blocked on its way to a cache.
    visibility: VolumesVisibility = VolumesVisibility::Rays, paper = VolumesVisibility::Cones; OptionKind::Choice(VolumesVisibility::NAMES), "", "";
    /// 4 to this power of lights share one visibility.
    lod: u32 = 1, draft = 2, paper = 2; OptionKind::Integer(0, 4), "", "falls";
    /// Neighbouring groups, up to 64 together, share one visibility where a cache sees them no wider than this across; 0: each has its own.
    aperture: f64 = 0.0; OptionKind::Number(0.0, 180.0), "°", "falls";
    /// With `visibility=cones` voxels along the longest axis of the scene.
    voxels: u32 = 128; OptionKind::Integer(16, 512), "voxels", "cubic";
    /// With `visibility=cones` how triangles become voxels.
    voxelisation: VolumesVoxelisation = VolumesVoxelisation::Auto; OptionKind::Choice(VolumesVoxelisation::NAMES), "", "";
    /// With `visibility=cones` what fills voxels.
    occluders: VolumesOccluders = VolumesOccluders::Surfaces; OptionKind::Choice(VolumesOccluders::NAMES), "", "";
    /// With `visibility=cones` how fast a voxel's opacity follows what moves; 0: at once.
    adaption: f64 = 0.0; OptionKind::Number(0.0, 1e6), "1/s", "";
    /// With `visibility=cones` the opacity that cones meet.
    opacity: VolumesOpacity = VolumesOpacity::Axes, paper = VolumesOpacity::Mean; OptionKind::Choice(VolumesOpacity::NAMES), "", "";
    /// With `visibility=cones` what cones do where nothing is.
    empty: VolumesEmpty = VolumesEmpty::Skip, paper = VolumesEmpty::March; OptionKind::Choice(VolumesEmpty::NAMES), "", "";
    /// With `visibility=cones` the width of a cone's samples over its own.
    cone_width: f64 = 0.5, paper = 1.0; OptionKind::Number(0.125, 1.0), "", "falls";
    /// Where caches lie.
    placement: VolumesPlacement = VolumesPlacement::Visible; OptionKind::Choice(VolumesPlacement::NAMES), "", "";
    /// How far off their nodes caches lie at most, along each axis.
    jitter: f64 = 0.0; OptionKind::Number(0.0, 0.5), "cells", "";
    /// Caches of the second volume are lit anew every second frame only, those of the third every fourth, and so on, up to this many frames; 1: all in every frame. A picture alone has all of its light.
    update: u32 = 1; OptionKind::Integer(1, 64), "frames", "falls";
    /// What caches count by, beside their distances, for a pixel between them.
    weights: VolumesWeights = VolumesWeights::Trilinear, high = VolumesWeights::Rays; OptionKind::Choice(VolumesWeights::NAMES), "", "";
    /// How the light of emissive surfaces and of the sky gets to the surfaces that reflect it first.
    area_lights: VolumesAreaLights = VolumesAreaLights::Rays, paper = VolumesAreaLights::Views; OptionKind::Choice(VolumesAreaLights::NAMES), "", "";
    /// Scatterings between the light and the first visible surface at most; 0: no indirect light. From the second on samples of the whole scene's surfaces exchange light.
    bounces: u32 = 1, high = 16; OptionKind::Integer(0, 16), "scatterings", "";
    /// Samples of all diffuse surface, with `bounces` beyond 1, and with `area_lights=rays` where there are any.
    samples: u32 = 4096, draft = 1024; OptionKind::Integer(16, 16384), "samples", "linear, quadratic where samples light each other";
    /// What a virtual area light is to a cache.
    val: VolumesVal = VolumesVal::Disc, paper = VolumesVal::Paper; OptionKind::Choice(VolumesVal::NAMES), "", "";
}

impl VolumesOptions {
    /// The caches, which other methods may light too.
    pub(crate) fn cache_settings(&self) -> CacheSettings {
        CacheSettings {
            lights: LightRule {
                drawn: 0,
                punctual: false,
                side: self.lights,
                lod: self.lod,
                paper: self.val == VolumesVal::Paper,
            },
            places: PlaceRule {
                cascades: CascadeRule { count: self.cascades, resolution: self.resolution, cell: self.cell },
                moves: self.placement == VolumesPlacement::Visible,
                jitter: self.jitter as f32,
            },
            sight: match self.visibility {
                VolumesVisibility::None => CacheSight::Open,
                VolumesVisibility::Rays => CacheSight::Rays,
                VolumesVisibility::Cones => CacheSight::Cones(self.voxel_settings()),
            },
            weighs_by_rays: self.weights == VolumesWeights::Rays,
        }
    }

    /// Bands of which each channel has its own; those above are the luminance's.
    pub(super) fn chroma_bands(&self) -> u32 {
        self.chroma.min(self.bands)
    }

    /// Numbers that a cache holds (glsl/volumes/numbers.glsl).
    pub(super) fn numbers(&self) -> usize {
        match (self.bands, self.chroma_bands()) {
            (3, 3) => 28,
            (3, 2) => 20,
            (3, _) | (_, 2) => 12,
            _ => 8,
        }
    }

    /// The voxels that cones pass through.
    pub(super) fn voxel_settings(&self) -> VoxelSettings {
        VoxelSettings {
            resolution: self.voxels,
            voxelisation: match self.voxelisation {
                VolumesVoxelisation::Auto => None,
                VolumesVoxelisation::Compute => Some(Voxelisation::Compute),
                VolumesVoxelisation::Raster => Some(Voxelisation::Raster),
            },
            solid: self.occluders == VolumesOccluders::Solids,
            adaption: self.adaption as f32,
            directional: self.opacity == VolumesOpacity::Axes,
            skip_empty: self.empty == VolumesEmpty::Skip,
            cone_width: self.cone_width as f32,
        }
    }
}
