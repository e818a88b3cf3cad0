//! Cones through voxels against closed forms and rays.

use glam::{DAffine3, DVec3};

use super::ball;
use crate::frame::geometry::Geometry;
use crate::frame::inputs::FrameTime;
use crate::frame::scene_data::SceneData;
use crate::frame::voxels::grid::VoxelGrid;
use crate::frame::voxels::{VoxelSettings, declare};
use crate::gpu_tests::scenes::{closed_box, lambert, place, quad};
use crate::gpu_tests::session::Session;
use crate::graph::{Dependence, Graph};
use crate::renderer::Timing;
use crate::scene::Scene;
use crate::shaders::selftest::{Cones, ConesPush};

use ash::vk;

/// A cone from a point to a group of lights around another one, on a surface with this normal.
#[derive(Clone, Copy, Debug)]
struct Cone {
    from: DVec3,
    center: DVec3,
    radius: f64,
    normal: DVec3,
}

/// What came of a cone.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Answer {
    visibility: f64,
    samples: f64,
    skipped: f64,
}

fn answers(session: &Session, scene: &Scene, settings: &VoxelSettings, cones: &[Cone]) -> Vec<Answer> {
    let mut store = session.store();
    let device = store.device().clone();
    let data = SceneData::update(&device, store.pipelines(), None, scene).expect("the scene fits the device");
    let mut graph = Graph::new(&mut store);
    let geometry = Geometry::import(&mut graph, &data);
    let grid = VoxelGrid::around(&data, settings.resolution);
    let (voxels, _) = declare(&mut graph, (&data, &geometry), FrameTime::default(), grid, settings);
    let texel = |vector: DVec3, last: f64| vector.as_vec3().extend(last as f32).to_array();
    let of_cone = |cone: &Cone| {
        let [from, center] = [cone.from, cone.center].map(|point| point - data.origin);
        [texel(from, cone.radius), texel(center, 0.0), texel(cone.normal, 0.0)]
    };
    let texels: Vec<[f32; 4]> = cones.iter().flat_map(of_cone).collect();
    let found = graph.buffer::<[f32; 4]>("answers", cones.len());
    let count = u32::try_from(cones.len()).expect("few");
    let pass = Cones {
        voxels: voxels.group.clone(),
        cones: graph.upload("cones", &texels, Dependence::NONE).texels(vk::Format::R32G32B32A32_SFLOAT),
        answers: found.write(),
        push: ConesPush { count },
    };
    graph.pass("test/cones", pass).threads([count, 1, 1]);
    let read = graph.read_back_buffer(found);
    let mut executed = graph.run(Timing::Frame).expect("a frame");
    assert!(executed.outgrown.is_empty());
    let found = bytemuck::pod_collect_to_vec::<u8, [f32; 4]>(&executed.take(read));
    let answer = |[visibility, samples, skipped, _]: [f32; 4]| Answer {
        visibility: visibility.into(),
        samples: samples.into(),
        skipped: skipped.into(),
    };
    found.into_iter().map(answer).collect()
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

/// Halton's points in bases 2, 3, 5, 7, 11.
fn halton(index: u32) -> [f64; 5] {
    [2, 3, 5, 7, 11].map(|base: u32| {
        let (mut rest, mut share, mut value) = (index + 1, 1.0, 0.0);
        while rest > 0 {
            share /= f64::from(base);
            value += share * f64::from(rest % base);
            rest /= base;
        }
        value
    })
}

/// Cones from points within a room of half side 1 to groups on its walls, as a light view of 16² groups leaves them.
fn within_room(count: u32) -> Vec<Cone> {
    let cone = |index: u32| {
        let [x, y, z, u, v] = halton(index);
        let from = DVec3::new(x, y, z) * 2.0 - 1.0;
        let axis = (index % 3) as usize;
        let side = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
        let (mut center, mut normal) = (DVec3::ZERO, DVec3::ZERO);
        (center[axis], normal[axis]) = (side, -side);
        (center[(axis + 1) % 3], center[(axis + 2) % 3]) = (1.9 * u - 0.95, 1.9 * v - 0.95);
        Cone { from, center, radius: 0.08, normal }
    };
    (0..count).map(cone).collect()
}

#[test]
fn in_an_empty_room_all_is_seen() {
    let session = Session::open();
    let scene = closed_box(1.0, lambert([0.5; 3]));
    let cones = within_room(4096);
    let mut short = f64::NEG_INFINITY;
    for (resolution, directional, least) in [(128, true, 0.97), (128, false, 0.97), (64, true, 0.95), (32, true, 0.9)] {
        let settings = VoxelSettings { resolution, directional, ..VoxelSettings::default() };
        let found = answers(&session, &scene, &settings, &cones);
        let seen = mean(found.iter().map(|answer| answer.visibility));
        // As light counts them: by the cosine at the light.
        let weight = |cone: &Cone| cone.normal.dot((cone.from - cone.center).normalize());
        let weights: f64 = cones.iter().map(weight).sum();
        let lit =
            cones.iter().zip(&found).map(|(cone, answer)| weight(cone) * answer.visibility).sum::<f64>() / weights;
        eprintln!("{resolution}, along axes {directional}: {seen:.4} of all cones, {lit:.4} by cosine");
        short = short.max(least - seen.min(lit));
    }
    assert!(short <= 0.0, "{short}");
}

/// A room and a rectangle in it that faces along z.
fn room_with_card(low: [f32; 2], high: [f32; 2], z: f32) -> Scene {
    let mut scene = closed_box(1.0, lambert([0.5; 3]));
    let material = scene.add_material(lambert([0.5; 3])).expect("sound");
    let corners = [[low[0], low[1], z], [high[0], low[1], z], [high[0], high[1], z], [low[0], high[1], z]];
    place(&mut scene, vec![quad(corners, material)], DAffine3::IDENTITY);
    scene
}

/// The share of the group's disc, as the point sees it, that rays past the card reach.
fn by_rays(cone: &Cone, low: [f32; 2], high: [f32; 2], z: f64) -> f64 {
    let toward = (cone.center - cone.from).normalize();
    let (across, up) = toward.any_orthonormal_pair();
    let seen = (0..1024).filter(|&index| {
        let [u, v, ..] = halton(index);
        let (radius, angle) = (cone.radius * u.sqrt(), std::f64::consts::TAU * v);
        let to = cone.center + across * (radius * angle.cos()) + up * (radius * angle.sin());
        let share = (z - cone.from.z) / (to.z - cone.from.z);
        let at = cone.from.lerp(to, share);
        let between = |at: f64, axis: usize| f64::from(low[axis]) <= at && at <= f64::from(high[axis]);
        !((0.0..1.0).contains(&share) && between(at.x, 0) && between(at.y, 1))
    });
    seen.count() as f64 / 1024.0
}

/// Root mean square difference from rays and the mean of both, over cones from one wall to the other past a card.
fn against_rays(session: &Session, card: ([f32; 2], [f32; 2]), settings: &VoxelSettings, radius: f64) -> [f64; 3] {
    let z = 0.013;
    let scene = room_with_card(card.0, card.1, z);
    let cone = |index: u32| {
        let [a, b, c, d, _] = halton(index);
        let from = DVec3::new(1.6 * a - 0.8, 1.6 * b - 0.8, -0.7);
        let center = DVec3::new(1.6 * c - 0.8, 1.6 * d - 0.8, 1.0);
        Cone { from, center, radius, normal: DVec3::NEG_Z }
    };
    let cones: Vec<Cone> = (0..1024).map(cone).collect();
    let exact: Vec<f64> = cones.iter().map(|cone| by_rays(cone, card.0, card.1, f64::from(z))).collect();
    let found = answers(session, &scene, settings, &cones);
    let square = |(answer, exact): (&Answer, &f64)| (answer.visibility - exact).powi(2);
    let error = mean(found.iter().zip(&exact).map(square)).sqrt();
    [error, mean(found.iter().map(|answer| answer.visibility)), mean(exact.into_iter())]
}

#[test]
fn cones_past_a_half_plane_and_a_square_see_what_rays_see() {
    let session = Session::open();
    let half_plane = ([-0.98, -0.98], [0.11, 0.98]);
    let square = ([-0.31, -0.27], [0.33, 0.35]);
    let mut worst = 0.0_f64;
    for (name, card) in [("half plane", half_plane), ("square", square)] {
        for radius in [0.02, 0.08, 0.25] {
            let of = |directional, cone_width| VoxelSettings { directional, cone_width, ..VoxelSettings::default() };
            let all = [(true, 0.5), (true, 1.0), (false, 0.5), (false, 1.0)];
            let found = all.map(|(directional, width)| against_rays(&session, card, &of(directional, width), radius));
            let [along, wide, plain, plain_wide] = found;
            eprintln!(
                "{name}, radius {radius}: of full width along axes {:.3}, by the mean {:.3}",
                wide[0], plain_wide[0]
            );
            eprintln!(
                "{name}, radius {radius}: rays {:.3}; along axes {:.3}, off by {:.3}; by the mean {:.3}, off by {:.3}",
                along[2], along[1], along[0], plain[1], plain[0]
            );
            worst = worst.max(along[0]);
        }
    }
    assert!(worst < 0.1, "{worst}");
}

/// The share of the group's disc that rays past a ball around the origin reach.
fn past_ball(cone: &Cone, ball: f64) -> f64 {
    let toward = (cone.center - cone.from).normalize();
    let (across, up) = toward.any_orthonormal_pair();
    let seen = (0..1024).filter(|&index| {
        let [u, v, ..] = halton(index);
        let (radius, angle) = (cone.radius * u.sqrt(), std::f64::consts::TAU * v);
        let way = (cone.center + across * (radius * angle.cos()) + up * (radius * angle.sin()) - cone.from).normalize();
        (cone.from + way * way.dot(-cone.from)).length() > ball
    });
    seen.count() as f64 / 1024.0
}

#[test]
fn filling_a_ball_keeps_its_shadow_where_opacity_is_the_mean() {
    let session = Session::open();
    let radius = 0.35;
    let mut scene = closed_box(1.0, lambert([0.5; 3]));
    let material = scene.add_material(lambert([0.5; 3])).expect("sound");
    place(&mut scene, vec![ball(radius as f32, 32, material)], DAffine3::IDENTITY);
    let cone = |index: u32| {
        let [a, b, c, d, _] = halton(index);
        let from = DVec3::new(1.2 * a - 0.6, 1.2 * b - 0.6, -0.7);
        let center = DVec3::new(1.2 * c - 0.6, 1.2 * d - 0.6, 1.0);
        Cone { from, center, radius: 0.15, normal: DVec3::NEG_Z }
    };
    let cones: Vec<Cone> = (0..1024).map(cone).collect();
    let exact: Vec<f64> = cones.iter().map(|cone| past_ball(cone, radius)).collect();
    let error = |solid, directional| {
        let found =
            answers(&session, &scene, &VoxelSettings { solid, directional, ..VoxelSettings::default() }, &cones);
        mean(found.iter().zip(&exact).map(|(answer, exact)| (answer.visibility - exact).powi(2))).sqrt()
    };
    let [hollow, filled] = [false, true].map(|solid| error(solid, false));
    let [hollow_along, filled_along] = [false, true].map(|solid| error(solid, true));
    eprintln!("ball: off by {hollow:.3}, filled {filled:.3}; along axes {hollow_along:.3}, filled {filled_along:.3}");
    assert!(filled < 0.6 * hollow && filled_along < 0.15 && hollow_along < 0.1);
}

#[test]
fn a_point_within_the_group_sees_it_and_one_behind_a_wall_does_not() {
    let session = Session::open();
    let scene = room_with_card([-0.98; 2], [0.98; 2], 0.0);
    let to = |from: DVec3, radius: f64| Cone { from, center: DVec3::new(0.1, 0.0, 0.6), radius, normal: DVec3::NEG_Z };
    let cones = [
        to(DVec3::new(0.1, 0.0, 0.5), 0.2),
        to(DVec3::new(0.1, 0.0, -0.2), 0.9),
        to(DVec3::new(0.2, 0.1, -0.5), 0.01),
        to(DVec3::new(0.2, 0.1, -0.6), 0.1),
        to(DVec3::new(0.2, 0.1, 0.3), 0.1),
    ];
    let found = answers(&session, &scene, &VoxelSettings::default(), &cones);
    let seen: Vec<f64> = found.iter().map(|answer| answer.visibility).collect();
    assert!(seen[0] == 1.0 && seen[1] == 1.0 && seen[2] < 0.01 && seen[3] < 0.05 && seen[4] > 0.99, "{seen:?}");
}

#[test]
fn skipping_what_is_empty_changes_nothing_but_the_work() {
    let session = Session::open();
    let scene = room_with_card([-0.31, -0.27], [0.33, 0.35], 0.013);
    let cones = within_room(2048);
    let of = |skip_empty| VoxelSettings { skip_empty, ..VoxelSettings::default() };
    let [plain, skipping] = [false, true].map(|skip| answers(&session, &scene, &of(skip), &cones));
    let work = |found: &[Answer]| mean(found.iter().map(|answer| answer.samples));
    eprintln!("{:.1} samples a cone, {:.1} where what is empty is skipped", work(&plain), work(&skipping));
    for (plain, skipping) in plain.iter().zip(&skipping) {
        assert!((plain.visibility - skipping.visibility).abs() < 1e-6, "{plain:?} {skipping:?}");
        assert_eq!(plain.samples, skipping.samples + skipping.skipped, "the same steps");
    }
    assert!(work(&skipping) < 0.7 * work(&plain));
}
