//! What every subcommand has besides its own arguments.

use anyhow::{Result, bail};
use clap::{ArgAction, Args, ValueEnum};
use irradia::renderer::{Context, ContextOptions, CrashMarkers, Validation};

use super::terminal::Terminal;

/// What every subcommand takes.
#[derive(Debug, Args)]
#[command(next_help_heading = "Everywhere")]
pub(super) struct GlobalArgs {
    /// The device to use: a part of its name or its index in `irradia devices` [default: the first discrete GPU, else
    /// integrated, else CPU]
    #[arg(long, global = true, value_name = "NAME|INDEX")]
    pub(super) device: Option<String>,
    /// Vulkan validation layers; any message they have makes the command fail
    #[arg(long, global = true, value_enum, default_value_t = ValidationChoice::Off)]
    pub(super) validation: ValidationChoice,
    /// Errors and results only: no progress, no warnings
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(super) quiet: bool,
    /// Say more; twice for everything
    #[arg(short, long, global = true, action = ArgAction::Count)]
    pub(super) verbose: u8,
}

/// The values of `--validation`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum ValidationChoice {
    /// None
    Off,
    /// Correct use of the interface
    Core,
    /// The same, and hazards between commands
    Sync,
    /// The same, and what only shows on the device, such as indices out of bounds
    Gpu,
}

/// What a subcommand has besides its own arguments.
pub(super) struct Invocation<'a> {
    pub(super) global: &'a GlobalArgs,
    pub(super) terminal: &'a Terminal,
}

impl Invocation<'_> {
    /// The device that the arguments choose, for frames whose passes leave marks on it or do not.
    pub(super) fn context(&self, crash_markers: CrashMarkers) -> Result<Context> {
        let validation = match self.global.validation {
            ValidationChoice::Off => Validation::Off,
            ValidationChoice::Core => Validation::Core,
            ValidationChoice::Sync => Validation::Synchronization,
            ValidationChoice::Gpu => Validation::GpuAssisted,
        };
        let device = self.global.device.clone();
        Ok(Context::new(&ContextOptions { device, validation, crash_markers })?)
    }

    /// Fails if the validation layers had anything to say.
    pub(super) fn check_validation(&self, context: &Context) -> Result<()> {
        let messages = context.validation_messages();
        let Some(first) = messages.first() else { return Ok(()) };
        for message in &messages[1..] {
            tracing::warn!("validation: {message}");
        }
        bail!("the validation layers have {} message(s), the first: {first}", messages.len());
    }
}

/// What subcommands take whose frames are timed.
#[derive(Clone, Copy, Debug, Args)]
pub(super) struct TimedArgs {
    /// Let each pass leave a mark on the device when it has finished, so that a lost device names the last one; costs time on a GPU
    #[arg(long)]
    crash_markers: bool,
}

impl TimedArgs {
    pub(super) fn crash_markers(self) -> CrashMarkers {
        if self.crash_markers { CrashMarkers::On } else { CrashMarkers::Off }
    }
}

/// Wrong usage that only several arguments together show.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub(super) struct WrongUsage {
    pub(super) subcommand: &'static str,
    pub(super) message: &'static str,
}
