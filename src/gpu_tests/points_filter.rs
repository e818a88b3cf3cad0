//! The filter of `points`: flux, edges, the tiles that it lists, and whole numbers.

use glam::{DAffine3, DVec3};

use super::points::settings;
use super::scenes::{floor, lambert, place, quad};
use super::session::Session;
use super::splat_bench::{Bench, Landed, from_above, largest, oblique, orthographic, random, white_floor};
use crate::caustics::points::draw::draw;
use crate::frame::photons::kept::KeptPhotons;
use crate::renderer::Timing;
use crate::renderer::options::{PointOptions, PointTiles};

const SIZE: [u32; 2] = [120, 96];

fn options(changes: &[(&str, &str)]) -> PointOptions {
    settings(changes).points
}

/// Irradiance by these photons on a white surface, and how many tiles were listed.
fn filtered(bench: &mut Bench<'_>, options: &PointOptions, photons: &[Landed]) -> (Vec<DVec3>, u64) {
    let count = photons.len() as u32 + 1;
    let (light, passes) = bench.frame(photons, Some(0.4), Timing::Passes, |graph, buffer, photons| {
        draw(graph, buffer, options, KeptPhotons { photons, count })
    });
    let drawn = passes.iter().find(|pass| pass.pass == "draw/points").expect("it is drawn");
    (light, drawn.work["tiles"])
}

/// Both filters, and the radii of the one in the world.
fn filters(pixel: f64) -> Vec<PointOptions> {
    let world = |pixels: f64| options(&[("points.radius", &format!("{}", pixels * pixel))]);
    vec![
        options(&[("points.filter", "screen")]),
        world(0.01),
        world(1.2),
        world(3.7),
        world(11.0),
        world(100.0),
        options(&[]),
    ]
}

/// Photons where pixels of the floor are seen, up to the screen's edges.
fn scattered(bench: &Bench<'_>, count: usize) -> Vec<Landed> {
    let mut seed = 5;
    let mut photon = || {
        let (x, y, position) = loop {
            let [x, y] = SIZE.map(|side| f64::from(side) * random(&mut seed));
            let (_, sight) = bench.ray(x, y);
            let position = bench.on_floor(x, y);
            // The floor ends at 4 m.
            if sight.y < 0.0 && position.x.abs().max(position.z.abs()) < 3.5 {
                break (x, y, position);
            }
        };
        let pixel = (bench.on_floor(x + 0.5, y) - bench.on_floor(x - 0.5, y)).length();
        let radius = pixel * 40_f64.powf(random(&mut seed) - 0.3);
        let flux = [0, 1, 2].map(|_| random(&mut seed).powi(4) as f32);
        Landed { position, normal: DVec3::Y, flux, radius }
    };
    (0..count).map(|_| photon()).collect()
}

fn total(photons: &[Landed]) -> DVec3 {
    photons.iter().map(|photon| DVec3::from(photon.flux.map(f64::from))).sum()
}

#[test]
fn filtered_flux_is_landed_flux_up_to_the_edges_of_the_screen() {
    let session = Session::open();
    let scene = white_floor();
    for (what, camera) in [("above", from_above()), ("oblique", oblique()), ("orthographic", orthographic())] {
        let mut bench = Bench::new(&session, &scene, &camera, SIZE);
        let pixel = (bench.on_floor(61.0, 48.0) - bench.on_floor(60.0, 48.0)).length();
        for count in [1, 7, 400] {
            let photons = scattered(&bench, count);
            for options in filters(pixel) {
                let (light, _) = filtered(&mut bench, &options, &photons);
                let error = (bench.flux_on_floor(&light) / total(&photons) - 1.0).abs().max_element();
                println!(
                    "{what}, {count} photons, {:?} of {}: flux off by {error:.2e}",
                    options.filter, options.radius
                );
                assert!(error < 0.01, "{what}, {count} photons, {options:?}: {error}");
            }
        }
    }
}

