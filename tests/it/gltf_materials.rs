//! What the glTF reader promises of materials and textures, feature by feature, on files made here.

use crate::gltf_file::{self, File};
use irradia::scene::{Alpha, LoadOptions, Scene, Wrap};
use serde_json::{Value, json};

fn fault(file: &File) -> String {
    file.load().expect_err("the file is at fault").to_string()
}

#[test]
fn materials_take_their_extensions() {
    let mut file = File::triangle();
    file.material(json!({
        "name": "all",
        "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 7.0},
        "emissiveFactor": [1.0, 0.5, 0.0], "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
        "extensions": {
            "KHR_materials_emissive_strength": {"emissiveStrength": 20.0}, "KHR_materials_ior": {"ior": 1.33},
            "KHR_materials_specular": {"specularFactor": 0.0, "specularColorFactor": [2.0, 1.0, 0.5]},
            "KHR_materials_transmission": {"transmissionFactor": 0.75},
            "KHR_materials_volume": {"thicknessFactor": 1.0, "attenuationDistance": 3.0, "attenuationColor": [0.5, 0.6, 0.7]},
        },
    }));
    let scene = file.load().expect("it is sound");
    let material = &scene.materials()[0];
    assert_eq!((material.base_color, material.metallic, material.roughness), ([0.1, 0.2, 0.3, 0.4], 0.5, 1.0));
    assert_eq!(material.emissive, [20.0, 10.0, 0.0]);
    assert_eq!((material.alpha, material.double_sided, material.unlit), (Alpha::Mask { cutoff: 0.25 }, true, false));
    assert_eq!((material.ior, material.specular, material.specular_color), (1.33, 0.0, [2.0, 1.0, 0.5]));
    assert_eq!((material.transmission, material.thickness), (0.75, 1.0));
    assert_eq!((material.attenuation_distance, material.attenuation_color), (3.0, [0.5, 0.6, 0.7]));
    let facts = scene.facts();
    assert!(
        facts.emissive && facts.transmissive && facts.alpha_masked && facts.specular && facts.diffuse && facts.lit()
    );
}

#[test]
fn a_matt_material_has_no_specular_lobe_and_metal_no_diffuse_one() {
    let facts = |material: Value| {
        let mut file = File::triangle();
        file.material(material);
        file.load().expect("it is sound").facts()
    };
    let matt = facts(
        json!({"pbrMetallicRoughness": {"metallicFactor": 0.0}, "extensions": {"KHR_materials_specular": {"specularFactor": 0.0}}}),
    );
    assert!(matt.diffuse && !matt.specular && !matt.glossy && !matt.lit());
    let metal = facts(json!({"pbrMetallicRoughness": {"roughnessFactor": 0.1}}));
    assert!(!metal.diffuse && metal.specular && metal.glossy);
    let plastic = facts(json!({"pbrMetallicRoughness": {"metallicFactor": 0.0}}));
    assert!(plastic.diffuse && plastic.specular && !plastic.glossy);
}

#[test]
fn blending_becomes_a_cutout_with_a_warning() {
    let mut file = File::triangle();
    file.material(json!({"name": "veil", "alphaMode": "BLEND"}));
    let scene = file.load().expect("it is sound");
    assert_eq!(scene.materials()[0].alpha, Alpha::Mask { cutoff: 0.5 });
    assert!(scene.warnings.len() == 1 && scene.warnings[0].contains("veil"), "{:?}", scene.warnings);
}

