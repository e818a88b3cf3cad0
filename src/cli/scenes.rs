//! `irradia scenes`: the built-in scenes and what each tests.

use anyhow::Result;
use clap::Args;
use irradia::scene::{Facts, Scene, builtin_names};

use super::invocation::Invocation;

/// List the built-in scenes
#[derive(Debug, Args)]
pub(crate) struct ScenesArgs {}

/// One line a scene: name, size, lights, what it tests.
pub(crate) fn run(_: &ScenesArgs, invocation: &Invocation<'_>) -> Result<()> {
    let names = builtin_names();
    let width = names.iter().map(|name| name.len()).max().unwrap_or_default();
    let mut text = format!("{:width$}  triangles  lights                    what it tests\n", "scene");
    for name in names {
        let scene = Scene::open(name)?;
        let facts = scene.facts();
        let (triangles, lights) = (facts.triangles, light_text(&facts));
        let description = scene.description.as_deref().unwrap_or_default();
        text += &format!("{name:width$}  {triangles:>9}  {lights:<24}  {description}\n");
    }
    invocation.terminal.print(&text)
}

/// Such as `2 point, 1 spot, surfaces`.
fn light_text(facts: &Facts) -> String {
    let kinds = [(facts.point_lights, "point"), (facts.spot_lights, "spot"), (facts.directional_lights, "directional")];
    let counted = kinds.into_iter().filter(|(count, _)| *count > 0).map(|(count, kind)| format!("{count} {kind}"));
    let areas = [(facts.emissive, "surfaces"), (facts.sky, "sky")];
    counted
        .chain(areas.into_iter().filter(|(present, _)| *present).map(|(_, kind)| kind.to_owned()))
        .collect::<Vec<_>>()
        .join(", ")
}
