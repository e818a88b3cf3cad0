//! Baking: the settled diffuse light of a scene as a glTF file that any viewer shows, and as irradiance for engines that multiply themselves.
//!
//! ```text
//! light maps ──▶ atlas ──▶ light (radiance ρ/π·E + Le, 8 bits) ──▶ document ──▶ .glb
//! (the device)   (where)     └──▶ irradiance E                 ──▶ .irradiance.exr
//! ```

mod atlas;
mod cameras;
mod document;
mod error;
mod fill;
mod geometry;
mod glb;
mod light;
mod looks;
mod materials;
mod textures;
mod warnings;

use std::collections::BTreeMap;

pub use self::error::BakeError;

use self::atlas::Atlas;
use self::light::Light;
use crate::image::ColorImage;
use crate::renderer::options::{LightmapsOptions, LightmapsSettle, LightmapsSource};
use crate::renderer::{Context, DiffuseMethod, Preset, Renderer, Settings, Technique};
use crate::scene::Scene;
use crate::slot::Slot;

/// What baking is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stage {
    /// Light maps, on the device.
    Light,
    /// What surfaces reflect of it.
    Surfaces,
    /// The file.
    File,
}

impl Stage {
    /// All stages, in their order.
    pub const ALL: [Stage; 3] = [Stage::Light, Stage::Surfaces, Stage::File];

    /// What a progress bar says.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Light => "light",
            Stage::Surfaces => "surfaces",
            Stage::File => "file",
        }
    }
}

/// How light is baked.
#[derive(Clone, Debug, PartialEq)]
pub struct BakeOptions {
    /// The light maps. Their `settle` does not matter.
    pub lightmaps: LightmapsOptions,
    /// Texels of the file along the side of one of the light maps, 1 to [`MOST_DETAIL`], or fewer where there are more than four million: direct light is found at each, the rest
    /// interpolated.
    pub detail: u32,
}

impl Default for BakeOptions {
    fn default() -> BakeOptions {
        BakeOptions { lightmaps: LightmapsOptions::default(), detail: 2 }
    }
}

/// The most that [`BakeOptions::detail`] may be.
pub const MOST_DETAIL: u32 = 8;

/// A baked scene.
#[derive(Clone, Debug)]
pub struct Baked {
    /// A whole `.glb` file: the scene's meshes, without lights; what they emit is the light that they reflected.
    pub glb: Vec<u8>,
    /// Irradiance in W/m² at the texels of the file's emissive texture, by `TEXCOORD_1`.
    pub irradiance: ColorImage,
    /// Its parts: [`Slot::Direct`] of the lights themselves, [`Slot::Diffuse`] of diffuse surfaces, [`Slot::Caustics`] by way of mirrors and glass.
    pub parts: BTreeMap<Slot, ColorImage>,
    /// Sides of surfaces, each lit by a rectangle of the atlas.
    pub surfaces: usize,
    /// The [`BakeOptions::detail`] that there was room for.
    pub detail: u32,
}

/// Bakes the light of a scene as it is now.
///
/// # Errors
/// [`BakeError`].
pub fn bake(
    context: &Context,
    scene: &Scene,
    options: &BakeOptions,
    mut hear: impl FnMut(Stage),
) -> Result<Baked, BakeError> {
    let (lightmaps, detail) = (&options.lightmaps, options.detail.clamp(1, MOST_DETAIL));
    if lightmaps.source == LightmapsSource::Photons {
        return Err(BakeError::Photons);
    }
    hear(Stage::Light);
    let settings = Settings::new(Technique::Direct, Preset::Default).with(|settings| {
        settings.methods.diffuse = DiffuseMethod::Lightmaps;
        settings.lightmaps = lightmaps.clone().with(|options| {
            options.settle = LightmapsSettle::Always;
            options.per_light = 0;
        });
    });
    let mut packed = None;
    let found = Renderer::new(context, settings)?.surface_light(scene, detail, |map| {
        let charts: Vec<_> = (0..triangle_count(scene)).map(|triangle| map.chart(triangle)).collect();
        let atlas = Atlas::new(&charts)?;
        packed = Some((charts, atlas));
        Ok::<(), BakeError>(())
    })?;
    let nothing = || BakeError::Nothing { scene: scene.name.clone() };
    let (found, (charts, atlas)) = found.zip(packed).ok_or_else(nothing)?;
    warnings::warn_of_detail(found.detail, detail);

    hear(Stage::Surfaces);
    let looks = looks::mean_looks(scene, &charts, &atlas);
    warnings::warn_of_looks(scene, &charts, &looks);
    let light = Light::new(&atlas, &found, &looks);

    hear(Stage::File);
    let glb = document::write(scene, &charts, &atlas, &light)?;
    let Light { irradiance, parts, .. } = light;
    Ok(Baked { glb, irradiance, parts, surfaces: atlas.sheets.len(), detail: found.detail })
}

/// Of all instances.
fn triangle_count(scene: &Scene) -> usize {
    let meshes = scene.meshes();
    scene.instances().iter().map(|it| meshes[it.mesh.0].primitives[it.primitive].triangle_count()).sum()
}
