//! The scene of a command, what is added to it, and where it is seen from.

use std::time::Instant;

use clap::Args;
use irradia::scene::{CameraView, Flight, LightSpec, LoadOptions, Scene, parse_sky};

use super::values;

/// View and lights.
#[derive(Debug, Args)]
#[command(next_help_heading = "View and light")]
pub(crate) struct SceneArgs {
    /// Width and height of the image in pixels
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = values::size)]
    pub(crate) size: [u32; 2],
    /// The camera, by name or index [default: the scene's first, or a view of the whole scene if it has none]
    #[arg(long, value_name = "NAME|INDEX")]
    pub(crate) camera: Option<String>,
    /// The way that the eye takes over the frames: a file of keyframes, or the name of a built-in flight
    #[arg(long, value_name = "FILE|NAME", conflicts_with = "camera")]
    flight: Option<String>,
    #[command(flatten)]
    source: SourceArgs,
}

/// What is added to the scene, and what reading it may do.
#[derive(Debug, Args)]
#[command(next_help_heading = "View and light")]
pub(crate) struct SourceArgs {
    /// A light to add, repeatable: sun:AZIMUTH,ELEVATION[,W/m²], point:X,Y,Z,W/sr or spot:…
    #[arg(long = "light", value_name = "LIGHT", value_parser = LightSpec::parse, allow_hyphen_values = true)]
    lights: Vec<LightSpec>,
    /// Radiance of the sky, W/(m² sr)
    #[arg(long, value_name = "R,G,B", value_parser = parse_sky)]
    sky: Option<[f32; 3]>,
    #[command(flatten)]
    load: LoadArgs,
}

/// What reading a scene may do.
#[derive(Debug, Args)]
#[command(next_help_heading = "Scene files")]
pub(crate) struct LoadArgs {
    /// Read files that the glTF file names outside its own folder: by .., absolute paths, file: URIs or symbolic links
    #[arg(long)]
    allow_outside_files: bool,
    /// Memory that the textures of a scene may take, in MiB at four bytes a texel [default: 4096]
    #[arg(long, value_name = "MIB")]
    max_texture_mib: Option<u32>,
}

impl LoadArgs {
    pub(crate) fn options(&self) -> LoadOptions {
        LoadOptions::default().with(|options| {
            options.allow_outside_files = self.allow_outside_files;
            if let Some(mib) = self.max_texture_mib {
                options.texture_bytes = u64::from(mib) << 20;
            }
        })
    }
}

/// A scene ready to render, and the host time that loading it took.
pub(crate) struct LoadedScene {
    pub(crate) scene: Scene,
    pub(crate) load_ms: f64,
}

impl SourceArgs {
    /// Opens a path or a built-in scene, adds the lights, and warns of what the user should know.
    pub(crate) fn open(&self, spec: &str) -> anyhow::Result<LoadedScene> {
        let start = Instant::now();
        let mut scene = Scene::open_with(spec, &self.load.options())?;
        let load_ms = 1e3 * start.elapsed().as_secs_f64();
        for light in &self.lights {
            scene.add_light_spec(light)?;
        }
        if let Some(sky) = self.sky {
            scene.set_sky(sky);
        }
        warn_of(&scene, "add one with --light sun:45,60 or --light point:X,Y,Z,W/sr, or a sky with --sky 1,1,1");
        Ok(LoadedScene { scene, load_ms })
    }
}

impl SceneArgs {
    /// As [`SourceArgs::open`]; a flight that cannot be used fails it.
    pub(crate) fn open(&self, spec: &str) -> anyhow::Result<LoadedScene> {
        self.flight()?;
        self.source.open(spec)
    }

    /// The flight, if there is one.
    pub(crate) fn flight(&self) -> anyhow::Result<Option<Flight>> {
        Ok(self.flight.as_deref().map(Flight::open).transpose()?)
    }

    /// Where the scene, as it is now, is seen from at a time of the sequence, in seconds.
    pub(crate) fn view(&self, scene: &Scene, seconds: f64) -> anyhow::Result<CameraView> {
        if let Some(flight) = self.flight()? {
            return Ok(flight.view(seconds));
        }
        let view = scene.camera_view(self.camera.as_deref())?;
        if view.automatic {
            tracing::info!("{} has no camera; a view of the whole scene is taken", scene.name);
        }
        Ok(view)
    }
}

/// Warns of what the user should know of a scene; `advice` says how it would get light.
pub(crate) fn warn_of(scene: &Scene, advice: &str) {
    for warning in &scene.warnings {
        tracing::warn!("{warning}");
    }
    if !scene.facts().lit() {
        tracing::warn!("{} has no light and stays black; {advice}", scene.name);
    }
}
