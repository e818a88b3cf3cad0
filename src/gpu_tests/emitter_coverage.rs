//! What alpha and textures leave of an emitter lights as if it were built that way, whoever draws points on it.

use glam::{DAffine3, DVec3};

use super::path_probe::{Ask, Tracer, assert_near};
use super::scenes::{builtin, floor, lambert, place, quad, request, view};
use super::session::Session;
use crate::renderer::{DirectMethod, Frame, FrameRequest, Preset, Settings, Slot, Technique, Timing};
use crate::scene::{Alpha, Material, Primitive, Scene, Texture, TextureRef, Wrap};

const SIZE: [u32; 2] = [48, 32];
/// Pixels across a block whose means are compared.
const BLOCK: usize = 8;

/// How a part of a panel of 2×2 m is kept.
#[derive(Clone, Copy, Debug)]
enum Kept {
    /// That part as geometry.
    Built,
    /// Alpha of a texture, one texel a quarter.
    ByTexture,
    /// The same through the second set of texture coordinates, a transform, and a texture that repeats mirrored.
    ByTransformedTexture,
    /// Alpha of vertex colours that falls across the panel.
    ByVertices,
    /// Factor, texture and vertex colours together.
    ByProduct,
    /// An emissive texture.
    ByLight,
}

impl Kept {
    /// The part that is left: x and z from, x and z to.
    fn part(self) -> [f32; 4] {
        if matches!(self, Kept::ByVertices) { [0.5, -1.0, 1.0, 1.0] } else { [0.0, -1.0, 1.0, 0.0] }
    }
}

fn texture(scene: &mut Scene, texel: impl Fn(usize) -> [u8; 4], wrap: Wrap) -> TextureRef {
    let rgba8 = (0..4).flat_map(texel).collect();
    let texture =
        Texture { name: String::new(), width: 2, height: 2, rgba8, wrap: [wrap; 2], nearest: true, srgb: true };
    TextureRef::new(scene.add_texture(texture).expect("sound"))
}

/// The panel at y = 1.5, which shines downwards.
fn panel(scene: &mut Scene, kept: Kept, [x0, z0, x1, z1]: [f32; 4], double_sided: bool) -> Primitive {
    let mut glow = Material { emissive: [4.0, 6.0, 8.0], double_sided, ..lambert([0.0; 3]) };
    // Texel 1 is the quarter x > 0, z < 0.
    let alpha = |kept: u8, cut: u8| move |texel: usize| [255, 255, 255, if texel == 1 { kept } else { cut }];
    let mask = |cutoff: f32| Alpha::Mask { cutoff };
    let mut colors = None;
    let mut texcoords = [Some(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), None];
    match kept {
        Kept::Built => {}
        Kept::ByTexture => {
            glow.base_color_texture = Some(texture(scene, alpha(128, 127), Wrap::Clamp));
            glow.alpha = mask(0.5);
        }
        Kept::ByTransformedTexture => {
            // u' = −2u + 3 mirrors what u from 0 to 1 shows, twice.
            let moved = texture(scene, alpha(255, 0), Wrap::Mirror);
            let transform = [[-1.0, 0.0, 2.0], [0.0, 1.0, -2.0]];
            glow.base_color_texture = Some(TextureRef { texcoord: 1, transform, ..moved });
            glow.alpha = mask(0.5);
            texcoords = [Some(vec![[0.3; 2]; 4]), texcoords[0].take()];
        }
        Kept::ByVertices => {
            glow.alpha = mask(0.75);
            colors = Some([0.0, 1.0, 1.0, 0.0].map(|alpha| [1.0, 1.0, 1.0, alpha]).to_vec());
        }
        Kept::ByProduct => {
            glow.base_color[3] = 0.9;
            glow.base_color_texture = Some(texture(scene, alpha(230, 217), Wrap::Clamp));
            glow.alpha = mask(0.7);
            colors = Some(vec![[1.0, 1.0, 1.0, 0.9]; 4]);
        }
        Kept::ByLight => {
            let light = |texel: usize| [if texel == 1 { 255 } else { 0 }; 4];
            glow.emissive_texture = Some(texture(scene, light, Wrap::Clamp));
        }
    }
    let material = scene.add_material(glow).expect("sound");
    let corners = [[x0, 1.5, z0], [x1, 1.5, z0], [x1, 1.5, z1], [x0, 1.5, z1]];
    Primitive { colors, texcoords, ..quad(corners, material) }
}

