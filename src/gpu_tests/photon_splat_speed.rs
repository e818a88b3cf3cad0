//! What splatting photons costs. Not a test; run it with
//!
//! `IRRADIA_TEST_VALIDATION=off cargo test --lib photon_splat_speed -- --ignored --nocapture`
//!
//! SPLAT_SIDES, SPLAT_CASES, SPLAT_DOWNSCALES, SPLAT_WAYS and SPLAT_FRAMES choose, each a list with spaces.

use std::collections::BTreeMap;

use glam::DVec3;

use super::session::Session;
use super::splat_bench::{Bench, Landed, from_above, random, settings, white_floor};
use crate::renderer::Timing;

/// Photons, their radius in pixels of 512, how much of the image they cover.
const CASES: [(usize, f64, f64); 6] = [
    (0, 1.0, 1.0),
    (38_000, 8.0, 1.0),
    (38_000, 8.0, 0.4),
    (200_000, 8.0, 1.0),
    (200_000, 3.5, 1.0),
    (200_000, 3.5, 0.4),
];

/// Seconds that all threads but this one have computed, on Linux: those of a software driver.
fn driver_seconds() -> f64 {
    let own = std::fs::read_link("/proc/thread-self").unwrap_or_default();
    let tasks = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let others = tasks.map(|task| task.path()).filter(|path| path.file_name() != own.file_name());
    let nanoseconds = |path: std::path::PathBuf| -> Option<f64> {
        std::fs::read_to_string(path.join("schedstat")).ok()?.split(' ').next()?.parse().ok()
    };
    others.filter_map(nanoseconds).sum::<f64>() * 1e-9
}

/// Milliseconds of the splatting's passes, at best, and of a frame in processor time over two cores, which other work disturbs less.
#[test]
#[ignore = "a measurement"]
fn times() {
    let session = Session::open();
    let scene = white_floor();
    let choice = |name: &str, all: &str| std::env::var(name).unwrap_or_else(|_| all.to_owned());
    for side in choice("SPLAT_SIDES", "512 1024").split(' ').map(|side| side.parse::<u32>().expect("a number")) {
        let mut bench = Bench::new(&session, &scene, &from_above(), [side; 2]);
        let pixel = (bench.on_floor(1.0, 0.0) - bench.on_floor(0.0, 0.0)).length() * f64::from(side) / 512.0;
        for case in choice("SPLAT_CASES", "0 1 2 3 4 5").split(' ') {
            let (count, radius, spread) = CASES[case.parse::<usize>().expect("a number")];
            let mut seed = 3;
            let photons: Vec<Landed> = (0..count)
                .map(|_| {
                    let place = [0, 1].map(|_| {
                        let flat = random(&mut seed) - 0.5;
                        f64::from(side) * (0.5 + spread * flat)
                    });
                    let radius = radius * pixel * (0.7 + 0.6 * random(&mut seed));
                    let position = bench.on_floor(place[0], place[1]);
                    Landed { position, normal: DVec3::Y, flux: [1.0; 3], radius }
                })
                .collect();
            for downscale in choice("SPLAT_DOWNSCALES", "1 2 4").split(' ') {
                for way in choice("SPLAT_WAYS", "tiles discs").split(' ') {
                    let settings = settings(&[("splat", way), ("downscale", downscale)]);
                    let mut best = BTreeMap::<String, f64>::new();
                    let (mut total, mut computed) = (f64::MAX, f64::MAX);
                    for _ in 0..choice("SPLAT_FRAMES", "5").parse().expect("a number") {
                        bench.store.invalidate();
                        let before = driver_seconds();
                        let passes = bench.run(&settings, &photons, Timing::Passes).1;
                        let mut sum = 0.0;
                        for pass in passes.iter().filter(|pass| pass.piece == "caustics/photons") {
                            let time = best.entry(pass.pass.clone()).or_insert(f64::MAX);
                            *time = time.min(pass.ms.unwrap_or(0.0));
                            sum += pass.ms.unwrap_or(0.0);
                        }
                        total = total.min(sum);
                        computed = computed.min((driver_seconds() - before) * 500.0);
                    }
                    let parts: Vec<String> =
                        best.iter().filter(|(_, ms)| **ms > 0.05).map(|(name, ms)| format!("{name} {ms:.2}")).collect();
                    println!(
                        "{side}² {count} r={radius} spread {spread} 1/{downscale} {way}: {total:.2} ms, computed {computed:.2} ms ({})",
                        parts.join(", ")
                    );
                }
            }
        }
    }
}