/// One photon in the middle of a pixel, seen from straight above in parallel: equation 4 over its sum, 156.76.
#[test]
fn one_photon_is_spread_as_equation_4_says() {
    let session = Session::open();
    let scene = white_floor();
    let camera = crate::scene::CameraView::look_at(
        DVec3::new(0.0, 2.0, 0.0),
        DVec3::ZERO,
        DVec3::Z,
        crate::scene::Projection::Orthographic { half_width: 1.2, half_height: 0.96, near: 0.1, far: 10.0 },
    );
    let mut bench = Bench::new(&session, &scene, &camera, SIZE);
    let photon = Landed { position: bench.on_floor(40.5, 30.5), normal: DVec3::Y, flux: [1.0, 2.0, 4.0], radius: 0.1 };
    let (light, tiles) = filtered(&mut bench, &options(&[("points.filter", "screen")]), &[photon]);
    let area = 0.02 * 0.02;
    for (index, found) in (0_i32..).zip(&light) {
        let (i, j) = (index % 120 - 40, index / 120 - 30);
        let weight = if i.abs() <= 3 && j.abs() <= 3 { f64::from(19 - i * i - j * j).sqrt() } else { 0.0 };
        let expected = DVec3::new(1.0, 2.0, 4.0) * weight / (156.76 * area);
        assert!(
            (*found - expected).abs().max_element() < 1e-3 * 4.0 / area,
            "{i}, {j}: {found} in place of {expected}"
        );
    }
    // Pixels 37 to 43 and 27 to 33, of tiles of eight.
    assert_eq!(tiles, 4);
}

/// A floor that ends in sight, and one half a metre below it: nothing of what lands on the one is lost or comes to the other.
#[test]
fn light_stays_on_its_surface() {
    let session = Session::open();
    let mut scene = floor(0.3, lambert([1.0; 3]));
    let white = scene.add_material(lambert([1.0; 3])).expect("a sound material");
    let corners = [[-4.0, -0.5, -4.0], [-4.0, -0.5, 4.0], [4.0, -0.5, 4.0], [4.0, -0.5, -4.0]];
    place(&mut scene, vec![quad(corners, white)], DAffine3::IDENTITY);
    for (what, camera) in [("above", from_above()), ("oblique", oblique())] {
        let mut bench = Bench::new(&session, &scene, &camera, SIZE);
        let mut seed = 3;
        let mut photon = || {
            let [x, z] = [0, 1].map(|_| 0.6 * random(&mut seed) - 0.3);
            Landed { position: DVec3::new(x, 0.0, z), normal: DVec3::Y, flux: [1.0; 3], radius: 0.05 }
        };
        let photons: Vec<Landed> = (0..2000).map(|_| photon()).collect();
        for options in [options(&[("points.filter", "screen")]), options(&[("points.radius", "0.08")]), options(&[])] {
            let (light, _) = filtered(&mut bench, &options, &photons);
            let upper = |index: usize| {
                let (x, y) = (f64::from(index as u32 % SIZE[0]) + 0.5, f64::from(index as u32 / SIZE[0]) + 0.5);
                let point = bench.on_floor(x, y);
                point.x.abs() < 0.3 && point.z.abs() < 0.3
            };
            let of = |wanted: bool| -> Vec<DVec3> {
                let pick = |(index, light): (usize, &DVec3)| if upper(index) == wanted { *light } else { DVec3::ZERO };
                light.iter().enumerate().map(pick).collect()
            };
            // On the floor below a pixel shows other places, and more of them.
            assert!(largest(&of(false)) == 0.0, "{what}, {options:?}: light on the floor below");
            // Photons in pixels whose middle shows the floor below are not seen.
            let seen: Vec<Landed> =
                photons.iter().copied().filter(|photon| upper(bench.pixel_of(photon.position))).collect();
            assert!(seen.len() > photons.len() * 9 / 10);
            let error = bench.flux_on_floor(&of(true)).x / total(&seen).x - 1.0;
            println!("{what}, {:?} of {}: flux off by {error:.2e}", options.filter, options.radius);
            assert!(error.abs() < 0.01, "{what}, {options:?}: {error}");
        }
    }
}