/// A matt corner of a room with a plate of rough metal under a panel, of which alpha or a texture leaves a part, or just that part.
fn room(kept: Kept, built: bool, double_sided: bool, world: DAffine3) -> Scene {
    let mut scene = floor(2.0, lambert([0.6, 0.5, 0.4]));
    let [matt, metal] = [lambert([0.7; 3]), Material { metallic: 1.0, roughness: 0.4, ..lambert([0.9; 3]) }]
        .map(|material| scene.add_material(material).expect("sound"));
    let wall = quad([[-2.0, 0.0, -2.0], [2.0, 0.0, -2.0], [2.0, 3.0, -2.0], [-2.0, 3.0, -2.0]], matt);
    let plate = quad([[-1.6, 0.1, 0.6], [-0.4, 0.3, 1.2], [-0.2, 0.6, 0.2], [-1.4, 0.4, -0.4]], metal);
    place(&mut scene, vec![wall, plate], DAffine3::IDENTITY);
    let panel = if built {
        panel(&mut scene, Kept::Built, kept.part(), double_sided)
    } else {
        panel(&mut scene, kept, [-1.0, -1.0, 1.0, 1.0], double_sided)
    };
    place(&mut scene, vec![panel], world);
    scene
}

fn asked(slots: &[Slot]) -> FrameRequest {
    // From below the panel, which is not seen: an emissive texture leaves a dark surface where alpha leaves none.
    let camera = view(DVec3::new(1.4, 0.9, 1.9), DVec3::new(-0.2, 0.3, -0.8));
    FrameRequest { image: false, ..request(SIZE, camera, slots) }
}

/// Means of blocks of pixels.
fn blocks(frame: &Frame, slot: Slot) -> Vec<f64> {
    let [width, height] = SIZE.map(|side| side as usize / BLOCK);
    let mut sums = vec![0.0; width * height];
    for (pixel, color) in frame.slots[&slot].pixels.iter().enumerate() {
        let (x, y) = (pixel % SIZE[0] as usize / BLOCK, pixel / SIZE[0] as usize / BLOCK);
        sums[y * width + x] += color.iter().map(|&channel| f64::from(channel)).sum::<f64>();
    }
    sums.into_iter().map(|sum| sum / (3 * BLOCK * BLOCK) as f64).collect()
}

fn with(technique: Technique, changes: &[(&str, &str)]) -> Settings {
    let mut settings = Settings::new(technique, Preset::Default);
    for (key, value) in changes {
        settings.set(key, value).expect("a setting and its value");
    }
    settings
}

/// In no block is the light of the part that is left further from that of the part as geometry.
fn assert_as_built(session: &Session, settings: &Settings, slot: Slot, kept: Kept, world: DAffine3, tolerance: f64) {
    for double_sided in [false, true] {
        if double_sided && !matches!(kept, Kept::ByTexture) {
            continue;
        }
        let [found, built] = [false, true].map(|built| {
            let frame = session.render(&room(kept, built, double_sided, world), settings, &asked(&[slot]));
            blocks(&frame, slot)
        });
        let mean = built.iter().sum::<f64>() / built.len() as f64;
        let ratios =
            found.iter().zip(&built).filter(|(_, built)| **built > 0.1 * mean).map(|(found, built)| found / built);
        let (low, high) = ratios.fold((f64::INFINITY, 0.0_f64), |(low, high), it| (low.min(it), high.max(it)));
        println!("{kept:?}, {slot}: {low:.4} to {high:.4} of {mean:.4}");
        assert!(mean > 0.01, "{kept:?}: {mean}");
        assert!(low > 1.0 - tolerance && high < 1.0 + tolerance, "{kept:?}, {slot}: {low} to {high}");
    }
}

