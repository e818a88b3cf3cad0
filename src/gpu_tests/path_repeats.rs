//! The same samples give the same bits; other samples differ by as much as their noise says; the noise falls as it should.

use glam::DVec3;

use super::path_probe::{Ask, Traced, Tracer};
use super::scenes::builtin;
use super::session::Session;
use crate::renderer::Slot;

fn rmse(a: &[DVec3], b: &[DVec3]) -> f64 {
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (*a - *b).length_squared() / 3.0).sum();
    (squares / a.len() as f64).sqrt()
}

fn trace(tracer: &mut Tracer, name: &str, size: [u32; 2], samples: u32, seed: u32) -> Traced {
    let scene = builtin(name);
    let camera = scene.camera_view(None).expect("its camera");
    tracer.trace(&scene, &Ask { seed, bounces: Some(3), ..Ask::new(size, samples, camera) })
}

#[test]
fn the_same_samples_have_the_same_bits_whatever_came_before() {
    let session = Session::open();
    let mut kept = Tracer::new(&session);
    for (name, size) in [("cornell-panel", [17, 5]), ("ring", [40, 24]), ("cornell-panel", [1, 1])] {
        let first = trace(&mut kept, name, size, 3, 7);
        let again = trace(&mut kept, name, size, 3, 7);
        let fresh = trace(&mut Tracer::new(&session), name, size, 3, 7);
        first.assert_finite(name);
        assert!(first.halves == again.halves, "{name}: a second time");
        assert!(first.halves == fresh.halves, "{name}: by a tracer that knew no other scene");
        assert!(first.halves[0] != first.halves[1], "{name}: the halves are independent");
    }
}

#[test]
fn noise_falls_with_the_root_of_the_samples() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let size = [32, 32];
    let counts = [4, 16, 64, 256];
    let long = trace(&mut tracer, "cornell-panel", size, 2048, 1).slot(Slot::Diffuse);
    let points: Vec<(f64, f64)> = counts
        .iter()
        .map(|&count| {
            let traced = trace(&mut tracer, "cornell-panel", size, count, 2);
            let [a, b] = [0, 1].map(|half| &traced.halves[half][2]);
            let (error, estimate) = (rmse(&traced.slot(Slot::Diffuse), &long), 0.5 * rmse(a, b));
            println!("2·{count} samples: rmse {error:.2e}, by the halves {estimate:.2e}");
            // The long run has noise of its own.
            assert!((error / estimate - 1.0).abs() < 0.15, "{count}: {error:.2e} is not {estimate:.2e}");
            (f64::from(count).ln(), error.ln())
        })
        .collect();
    let slope = (points[3].1 - points[0].1) / (points[3].0 - points[0].0);
    println!("slope {slope:.3}");
    assert!((-0.75..-0.45).contains(&slope), "the error falls with the power {slope}");
}
