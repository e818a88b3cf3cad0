//! `irradia sweep`: time against error over a grid; tables to standard output, results and plots to files.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context as _, Result, anyhow, bail};
use clap::Args;
use irradia::bench::report::Device;
use irradia::bench::sweep::{self, Grid, GridScene, Group, Outcomes, Point, Shard, Sweep};
use irradia::bench::{Options, References, Subject, run as measure};
use irradia::output::Target;
use irradia::reference::Cache;
use irradia::renderer::{Context, Settings};
use irradia::scene::{CameraView, LoadOptions, Scene};

use super::invocation::{Invocation, TimedArgs};
use super::reference::open_cache;
use super::scene_args::{LoadArgs, warn_of};
use super::terminal::{Progress, Steps, Terminal};
use super::{files, values};

/// Measure a grid of techniques and settings on scenes: time against error
#[derive(Debug, Args)]
pub(crate) struct SweepArgs {
    /// The grid, a TOML file
    #[arg(value_name = "FILE", required_unless_present = "merge")]
    grid: Option<PathBuf>,
    /// Measure the I-th of N equal parts of the grid
    #[arg(long, value_name = "I/N", value_parser = str::parse::<Shard>, requires = "json")]
    shard: Option<Shard>,
    /// Put results together instead of measuring
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with_all = ["grid", "shard", "restart", "size", "reference", "frames"])]
    merge: Vec<PathBuf>,
    /// Width and height in pixels, instead of the grid's
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    size: Option<[u32; 2]>,
    /// Samples per pixel of the references, instead of the grid's
    #[arg(long, value_name = "SPP", value_parser = clap::value_parser!(u32).range(1..))]
    reference: Option<u32>,
    /// Rounds of every point, instead of the grid's
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    frames: Option<u32>,
    /// Write everything as JSON, schema irradia-sweep/1, after every group of points; what it already holds is kept
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Measure what the JSON already holds anew
    #[arg(long, requires = "json")]
    restart: bool,
    /// Write a row for every point as CSV
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write a plot of every scene into this folder, as SVG
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    #[command(flatten)]
    timed: TimedArgs,
    #[command(flatten)]
    load: LoadArgs,
}

/// Measures or merges, prints the tables, writes the files. What fails is told at the end.
pub(crate) fn run(args: &SweepArgs, invocation: &Invocation<'_>) -> Result<()> {
    let open = |path: &Option<PathBuf>| path.as_deref().map(Target::open).transpose();
    let (json, csv) = (open(&args.json)?, open(&args.csv)?);
    if let Some(folder) = &args.plots {
        fs::create_dir_all(folder).with_context(|| format!("the folder {} cannot be made", folder.display()))?;
    }
    let sweep = match &args.grid {
        Some(path) => measure_grid(args, path, json.as_ref(), invocation)?,
        None => {
            let parts: Result<Vec<_>, _> =
                args.merge.iter().map(|path| Sweep::read(path).map(|part| (path.clone(), part))).collect();
            let sweep = Sweep::merge(parts?)?;
            if let Some(target) = &json {
                sweep.write(target)?;
            }
            invocation.terminal.print(&format!("{}\n\n", sweep.measured_by()))?;
            for scene in &sweep.grid.scenes {
                print_scene(&sweep, scene, invocation.terminal)?;
            }
            print_growth(&sweep, invocation.terminal)?;
            sweep
        }
    };
    if let Some(target) = csv {
        target.write(sweep::csv(&sweep).as_bytes())?;
    }
    if let Some(folder) = &args.plots {
        write_plots(&sweep, folder)?;
    }
    let points = sweep.grid.points()?;
    let missing = points.iter().filter(|point| !sweep.holds(point) && !failed(&sweep, point)).count();
    if missing > 0 {
        invocation.terminal.say(&format!("{missing} of the {} points of the grid are still missing", points.len()));
    }
    match sweep.failures.as_slice() {
        [] => Ok(()),
        [failure] => bail!("{failure}"),
        [first, others @ ..] => bail!("{} points failed, the first: {first}", others.len() + 1),
    }
}

/// Measures what is not yet measured of the grid, or of a part of it.
fn measure_grid(args: &SweepArgs, path: &Path, json: Option<&Target>, invocation: &Invocation<'_>) -> Result<Sweep> {
    let mut grid = Grid::load(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    for scene in &grid.scenes {
        scene.find(folder).map_err(|error| anyhow!("{}: {error}", path.display()))?;
    }
    if let Some(size) = args.size {
        grid.size = size;
        grid.scenes.iter_mut().for_each(|scene| scene.size = None);
    }
    grid.reference = args.reference.or(grid.reference);
    grid.frames = args.frames.unwrap_or(grid.frames);
    let mut points = grid.points()?;
    points.retain(|point| args.shard.is_none_or(|shard| shard.holds(point, grid.scenes.len())));

    let earlier = args.json.as_ref().filter(|path| !args.restart && path.is_file());
    let earlier = earlier.map(|path| Sweep::read(path).map(|sweep| (path, sweep))).transpose()?;
    let cache = grid.reference.map_or(Ok(None), |_| open_cache(false))?;
    let context = invocation.context(args.timed.crash_markers())?;
    let mut result = Sweep::new(grid.clone(), Device::from(&context.device()));
    if let Some((path, earlier)) = earlier {
        result = result.resume(path, earlier)?;
        let done = points.iter().filter(|point| result.holds(point)).count();
        invocation.terminal.say(&format!("{done} of {} points are done in {}", points.len(), path.display()));
    }
    invocation.terminal.print(&format!("{}\n\n", result.measured_by()))?;

    let pending = points.iter().filter(|point| !result.holds(point)).count();
    let progress = invocation.terminal.progress(pending as u64);
    let terminal = invocation.terminal;
    let mut bench = Bench {
        context: &context,
        grid: &grid,
        folder,
        load_options: args.load.options(),
        opened: None,
        cache: cache.as_ref(),
        progress: &progress,
        terminal,
    };
    let mut done = 0;
    let mut measure = |group: &Group<'_>| {
        let outcome = bench.measure(group);
        done += group.points.len() as u64;
        bench.progress.at(done);
        outcome
    };
    // A reader of the tables sees a scene as soon as its last point is done.
    let mut shown = 0;
    let mut save = |sweep: &Sweep| -> Result<()> {
        if let Some(target) = json.filter(|target| !target.is_stream()) {
            sweep.write(target)?;
        }
        while shown < grid.scenes.len() && is_done(sweep, &points, shown) {
            print_scene(sweep, &grid.scenes[shown], invocation.terminal)?;
            shown += 1;
        }
        Ok(())
    };
    save(&result)?;
    sweep::run(&mut result, &points, &mut measure, &mut save)?;
    drop(progress);
    // What was saved into a stream cannot be taken back.
    if let Some(target) = json.filter(|target| target.is_stream()) {
        result.write(target)?;
    }
    print_growth(&result, terminal)?;
    invocation.check_validation(&context)?;
    Ok(result)
}

