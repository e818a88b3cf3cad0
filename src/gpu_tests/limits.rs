//! The tables of what methods need (src/renderer/limits.rs) against what their passes do.

use std::collections::BTreeSet;

use super::scenes::builtin;
use super::session::Session;
use crate::renderer::limits::{format_lacks, is_program_of};
use crate::renderer::{FrameRequest, Preset, Settings, Technique};
use crate::slot::Slot;

/// A technique, a scene, and settings.
type Way = (Technique, &'static str, &'static [(&'static str, &'static str)]);

/// Ways through the methods that run different programs.
const WAYS: &[Way] = &[
    (Technique::Rsm, "textured", &[]),
    (Technique::Particles, "cornell-point", &[]),
    (Technique::Lightmaps, "cornell-glossy", &[("lightmaps.count", "500"), ("cubemap.resolution", "32")]),
    (Technique::Lightmaps, "ring", &[("lightmaps.count", "500"), ("lightmaps.gather", "hemicube")]),
    (Technique::Hybrid, "textured", &[("vpl.visibility", "traced"), ("vpl.bounces", "2"), ("photons.downscale", "2")]),
    (Technique::Hybrid, "ring", &[("vpl.visibility", "ism"), ("vpl.shading", "stencil"), ("photons.splat", "discs")]),
    (Technique::Hybrid, "ring", &[("photons.trace", "lines"), ("vpl.shading", "pixels")]),
    (
        Technique::Hybrid,
        "ring",
        &[("photons.trace", "march"), ("photons.geometry", "layers:2"), ("photons.projection", "camera")],
    ),
];

#[test]
fn methods_say_which_programs_and_formats_they_need() {
    let session = Session::open();
    let mut faults = BTreeSet::new();
    for (technique, name, ways) in WAYS {
        let mut settings = Settings::new(*technique, Preset::Draft);
        ways.iter().for_each(|(key, value)| settings.set(key, value).expect("a setting"));
        let scene = builtin(name);
        let request = FrameRequest {
            slots: Slot::ALL.to_vec(),
            ..FrameRequest::new([96, 72], scene.camera_view(None).expect("a camera"))
        };
        let mut renderer = session.renderer(&settings);
        renderer.render(&scene, &request).expect("a frame");
        for noted in &renderer.store.uses {
            if !is_program_of(&settings, noted.program, true) {
                faults.insert(format!("{}: {} is not said to be needed", noted.piece, noted.program));
            }
            faults.extend(format_lacks(noted.program, &noted.images, &noted.texels));
        }
    }
    assert!(faults.is_empty(), "{}", faults.into_iter().collect::<Vec<_>>().join("\n"));
}
