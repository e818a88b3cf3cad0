//! The command line: arguments in, library calls, sentences out. One file a subcommand.
//!
//! Tables and results go to standard output; progress, warnings and errors to standard error. Exit status: 0 done,
//! 1 a failure said in one sentence, 2 wrong usage.

mod attributes;
mod bench;
mod compare;
mod devices;
mod files;
mod graph;
mod method_args;
mod reference;
mod render;
mod scene_args;
mod scenes;
mod sweep;
mod terminal;
mod values;

use std::process::ExitCode;

use anyhow::bail;
use clap::error::ErrorKind;
use clap::{ArgAction, Args, CommandFactory, Parser, Subcommand, ValueEnum};
use irradia::renderer::{Context, ContextOptions, Validation};

use self::terminal::{Terminal, Verbosity};

/// Headless global illumination with Vulkan, and the bench that says what each method costs.
#[derive(Debug, Parser)]
#[command(name = "irradia", version, arg_required_else_help = true)]
struct Cli {
    #[command(flatten)]
    global: GlobalArgs,
    #[command(subcommand)]
    command: Command,
}

/// What every subcommand takes.
#[derive(Debug, Args)]
#[command(next_help_heading = "Everywhere")]
struct GlobalArgs {
    /// The device to use: a part of its name or its index in `irradia devices` [default: the first discrete GPU, else
    /// integrated, else CPU]
    #[arg(long, global = true, value_name = "NAME|INDEX")]
    device: Option<String>,
    /// Vulkan validation layers; any message they have makes the command fail
    #[arg(long, global = true, value_enum, default_value_t = ValidationChoice::Off)]
    validation: ValidationChoice,
    /// Errors and results only: no progress, no warnings
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Say more; twice for everything
    #[arg(short, long, global = true, action = ArgAction::Count)]
    verbose: u8,
}

/// The values of `--validation`.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum ValidationChoice {
    /// None
    Off,
    /// Correct use of the interface
    Core,
    /// The same, and hazards between commands
    Sync,
    /// The same, and what only shows on the device, such as indices out of bounds
    Gpu,
}

#[derive(Debug, Subcommand)]
enum Command {
    Render(render::RenderArgs),
    Bench(bench::BenchArgs),
    Sweep(sweep::SweepArgs),
    Compare(compare::CompareArgs),
    Reference(reference::ReferenceArgs),
    Graph(graph::GraphArgs),
    Scenes(scenes::ScenesArgs),
    Devices(devices::DevicesArgs),
}

/// Parses the arguments, runs the subcommand, and says what went wrong.
pub(crate) fn main() -> ExitCode {
    let cli = Cli::parse();
    let verbosity = match (cli.global.quiet, cli.global.verbose) {
        (true, _) => Verbosity::Quiet,
        (false, 0) => Verbosity::Normal,
        (false, 1) => Verbosity::Verbose,
        (false, _) => Verbosity::Everything,
    };
    let terminal = Terminal::new(verbosity);
    let invocation = Invocation { global: &cli.global, terminal: &terminal };
    let done = match &cli.command {
        Command::Render(args) => render::run(args, &invocation),
        Command::Bench(args) => bench::run(args, &invocation),
        Command::Sweep(args) => sweep::run(args, &invocation),
        Command::Compare(args) => compare::run(args, &invocation),
        Command::Reference(args) => reference::run(args, &invocation),
        Command::Graph(args) => graph::run(args, &invocation),
        Command::Scenes(args) => scenes::run(args, &invocation),
        Command::Devices(args) => devices::run(args, &invocation),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            terminal.error(&format!("{error:#}"));
            ExitCode::FAILURE
        }
    }
}

/// What a subcommand has besides its own arguments.
struct Invocation<'a> {
    global: &'a GlobalArgs,
    terminal: &'a Terminal,
}

impl Invocation<'_> {
    /// The device that the arguments choose.
    fn context(&self) -> anyhow::Result<Context> {
        let validation = match self.global.validation {
            ValidationChoice::Off => Validation::Off,
            ValidationChoice::Core => Validation::Core,
            ValidationChoice::Sync => Validation::Synchronization,
            ValidationChoice::Gpu => Validation::GpuAssisted,
        };
        Ok(Context::new(&ContextOptions { device: self.global.device.clone(), validation })?)
    }

    /// Fails if the validation layers had anything to say.
    fn check_validation(&self, context: &Context) -> anyhow::Result<()> {
        let messages = context.validation_messages();
        let Some(first) = messages.first() else { return Ok(()) };
        for message in &messages[1..] {
            tracing::warn!("validation: {message}");
        }
        bail!("the validation layers have {} message(s), the first: {first}", messages.len());
    }
}

/// Wrong usage that only several arguments together show: says so as the parser would, and ends with status 2.
fn wrong_usage(subcommand: &str, message: &str) -> ! {
    let mut cli = Cli::command();
    cli.build();
    let command = match cli.find_subcommand_mut(subcommand) {
        Some(command) => command,
        None => &mut cli,
    };
    command.error(ErrorKind::ArgumentConflict, message).exit()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arguments_are_consistent() {
        Cli::command().debug_assert();
    }
}
