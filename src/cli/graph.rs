//! `irradia graph`: the passes of a frame, and which are skipped and why.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;
use irradia::output::Target;
use irradia::renderer::{CrashMarkers, FrameRequest, Renderer};

use super::invocation::Invocation;
use super::method_args::MethodArgs;
use super::scene_args::SceneArgs;

/// Show the passes of a frame, and which are skipped and why
#[derive(Debug, Args)]
pub(crate) struct GraphArgs {
    /// A .gltf or .glb file, or the name of a built-in scene
    scene: String,
    /// Also write the graph for Graphviz to this file
    #[arg(long, value_name = "FILE")]
    dot: Option<PathBuf>,
    #[command(flatten)]
    methods: MethodArgs,
    #[command(flatten)]
    scene_args: SceneArgs,
}

/// Describes the frame that the bench would measure; nothing is rendered.
pub(crate) fn run(args: &GraphArgs, invocation: &Invocation<'_>) -> Result<()> {
    let dot = args.dot.as_deref().map(Target::open).transpose()?;
    let settings = args.methods.settings()?;
    let scene = args.scene_args.open(&args.scene)?.scene;
    let context = invocation.context(CrashMarkers::On)?;
    let request = FrameRequest::new(args.scene_args.size, args.scene_args.view(&scene, 0.0)?);
    let request = request.with(|request| request.read_back = false);
    let description = Renderer::new(&context, settings)?.describe(&scene, &request)?;
    if let Some(target) = dot {
        target.write(description.dot().as_bytes())?;
    }
    invocation.terminal.print(&format!("{}\n", description.text().trim_end()))?;
    invocation.check_validation(&context)
}