/// Whether all points of a scene have been measured or have failed.
fn is_done(sweep: &Sweep, points: &[Point], scene: usize) -> bool {
    points.iter().filter(|point| point.scene == scene).all(|point| sweep.holds(point) || failed(sweep, point))
}

fn failed(sweep: &Sweep, point: &Point) -> bool {
    sweep.failures.iter().any(|failure| failure.id == point.id)
}

/// What measures the groups, and the scene that is open.
struct Bench<'a> {
    context: &'a Context,
    grid: &'a Grid,
    /// Where the grid lies: its files are seen from there.
    folder: &'a Path,
    load_options: LoadOptions,
    opened: Option<Opened>,
    /// Of the references, which are read from it again for every group.
    cache: Option<&'a Cache>,
    progress: &'a Progress,
    terminal: &'a Terminal,
}

struct Opened {
    name: String,
    scene: Scene,
    camera: CameraView,
    load_ms: f64,
}

impl Bench<'_> {
    fn measure(&mut self, group: &Group<'_>) -> Outcomes {
        self.progress.about(&group.scene.name);
        let opened = match self.opened.take() {
            Some(opened) if opened.name == group.scene.name => opened,
            _ => open(group.scene, self.folder, &self.load_options)?,
        };
        let Opened { name, scene, camera, load_ms } = &opened;
        let subject = Subject { name, scene, camera, load_ms: *load_ms };
        let contenders: Vec<Settings> = group.points.iter().map(|point| point.settings.clone()).collect();
        let Grid { frames, warmup, max_seconds, .. } = *self.grid;
        let size = self.grid.size_of(group.scene);
        let slots = self.grid.reference.is_some();
        let (pictures, pieces) = Default::default();
        let options = Options { size, frames, warmup, lead_in: None, max_seconds, pictures, slots, pieces };
        let outcomes = measure(self.context, &subject, &contenders, &options, &mut || ());
        let mut steps = Steps::new(self.terminal, &format!("reference of {name}"));
        let mut references = self
            .grid
            .reference
            .map(|spp| References::new(self.context, &subject, size, spp, self.cache, |progress| steps.show(progress)));
        let compared = outcomes.into_iter().zip(&contenders).map(|(outcome, settings)| {
            let mut finished = outcome.map_err(|failure| failure.error)?;
            if let Some(references) = &mut references {
                let compared = references.compare(&mut finished, settings);
                compared.map_err(|error| format!("{:#}", anyhow::Error::from(error)))?;
            }
            Ok(finished.run)
        });
        let compared = compared.collect();
        drop(references);
        self.opened = Some(opened);
        Ok(compared)
    }
}

fn open(scene: &GridScene, folder: &Path, options: &LoadOptions) -> Result<Opened, String> {
    let start = Instant::now();
    let opened = scene.open(folder, options)?;
    let load_ms = 1e3 * start.elapsed().as_secs_f64();
    warn_of(&opened, "add one in the grid, light = [\"sun:45,60\"], or a sky, sky = [1, 1, 1]");
    let camera = opened.camera_view(scene.camera.as_deref()).map_err(|error| error.to_string())?;
    Ok(Opened { name: scene.name.clone(), scene: opened, camera, load_ms })
}

fn print_scene(sweep: &Sweep, scene: &GridScene, terminal: &Terminal) -> Result<()> {
    let text = sweep::scene_text(sweep, &scene.name);
    if text.is_empty() { Ok(()) } else { terminal.print(&format!("{text}\n")) }
}

fn print_growth(sweep: &Sweep, terminal: &Terminal) -> Result<()> {
    let text = sweep::growth_text(sweep);
    if text.is_empty() { Ok(()) } else { terminal.print(&format!("{text}\n")) }
}

/// A plot for every scene that has points with an error.
fn write_plots(sweep: &Sweep, folder: &Path) -> Result<()> {
    for scene in &sweep.grid.scenes {
        match sweep::plot(sweep, &scene.name) {
            Some(text) => {
                let path = folder.join(files::from_words(&[&scene.name]) + ".svg");
                Target::from(&path).write(text.as_bytes())?;
            }
            None => tracing::warn!("{} has no point with an error, so there is no plot of it", scene.name),
        }
    }
    Ok(())
}
