//! Which surfaces keep their materials, and that these are what the format allows, whatever the scene's are.

use irradia::glam::{DAffine3, DVec3};
use irradia::scene::{Alpha, Material, NodeId, Scene, TextureRef};
use serde_json::Value;

use super::file::{list, number, parts};
use super::materials::checkers;
use super::{add_point_light, add_square, baked, context, lambert, options, shown, view};

fn named(name: &str, material: Material) -> Material {
    Material { name: name.to_owned(), ..material }
}

fn factor<'a>(document: &'a Value, name: &str, pointer: &str) -> &'a Value {
    let material = list(&document["materials"]).iter().find(|material| material["name"] == name).expect("by its name");
    material.pointer(pointer).expect("a factor")
}

/// Baked light stands for the diffuse lobe alone: a window or a mirror with a rest of it would be a black slab.
#[test]
fn what_is_mostly_metal_or_glass_stays_so() {
    let context = context();
    let mut scene = Scene::empty("rests");
    add_square(&mut scene, [2.0, 0.0], named("floor", lambert([0.5; 3])));
    let kept = [
        named("window", Material { transmission: 0.95, double_sided: true, ..Material::default() }),
        named("mirror", Material { metallic: 0.95, ..Material::default() }),
        named("frosted mirror", Material { metallic: 0.3, transmission: 0.4, ..Material::default() }),
    ];
    let baked_ones = [
        named("wall", lambert([0.5; 3])),
        named("lacquer", Material { metallic: 0.3, ..Material::default() }),
        named("paper", Material { transmission: 0.3, ..Material::default() }),
    ];
    for (place, material) in kept.iter().chain(&baked_ones).enumerate() {
        add_square(&mut scene, [0.5, 1.0 + place as f32], material.clone());
    }
    add_point_light(&mut scene, DVec3::new(0.8, 9.0, 0.0), 8.0);
    let (_, loaded) = baked(&context, &scene, &options(500));
    let names: Vec<&str> = loaded.materials().iter().map(|material| material.name.as_str()).collect();
    for material in &kept {
        let found = loaded.materials().iter().find(|it| it.name == material.name);
        let share = |it: &Material| [it.metallic, it.transmission];
        assert_eq!(found.map(share), Some(share(material)), "{names:?}");
    }
    assert!(baked_ones.iter().all(|material| !names.contains(&&*material.name)), "{names:?}");
}

/// The thickness of a volume is in the units of its mesh, and the file has the scene's.
#[test]
fn glass_is_as_thick_as_its_node_makes_it() {
    let context = context();
    let mut scene = Scene::empty("centimetres");
    add_square(&mut scene, [1.0, 0.0], lambert([0.5; 3]));
    let glass =
        Material { transmission: 1.0, thickness: 2.0, attenuation_distance: 3.0, ior: 1.33, ..Material::default() };
    add_square(&mut scene, [50.0, 100.0], named("glass", glass));
    scene.set_local_transform(NodeId(1), DAffine3::from_scale(DVec3::splat(0.01))).expect("sound");
    add_point_light(&mut scene, DVec3::new(0.0, 2.0, 0.0), 8.0);
    let (baked, _) = baked(&context, &scene, &options(300));
    let (document, _) = parts(&baked.glb);
    let volume = factor(&document, "glass", "/extensions/KHR_materials_volume");
    let thickness = volume["thicknessFactor"].as_f64().expect("a number");
    assert!((thickness / 0.02 - 1.0).abs() < 1e-6 && volume["attenuationDistance"] == 3.0, "{volume}");
}

