//! Surfaces without diffuse light keep their material, and what alpha cuts out stays cut out.

use irradia::glam::DVec3;
use irradia::scene::{Alpha, Material, Scene, Texture, TextureRef, Wrap};

use super::{add_point_light, add_square, baked, context, lambert, options, shown, view};

/// Black and white squares, the black ones transparent.
pub(super) fn checkers(scene: &mut Scene, side: u32) -> TextureRef {
    let texel = |index: u32| [if (index % side + index / side).is_multiple_of(2) { 255 } else { 0 }; 4];
    let texture = Texture {
        name: String::new(),
        width: side,
        height: side,
        rgba8: (0..side * side).flat_map(texel).collect(),
        wrap: [Wrap::Mirror, Wrap::Clamp],
        nearest: true,
        srgb: true,
    };
    TextureRef::new(scene.add_texture(texture).expect("sound"))
}

#[test]
fn what_has_no_diffuse_light_keeps_its_material() {
    let context = context();
    let mut scene = Scene::empty("showcase");
    let turned = TextureRef { transform: [[1.2, 1.2, 0.25], [-1.6, 0.9, 0.5]], ..checkers(&mut scene, 4) };
    let metal = Material {
        name: "metal".to_owned(),
        base_color: [0.9, 0.6, 0.3, 1.0],
        metallic: 1.0,
        roughness: 0.25,
        base_color_texture: Some(turned),
        ..Material::default()
    };
    let glass = Material {
        name: "glass".to_owned(),
        roughness: 0.0,
        transmission: 1.0,
        thickness: 0.5,
        attenuation_distance: 2.0,
        attenuation_color: [0.5, 0.75, 1.0],
        ior: 1.33,
        specular_color: [1.0, 0.5, 0.25],
        ..Material::default()
    };
    let lamp =
        Material { name: "lamp".to_owned(), emissive: [12.0, 6.0, 3.0], double_sided: true, ..lambert([0.0; 3]) };
    let sign =
        Material { name: "sign".to_owned(), unlit: true, base_color: [0.5, 0.25, 1.0, 1.0], ..Material::default() };
    let kept = [metal, glass, lamp, sign];
    add_square(&mut scene, [2.0, 0.0], lambert([0.5; 3]));
    for (number, material) in kept.iter().enumerate() {
        add_square(&mut scene, [0.5, 1.0 + number as f32], material.clone());
    }
    let (_, loaded) = baked(&context, &scene, &options(500));
    for expected in kept {
        let found = loaded.materials().iter().find(|material| material.name == expected.name).expect("by its name");
        let close = |a: &TextureRef, b: &TextureRef| {
            a.transform.as_flattened().iter().zip(b.transform.as_flattened()).all(|(a, b)| (a - b).abs() < 1e-5)
        };
        let [of_found, of_expected] = [found, &expected].map(|material| material.base_color_texture);
        assert_eq!(of_found.is_some(), of_expected.is_some());
        assert!(of_found.iter().zip(&of_expected).all(|(a, b)| close(a, b)), "{of_found:?} {of_expected:?}");
        assert_eq!(Material { base_color_texture: of_expected, ..found.clone() }, expected);
        if let Some(texture) = of_found {
            let texture = &loaded.textures()[texture.texture.0];
            assert_eq!((&texture.rgba8, texture.wrap), (&scene.textures()[0].rgba8, scene.textures()[0].wrap));
        }
    }
    assert!(loaded.lights().is_empty());
}

/// Through the holes of a lattice shows what is behind, and of the lattice its light.
#[test]
fn holes_stay_holes() {
    let context = context();
    let mut scene = Scene::empty("lattice");
    let texture = Some(checkers(&mut scene, 2));
    let mask = Alpha::Mask { cutoff: 0.5 };
    add_square(&mut scene, [1.0, 0.0], Material { alpha: mask, base_color_texture: texture, ..lambert([0.5; 3]) });
    let below = Material { emissive: [3.0, 0.0, 0.0], ..lambert([0.0; 3]) };
    add_square(&mut scene, [4.0, -1.0], below);
    add_point_light(&mut scene, DVec3::new(0.0, 2.0, 0.0), 8.0);
    let (_, loaded) = baked(&context, &scene, &options(2000));
    let camera = view(DVec3::new(0.0, 0.7, 0.0), DVec3::ZERO);
    let found = shown(&context, &loaded, Some(&camera));
    let at = |x: usize, y: usize| found[y * 96 + x];
    // Columns run along x, rows along z; the first and the last texel are there.
    let [solid, hole] = [[(30, 20), (66, 52)], [(66, 20), (30, 52)]];
    for (x, y) in hole {
        assert_eq!(at(x, y), [3.0, 0.0, 0.0], "{x} {y}");
    }
    for (x, y) in solid {
        let [red, green, blue] = at(x, y);
        assert!(
            (0.15..0.35).contains(&green) && (red - green).abs() < 0.05 && blue == green,
            "{x} {y}: {:?}",
            at(x, y)
        );
    }
}
