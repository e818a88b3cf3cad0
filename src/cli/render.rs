//! `irradia render`: frames of a scene to files.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context as _, Result, bail};
use clap::Args;
use irradia::image::tone_map;
use irradia::output::{self, ImageFormat, Target};
use irradia::reference::IMAGE;
use irradia::renderer::{CrashMarkers, Frame, FrameRequest, Renderer, Slot, ToneMap};
use irradia::scene::{CameraView, FRAME_RATE};

use super::attributes::Picture;
use super::files;
use super::invocation::{Invocation, WrongUsage};
use super::method_args::MethodArgs;
use super::scene_args::SceneArgs;
use super::terminal::Progress;
use super::values::{self, Choice, FrameRange, ImagePath};

/// Render frames of a scene to EXR or PNG files
#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// A .gltf or .glb file, or the name of a built-in scene
    scene: String,
    /// Where the image goes: .exr holds linear radiance and slots, .png the tone-mapped image
    #[arg(short, long, value_name = "FILE", value_parser = values::image_path)]
    output: ImagePath,
    /// The frame of the scene's animation, at 30 frames a second
    #[arg(long, value_name = "N", default_value_t = 0)]
    frame: u32,
    /// Frames A to B, both included, a file each: out.0007.exr for out.exr, or the number in place of ####
    #[arg(long, value_name = "A..B", value_parser = values::frame_range, conflicts_with = "frame")]
    frames: Option<FrameRange>,
    /// Frames rendered before the first, for methods that keep something over frames [default: what these methods need; none if no method keeps anything]
    #[arg(long, value_name = "N")]
    lead_in: Option<u32>,
    /// Slots that an EXR file holds besides the image, as layers: a list, or all
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = values::slot_choice())]
    slots: Vec<Choice<Slot>>,
    /// Render N by N times the pixels and average them, with any technique
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=16))]
    aa: u32,
    /// How a PNG's pixels are made from radiance [default: aces]
    #[arg(long, value_parser = values::tone_map())]
    tonemap: Option<ToneMap>,
    #[command(flatten)]
    methods: MethodArgs,
    #[command(flatten)]
    scene_args: SceneArgs,
}

/// Host time by what it was spent on, seconds.
#[derive(Default)]
struct Spent {
    render: f64,
    write: f64,
}

/// Renders every frame asked for and says what was written.
pub(crate) fn run(args: &RenderArgs, invocation: &Invocation<'_>) -> Result<()> {
    let format = args.output.format;
    if format == ImageFormat::Png && !args.slots.is_empty() {
        let message = "a PNG holds the image alone; write an .exr to get its --slots";
        bail!(WrongUsage { subcommand: "render", message });
    }
    if format == ImageFormat::Exr && args.tonemap.is_some() {
        tracing::warn!("an EXR holds linear radiance, so --tonemap changes nothing");
    }
    let start = Instant::now();
    let mut opened = Some(Target::open(&path_of(args, args.frames.map_or(args.frame, |range| range.first)))?);
    let settings = args.methods.settings_of_pictures()?;
    let loaded = args.scene_args.open(&args.scene)?;
    let mut scene = loaded.scene;
    let context = invocation.context(CrashMarkers::On)?;
    let mut renderer = Renderer::new(&context, settings)?;
    let device = context.device();

    let lead_in = args.lead_in.unwrap_or(renderer.settings().lead_in());
    let FrameRange { first, last } = args.frames.unwrap_or(FrameRange { first: args.frame, last: args.frame });
    let frames = (last - first).saturating_add(lead_in.min(first)).saturating_add(1);
    let progress = (frames > 1).then(|| invocation.terminal.progress(u64::from(frames)));
    let mut spent = Spent::default();
    let mut noise = String::new();
    for number in first.saturating_sub(lead_in)..=last {
        scene.set_frame(number);
        let request = request(args, args.scene_args.view(&scene, f64::from(number) / FRAME_RATE)?, number);
        let rendering = Instant::now();
        if number < first {
            renderer.render(&scene, &request.with(|request| request.read_back = false))?;
            spent.render += rendering.elapsed().as_secs_f64();
            step(progress.as_ref());
            continue;
        }
        let frame = reduced(renderer.render(&scene, &request)?, args);
        spent.render += rendering.elapsed().as_secs_f64();

        noise = noise_of(&frame, args.aa);
        let camera = &request.camera.name;
        let picture = Picture {
            scene: &scene.name,
            camera,
            frame: number,
            lead_in: lead_in.min(first),
            size: frame.size,
            settings: renderer.settings(),
            device: &device,
            tonemap: (format == ImageFormat::Png).then(|| args.tonemap.unwrap_or_default()),
            aa: args.aa,
            estimate: frame.estimate.as_ref(),
        };
        let writing = Instant::now();
        let target = opened.take().unwrap_or_else(|| Target::from(&path_of(args, number)));
        write(&target, format, &frame, &picture)?;
        spent.write += writing.elapsed().as_secs_f64();
        step(progress.as_ref());
    }
    drop(progress);
    let (names, [width, height]) = (written_names(args, first, last), args.scene_args.size);
    invocation.terminal.say(&format!(
        "wrote {names} ({width}x{height}) in {:.2} s: scene {:.2} s, rendering {:.2} s, writing {:.2} s{noise}",
        start.elapsed().as_secs_f64(),
        1e-3 * loaded.load_ms,
        spent.render,
        spent.write,
    ));
    invocation.check_validation(&context)
}

