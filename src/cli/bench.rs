//! `irradia bench`: techniques side by side on scenes; tables to standard output, reports to files.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context as _, Result, bail};
use clap::Args;
use irradia::bench::over_time::{Comparing, Played, Sequence, over_time_text, play, steps_per_contender};
use irradia::bench::report::{Failure, Report, Run};
use irradia::bench::{ErrorsUnknown, Finished, Options, PICTURE_TONE_MAP, References, Subject, run as measure, tables};
use irradia::output::{self, Target};
use irradia::reference::Cache;
use irradia::renderer::{Context, Preset, Settings, Technique};

use super::attributes::Picture;
use super::files;
use super::invocation::{Invocation, TimedArgs};
use super::method_args::OptionArgs;
use super::over_time_args::OverTimeArgs;
use super::reference;
use super::scene_args::SceneArgs;
use super::terminal::{Progress, Steps, Terminal};
use super::values::{self, Choice};

/// Measure techniques on scenes, pass by pass
#[derive(Debug, Args)]
pub(crate) struct BenchArgs {
    /// .gltf or .glb files, or names of built-in scenes
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
    /// The techniques to compare, a list, or all
    #[arg(long, value_delimiter = ',', value_parser = values::technique_choice(), default_value = Technique::Rsm.name())]
    technique: Vec<Choice<Technique>>,
    /// The presets to measure each technique at, a list
    #[arg(long, value_delimiter = ',', value_parser = values::preset(), default_value = Preset::Default.name())]
    preset: Vec<Preset>,
    /// Rounds; each technique renders in each round in turn. With --animate the frames of the sequence
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..))]
    frames: u32,
    /// Frames of each technique before the rounds, after its first, which is timed apart
    #[arg(long, value_name = "N", default_value_t = 2)]
    warmup: u32,
    /// Frames of each technique before the rounds so that what it keeps over frames has settled; with any, frames without a past are timed too
    /// [default: what its methods need; none if no method keeps anything]
    #[arg(long, value_name = "N")]
    lead_in: Option<u32>,
    /// Also time a piece on its own, such as caustics/photons/lists: its inputs are made once, it alone is repeated; may be given again
    #[arg(long, value_name = "PIECE")]
    piece: Vec<String>,
    /// Samples per pixel of references by path tracing, to say how far each technique is from them
    #[arg(long, value_name = "SPP", value_parser = clap::value_parser!(u32).range(1..))]
    reference: Option<u32>,
    /// Neither read nor write the cache of references
    #[arg(long, requires = "reference")]
    no_cache: bool,
    /// Write everything as JSON, schema irradia-bench/1
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the tables as CSV
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write the tables as Markdown
    #[arg(long, value_name = "FILE")]
    md: Option<PathBuf>,
    /// Write a PNG of every run into this folder
    #[arg(long, value_name = "DIR")]
    images: Option<PathBuf>,
    #[command(flatten)]
    over_time: OverTimeArgs,
    #[command(flatten)]
    timed: TimedArgs,
    #[command(flatten)]
    options: OptionArgs,
    #[command(flatten)]
    scene_args: SceneArgs,
}

/// Runs all scenes, prints their tables, writes the reports. What fails is told at the end.
pub(crate) fn run(args: &BenchArgs, invocation: &Invocation<'_>) -> Result<()> {
    let bench = Bench::new(args, invocation)?;
    let mut report = Report::new(&bench.context.device());
    invocation.terminal.print(&format!("{}\n\n", report.heading()))?;

    let progress = invocation.terminal.progress(bench.frames_per_scene() * args.scenes.len() as u64);
    for (index, spec) in args.scenes.iter().enumerate() {
        progress.about(spec);
        let (runs, mut failures) = match bench.scene(spec, &report.runs, &progress) {
            Ok(outcome) => outcome,
            Err(error) => {
                (Vec::new(), vec![Failure { scene: spec.clone(), error: format!("{error:#}"), ..Failure::default() }])
            }
        };
        progress.at(bench.frames_per_scene() * (index as u64 + 1));
        if !runs.is_empty() {
            let shown: Vec<&Run> = runs.iter().collect();
            let text = format!("{}\n{}", tables::scene_text(&shown), over_time_text(&shown));
            invocation.terminal.print(&text)?;
            if let Err(error) = args.over_time.write_plots(&shown) {
                failures.push(Failure { scene: spec.clone(), error: format!("{error:#}"), ..Failure::default() });
            }
        }
        report.runs.extend(runs);
        report.failures.extend(failures);
    }
    drop(progress);
    if report.runs.len() > 1 {
        invocation.terminal.print(&tables::summary_text(&report.runs))?;
    }
    bench.files.write(&report)?;
    args.over_time.write_csv(&report.runs)?;
    invocation.check_validation(&bench.context)?;
    match report.failures.as_slice() {
        [] => Ok(()),
        [failure] => bail!("{failure}"),
        failures => bail!("{} runs failed: {}", failures.len(), sentences(failures)),
    }
}

