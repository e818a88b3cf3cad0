//! Splatting of photons: energy, order, edges, sizes; against closed forms and one way against the other.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3};

use super::scenes::{lambert, place, quad, view};
use super::session::Session;
use super::splat_bench::{
    Bench, Landed, WAYS, from_above, largest, oblique, orthographic, random, settings, white_floor,
};
use crate::caustics::photons::sums::TILES_AT_ONCE;
use crate::renderer::Timing;
use crate::scene::Scene;

#[test]
fn a_photon_delivers_its_flux_whatever_its_radius() {
    const SIZE: [u32; 2] = [120, 96];
    let session = Session::open();
    let scene = white_floor();
    for (what, camera) in [("above", from_above()), ("oblique", oblique()), ("orthographic", orthographic())] {
        let mut bench = Bench::new(&session, &scene, &camera, SIZE);
        for (way, kernel) in [("tiles", "cone"), ("tiles", "gaussian"), ("discs", "cone"), ("discs", "gaussian")] {
            let settings = settings(&[("splat", way), ("kernel", kernel), ("downscale", "1")]);
            let mut seed = 7;
            for radius_in_pixels in [1e-4, 0.3, 0.8, 1.3, 2.1, 2.9, 3.5, 5.0, 8.0, 16.0, 30.0] {
                let [x, y] = [60.0 + random(&mut seed), 50.0 + random(&mut seed)];
                let position = bench.on_floor(x, y);
                let pixel = (bench.on_floor(x + 1.0, y) - position).length();
                let radius = radius_in_pixels * pixel;
                let photon = Landed { position, normal: DVec3::Y, flux: [1.0, 0.5, 2.0], radius };
                let light = bench.irradiance(&settings, &[photon]);
                let found = bench.flux_on_floor(&light);
                let error = (found / DVec3::new(1.0, 0.5, 2.0) - 1.0).abs().max_element();
                println!("{what}, {way}, {kernel}, {radius_in_pixels} pixels: flux off by {error:.2e}");
                assert!(error < 0.01, "{found}");
            }
        }
    }
}

#[test]
fn an_ellipse_delivers_its_flux_along_its_axes() {
    const SIZE: [u32; 2] = [120, 96];
    let session = Session::open();
    let scene = white_floor();
    for (what, camera) in [("above", from_above()), ("oblique", oblique()), ("orthographic", orthographic())] {
        let mut bench = Bench::new(&session, &scene, &camera, SIZE);
        bench.squeeze = (0.25, DVec3::new(0.6, 0.0, 0.8));
        for way in WAYS {
            let settings = settings(&[("splat", way), ("footprint", "beam"), ("downscale", "1")]);
            for radius_in_pixels in [0.5, 2.0, 6.0, 12.0, 24.0] {
                let position = bench.on_floor(60.3, 50.6);
                let pixel = (bench.on_floor(61.3, 50.6) - position).length();
                let radius = radius_in_pixels * pixel;
                let photon = Landed { position, normal: DVec3::Y, flux: [1.0, 0.5, 2.0], radius };
                let light = bench.irradiance(&settings, &[photon]);
                let found = bench.flux_on_floor(&light);
                let error = (found / DVec3::new(1.0, 0.5, 2.0) - 1.0).abs().max_element();
                println!("{what}, {way}, {radius_in_pixels} pixels: flux off by {error:.2e}");
                assert!(error < 0.03, "{found}");
                if radius_in_pixels < 12.0 {
                    continue;
                }
                // Second moments along both axes: 0.0657·h² each for a Gaussian that ends at h = √8 deviations.
                let moment = |axis: DVec3| {
                    let pixels = light.iter().enumerate().map(|(index, light)| {
                        let at = bench
                            .on_floor(f64::from(index as u32 % SIZE[0]) + 0.5, f64::from(index as u32 / SIZE[0]) + 0.5);
                        let corner = |x: f64| {
                            bench.on_floor(f64::from(index as u32 % SIZE[0]) + x, f64::from(index as u32 / SIZE[0]))
                        };
                        // Pixels of one row are alike in area.
                        (light.x * (corner(1.0) - corner(0.0)).length_squared(), (at - position).dot(axis))
                    });
                    let sums =
                        pixels.fold((0.0, 0.0), |sums, (weight, off)| (sums.0 + weight, sums.1 + weight * off * off));
                    (sums.1 / sums.0).sqrt()
                };
                let [narrow, wide] = [DVec3::new(0.6, 0.0, 0.8), DVec3::new(0.8, 0.0, -0.6)].map(moment);
                let ratio = narrow / wide;
                println!("{what}, {way}: {ratio:.3} as wide as long");
                assert!((0.2..0.34).contains(&ratio), "{what}: {narrow} to {wide}");
            }
        }
    }
}

