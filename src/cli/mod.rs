//! The command line: arguments in, library calls, sentences out. One file a subcommand.
//!
//! Tables and results go to standard output; progress, warnings and errors to standard error. Exit status: 0 done,
//! 1 a failure said in one sentence, 2 wrong usage.

mod attributes;
mod bake;
mod bench;
mod compare;
mod devices;
mod files;
mod graph;
mod invocation;
mod method_args;
mod over_time_args;
mod reference;
mod render;
mod scene_args;
mod scenes;
mod settings;
mod sweep;
mod terminal;
mod values;

use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser, Subcommand};

use self::invocation::{GlobalArgs, Invocation, WrongUsage};
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

#[derive(Debug, Subcommand)]
enum Command {
    Render(render::RenderArgs),
    Bake(bake::BakeArgs),
    Bench(bench::BenchArgs),
    Sweep(sweep::SweepArgs),
    Compare(compare::CompareArgs),
    Reference(reference::ReferenceArgs),
    Graph(graph::GraphArgs),
    Scenes(scenes::ScenesArgs),
    Settings(settings::SettingsArgs),
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
        Command::Bake(args) => bake::run(args, &invocation),
        Command::Bench(args) => bench::run(args, &invocation),
        Command::Sweep(args) => sweep::run(args, &invocation),
        Command::Compare(args) => compare::run(args, &invocation),
        Command::Reference(args) => reference::run(args, &invocation),
        Command::Graph(args) => graph::run(args, &invocation),
        Command::Scenes(args) => scenes::run(args, &invocation),
        Command::Settings(args) => settings::run(args, &invocation),
        Command::Devices(args) => devices::run(args, &invocation),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            if let Some(usage) = error.downcast_ref() {
                exit_of(usage);
            }
            terminal.error(&format!("{error:#}"));
            ExitCode::FAILURE
        }
    }
}

/// Says that the usage is wrong as the parser would, and ends with status 2.
fn exit_of(usage: &WrongUsage) -> ! {
    let mut cli = Cli::command();
    cli.build();
    let command = match cli.find_subcommand_mut(usage.subcommand) {
        Some(command) => command,
        None => &mut cli,
    };
    command.error(ErrorKind::ArgumentConflict, usage.message).exit()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arguments_are_consistent() {
        Cli::command().debug_assert();
    }
}
