//! Light paths go where they are of use: to what gathers light, and not on and on after that.

use super::path_probe::{Ask, Tracer};
use super::scenes::builtin;
use super::session::Session;
use crate::renderer::Slot;

/// Without targets the noise is twice as high; where roulette compares with what each path itself carried it takes half as many rays again.
#[test]
fn caustics_of_a_small_ring_take_few_rays() {
    const SIDE: u32 = 64;
    const SAMPLES: u32 = 4;
    let session = Session::open();
    let scene = builtin("ring");
    let camera = scene.camera_view(None).expect("its camera");
    let traced = Tracer::new(&session).trace(&scene, &Ask::new([SIDE; 2], SAMPLES, camera));
    let rays = traced.cost.rays as f64 / f64::from(2 * SAMPLES * SIDE * SIDE);
    let noise = traced.error(Slot::Caustics) * f64::from(SIDE) / traced.mean(Slot::Caustics).x;
    println!("{rays:.1} rays a sample, noise {:.1} % of caustics", 100.0 * noise);
    assert!(rays < 27.0, "{rays} rays a sample");
    assert!(noise < 0.35, "noise {noise}");
}
