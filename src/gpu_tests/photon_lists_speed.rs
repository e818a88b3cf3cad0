//! What rays through per-pixel lists cost and how many of them go astray.

use std::path::Path;

use super::photon_stage::{Found, Stage, coherent_rays, photon_options};
use super::scenes::builtin;
use super::session::Session;
use crate::scene::Scene;

/// Milliseconds that all threads of this process have run, over two cores.
fn cpu_ms() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let ticks = |field: usize| fields.get(field).and_then(|ticks| ticks.parse::<f64>().ok()).unwrap_or(0.0);
    (ticks(11) + ticks(12)) * 10.0 / 2.0
}

/// The values that an environment variable names, by commas.
fn named(variable: &str, default: &str) -> Vec<String> {
    std::env::var(variable).unwrap_or(default.to_owned()).split(',').map(str::to_owned).collect()
}

#[test]
#[ignore = "a measurement"]
fn rays_against_the_hierarchy() {
    const RUNS: u32 = 20;
    let session = Session::open();
    let views = named("IRRADIA_LIST_VIEWS", "1,2,3");
    for name in named("IRRADIA_LIST_SCENES", "ring,ring-occluded,cornell-point,water,two-rooms") {
        let scene = match Path::new(&name) {
            file if file.exists() => Scene::load(file).expect("a sound file"),
            _ => builtin(&name),
        };
        let mut stage = Stage::new(&session, scene);
        let rays = stage.surface_rays(38_000, 3);
        let timed = [("surface", rays.clone()), ("coherent", coherent_rays(195))];
        for resolution in named("IRRADIA_LIST_SIZES", "128,256") {
            for trace in named("IRRADIA_LIST_TRACES", "march,lines") {
                let place = format!("{name} {resolution} {trace}");
                let given = [("resolution", &*resolution), ("trace", &*trace)];
                for views in &views {
                    let settings = photon_options(&[&given[..], &[("views", views)]].concat());
                    println!("{place} {views} views: {}", stage.compare(&settings, &rays));
                }
                let settings = photon_options(&given);
                for (what, rays) in &timed {
                    let first = stage.trace(&settings, rays);
                    let before = cpu_ms();
                    let runs: Vec<Found> = (1..=RUNS).map(|salt| stage.trace_again(&settings, rays, salt)).collect();
                    let cpu = (cpu_ms() - before) / f64::from(RUNS);
                    let least = runs.iter().map(|run| run.ms(&format!("trace/{trace}"))).fold(f64::MAX, f64::min);
                    let steps = first.work("trace/march.0", "steps") as f64 / rays.len() as f64;
                    println!("{place} {} {what} rays: {least:.2} ms, cpu {cpu:.2} ms, {steps:.1} steps", rays.len());
                }
                let settings = &settings;
                let before = cpu_ms();
                let built: Vec<Found> = (0..RUNS).map(|_| stage.trace(settings, &[])).collect();
                let cpu = (cpu_ms() - before) / f64::from(RUNS);
                let least = |pass: &str| built.iter().map(|run| run.ms(pass)).fold(f64::MAX, f64::min);
                let nodes = built[0].work("lists/", "nodes");
                println!(
                    "{place} lists: {:.2} ms, of that blocks {:.2}, cpu {cpu:.2} ms, {nodes} nodes",
                    least("lists/"),
                    least("lists/blocks")
                );
            }
        }
    }
}
