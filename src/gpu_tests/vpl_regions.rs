//! `vpl` at regions: they partition the image, both ways to find them agree, and what is gathered at them is close to what every
//! pixel would gather.

use ash::vk;

use super::probe::{Probe, probe, slot};
use super::scenes::{builtin, request, vpl_settings};
use super::session::Session;
use crate::diffuse::vpl::rule_of;
use crate::frame::regions::{flattened_size, interpolate, level_count, pyramid};
use crate::frame::twins;
use crate::graph::ClearColor;
use crate::renderer::{ColorImage, Settings, Slot};

const SIZE: [u32; 2] = [270, 258];
const SCENES: [&str; 3] = ["cornell-point", "ring", "lights"];

fn with(shading: &str) -> Settings {
    vpl_settings(&[("vpl.shading", shading), ("vpl.count", "64"), ("lights.resolution", "64")])
}

fn diffuse(session: &Session, name: &str, size: [u32; 2], settings: &Settings) -> ColorImage {
    let scene = builtin(name);
    let request = request(size, scene.camera_view(None).expect("its camera"), &[Slot::Diffuse]);
    session.render(&scene, settings, &request).slots.remove(&Slot::Diffuse).expect("it was asked for")
}

fn words(floats: &[f32]) -> Vec<u32> {
    floats.iter().map(|float| float.to_bits()).collect()
}

/// The valid regions by their list, as texels of the flattened image, and whether each pixel shows a surface that takes diffuse light.
fn listed(session: &Session, name: &str) -> (Vec<[u32; 2]>, Vec<bool>) {
    let scene = builtin(name);
    let request = request(SIZE, scene.camera_view(None).expect("its camera"), &[]);
    let frame: Probe = probe(session, &scene, &with("compute"), &request, |graph, declared| {
        let list = declared.vpl.as_ref().and_then(|vpl| vpl.list).expect("a list");
        vec![
            graph.read_back_buffer(list),
            graph.read_back(declared.gbuffer.depth),
            graph.read_back(declared.gbuffer.surface),
            slot(graph, declared, Slot::Diffuse),
        ]
    });
    let list = words(&frame.floats(0));
    let count = list[3] as usize;
    assert_eq!(list[..3], [list[3].div_ceil(128), 1, 1], "the groups of the indirect dispatch");
    let pixels = frame.pixels([1, 2], SIZE);
    let takes = pixels.iter().map(|pixel| pixel.as_ref().is_some_and(|pixel| pixel.albedo.max_element() > 0.0));
    (list[4..4 + count].iter().map(|texel| [texel & 0xFFFF, texel >> 16]).collect(), takes.collect())
}

/// Level and cell of a texel of the flattened image (glsl/regions/regions.glsl).
fn region_of(texel: [u32; 2]) -> (u32, [u32; 2]) {
    let side_column = SIZE[0].next_multiple_of(4);
    if texel[0] < side_column {
        return (0, texel);
    }
    let top = |level: u32| SIZE[1] - (SIZE[1] >> (level - 1));
    let level = (1..7).rev().find(|&level| texel[1] >= top(level)).expect("level 1 begins at 0");
    (level, [texel[0] - side_column, texel[1] - top(level)])
}

#[test]
fn every_pixel_that_takes_light_lies_in_one_valid_region() {
    let session = Session::open();
    for name in SCENES {
        let (regions, takes) = listed(&session, name);
        let mut covered = vec![0_u32; takes.len()];
        let mut levels = [0_u32; 7];
        for &texel in &regions {
            let (level, cell) = region_of(texel);
            levels[level as usize] += 1;
            for y in cell[1] << level..(cell[1] + 1) << level {
                for x in cell[0] << level..(cell[0] + 1) << level {
                    covered[(y * SIZE[0] + x) as usize] += 1;
                }
            }
        }
        println!("{name}: {} regions of {} pixels, by level {levels:?}", regions.len(), takes.len());
        for (index, (count, takes)) in covered.iter().zip(&takes).enumerate() {
            assert_eq!(*count, u32::from(*takes), "{name}: pixel {index}");
        }
        assert!(levels[3] > 0 && regions.len() * 3 < takes.len(), "{name}: large flat parts are large regions");
    }
}

#[test]
fn stencil_and_list_shade_the_same_regions_to_the_same_picture() {
    let session = Session::open();
    for name in SCENES {
        let scene = builtin(name);
        let request = request(SIZE, scene.camera_view(None).expect("its camera"), &[]);
        let frame = probe(&session, &scene, &with("stencil"), &request, |graph, declared| {
            let invocations = declared.vpl.as_ref().and_then(|vpl| vpl.invocations).expect("a counter");
            vec![graph.read_back_buffer(invocations), slot(graph, declared, Slot::Diffuse)]
        });
        let (regions, _) = listed(&session, name);
        let invocations = words(&frame.floats(0))[0] as usize;
        assert_eq!(invocations, regions.len(), "{name}: the shader runs for valid regions alone");
        let by_list = diffuse(&session, name, SIZE, &with("compute"));
        let maximum = by_list.pixels.iter().flatten().fold(0.0_f32, |most, &value| most.max(value));
        for (index, (stencil, list)) in frame.colors(1).iter().zip(&by_list.pixels).enumerate() {
            for (channel, value) in list.iter().take(3).enumerate() {
                let difference = (stencil[channel] - f64::from(*value)).abs();
                assert!(difference <= 1e-6 * f64::from(maximum), "{name}, pixel {index}: {difference} apart");
            }
        }
    }
}

