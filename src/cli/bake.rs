//! `irradia bake`: the diffuse light of a scene into a .glb that any viewer shows, and its irradiance beside it.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Result, bail};
use clap::Args;
use clap::builder::TypedValueParser;
use irradia::bake::{BakeOptions, MOST_DETAIL, Stage, bake};
use irradia::output::{Attributes, Target, write_exr};
use irradia::renderer::{CrashMarkers, DeviceReport, Preset, Settings, Technique};
use irradia::scene::Scene;
use serde_json::json;

use super::invocation::{Invocation, WrongUsage};
use super::scene_args::SourceArgs;
use super::values::{self, Setting};

/// Settings of lightmaps that tell how light is renewed or shown, or are for photons alone.
const WITHOUT_EFFECT: [&str; 8] = [
    "lightmaps.settle",
    "lightmaps.show",
    "lightmaps.texels",
    "lightmaps.rounds",
    "lightmaps.per_light",
    "lightmaps.blend",
    "lightmaps.nearest",
    "lightmaps.invalidate",
];

/// Bake the diffuse light of a scene into a .glb that any viewer shows, and its irradiance into an .exr beside it
#[derive(Debug, Args)]
pub(crate) struct BakeArgs {
    /// A .gltf or .glb file, or the name of a built-in scene
    scene: String,
    /// Where the scene goes; NAME.irradiance.exr beside NAME.glb gets the irradiance, W/m², by the same texture coordinates
    #[arg(short, long, value_name = "NAME.glb", value_parser = glb_path)]
    output: PathBuf,
    /// The frame of the scene's animation, at 30 frames a second
    #[arg(long, value_name = "N", default_value_t = 0)]
    frame: u32,
    /// How time is traded against error
    #[arg(long, value_parser = values::preset(), default_value = Preset::Default.name())]
    preset: Preset,
    /// Side of a texel of the light maps in metres, the same as --set lightmaps.texel=M; 0: by lightmaps.count
    #[arg(long, value_name = "M")]
    texel: Option<f64>,
    /// Texels of the file along the side of a texel of the light maps: direct light is found at each of them, the rest interpolated
    #[arg(long, value_name = "N", default_value_t = BakeOptions::default().detail, value_parser = detail())]
    detail: u32,
    /// A setting of lightmaps to change after the preset, repeatable
    #[arg(long, value_name = "lightmaps.KEY=VALUE", value_parser = values::setting)]
    set: Vec<Setting>,
    #[command(flatten)]
    source: SourceArgs,
}

/// Bakes, and says what was written.
pub(crate) fn run(args: &BakeArgs, invocation: &Invocation<'_>) -> Result<()> {
    let start = Instant::now();
    let settings = settings(args)?;
    let beside = args.output.with_extension("irradiance.exr");
    let same = |path: &Path| fs::canonicalize(path).is_ok_and(|path| fs::canonicalize(&args.scene).ok() == Some(path));
    if same(&args.output) {
        bail!(
            "{} is the scene itself, whose lights and materials would be lost; give another name",
            args.output.display()
        );
    }
    let [glb, irradiance] = [&args.output, &beside].map(|path| Target::open(path));
    let (glb, irradiance) = (glb?, irradiance?);
    let mut scene = args.source.open(&args.scene)?.scene;
    scene.set_frame(args.frame);
    let context = invocation.context(CrashMarkers::On)?;

    let progress = invocation.terminal.progress(Stage::ALL.len() as u64);
    let options = BakeOptions { lightmaps: settings.lightmaps.clone(), detail: args.detail };
    let baked = bake(&context, &scene, &options, |stage| {
        progress.at(Stage::ALL.iter().position(|known| *known == stage).unwrap_or_default() as u64);
        progress.about(stage.name());
    })?;
    drop(progress);
    // They belong together: neither is replaced unless both could be written.
    let staged = glb.stage(&baked.glb)?;
    let made = Made { args, scene: &scene, settings: &settings, device: &context.device(), detail: baked.detail };
    write_exr(&irradiance, &baked.irradiance, &baked.parts, &made.attributes())?;
    staged.finish()?;
    let [width, height] = baked.irradiance.size;
    invocation.terminal.say(&format!(
        "wrote {} ({:.1} MB) and {} ({width}x{height}, {} sides of surfaces) in {:.2} s",
        args.output.display(),
        1e-6 * baked.glb.len() as f64,
        beside.display(),
        baked.surfaces,
        start.elapsed().as_secs_f64(),
    ));
    invocation.check_validation(&context)
}

fn settings(args: &BakeArgs) -> Result<Settings> {
    let mut settings = Settings::new(Technique::Lightmaps, args.preset);
    for Setting { key, value } in &args.set {
        if !key.starts_with("lightmaps.") {
            bail!(WrongUsage {
                subcommand: "bake",
                message: "light is baked by lightmaps; its settings alone can be --set"
            });
        }
        if WITHOUT_EFFECT.contains(&key.as_str()) {
            bail!(WrongUsage {
                subcommand: "bake",
                message: "baked light is settled light by rays: lightmaps.settle, show, texels, rounds, per_light, blend, nearest and invalidate change nothing of it"
            });
        }
        settings.set(key, value)?;
    }
    settings.set("lightmaps.settle", "always")?;
    if let Some(texel) = args.texel {
        settings.set("lightmaps.texel", &texel.to_string())?;
    }
    Ok(settings)
}

/// What the light was made of.
struct Made<'a> {
    args: &'a BakeArgs,
    scene: &'a Scene,
    settings: &'a Settings,
    device: &'a DeviceReport,
    /// As it was taken.
    detail: u32,
}

impl Made<'_> {
    /// Names as those of pictures.
    fn attributes(&self) -> Attributes {
        let options = self.settings.options().remove("lightmaps");
        let lightmaps = options.map(|options| options.to_string()).unwrap_or_default();
        let lights: Vec<&str> = self.scene.lights().iter().map(|light| light.name.as_str()).collect();
        let all = [
            ("irradia", env!("CARGO_PKG_VERSION").to_owned()),
            ("scene", self.scene.name.clone()),
            ("frame", self.args.frame.to_string()),
            ("lights", json!(lights).to_string()),
            ("sky", json!(self.scene.sky()).to_string()),
            ("quantity", "irradiance, W/m²".to_owned()),
            ("detail", self.detail.to_string()),
            ("preset", self.args.preset.name().to_owned()),
            ("settings", format!("{{\"lightmaps\":{lightmaps}}}")),
            ("device", self.device.name.clone()),
            ("driver", self.device.driver.clone()),
            ("api", self.device.api.clone()),
        ];
        all.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
    }
}

fn detail() -> impl TypedValueParser<Value = u32> {
    clap::value_parser!(u32).range(1..=i64::from(MOST_DETAIL))
}

fn glb_path(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let named = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("glb"));
    if named { Ok(path) } else { Err("a baked scene is a .glb file".to_owned()) }
}
