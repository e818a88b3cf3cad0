//! `irradia reference`: images by unbiased light transport, shards of them, and the cache that keeps them.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use irradia::bench::tables;
use irradia::output::{ImageFormat, Target};
use irradia::reference::{
    Cache, CausticPaths, Estimator, Goal, Job, PixelFilter, ReferenceFile, ReferenceRequest, Shard, estimator_name,
    merge,
};
use irradia::renderer::CrashMarkers;
use irradia::scene::FRAME_RATE;

use super::invocation::{Invocation, WrongUsage};
use super::scene_args::SceneArgs;
use super::terminal::Steps;
use super::values;

/// Make a reference by unbiased light transport, and say how noisy it is
///
/// References are kept in the cache, $IRRADIA_CACHE_DIR or irradia/references in the user's cache folder, and go on from
/// what is there.
#[derive(Debug, Args)]
pub(crate) struct ReferenceArgs {
    /// A .gltf or .glb file, or the name of a built-in scene
    #[arg(required_unless_present_any = ["merge", "list", "clear"])]
    scene: Option<String>,
    /// Samples per pixel; as many or a few more are made
    #[arg(long, value_name = "N", required_unless_present_any = ["merge", "list", "clear"])]
    #[arg(value_parser = clap::value_parser!(u32).range(1..))]
    spp: Option<u32>,
    /// Relative noise of the image at which fewer samples do, such as 0.5%; it is looked at each time their number has doubled
    #[arg(long, value_name = "P%", value_parser = values::percentage, conflicts_with = "shard")]
    noise: Option<f64>,
    /// How light transport is estimated; auto: path, but the slot specular by sppm where that is less noisy at equal cost
    #[arg(long, value_parser = estimator(), default_value = "path")]
    estimator: Estimator,
    /// Scatterings between the light and the first visible surface at most; 0 is direct light [default: no limit]
    #[arg(long, value_name = "N")]
    bounces: Option<u32>,
    /// Which caustics there are: all; in the slot caustics only light that met nothing but specular lobes on its way; unmirrored: none in what mirrors and glass show, and lamps
    /// behind one surface of glass in the slot specular; mirrored: all, with those lamps there; none: nothing specular before the first visible surface
    #[arg(long, value_parser = caustics(), default_value = "all")]
    caustics: CausticPaths,
    /// Reflections and refractions at most between the eye and what mirrors and glass show; --bounces limits the way of light to that then [default: they are bounces]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=254))]
    mirrors: Option<u32>,
    /// Where in a pixel light is sampled
    #[arg(long, value_parser = values::pixel_filter(), default_value = "center")]
    filter: PixelFilter,
    /// Which of the equally good sequences of samples is taken
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u32,
    /// The frame of the scene's animation, at 30 frames a second
    #[arg(long, value_name = "N", default_value_t = 0)]
    frame: u32,
    /// Where the reference goes, besides the cache
    #[arg(short, long, value_name = "FILE.exr", value_parser = exr_path)]
    output: Option<PathBuf>,
    /// Make part I of N of the samples alone, into the output file; --merge puts the parts together
    #[arg(long, value_name = "I/N", value_parser = Shard::parse, requires = "output")]
    shard: Option<Shard>,
    /// Neither read nor write the cache
    #[arg(long)]
    no_cache: bool,
    /// Put the shards of a reference together, into the output file or else into the cache
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with_all = ["scene", "spp", "shard", "noise", "list", "clear"])]
    merge: Option<Vec<PathBuf>>,
    /// List what is in the cache
    #[arg(long, conflicts_with_all = ["scene", "spp", "shard", "noise", "output", "clear"])]
    list: bool,
    /// Remove from the cache what has a key that begins so, or all
    #[arg(long, value_name = "KEY-PREFIX|all", num_args = 0..=1, default_missing_value = ALL)]
    #[arg(value_parser = key_prefix, conflicts_with_all = ["scene", "spp", "shard", "noise", "output"])]
    clear: Option<String>,
    #[command(flatten)]
    scene_args: SceneArgs,
}

/// The word for every key.
const ALL: &str = "all";

/// Does what the arguments say: one of making, merging, listing, clearing.
pub(crate) fn run(args: &ReferenceArgs, invocation: &Invocation<'_>) -> Result<()> {
    let output = args.output.as_deref().map(Target::open).transpose()?;
    if args.list {
        return list(invocation);
    }
    if let Some(prefix) = &args.clear {
        return clear(prefix, invocation);
    }
    if let Some(parts) = &args.merge {
        if args.no_cache && args.output.is_none() {
            let message = "--merge with --no-cache needs a place for the result; give it with -o FILE.exr";
            bail!(WrongUsage { subcommand: "reference", message });
        }
        let merged = merge(parts)?;
        return report(&merged, &merged_places(output.as_ref(), &merged)?, invocation);
    }
    match (&args.scene, args.spp) {
        (Some(scene), Some(spp)) => make(args, scene, spp, output.as_ref(), invocation),
        _ => bail!(WrongUsage { subcommand: "reference", message: "a reference needs a SCENE and --spp N" }),
    }
}

