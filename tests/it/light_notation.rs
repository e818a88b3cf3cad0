//! Lights and skies as a command line writes them.

use glam::DVec3;
use irradia::scene::{LightKind, LightSpec, Scene, parse_sky};
use std::f64::consts::PI;

#[track_caller]
fn assert_close(actual: f64, expected: f64, relative: f64) {
    assert!((actual - expected).abs() <= relative * expected.abs(), "{actual} is not {expected}");
}

#[test]
fn suns_stand_where_their_angles_say() {
    let cases = [
        ("sun:0,0", DVec3::Z),       // in the north, hence shining south
        ("sun:90,0", DVec3::NEG_X),  // in the east
        ("sun:180,0", DVec3::NEG_Z), // in the south
        ("sun:12,90", DVec3::NEG_Y), // overhead
        ("sun:90,45", DVec3::new(-1.0, -1.0, 0.0).normalize()),
    ];
    for (spec, direction) in cases {
        let parsed = LightSpec::parse(spec).expect(spec);
        assert!((parsed.direction - direction).length() < 1e-9, "{spec}: {}", parsed.direction);
        assert_eq!(parsed.light.kind, LightKind::Directional);
        assert_eq!(parsed.light.intensity, [PI as f32; 3], "its default");
    }
}

#[test]
fn lights_written_out_are_placed_as_written() {
    let mut scene = Scene::empty("lights");
    for spec in ["sun:90,45,2", "point:1,2,3,4:5:6", "spot:1,2,3,0,-2,0,30,7"] {
        scene.add_light_spec(&LightSpec::parse(spec).expect(spec)).expect(spec);
    }
    let [sun, point, spot] = &scene.placed_lights()[..] else { panic!("three lights") };
    assert_eq!(sun.intensity, [2.0; 3]);
    assert!((sun.direction - DVec3::new(-1.0, -1.0, 0.0).normalize()).length() < 1e-9, "{}", sun.direction);
    assert_eq!((point.position, point.intensity), (DVec3::new(1.0, 2.0, 3.0), [4.0, 5.0, 6.0]));
    assert!((spot.direction - DVec3::NEG_Y).length() < 1e-9, "{}", spot.direction);
    let LightKind::Spot { inner_angle, outer_angle } = spot.kind else { panic!("a spot") };
    assert_close(outer_angle.into(), PI / 6.0, 1e-6);
    assert_close(inner_angle.into(), 0.9 * PI / 6.0, 1e-6);
    assert_eq!(scene.facts().punctual_lights, 3);
    assert_eq!(scene.revisions().geometry, 0);
}

#[test]
fn lights_that_cannot_be_read_say_how_to_write_them() {
    for spec in [
        "",
        "moon:1,2",
        "sun",
        "sun:1",
        "sun:a,2",
        "sun:1,2,-3",
        "sun:1,2,3,4",
        "point:1,2,3",
        "point:1,2,3,1:2",
        "point:1,2,nan,1",
        "spot:0,0,0,0,0,0,30,1",
        "spot:0,0,0,0,1,0,0,1",
        "spot:0,0,0,0,1,0,91,1",
        "spot:0,0,0,0,1,0,30,inf",
    ] {
        let sentence = LightSpec::parse(spec).expect_err(spec);
        assert!(sentence.contains("write "), "{spec}: {sentence}");
    }
    assert!(LightSpec::parse("spot:0,0,0,0,1,0,90,1").is_ok());
    assert_eq!(parse_sky("1,2.5,0"), Ok([1.0, 2.5, 0.0]));
    assert_eq!(parse_sky("0.5"), Ok([0.5; 3]));
    for spec in ["", "1,2", "1,2,-3", "1,2,x", "1,2,3,4"] {
        assert!(parse_sky(spec).is_err(), "{spec}");
    }
}