/// What stays the same from scene to scene.
struct Bench<'a> {
    args: &'a BenchArgs,
    context: Context,
    contenders: Vec<Settings>,
    options: Options,
    files: ReportFiles,
    cache: Option<Cache>,
    terminal: &'a Terminal,
}

impl Bench<'_> {
    /// Finds out what can go wrong before the first frame: devices, and files that could not be written.
    fn new<'a>(args: &'a BenchArgs, invocation: &Invocation<'a>) -> Result<Bench<'a>> {
        let files = ReportFiles::open(args)?;
        args.scene_args.flight()?;
        let mut contenders = Vec::new();
        for technique in Choice::expand(&args.technique, &Technique::ALL) {
            for preset in &args.preset {
                contenders.push(args.options.settings(technique, *preset)?);
            }
        }
        let pictures = args.images.is_some();
        let (size, frames, warmup) = (args.scene_args.size, args.frames, args.warmup);
        let (pieces, slots) = (args.piece.clone(), args.reference.is_some());
        let lead_in = args.lead_in;
        let options = Options { size, frames, warmup, lead_in, max_seconds: None, pictures, slots, pieces };
        let cache = args.reference.map_or(Ok(None), |_| reference::open_cache(args.no_cache))?;
        let context = invocation.context(args.timed.crash_markers())?;
        if let Some(folder) = &args.images {
            fs::create_dir_all(folder).with_context(|| format!("the folder {} cannot be made", folder.display()))?;
        }
        args.over_time.make_folder()?;
        Ok(Bench { args, context, contenders, options, files, cache, terminal: invocation.terminal })
    }

    fn frames_per_scene(&self) -> u64 {
        let steps = match self.args.over_time.fps() {
            Some(_) => steps_per_contender(&self.options),
            None => self.options.frames_per_contender(),
        };
        steps * self.contenders.len() as u64
    }

    /// Measures all contenders on one scene and writes their pictures.
    fn scene(&self, spec: &str, earlier: &[Run], progress: &Progress) -> Result<(Vec<Run>, Vec<Failure>)> {
        let loaded = self.args.scene_args.open(spec)?;
        let camera = self.args.scene_args.view(&loaded.scene, 0.0)?;
        // Two files may hold scenes of the same name; then the path tells them apart.
        let known = earlier.iter().any(|run| run.scene == loaded.scene.name);
        let name = if known { spec } else { &loaded.scene.name };
        let subject = Subject { name, scene: &loaded.scene, camera: &camera, load_ms: loaded.load_ms };
        if let Some(fps) = self.args.over_time.fps() {
            return self.play(&subject, fps, progress);
        }
        let outcomes = measure(&self.context, &subject, &self.contenders, &self.options, &mut || progress.step());
        let mut steps = Steps::new(self.terminal, &format!("reference of {name}"));
        let mut references = self.args.reference.map(|spp| {
            let show = |progress| steps.show(progress);
            References::new(&self.context, &subject, self.options.size, spp, self.cache.as_ref(), show)
        });
        let (mut runs, mut failures) = (Vec::new(), Vec::new());
        for (outcome, settings) in outcomes.into_iter().zip(&self.contenders) {
            let mut finished = match outcome {
                Ok(finished) => finished,
                Err(failure) => {
                    failures.push(failure);
                    continue;
                }
            };
            let failure = |error: String| Failure { error, ..failure_of(name, settings) };
            if let Some(made) = &mut references {
                match made.compare(&mut finished, settings) {
                    Ok(()) => {}
                    Err(error @ ErrorsUnknown::Reference(_)) => {
                        // It is the scene's failure, and that of all contenders to come.
                        failures.push(Failure { technique: None, preset: None, ..failure(error.to_string()) });
                        references = None;
                    }
                    Err(error) => failures.push(failure(format!("{:#}", anyhow::Error::from(error)))),
                }
            }
            if let Err(error) = self.write_picture(&finished, settings) {
                failures.push(failure(format!("{error:#}")));
            }
            runs.push(finished.run);
        }
        Ok((runs, failures))
    }

    /// Plays one scene frame by frame with all contenders.
    fn play(&self, subject: &Subject<'_>, fps: f64, progress: &Progress) -> Result<(Vec<Run>, Vec<Failure>)> {
        let flight = self.args.scene_args.flight()?;
        let sequence = Sequence {
            fps,
            flight: flight.as_ref(),
            camera: self.args.scene_args.camera.as_deref(),
            lag: self.args.over_time.lag(),
            compare: self.args.reference.map(|spp| Comparing { spp, cache: self.cache.as_ref() }),
        };
        let step = &mut || progress.step();
        let Played { outcomes, failure } =
            play(&self.context, subject, &self.contenders, &self.options, &sequence, step);
        let (mut runs, mut failures) = (Vec::new(), Vec::from_iter(failure));
        for (outcome, settings) in outcomes.into_iter().zip(&self.contenders) {
            match outcome {
                Ok(finished) => {
                    if let Err(error) = self.write_picture(&finished, settings) {
                        failures.push(Failure { error: format!("{error:#}"), ..failure_of(subject.name, settings) });
                    }
                    runs.push(finished.run);
                }
                Err(failure) => failures.push(failure),
            }
        }
        Ok((runs, failures))
    }

    fn write_picture(&self, finished: &Finished, settings: &Settings) -> Result<()> {
        let (Some(folder), Some(pixels)) = (&self.args.images, &finished.picture) else { return Ok(()) };
        let run = &finished.run;
        let path = folder.join(files::from_words(&[&run.scene, &run.technique, &run.preset]) + ".png");
        let device = self.context.device();
        let picture = Picture {
            scene: &run.scene,
            camera: &run.camera,
            frame: run.over_time.as_ref().map_or(0, |_| run.frames.saturating_sub(1)),
            lead_in: run.lead_in,
            size: run.size,
            settings,
            device: &device,
            tonemap: Some(PICTURE_TONE_MAP),
            aa: 1,
            estimate: None,
        };
        Ok(output::write_png(&path, run.size, pixels, &picture.attributes())?)
    }
}

/// The files that tell what was measured.
struct ReportFiles {
    json: Option<Target>,
    csv: Option<Target>,
    md: Option<Target>,
}

impl ReportFiles {
    fn open(args: &BenchArgs) -> Result<ReportFiles> {
        let open = |path: &Option<PathBuf>| path.as_deref().map(Target::open).transpose();
        Ok(ReportFiles { json: open(&args.json)?, csv: open(&args.csv)?, md: open(&args.md)? })
    }

    fn write(&self, report: &Report) -> Result<()> {
        if let Some(target) = &self.json {
            target.write((serde_json::to_string_pretty(report)? + "\n").as_bytes())?;
        }
        if let Some(target) = &self.csv {
            target.write(tables::csv(report).as_bytes())?;
        }
        if let Some(target) = &self.md {
            target.write(tables::markdown(report).as_bytes())?;
        }
        Ok(())
    }
}

fn failure_of(scene: &str, settings: &Settings) -> Failure {
    Failure {
        scene: scene.to_owned(),
        technique: Some(settings.technique.name().to_owned()),
        preset: Some(settings.preset.name().to_owned()),
        ..Failure::default()
    }
}

fn sentences(failures: &[Failure]) -> String {
    failures.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}