#[test]
fn irradiance_at_fewer_samples_keeps_the_flux() {
    const SIZE: [u32; 2] = [130, 97];
    let session = Session::open();
    let scene = white_floor();
    for (what, camera) in [("above", from_above()), ("oblique", oblique())] {
        let mut bench = Bench::new(&session, &scene, &camera, SIZE);
        for (way, downscale) in [("tiles", "2"), ("tiles", "4"), ("discs", "2"), ("discs", "4")] {
            let settings = settings(&[("splat", way), ("downscale", downscale)]);
            let mut seed = 11;
            for radius_in_pixels in [0.1, 2.0, 5.0, 9.0, 20.0] {
                let position = bench.on_floor(60.0 + random(&mut seed), 50.0 + random(&mut seed));
                let radius = radius_in_pixels * (bench.on_floor(61.0, 50.0) - bench.on_floor(60.0, 50.0)).length();
                let photon = Landed { position, normal: DVec3::Y, flux: [1.0; 3], radius };
                let light = bench.irradiance(&settings, &[photon]);
                let error = (bench.flux_on_floor(&light).x - 1.0).abs();
                println!("{what}, {way}, 1/{downscale}, {radius_in_pixels} pixels: flux off by {error:.2e}");
                assert!(error < 0.02);
            }
        }
    }
}

/// Photons all over the floor, off the image and behind the camera too, of radii from 3 pixels to more than the image.
fn scattered(bench: &Bench<'_>, count: usize) -> Vec<Landed> {
    let mut seed = 5;
    let mut photon = || {
        let [x, z] = [0, 1].map(|_| 8.0 * random(&mut seed) - 4.0);
        let position = DVec3::new(x, 0.0, z);
        let (start, _) = bench.ray(0.0, 0.0);
        let pixel = (position - start).length() * 2.0 * 30_f64.to_radians().tan() / f64::from(bench.size[1]);
        let slant = ((position - start).normalize().y).abs().max(0.1);
        let radius = pixel / slant * 3.0 * 50_f64.powf(random(&mut seed).powi(3));
        let flux = [0, 1, 2].map(|_| random(&mut seed) as f32);
        Landed { position, normal: DVec3::Y, flux, radius }
    };
    (0..count).map(|_| photon()).collect()
}

/// Σ Φ·3(1 − d/h)/(πh²) at each pixel of the floor.
fn by_definition(bench: &Bench<'_>, photons: &[Landed]) -> Vec<DVec3> {
    let at = |index: u32| {
        let (x, y) = (f64::from(index % bench.size[0]) + 0.5, f64::from(index / bench.size[0]) + 0.5);
        let point = bench.on_floor(x, y);
        let given = |photon: &Landed| {
            let part = (1.0 - (point - photon.position).length() / photon.radius).max(0.0);
            DVec3::from(photon.flux.map(f64::from)) * (part * 3.0 / (PI * photon.radius * photon.radius))
        };
        let (_, ray) = bench.ray(x, y);
        let visible = ray.y < 0.0 && point.x.abs() < 4.0 && point.z.abs() < 4.0;
        if visible { photons.iter().map(given).sum() } else { DVec3::ZERO }
    };
    (0..bench.size[0] * bench.size[1]).map(at).collect()
}