#[test]
fn neither_the_order_of_photons_nor_the_list_of_tiles_shows() {
    let session = Session::open();
    let scene = white_floor();
    let mut bench = Bench::new(&session, &scene, &oblique(), SIZE);
    let photons = scattered(&bench, 900);
    let mut shuffled = photons.clone();
    let mut seed = 9;
    for index in (1..shuffled.len()).rev() {
        shuffled.swap(index, (random(&mut seed) * (index + 1) as f64) as usize);
    }
    for options in filters(0.02) {
        let all = options.clone().with(|options| options.tiles = PointTiles::All);
        let (first, _) = filtered(&mut bench, &options, &photons);
        assert!(first == filtered(&mut bench, &options, &shuffled).0, "{options:?}: the order shows");
        assert!(first == filtered(&mut bench, &all, &photons).0, "{options:?}: the list of tiles shows");
    }
}

/// A bright photon leaves faint ones few whole numbers, by which their widths are rounded up at random: no tile that this reaches is left out, and none of their light.
#[test]
fn the_list_of_tiles_knows_what_rounding_may_do() {
    let session = Session::open();
    let scene = white_floor();
    let mut bench = Bench::new(&session, &scene, &from_above(), SIZE);
    let photon = |bench: &Bench<'_>, [x, y]: [f64; 2], flux: f64| {
        let position = bench.on_floor(x, y);
        Landed { position, normal: DVec3::Y, flux: [flux as f32; 3], radius: 1e-4 }
    };
    let mut photons = vec![photon(&bench, [112.5, 52.5], 1.0)];
    let mut seed = 3;
    for number in 0..300 {
        // In the middle of every fifth tile, so that narrow light stays in it.
        let at = [0, 1].map(|_| 40.0 * (3.0 * random(&mut seed)).floor() + 2.0 + 4.0 * random(&mut seed));
        photons.push(photon(&bench, at, 2_f64.powf(-30.0 + f64::from(number) / 60.0)));
    }
    let mut faint_flux = |options: &PointOptions| {
        let (mut light, _) = filtered(&mut bench, options, &photons);
        let bright = light.iter_mut().enumerate().filter(|(pixel, _)| pixel % SIZE[0] as usize > 105);
        bright.for_each(|(_, light)| *light = DVec3::ZERO);
        bench.flux_on_floor(&light).x
    };
    // The same photons are as many wholes, and as wide as equation 4 says.
    let expected = faint_flux(&options(&[("points.filter", "screen")]));
    let found = faint_flux(&options(&[]));
    println!("{:.2e} of the flux is lost", 1.0 - found / expected);
    assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
}

/// Whole numbers are scaled by the flux that there is, not by the room that there is for photons.
#[test]
fn places_without_photons_take_no_precision() {
    let session = Session::open();
    let scene = white_floor();
    let mut bench = Bench::new(&session, &scene, &oblique(), SIZE);
    let photons = scattered(&bench, 900);
    let nothing = Landed { position: DVec3::ZERO, normal: DVec3::Y, flux: [0.0; 3], radius: 0.0 };
    let mut many = photons.clone();
    many.resize(100_000, nothing);
    for options in [options(&[]), options(&[("points.filter", "screen")])] {
        assert!(filtered(&mut bench, &options, &photons).0 == filtered(&mut bench, &options, &many).0, "{options:?}");
    }
}

/// Where there are no photons nothing is filtered.
#[test]
fn tiles_without_photons_are_skipped() {
    let session = Session::open();
    let scene = white_floor();
    let mut bench = Bench::new(&session, &scene, &from_above(), SIZE);
    let none = filtered(&mut bench, &options(&[]), &[]);
    assert!(none.1 == 0 && largest(&none.0) == 0.0);
    let photon = Landed { position: bench.on_floor(12.0, 12.0), normal: DVec3::Y, flux: [1.0; 3], radius: 1e-3 };
    assert_eq!(filtered(&mut bench, &options(&[]), &[photon]).1, 1, "the middle of a tile");
}