/// Factors beyond what the format allows.
#[test]
fn factors_are_what_the_format_allows() {
    let context = context();
    let mut scene = Scene::empty("factors");
    let metal = Material { base_color: [2.0, 0.5, 3.0, 4.0], metallic: 1.5, roughness: 7.0, ..Material::default() };
    let glass = Material {
        transmission: 2.0,
        thickness: 1.0,
        ior: 0.5,
        specular: 3.0,
        attenuation_color: [2.0, 1.0, 0.5],
        ..Material::default()
    };
    add_square(&mut scene, [1.0, 0.0], lambert([0.5; 3]));
    add_square(&mut scene, [1.0, -1.0], named("metal", metal));
    add_square(&mut scene, [1.0, -2.0], named("glass", glass));
    add_point_light(&mut scene, DVec3::new(0.0, 2.0, 0.0), 8.0);
    let (baked, _) = baked(&context, &scene, &options(300));
    let (document, _) = parts(&baked.glb);
    let one = |name: &str, pointer: &str| assert_eq!(factor(&document, name, pointer), 1.0, "{name} {pointer}");
    one("metal", "/pbrMetallicRoughness/metallicFactor");
    one("metal", "/pbrMetallicRoughness/roughnessFactor");
    one("glass", "/extensions/KHR_materials_transmission/transmissionFactor");
    one("glass", "/extensions/KHR_materials_specular/specularFactor");
    one("glass", "/extensions/KHR_materials_ior/ior");
    one("glass", "/extensions/KHR_materials_volume/attenuationColor/0");
    let color = factor(&document, "metal", "/pbrMetallicRoughness/baseColorFactor");
    assert_eq!(*color, serde_json::json!([1.0, 0.5, 1.0, 1.0]));
}

/// Textures by coordinates that their meshes do not have are read at the zero of these.
#[test]
fn textures_have_coordinates() {
    let context = context();
    let mut scene = Scene::empty("coordinates");
    let texture = checkers(&mut scene, 2);
    let second = Some(TextureRef { texcoord: 1, ..texture });
    // The transform takes (0, 0) to a hole: all is cut away.
    let to_hole = TextureRef { texcoord: 1, transform: [[1.0, 0.0, 0.75], [0.0, 1.0, 0.25]], ..texture };
    let mask = Alpha::Mask { cutoff: 0.5 };
    let lattice = Material { alpha: mask, base_color_texture: Some(to_hole), ..lambert([0.5; 3]) };
    add_square(&mut scene, [4.0, -1.0], Material { emissive: [3.0, 0.0, 0.0], ..lambert([0.0; 3]) });
    add_square(&mut scene, [1.0, 0.0], lattice);
    add_square(&mut scene, [1.0, -3.0], Material { metallic: 1.0, base_color_texture: second, ..Material::default() });
    add_square(&mut scene, [1.0, -5.0], lambert([0.5; 3]));
    add_point_light(&mut scene, DVec3::new(0.0, 2.0, 0.0), 8.0);
    let (baked, loaded) = baked(&context, &scene, &options(500));
    let camera = view(DVec3::new(0.0, 0.7, 0.0), DVec3::ZERO);
    let found = shown(&context, &loaded, Some(&camera));
    assert!(found.iter().all(|pixel| *pixel == [3.0, 0.0, 0.0]), "{:?}", found[0]);

    let (document, _) = parts(&baked.glb);
    let sets = |value: &Value| -> Vec<u64> {
        let text = value.to_string();
        text.split("\"texCoord\":").skip(1).filter_map(|rest| rest.split(['}', ',']).next()?.parse().ok()).collect()
    };
    for primitive in list(&document["meshes"]).iter().flat_map(|mesh| list(&mesh["primitives"])) {
        let material = &list(&document["materials"])[number(&primitive["material"])];
        for set in sets(material) {
            let attributes = &primitive["attributes"];
            assert!(attributes[format!("TEXCOORD_{set}")].is_u64(), "{material} {attributes}");
        }
    }
}

/// A floor of three parts metal keeps its material and emits what its diffuse part reflects.
#[test]
fn metal_emits_its_diffuse_light() {
    let context = context();
    let mut scene = Scene::empty("tiles");
    add_square(
        &mut scene,
        [1.0, 0.0],
        named("tiles", Material { metallic: 0.75, double_sided: true, ..lambert([0.8; 3]) }),
    );
    add_point_light(&mut scene, DVec3::new(0.0, 2.0, 0.0), 8.0);
    let (_, loaded) = baked(&context, &scene, &options(2000));
    let tiles = &loaded.materials()[0];
    assert_eq!((&*tiles.name, tiles.metallic), ("tiles", 0.75));
    assert_eq!(loaded.facts().triangles, 2 * scene.facts().triangles);
    let camera = view(DVec3::new(0.0, 0.4, 0.0), DVec3::ZERO);
    let found = shown(&context, &loaded, Some(&camera))[36 * 96 + 48][0];
    // The metal reflects 0.6 of what comes, and the rest of it meets the other part.
    let expected = 0.8 * 0.25 * 0.4 / std::f32::consts::PI * 8.0 / 4.0;
    assert!((found / expected - 1.0).abs() < 0.03, "{found} {expected}");
}
