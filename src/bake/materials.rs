//! Materials of the baked file: black ones that emit what the surface reflected, and the scene's own where there is no diffuse light to bake.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};

use super::BakeError;
use super::glb::Glb;
use super::textures::{Channels, Textures};
use crate::scene::{Alpha, Material, MaterialId, Scene, TextureRef};

/// What a primitive of the baked file is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Look {
    /// The scene's own material.
    Kept {
        id: MaterialId,
        /// How much longer things are in the scene than in their mesh, where that matters to the material: a float's bits.
        scale: u32,
        /// Of what the diffuse lobe of one side reflects, as below; `None`: nothing is added.
        light: Option<i32>,
    },
    /// Baked light.
    Baked {
        /// Of the power of two that the atlas is multiplied by; `None`: black.
        exponent: Option<i32>,
        /// The material whose alpha cuts it out.
        cut_by: Option<MaterialId>,
    },
}

/// The materials written so far.
pub(super) struct Materials<'a> {
    scene: &'a Scene,
    /// The number of the atlas among the textures.
    atlas: usize,
    pub(super) textures: Textures,
    pub(super) written: Vec<Value>,
    known: BTreeMap<Look, usize>,
    pub(super) extensions: BTreeSet<&'static str>,
}

impl<'a> Materials<'a> {
    pub(super) fn new(scene: &'a Scene, textures: Textures, atlas: usize) -> Materials<'a> {
        let (written, known, extensions) = Default::default();
        Materials { scene, atlas, textures, written, known, extensions }
    }

    /// The number of a material.
    pub(super) fn number(&mut self, glb: &mut Glb, look: Look) -> Result<usize, BakeError> {
        if let Some(known) = self.known.get(&look) {
            return Ok(*known);
        }
        let material = match look {
            Look::Kept { id, scale, light } => self.kept(glb, id, f32::from_bits(scale), light)?,
            Look::Baked { exponent, cut_by } => self.baked(glb, exponent, cut_by)?,
        };
        self.written.push(material);
        self.known.insert(look, self.written.len() - 1);
        Ok(self.written.len() - 1)
    }

    fn extend(&mut self, material: &mut Value, name: &'static str, extension: Value) {
        self.extensions.insert(name);
        material["extensions"][name] = extension;
    }

    /// What the atlas says.
    fn emit(&mut self, material: &mut Value, exponent: i32) {
        material["emissiveFactor"] = json!([1.0, 1.0, 1.0]);
        material["emissiveTexture"] = json!({ "index": self.atlas, "texCoord": 1 });
        let strength = json!({ "emissiveStrength": 2.0_f64.powi(exponent) });
        self.extend(material, "KHR_materials_emissive_strength", strength);
    }

    /// Nothing is reflected: neither lights that a viewer adds nor what surrounds it change what shows.
    fn baked(&mut self, glb: &mut Glb, exponent: Option<i32>, cut_by: Option<MaterialId>) -> Result<Value, BakeError> {
        let name = exponent.map_or_else(|| "black".to_owned(), |exponent| format!("light times 2^{exponent}"));
        let mut material = json!({
            "name": name,
            "pbrMetallicRoughness": { "baseColorFactor": [0.0, 0.0, 0.0, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0 },
        });
        if let Some(exponent) = exponent {
            self.emit(&mut material, exponent);
        }
        self.extend(&mut material, "KHR_materials_specular", json!({ "specularFactor": 0.0 }));
        if let Some(id) = cut_by {
            let of = &self.scene.materials()[id.0];
            material["name"] = format!("{name}, cut out as {}", of.name).into();
            cut_out(&mut material, of);
            material["pbrMetallicRoughness"]["baseColorFactor"][3] = unit(of.base_color[3]).into();
            if let Some(texture) = of.base_color_texture {
                let index = self.textures.number(glb, self.scene, texture.texture, Channels::Alpha)?;
                // Its coordinates come transformed as set 0.
                material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": index });
            }
        }
        Ok(material)
    }

    fn texture(&mut self, glb: &mut Glb, texture: TextureRef) -> Result<Value, BakeError> {
        let index = self.textures.number(glb, self.scene, texture.texture, Channels::All)?;
        let mut info = json!({ "index": index, "texCoord": texture.texcoord });
        if texture.transform != TextureRef::new(texture.texture).transform {
            self.extensions.insert("KHR_texture_transform");
            info["extensions"]["KHR_texture_transform"] = transform(texture.transform);
        }
        Ok(info)
    }

    fn kept(&mut self, glb: &mut Glb, id: MaterialId, scale: f32, light: Option<i32>) -> Result<Value, BakeError> {
        let scene = self.scene;
        let material = &scene.materials()[id.0];
        let mut written = json!({
            "name": material.name,
            "doubleSided": material.double_sided && light.is_none(),
            "pbrMetallicRoughness": {
                "baseColorFactor": material.base_color.map(unit),
                "metallicFactor": unit(material.metallic),
                "roughnessFactor": unit(material.roughness),
            },
        });
        cut_out(&mut written, material);
        let brightest = material.emissive.into_iter().fold(0.0, f32::max);
        if brightest > 0.0 {
            let strength = brightest.max(1.0);
            written["emissiveFactor"] = json!(material.emissive.map(|channel| channel / strength));
            if strength > 1.0 {
                let strength = json!({ "emissiveStrength": strength });
                self.extend(&mut written, "KHR_materials_emissive_strength", strength);
            }
        }
        if material.ior != Material::default().ior {
            self.extend(
                &mut written,
                "KHR_materials_ior",
                json!({ "ior": if material.ior > 0.0 { material.ior.max(1.0) } else { 0.0 } }),
            );
        }
        let Material { specular, specular_color, transmission, .. } = *material;
        if specular != 1.0 || specular_color != [1.0; 3] {
            let layer = json!({ "specularFactor": unit(specular), "specularColorFactor": specular_color });
            self.extend(&mut written, "KHR_materials_specular", layer);
        }
        if transmission > 0.0 {
            self.extend(
                &mut written,
                "KHR_materials_transmission",
                json!({ "transmissionFactor": unit(transmission) }),
            );
        }
        if material.thickness > 0.0 {
            let thickness = (material.thickness * scale).min(f32::MAX);
            let attenuation = material.attenuation_color.map(unit);
            let mut volume = json!({ "thicknessFactor": thickness, "attenuationColor": attenuation });
            if material.attenuation_distance.is_finite() {
                volume["attenuationDistance"] = material.attenuation_distance.into();
            }
            self.extend(&mut written, "KHR_materials_volume", volume);
        }
        if material.unlit {
            self.extend(&mut written, "KHR_materials_unlit", json!({}));
        }
        self.add_textures(glb, material, &mut written)?;
        if let Some(exponent) = light {
            self.emit(&mut written, exponent);
        }
        Ok(written)
    }

    fn add_textures(&mut self, glb: &mut Glb, material: &Material, written: &mut Value) -> Result<(), BakeError> {
        let core = [
            (material.base_color_texture, "/pbrMetallicRoughness", "baseColorTexture"),
            (material.metallic_roughness_texture, "/pbrMetallicRoughness", "metallicRoughnessTexture"),
            (material.normal_texture, "", "normalTexture"),
            (material.emissive_texture, "", "emissiveTexture"),
        ];
        for (texture, place, name) in core {
            let Some(texture) = texture else { continue };
            let info = self.texture(glb, texture)?;
            if let Some(place) = written.pointer_mut(place) {
                place[name] = info;
            }
        }
        if material.normal_texture.is_some() && material.normal_scale != 1.0 {
            written["normalTexture"]["scale"] = material.normal_scale.into();
        }
        let extended = [
            (material.transmission_texture, "KHR_materials_transmission", "transmissionTexture"),
            (material.specular_texture, "KHR_materials_specular", "specularTexture"),
            (material.specular_color_texture, "KHR_materials_specular", "specularColorTexture"),
        ];
        for (texture, extension, name) in extended {
            let Some(texture) = texture else { continue };
            self.extensions.insert(extension);
            let info = self.texture(glb, texture)?;
            written["extensions"][extension][name] = info;
        }
        Ok(())
    }
}

fn cut_out(written: &mut Value, material: &Material) {
    if let Alpha::Mask { cutoff } = material.alpha {
        written["alphaMode"] = "MASK".into();
        written["alphaCutoff"] = cutoff.clamp(0.0, f32::MAX).into();
    }
}

/// The format takes most factors from 0 to 1 alone, and the scene's may be greater.
pub(super) fn unit(factor: f32) -> f32 {
    if factor.is_nan() { 0.0 } else { factor.clamp(0.0, 1.0) }
}

/// A matrix as offset, rotation and scale: the extension has no shear, and whatever was read from it has none.
fn transform([[a, b, offset_u], [c, d, offset_v]]: [[f32; 3]; 2]) -> Value {
    let rotation = (-c).atan2(a);
    let (sin, cos) = rotation.sin_cos();
    json!({ "offset": [offset_u, offset_v], "rotation": rotation, "scale": [a.hypot(c), b * sin + d * cos] })
}