#[test]
fn every_pixel_gets_what_the_kernel_says_in_any_order_of_the_photons() {
    let session = Session::open();
    let scene = white_floor();
    for (what, camera, size) in [("above", from_above(), [96, 64]), ("oblique", oblique(), [75, 57])] {
        let mut bench = Bench::new(&session, &scene, &camera, size);
        let photons = scattered(&bench, 400);
        let mut shuffled = photons.clone();
        let mut seed = 9;
        for index in (1..shuffled.len()).rev() {
            shuffled.swap(index, (random(&mut seed) * (index + 1) as f64) as usize);
        }
        let expected = by_definition(&bench, &photons);
        for way in WAYS {
            let exact = settings(&[("splat", way), ("kernel", "cone"), ("downscale", "1")]);
            let found = bench.irradiance(&exact, &photons);
            let off = |(found, expected): (&DVec3, &DVec3)| (*found - *expected).abs().max_element();
            let error = found.iter().zip(&expected).map(off).fold(0.0, f64::max) / largest(&expected);
            println!("{what}, {way}: off by {error:.2e} of the maximum");
            assert!(error < 1e-4 && largest(&expected) > 0.0);
            for downscale in ["1", "4"] {
                let settings = settings(&[("splat", way), ("downscale", downscale)]);
                let first = bench.irradiance(&settings, &photons);
                assert!(first == bench.irradiance(&settings, &shuffled), "{way}: the order shows");
            }
        }
    }
}

#[test]
fn both_ways_agree() {
    let session = Session::open();
    let scene = white_floor();
    let mut bench = Bench::new(&session, &scene, &oblique(), [83, 61]);
    let mut photons = scattered(&bench, 500);
    for (index, photon) in photons.iter_mut().enumerate().filter(|(index, _)| index % 2 == 0) {
        photon.radius *= 1e-3 * index as f64;
    }
    for downscale in ["1", "2", "4"] {
        for kernel in ["cone", "gaussian"] {
            let of = |way| settings(&[("splat", way), ("downscale", downscale), ("kernel", kernel)]);
            let [tiles, discs] = WAYS.map(|way| bench.irradiance(&of(way), &photons));
            // At the rim of a disc of a few pixels, the last bits of positions show.
            let least = 0.1 * largest(&discs);
            let off = |(a, b): (&DVec3, &DVec3)| ((*a - *b).abs() / b.max(DVec3::splat(least))).max_element();
            let error = tiles.iter().zip(&discs).map(off).fold(0.0, f64::max);
            println!("1/{downscale}, {kernel}: relative difference {error:.2e}");
            assert!(error < 1e-5);
        }
    }
}

/// More photons in one tile than a group takes.
#[test]
fn crowded_tiles_are_shared() {
    let session = Session::open();
    let scene = white_floor();
    let mut bench = Bench::new(&session, &scene, &from_above(), [40, 32]);
    let mut seed = 2;
    let mut photon = || {
        let position = bench.on_floor(10.0 + 20.0 * random(&mut seed), 10.0 + 9.0 * random(&mut seed));
        let radius = 0.3 * random(&mut seed).powi(2);
        Landed { position, normal: DVec3::Y, flux: [random(&mut seed) as f32, 1.0, 0.1], radius }
    };
    let mut photons: Vec<Landed> = (0..70_000).map(|_| photon()).collect();
    for downscale in ["1", "2"] {
        let [tiles, discs] = WAYS.map(|way| settings(&[("splat", way), ("downscale", downscale)]));
        let (light, passes) = bench.run(&tiles, &photons, Timing::Passes);
        let touch = passes.iter().find(|pass| pass.pass == "splat/touch").expect("it ran");
        assert!(touch.work["crowded tiles"] > 0);
        photons.reverse();
        assert!(light == bench.irradiance(&tiles, &photons), "the order shows");
        assert!(light == bench.irradiance(&discs, &photons), "the ways differ");
        for tiles_at_once in [1, 4] {
            bench.tiles_at_once = tiles_at_once;
            assert!(light == bench.irradiance(&tiles, &photons), "crowded tiles, {tiles_at_once} at once");
            assert!(light == bench.irradiance(&discs, &photons), "discs, {tiles_at_once} tiles at once");
        }
        bench.tiles_at_once = TILES_AT_ONCE;
    }
}