fn make(
    args: &ReferenceArgs,
    spec: &str,
    spp: u32,
    output: Option<&Target>,
    invocation: &Invocation<'_>,
) -> Result<()> {
    let mut scene = args.scene_args.open(spec)?.scene;
    scene.set_frame(args.frame);
    let request = ReferenceRequest {
        size: args.scene_args.size,
        camera: args.scene_args.view(&scene, f64::from(args.frame) / FRAME_RATE)?,
        estimator: args.estimator,
        bounces: args.bounces,
        caustics: args.caustics,
        mirrors: args.mirrors,
        filter: args.filter,
        seed: args.seed,
    };
    let context = invocation.context(CrashMarkers::On)?;
    let job = Job { context: &context, scene: &scene, scene_name: &scene.name, request: &request };
    let mut steps = Steps::new(invocation.terminal, &scene.name);
    let mut progress = |progress| steps.show(progress);
    let mut places = Vec::new();
    let file = match (args.shard, output) {
        (Some(shard), Some(output)) => {
            places.push(output.path().to_owned());
            job.make_shard(spp, shard, output, &mut progress)?
        }
        (_, output) => {
            let cache = open_cache(args.no_cache)?;
            let file = job.make(Goal { spp, noise: args.noise }, cache.as_ref(), &mut progress)?;
            if let Some(output) = output {
                file.write(output)?;
                places.push(output.path().to_owned());
            }
            places.extend(cache.and_then(|cache| cache.find(file.key())));
            file
        }
    };
    drop(steps);
    report(&file, &places, invocation)?;
    if let Some(noise) = args.noise {
        let reached = file.reference().image_noise().rrmse;
        if reached > noise {
            let percent = |noise: f64| 100.0 * noise;
            tracing::warn!(
                "the noise is {:.3} %, above {:.3} %, after all --spp {spp} samples",
                percent(reached),
                percent(noise)
            );
        }
    }
    invocation.check_validation(&context)
}

/// Writes what was merged where the arguments say.
fn merged_places(output: Option<&Target>, merged: &ReferenceFile) -> Result<Vec<PathBuf>> {
    match output {
        Some(output) => {
            merged.write(output)?;
            Ok(vec![output.path().to_owned()])
        }
        None => Ok(vec![cache()?.keep(merged)?]),
    }
}

fn report(file: &ReferenceFile, places: &[PathBuf], invocation: &Invocation<'_>) -> Result<()> {
    let places: Vec<String> = places.iter().map(|path| format!("file: {}\n", path.display())).collect();
    invocation.terminal.print(&(tables::reference_text(&file.reference()) + &places.concat()))
}

fn list(invocation: &Invocation<'_>) -> Result<()> {
    let cache = cache()?;
    let entries = cache.list();
    let folder = cache.folder().display();
    let text = if entries.is_empty() {
        format!("there is no reference in {folder}\n")
    } else {
        format!("{}in {folder}\n", tables::cache_text(&entries))
    };
    invocation.terminal.print(&text)
}

fn clear(prefix: &str, invocation: &Invocation<'_>) -> Result<()> {
    let removed = cache()?.clear(Some(prefix).filter(|prefix| *prefix != ALL))?;
    let bytes: u64 = removed.iter().map(|entry| entry.bytes).sum();
    invocation.terminal.say(&format!("removed {} references, {:.1} MB", removed.len(), bytes as f64 * 1e-6));
    Ok(())
}

/// The cache, unless it is not wanted.
pub(crate) fn open_cache(without: bool) -> Result<Option<Cache>> {
    if without { Ok(None) } else { cache().map(Some) }
}

fn cache() -> Result<Cache> {
    Cache::open().context("there is no folder for the cache of references; set IRRADIA_CACHE_DIR, or HOME, to one")
}

fn estimator() -> impl TypedValueParser<Value = Estimator> {
    const ALL: [Estimator; 3] = [Estimator::Path, Estimator::Sppm, Estimator::Auto];
    PossibleValuesParser::new(ALL.map(estimator_name)).try_map(|name| {
        let found = ALL.into_iter().find(|estimator| estimator_name(*estimator) == name);
        found.ok_or_else(|| format!("there is no estimator {name:?}"))
    })
}

fn caustics() -> impl TypedValueParser<Value = CausticPaths> {
    PossibleValuesParser::new(CausticPaths::ALL.map(CausticPaths::name)).try_map(|name| {
        let found = CausticPaths::ALL.into_iter().find(|caustics| caustics.name() == name);
        found.ok_or_else(|| format!("there are no caustics {name:?}"))
    })
}

fn exr_path(text: &str) -> Result<PathBuf, String> {
    let path = Path::new(text);
    match ImageFormat::from_path(path) {
        Ok(ImageFormat::Exr) => Ok(path.to_owned()),
        _ => Err("a reference is an .exr file".to_owned()),
    }
}

fn key_prefix(text: &str) -> Result<String, String> {
    let sound = !text.is_empty() && text.bytes().all(|digit| digit.is_ascii_hexdigit());
    if sound || text == ALL {
        Ok(text.to_ascii_lowercase())
    } else {
        Err("a key is of hexadecimal digits; irradia reference --list shows them; all stands for every key".to_owned())
    }
}