const WAYS: [Kept; 5] = [Kept::ByTexture, Kept::ByTransformedTexture, Kept::ByVertices, Kept::ByProduct, Kept::ByLight];

/// The panel's node mirrors: corners 1 and 2 of each triangle change places.
fn mirrored() -> DAffine3 {
    DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)) * DAffine3::from_translation(DVec3::new(-0.3, 0.0, 0.0))
}

#[test]
fn paths_meet_what_is_left() {
    let session = Session::open();
    let settings = with(Technique::Path, &[("path.spp", "128"), ("path.bounces", "0")]);
    for kept in WAYS {
        assert_as_built(&session, &settings, Slot::Direct, kept, DAffine3::IDENTITY, 0.02);
    }
    assert_as_built(&session, &settings, Slot::Direct, Kept::ByLight, mirrored(), 0.02);
}

#[test]
fn traced_light_comes_from_what_is_left() {
    let session = Session::open();
    let mut settings = with(Technique::Direct, &[("traced.samples", "512")]);
    settings.methods.direct = DirectMethod::Traced;
    for kept in [Kept::ByTexture, Kept::ByVertices] {
        assert_as_built(&session, &settings, Slot::Direct, kept, DAffine3::IDENTITY, 0.02);
    }
    assert_as_built(&session, &settings, Slot::Direct, Kept::ByLight, mirrored(), 0.02);
}

/// Few emitters stand for the panel, elsewhere on it than on the part as geometry.
#[test]
fn emitter_samples_stand_on_what_is_left() {
    let session = Session::open();
    let settings = with(Technique::Rsm, &[("lights.emitter_samples", "128")]);
    for kept in [Kept::ByTexture, Kept::ByVertices] {
        assert_as_built(&session, &settings, Slot::Direct, kept, DAffine3::IDENTITY, 0.04);
    }
    assert_as_built(&session, &settings, Slot::Direct, Kept::ByLight, mirrored(), 0.04);
}

/// Photons and light paths start on what is left: the light that comes back from walls and metal.
#[test]
fn light_that_is_sent_out_comes_from_what_is_left() {
    let session = Session::open();
    let mut tracer = Tracer::new(&session);
    let photons = with(Technique::Sppm, &[("sppm.spp", "128"), ("sppm.bounces", "2")]);
    let camera = asked(&[]).camera;
    let mean_of = |frame: &Frame, slot: Slot| {
        let pixels = &frame.slots[&slot].pixels;
        pixels.iter().map(|pixel| DVec3::from(pixel.map(f64::from))).sum::<DVec3>() / pixels.len() as f64
    };
    for kept in [Kept::ByTexture, Kept::ByLight] {
        let rooms = [false, true].map(|built| room(kept, built, false, DAffine3::IDENTITY));
        let ask = Ask { light_paths: Some(true), bounces: Some(2), ..Ask::new(SIZE, 64, camera.clone()) };
        let [found, built] = rooms.each_ref().map(|room| tracer.trace(room, &ask).mean(Slot::Caustics));
        assert_near(&format!("{kept:?}, light paths"), found, built, 0.02);
        if matches!(kept, Kept::ByLight) {
            // Its dark part stops what walls send back, where a hole lets it out.
            continue;
        }
        let slots = [Slot::Diffuse, Slot::Caustics];
        let [found, built] = rooms.each_ref().map(|room| session.render(room, &photons, &asked(&slots)));
        for (slot, tolerance) in slots.into_iter().zip([0.03, 0.08]) {
            assert_near(&format!("{kept:?}, photons, {slot}"), mean_of(&found, slot), mean_of(&built, slot), tolerance);
        }
    }
}