/// The sums of all tiles of such a frame would be larger than a buffer may be.
#[test]
fn a_large_frame_fits_the_device() {
    const SIZE: [u32; 2] = [4096, 1040];
    let session = Session::open();
    let scene = white_floor();
    let mut bench = Bench::new(&session, &scene, &from_above(), SIZE);
    let lit = [[600, 10], [3500, 1030]];
    let photons = lit.map(|pixel| {
        let [x, y] = pixel.map(|place| f64::from(place) + 0.5);
        Landed { position: bench.on_floor(x, y), normal: DVec3::Y, flux: [1.0; 3], radius: 0.05 }
    });
    let crowd: Vec<Landed> = photons.into_iter().cycle().take(70_000).collect();
    let light = bench.irradiance(&settings(&[("splat", "tiles"), ("kernel", "cone"), ("downscale", "1")]), &crowd);
    let expected = 35_000.0 * 3.0 / (PI * 0.05 * 0.05);
    for [x, y] in lit {
        let found = light[(y * SIZE[0] + x) as usize].x;
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} of {expected}");
    }
}

/// A floor, a wall on its edge x = 0, and a shelf over the floor.
fn corner() -> Scene {
    let mut scene = white_floor();
    let id = scene.add_material(lambert([1.0; 3])).expect("sound");
    let wall = quad([[0.0, 0.0, -4.0], [0.0, 0.0, 4.0], [0.0, 3.0, 4.0], [0.0, 3.0, -4.0]], id);
    let shelf = quad([[0.5, 0.2, -0.5], [0.5, 0.2, 0.5], [1.5, 0.2, 0.5], [1.5, 0.2, -0.5]], id);
    place(&mut scene, vec![wall, shelf], DAffine3::IDENTITY);
    scene
}

