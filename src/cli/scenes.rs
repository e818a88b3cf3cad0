//! `irradia scenes`: the built-in scenes and what each tests.

use anyhow::Result;
use clap::Args;
use irradia::scene::{Scene, builtin_names};

use super::Invocation;

/// List the built-in scenes
#[derive(Debug, Args)]
pub(crate) struct ScenesArgs {}

/// One line a scene: name, size, lights, what it tests.
pub(crate) fn run(_: &ScenesArgs, invocation: &Invocation<'_>) -> Result<()> {
    let names = builtin_names();
    let width = names.iter().map(|name| name.len()).max().unwrap_or_default();
    let mut text = format!("{:width$}  triangles  lights  what it tests\n", "scene");
    for name in names {
        let scene = Scene::open(name)?;
        let facts = scene.facts();
        let (triangles, lights) = (facts.triangles, facts.lights);
        let description = scene.description.as_deref().unwrap_or_default();
        text += &format!("{name:width$}  {triangles:>9}  {lights:>6}  {description}\n");
    }
    invocation.terminal.print(&text)
}