fn step(progress: Option<&Progress>) {
    if let Some(progress) = progress {
        progress.step();
    }
}

fn request(args: &RenderArgs, camera: CameraView, number: u32) -> FrameRequest {
    // Supersampled pixels are averaged before they are tone-mapped.
    let display = args.output.format == ImageFormat::Png && args.aa == 1;
    let size = args.scene_args.size.map(|side| side.saturating_mul(args.aa));
    FrameRequest::new(size, camera).with(|request| {
        request.index = number;
        request.time_step = if number > 0 { (1.0 / FRAME_RATE) as f32 } else { 0.0 };
        request.slots = Choice::expand(&args.slots, &Slot::ALL);
        request.image = !display;
        request.tonemap = display.then(|| args.tonemap.unwrap_or_default());
    })
}

/// The frame at the size asked for.
fn reduced(mut frame: Frame, args: &RenderArgs) -> Frame {
    if args.aa > 1 {
        frame.size = args.scene_args.size;
        frame.image = frame.image.map(|image| output::box_reduced(&image, args.aa));
        for image in frame.slots.values_mut() {
            *image = output::box_reduced(image, args.aa);
        }
        if args.output.format == ImageFormat::Png {
            frame.display = frame.image.as_ref().map(|image| tone_map(image, args.tonemap.unwrap_or_default()));
        }
    }
    frame
}

/// What a path-traced frame says of itself.
fn noise_of(frame: &Frame, aa: u32) -> String {
    let Some(estimate) = &frame.estimate else { return String::new() };
    let pixels = f64::from(frame.size[0]) * f64::from(frame.size[1]);
    let seconds = estimate.seconds.max(1e-9);
    let noise =
        estimate.noise.get(IMAGE).map_or(String::new(), |noise| format!(", noise {:.3} %", 100.0 * noise.rrmse));
    format!(
        "; {} samples a pixel, {:.3} M samples/s, {:.3} M rays/s{noise}",
        estimate.spp,
        1e-6 * pixels * f64::from(estimate.spp * aa * aa) / seconds,
        1e-6 * estimate.rays as f64 / seconds,
    )
}

fn path_of(args: &RenderArgs, frame: u32) -> PathBuf {
    let path = &args.output.path;
    if args.frames.is_some() { files::numbered(path, frame) } else { files::single(path, frame) }
}

fn written_names(args: &RenderArgs, first: u32, last: u32) -> String {
    let (from, to) = (path_of(args, first), path_of(args, last));
    if from == to { from.display().to_string() } else { format!("{} to {}", from.display(), to.display()) }
}

fn write(target: &Target, format: ImageFormat, frame: &Frame, picture: &Picture<'_>) -> Result<()> {
    let attributes = picture.attributes();
    match format {
        ImageFormat::Exr => {
            let image = frame.image.as_ref().context("the renderer gave back no image")?;
            output::write_exr(target, image, &frame.slots, &attributes)?;
        }
        ImageFormat::Png => {
            let display = frame.display.as_ref().context("the renderer gave back no display values")?;
            output::write_png(target, frame.size, display, &attributes)?;
        }
        other => bail!("{} cannot be written as {other:?}", target.path().display()),
    }
    Ok(())
}