#[test]
fn nothing_leaks_round_corners_through_walls_or_onto_other_levels() {
    const SIZE: [u32; 2] = [90, 70];
    let session = Session::open();
    let scene = corner();
    let camera = view(DVec3::new(2.0, 1.5, 0.3), DVec3::new(0.4, 0.2, 0.0));
    let mut bench = Bench::new(&session, &scene, &camera, SIZE);
    // What a pixel shows, by the nearest hit of its ray.
    let shown = |index: u32| {
        let (start, ray) = bench.ray(f64::from(index % SIZE[0]) + 0.5, f64::from(index / SIZE[0]) + 0.5);
        let at = |axis: usize, place: f64| {
            let t = (place - start[axis]) / ray[axis];
            (t, start + ray * t)
        };
        let (wall, floor, shelf) = (at(0, 0.0), at(1, 0.0), at(1, 0.2));
        let on_shelf = shelf.0 > 0.0 && (0.5..1.5).contains(&shelf.1.x) && shelf.1.z.abs() < 0.5;
        let wall_hit = if wall.0 > 0.0 { wall.0 } else { f64::MAX };
        let floor_hit = if floor.0 > 0.0 { floor.0 } else { f64::MAX };
        if on_shelf && shelf.0 < wall_hit.min(floor_hit) {
            "shelf"
        } else if wall_hit < floor_hit {
            "wall"
        } else {
            "floor"
        }
    };
    let names: Vec<&str> = (0..SIZE[0] * SIZE[1]).map(shown).collect();
    let photon = |position: [f64; 3], normal: DVec3| Landed {
        position: DVec3::from(position),
        normal,
        flux: [1.0; 3],
        radius: 0.6,
    };
    let cases = [
        ("floor", photon([0.1, 0.0, 0.0], DVec3::Y)),
        ("wall", photon([0.0, 0.1, 0.0], DVec3::X)),
        ("nothing", photon([0.0, 0.3, 0.0], DVec3::NEG_X)),
        ("shelf", photon([0.7, 0.2, 0.0], DVec3::Y)),
        ("nothing", photon([1.0, 0.2, 0.0], DVec3::NEG_Y)),
        ("floor", photon([1.0, 0.0, 0.0], DVec3::Y)),
    ];
    for (lit, photon) in cases {
        for way in WAYS {
            for downscale in ["1", "2", "4"] {
                let settings = settings(&[("splat", way), ("downscale", downscale)]);
                let light = bench.irradiance(&settings, &[photon]);
                let lights = |what: &str| {
                    names.iter().zip(&light).filter(|(name, light)| **name == what && light.x > 0.0).count()
                };
                for name in ["floor", "wall", "shelf"] {
                    let count = lights(name);
                    // Where a ray grazes an edge, the picture and this test may see different surfaces.
                    assert!(
                        (name == lit && count > 20) || count < 3,
                        "{way}, 1/{downscale}: {lit} lights {count} pixels of {name}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_million_photons_on_one_pixel_do_not_overflow() {
    let session = Session::open();
    let scene = white_floor();
    let mut bench = Bench::new(&session, &scene, &from_above(), [9, 9]);
    for (way, count) in [("tiles", 1_000_000), ("discs", 200_000)] {
        let settings = settings(&[("splat", way), ("downscale", "1")]);
        let photon =
            Landed { position: bench.on_floor(4.5, 4.5), normal: DVec3::Y, flux: [3.0, 1.0, 1e-3], radius: 1e-6 };
        let one = bench.irradiance(&settings, &[photon]);
        let all = bench.irradiance(&settings, &vec![photon; count]);
        let brightest = largest(&one);
        for (one, all) in one.iter().zip(&all) {
            let off = (*all / count as f64 - *one).abs().max_element();
            assert!(off <= 1e-5 * one.max_element() + 1e-8 * brightest, "{off} of {one}");
        }
        assert!(one[40].x > 0.0);
    }
}

#[test]
fn no_photon_gives_black_without_work() {
    let session = Session::open();
    let scene = white_floor();
    let mut bench = Bench::new(&session, &scene, &from_above(), [50, 40]);
    for way in WAYS {
        for downscale in ["1", "4"] {
            let settings = settings(&[("splat", way), ("downscale", downscale)]);
            let some = Landed { position: bench.on_floor(20.0, 20.0), normal: DVec3::Y, flux: [1.0; 3], radius: 0.1 };
            assert!(largest(&bench.irradiance(&settings, &[some])) > 0.0);
            let (light, passes) = bench.run(&settings, &[], Timing::Passes);
            assert!(light.iter().all(|color| *color == DVec3::ZERO));
            for pass in passes.iter().filter(|pass| {
                ["splat/gather", "splat/resolve", "splat/project", "splat/upsample"].contains(&pass.pass.as_str())
            }) {
                assert_eq!(pass.work.get("invocations").copied().unwrap_or(0), 0, "{pass:?}");
            }
        }
    }
}

#[test]
fn any_flux_any_size_and_broken_photons() {
    let session = Session::open();
    let scene = white_floor();
    for size in [[1, 1], [17, 5], [5, 17], [33, 32]] {
        let mut bench = Bench::new(&session, &scene, &from_above(), size);
        let middle = bench.on_floor(0.5 * f64::from(size[0]), 0.5 * f64::from(size[1]));
        let photon = Landed { position: middle, normal: DVec3::Y, flux: [1.0; 3], radius: 0.2 };
        let broken = [
            Landed { flux: [f32::NAN; 3], ..photon },
            Landed { position: DVec3::NAN, ..photon },
            Landed { radius: f64::NAN, ..photon },
            Landed { radius: 0.0, flux: [0.0; 3], ..photon },
            Landed { flux: [-1.0; 3], ..photon },
            Landed { position: DVec3::splat(1e30), ..photon },
        ];
        for way in WAYS {
            for downscale in ["1", "2", "4"] {
                let settings = settings(&[("splat", way), ("downscale", downscale)]);
                let one = bench.irradiance(&settings, &[photon]);
                assert!(largest(&one) > 0.0, "{size:?}, {way}, 1/{downscale}");
                let with_broken: Vec<Landed> = broken.into_iter().chain([photon]).collect();
                assert_eq!(bench.irradiance(&settings, &with_broken), one, "{size:?}, {way}");
                for flux in [1e-6_f32, 1e6, 1e-20, 1e20] {
                    let scaled = bench.irradiance(&settings, &[Landed { flux: [flux; 3], ..photon }]);
                    for (one, scaled) in one.iter().zip(&scaled) {
                        assert!(
                            (scaled.x / f64::from(flux) - one.x).abs() <= 1e-5 * one.x,
                            "{way}, {flux}: {scaled} {one}"
                        );
                    }
                }
                let huge = bench.irradiance(&settings, &[Landed { radius: 1e6, flux: [1e12; 3], ..photon }]);
                let uniform = 1e12 * 3.0 / (PI * 1e12);
                assert!(huge.iter().all(|light| light.x > 0.5 * uniform && light.x < 2.0 * uniform), "{:?}", huge[0]);
            }
        }
    }
}