/// rrmse of a against b.
fn relative_error(a: &ColorImage, b: &ColorImage) -> f64 {
    let values = |image: &ColorImage| -> Vec<f64> {
        image.pixels.iter().flat_map(|pixel| pixel.iter().take(3)).map(|&value| f64::from(value)).collect()
    };
    let (a, b) = (values(a), values(b));
    let squares: f64 = a.iter().zip(&b).map(|(a, b)| (a - b) * (a - b)).sum();
    (squares / b.len() as f64).sqrt() / (b.iter().sum::<f64>() / b.len() as f64)
}

#[test]
fn regions_come_close_to_pixels() {
    let session = Session::open();
    for (name, bound) in [("cornell-empty", 0.02), ("cornell-point", 0.03), ("ring", 0.05)] {
        let pixels = diffuse(&session, name, [256, 256], &with("pixels"));
        let regions = diffuse(&session, name, [256, 256], &with("auto"));
        let error = relative_error(&regions, &pixels);
        println!("{name}: regions against pixels, rrmse {error:.4}");
        assert!(error < bound, "{name}: {error}");
    }
}

#[test]
fn constant_irradiance_stays_constant() {
    let session = Session::open();
    let scene = builtin("cornell-point");
    let request = request(SIZE, scene.camera_view(None).expect("its camera"), &[]);
    let settings = vpl_settings(&[]);
    let mut rsm = settings.clone();
    rsm.methods.diffuse = crate::renderer::DiffuseMethod::Rsm;
    let irradiance = [1.0, 2.0, 0.5];
    let alpha = twins::pack_direction_in_float(glam::Vec3::Y);
    let frame = probe(&session, &scene, &rsm, &request, |graph, declared| {
        let buffer = &declared.gbuffer;
        let levels = level_count(SIZE, settings.vpl.levels);
        assert_eq!(levels, 4);
        let rule = rule_of(&settings.vpl);
        let pyramid = pyramid(graph, buffer, &rule, levels, None);
        let flattened = graph.image("flattened", vk::Format::R32G32B32A32_SFLOAT, flattened_size(SIZE));
        let [red, green, blue] = irradiance;
        graph.clear_image("test/irradiance", flattened, ClearColor::Float([red, green, blue, alpha]));
        let radiance = graph.image("radiance", vk::Format::R32G32B32A32_SFLOAT, SIZE);
        interpolate(graph, buffer, &rule, &pyramid, flattened, radiance);
        vec![graph.read_back(buffer.depth), graph.read_back(buffer.surface), graph.read_back(radiance)]
    });
    let mut surfaces = 0;
    for (pixel, found) in frame.pixels([0, 1], SIZE).iter().zip(frame.colors(2)) {
        let Some(pixel) = pixel else {
            continue;
        };
        surfaces += 1;
        let expected = pixel.albedo * glam::DVec3::from(irradiance.map(f64::from)) * std::f64::consts::FRAC_1_PI;
        assert!((found - expected).abs().max_element() <= 1e-5, "{found} of {expected}");
    }
    assert!(surfaces > 10_000);
}

#[test]
fn any_size_and_any_number_of_vpls_give_finite_light() {
    let session = Session::open();
    for size in [[1, 1], [17, 5], [67, 65]] {
        for shading in ["pixels", "compute", "stencil"] {
            for count in ["0", "1", "33"] {
                let settings =
                    vpl_settings(&[("vpl.shading", shading), ("vpl.count", count), ("lights.resolution", "32")]);
                let image = diffuse(&session, "cornell-point", size, &settings);
                let sound = image.pixels.iter().flatten().all(|value| value.is_finite() && *value >= 0.0);
                assert!(sound, "{size:?}, {shading}, {count} VPLs");
                let lit = image.pixels.iter().any(|pixel| pixel[0] > 0.0);
                assert_eq!(lit, count != "0", "{size:?}, {shading}, {count} VPLs");
            }
        }
    }
}

/// The list's order differs from run to run; the picture must not.
#[test]
fn repeats_give_the_same_bits() {
    let session = Session::open();
    for shading in ["compute", "stencil"] {
        let bits = || -> Vec<u32> {
            let image = diffuse(&session, "lights", SIZE, &with(shading));
            image.pixels.iter().flatten().map(|value| value.to_bits()).collect()
        };
        let first = bits();
        for _ in 0..3 {
            assert!(first == bits(), "{shading}: other bits");
        }
    }
}
