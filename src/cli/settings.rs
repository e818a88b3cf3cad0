//! `irradia settings`: what `--set` takes, with values, ranges and costs.

use std::fmt::Write as _;

use anyhow::Result;
use clap::Args;

use super::invocation::Invocation;
use super::method_args::MethodArgs;

/// List what --set takes: each setting's value, range, unit, cost and meaning
#[derive(Debug, Args)]
pub(crate) struct SettingsArgs {
    #[command(flatten)]
    methods: MethodArgs,
}

/// Two lines a setting: its value and what it takes; what it means.
pub(crate) fn run(args: &SettingsArgs, invocation: &Invocation<'_>) -> Result<()> {
    let settings = args.methods.settings()?;
    let values = settings.options();
    let mut text = String::new();
    for (piece, table) in settings.tables() {
        for info in table {
            let value = values[piece][info.name].to_string().replace('"', "");
            let unit = if info.unit.is_empty() { String::new() } else { format!(" {}", info.unit) };
            let cost = if info.cost.is_empty() { String::new() } else { format!("; cost: {}", info.cost) };
            writeln!(text, "{piece}.{} = {value}{unit}   ({}{cost})\n    {}", info.name, info.kind, info.doc.trim())?;
        }
    }
    invocation.terminal.print(&text)
}
