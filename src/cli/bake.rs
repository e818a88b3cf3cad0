//! `irradia bake`: the diffuse light of a scene into a .glb that any viewer shows, and its irradiance beside it.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Result, bail};
use clap::Args;
use clap::builder::TypedValueParser;
use irradia::bake::{BakeOptions, MOST_DETAIL, Stage, bake};
use irradia::output::{Attributes, Target, write_exr};
use irradia::renderer::{CrashMarkers, Preset, Settings, Technique};

use super::invocation::{Invocation, WrongUsage};
use super::scene_args::SourceArgs;
use super::values::{self, Setting};

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
    write_exr(&irradiance, &baked.irradiance, &baked.parts, &attributes(args, &scene.name, &settings))?;
    glb.write(&baked.glb)?;
    let [width, height] = baked.irradiance.size;
    invocation.terminal.say(&format!(
        "wrote {} ({:.1} MB) and {} ({width}x{height}, {} surfaces) in {:.2} s",
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
        settings.set(key, value)?;
    }
    if let Some(texel) = args.texel {
        settings.set("lightmaps.texel", &texel.to_string())?;
    }
    Ok(settings)
}

fn attributes(args: &BakeArgs, scene: &str, settings: &Settings) -> Attributes {
    let lightmaps = settings.options().remove("lightmaps").map(|options| options.to_string()).unwrap_or_default();
    let all = [
        ("irradia", env!("CARGO_PKG_VERSION").to_owned()),
        ("scene", scene.to_owned()),
        ("frame", args.frame.to_string()),
        ("quantity", "irradiance, W/m²".to_owned()),
        ("detail", args.detail.to_string()),
        ("preset", args.preset.name().to_owned()),
        ("settings", format!("{{\"lightmaps\":{lightmaps}}}")),
    ];
    all.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

fn detail() -> impl TypedValueParser<Value = u32> {
    clap::value_parser!(u32).range(1..=i64::from(MOST_DETAIL))
}

fn glb_path(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let named = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("glb"));
    if named { Ok(path) } else { Err("a baked scene is a .glb file".to_owned()) }
}