/// Virtual lights and photons in views from emitters.
#[test]
fn views_from_emitters_look_from_what_is_left() {
    let session = Session::open();
    // Many virtual lights: with few, where they lie weighs as much as what is compared.
    let settings = with(Technique::Hybrid, &[("lights.emitter_samples", "32"), ("vpl.count", "1200")]);
    // Few photons land: elsewhere from other emitters, so that only emitters in the same places can be compared by them.
    let cases: [(Kept, &[Slot]); 2] =
        [(Kept::ByTexture, &[Slot::Diffuse, Slot::Caustics]), (Kept::ByVertices, &[Slot::Diffuse])];
    for (kept, slots) in cases {
        let [found, built] = [false, true].map(|built| {
            let room = room(kept, built, false, DAffine3::IDENTITY);
            session.render(&room, &settings, &asked(slots))
        });
        for &slot in slots {
            let mean = |frame: &Frame| DVec3::splat(blocks(frame, slot).iter().sum());
            assert_near(&format!("{kept:?}, {slot}"), mean(&found), mean(&built), 0.03);
        }
    }
}

/// Makes a material that alpha cuts away, and the vertex colours that it takes.
type Cut<'a> = &'a dyn Fn(&mut Scene) -> (Material, Option<Vec<[f32; 4]>>);

/// A wholly cut panel is nowhere: no emitter, not drawn, and no pass runs for it.
#[test]
fn a_panel_that_is_wholly_cut_is_none() {
    let session = Session::open();
    let glow = Material { emissive: [5.0; 3], alpha: Alpha::Mask { cutoff: 0.5 }, ..lambert([0.5; 3]) };
    let corners = [[-1.0, 1.5, -1.0], [1.0, 1.5, -1.0], [1.0, 1.5, 1.0], [-1.0, 1.5, 1.0]];
    let by_factor = |_: &mut Scene| {
        let base_color = [1.0, 1.0, 1.0, 0.3];
        (Material { base_color, ..glow.clone() }, None)
    };
    let by_texture = |scene: &mut Scene| {
        let base_color_texture = Some(texture(scene, |_| [255, 255, 255, 100], Wrap::Clamp));
        (Material { base_color_texture, ..glow.clone() }, None)
    };
    let by_vertices = |_: &mut Scene| (glow.clone(), Some(vec![[1.0, 1.0, 1.0, 0.4]; 4]));
    let ways: [Cut<'_>; 3] = [&by_factor, &by_texture, &by_vertices];
    let mut techniques = vec![with(Technique::Rsm, &[]), with(Technique::Hybrid, &[])];
    techniques.push(with(Technique::Direct, &[]));
    techniques[2].methods.direct = DirectMethod::Traced;
    techniques.push(with(Technique::Path, &[("path.spp", "4")]));
    let asked = FrameRequest { timing: Timing::Passes, ..asked(&[Slot::Emission, Slot::Direct, Slot::Diffuse]) };
    for way in ways {
        let empty = builtin("cornell-point");
        let mut scene = empty.clone();
        let (material, colors) = way(&mut scene);
        let material = scene.add_material(material).expect("sound");
        let texcoords = [Some(vec![[0.2; 2]; 4]), None];
        let small = corners.map(|[x, y, z]| [0.2 * x, y, 0.2 * z]);
        place(&mut scene, vec![Primitive { colors, texcoords, ..quad(small, material) }], DAffine3::IDENTITY);
        assert!(!scene.facts().emissive && scene.emitter_samples(8).is_empty());
        for settings in &techniques {
            let [found, expected] = [&scene, &empty].map(|scene| session.render(scene, settings, &asked));
            for (slot, image) in &expected.slots {
                let pixels = || found.slots[slot].pixels.iter().flatten().zip(image.pixels.iter().flatten());
                let sum: f32 = pixels().map(|(_, expected)| expected).sum();
                let off: f32 = pixels().map(|(found, expected)| (found - expected).abs()).sum();
                assert!(off <= 1e-3 * sum, "{slot} with {:?}: {off} of {sum}", settings.technique);
            }
            let runs = |frame: &Frame| -> Vec<String> {
                let ran = frame.timings.passes.iter().filter(|pass| pass.skipped.is_none());
                let names = ran.map(|pass| pass.full_name());
                // Textures and cut surfaces have passes of their own, which draw nothing here.
                names.filter(|name| !["textured", "masked"].iter().any(|part| name.contains(part))).collect()
            };
            assert_eq!(runs(&found), runs(&expected), "{:?}", settings.technique);
        }
    }
}