#[test]
fn textures_are_shared_split_by_use_and_decoded_only_if_used() {
    let mut file = File::triangle();
    let image = gltf_file::png(2, 1, &[255, 0, 0, 255, 0, 255, 0, 128]);
    let texture = file.texture(&image, json!({"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}));
    file.texture(b"this is no image, and nothing uses it", json!({}));
    file.material(json!({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": texture}, "metallicRoughnessTexture": {"index": texture, "texCoord": 1}},
        "emissiveTexture": {"index": texture},
    }));
    let scene = file.load().expect("it is sound");
    let material = &scene.materials()[0];
    let [base, data, emissive] =
        [material.base_color_texture, material.metallic_roughness_texture, material.emissive_texture]
            .map(|reference| reference.expect("it is used"));
    assert_eq!(base.texture, emissive.texture);
    assert_ne!(base.texture, data.texture);
    assert_eq!((base.texcoord, data.texcoord), (0, 1));
    assert_eq!(scene.textures().len(), 2);
    let [colors, numbers] = [base, data].map(|reference| &scene.textures()[reference.texture.0]);
    assert!(colors.srgb && !numbers.srgb && colors.nearest);
    assert_eq!(colors.wrap, [Wrap::Clamp, Wrap::Mirror]);
    assert_eq!((colors.width, colors.height), (2, 1));
    assert_eq!(colors.rgba8, [255, 0, 0, 255, 0, 255, 0, 128]);
}

#[test]
fn grey_and_16_bit_images_are_converted() {
    for (bytes, expected) in [
        (gltf_file::grey_png(&[77]), [77, 77, 77, 255]),
        (gltf_file::png_16(&[0xFFFF, 0x8080, 0, 0xFFFF]), [255, 128, 0, 255]),
    ] {
        let mut file = File::triangle();
        let texture = file.texture(&bytes, json!({}));
        file.material(json!({"emissiveTexture": {"index": texture}}));
        assert_eq!(file.load().expect("it is sound").textures()[0].rgba8, expected);
    }
}

#[test]
fn jpegs_are_grey_or_in_colour() {
    // R = Y + 1.402 (Cr - 128), G = Y - 0.714 (Cr - 128), B = Y where Cb is 128; decoders round as they like.
    for (values, expected) in [(vec![200], [200, 200, 200, 255]), (vec![100, 128, 178], [170, 64, 100, 255])] {
        let mut file = File::triangle();
        let texture = file.texture(&gltf_file::jpeg(&values), json!({}));
        file.material(json!({"emissiveTexture": {"index": texture}}));
        let scene = file.load().expect("it is sound");
        let texture = &scene.textures()[0];
        assert_eq!((texture.width, texture.height), (8, 8));
        let near = |texel: &[u8; 4]| texel.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1);
        assert!(texture.rgba8.as_chunks().0.iter().all(near), "{:?}", &texture.rgba8[..4]);
    }
}

#[test]
fn images_that_claim_more_than_they_hold_are_refused() {
    let mut image = gltf_file::png(1, 1, &[0; 4]);
    image[16..24].copy_from_slice(&[0, 0, 0x3F, 0xFF, 0, 0, 0x3F, 0xFF]); // 16383 × 16383
    let header_crc = gltf_file::crc32(&image[12..29]);
    image[29..33].copy_from_slice(&header_crc.to_be_bytes());
    let mut file = File::triangle();
    let texture = file.texture(&image, json!({}));
    file.material(json!({"emissiveTexture": {"index": texture}}));
    assert!(fault(&file).contains("16383×16383"), "{}", fault(&file));
}

#[test]
fn what_a_jpeg_can_hold_is_less_than_what_a_png_can() {
    let mut image = gltf_file::jpeg(&[200]);
    let frame = image.windows(2).position(|marker| marker == [0xFF, 0xC0]).expect("the header of a frame");
    image[frame + 5..frame + 9].copy_from_slice(&[0x3F, 0xFF, 0x3F, 0xFF]); // 16383 × 16383
    image.resize(32 << 10, 0);
    let mut file = File::triangle();
    let texture = file.texture(&image, json!({}));
    file.material(json!({"emissiveTexture": {"index": texture}}));
    let fault = fault(&file);
    assert!(fault.contains("16383×16383") && fault.contains("524224 at the least"), "{fault}");
}

#[test]
fn the_caller_says_how_large_images_may_be() {
    let mut file = File::triangle();
    let texture = file.texture(&gltf_file::png(3, 2, &[0; 24]), json!({}));
    file.material(json!({"emissiveTexture": {"index": texture}}));
    let load = |image_side, texture_bytes| {
        let limits =
            |options: &mut LoadOptions| (options.image_side, options.texture_bytes) = (image_side, texture_bytes);
        let (text, options) = (file.gltf(&file.data_uri()), LoadOptions::default().with(limits));
        Scene::from_bytes_with("test", text.as_bytes(), None, &options).map_err(|error| error.to_string())
    };
    let error = load(2, 24).expect_err("three texels");
    assert!(error.contains("LoadOptions::image_side"), "{error}");
    let error = load(3, 23).expect_err("24 bytes");
    assert!(error.contains("--max-texture-mib") && error.contains("LoadOptions::texture_bytes"), "{error}");
    load(3, 24).expect("just so");
}

#[test]
fn texture_transforms_scale_then_turn_then_move() {
    let mut file = File::triangle();
    let texture = file.texture(&gltf_file::png(1, 1, &[0; 4]), json!({}));
    let transform =
        json!({"offset": [0.5, 0.25], "rotation": std::f64::consts::FRAC_PI_2, "scale": [2.0, 3.0], "texCoord": 1});
    file.material(json!({"emissiveTexture": {"index": texture, "extensions": {"KHR_texture_transform": transform}}}));
    let scene = file.load().expect("it is sound");
    let reference = scene.materials()[0].emissive_texture.expect("it is used");
    assert_eq!(reference.texcoord, 1);
    // Scaled to (2, 3), turned to (3, -2), moved.
    let [u, v] = reference.apply([1.0, 1.0]);
    assert!((u - 3.5).abs() < 1e-5 && (v + 1.75).abs() < 1e-5, "{u} {v}");
}
