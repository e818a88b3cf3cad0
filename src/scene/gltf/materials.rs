//! Materials: factors brought into range, extensions merged in, textures asked for by use.

use super::document::{self, TextureInfo, get};
use super::images::TextureRequests;
use super::loader::Loader;
use super::primitives::RawMesh;
use crate::scene::{Alpha, Material, MaterialId, TextureRef};
use std::collections::{BTreeSet, HashMap};

/// Whether a texture holds colours, which are sRGB-encoded, or data.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    Color,
    Data,
}

impl<'a> Loader<'a> {
    /// Adds the materials that the meshes use, and their textures. `None` among the keys is glTF's default material.
    pub(super) fn add_materials(&mut self, meshes: &[RawMesh]) -> Result<HashMap<Option<usize>, MaterialId>, String> {
        let used: BTreeSet<Option<usize>> =
            meshes.iter().flat_map(|mesh| &mesh.primitives).map(|(_, material)| *material).collect();
        let mut requests = TextureRequests::default();
        let mut converted = Vec::new();
        let mut blended = Vec::new();
        for &index in &used {
            let material = match index {
                None => Material { metallic: 1.0, ..Material::default() },
                Some(index) => {
                    let source = get(&self.document.materials, index, "material")?;
                    if source.alpha_mode.as_deref() == Some("BLEND") {
                        blended.push(source.name.clone().unwrap_or(index.to_string()));
                    }
                    let material = self.convert_material(source, &mut requests);
                    material.map_err(|fault| {
                        format!("material {index} {:?}: {fault}", source.name.as_deref().unwrap_or(""))
                    })?
                }
            };
            converted.push(material);
        }
        if !blended.is_empty() {
            self.warn(format!(
                "blending is not supported: these materials are cut out at an opacity of one half: {}",
                blended.join(", ")
            ));
        }
        self.add_textures(requests)?;
        let mut ids = HashMap::new();
        for (index, material) in used.into_iter().zip(converted) {
            ids.insert(index, self.scene.add_material(material).map_err(|error| error.to_string())?);
        }
        Ok(ids)
    }

    fn convert_material(
        &mut self,
        source: &'a document::Material,
        requests: &mut TextureRequests<'a>,
    ) -> Result<Material, String> {
        let base = &source.pbr_metallic_roughness;
        let extensions = &source.extensions;
        let specular = &extensions.specular;
        let volume = &extensions.volume;
        let mut texture = |info: &'a Option<TextureInfo>, usage| self.convert_texture(info.as_ref(), usage, requests);
        let strength = extensions.emissive_strength.emissive_strength.unwrap_or(1.0);
        Ok(Material {
            name: source.name.clone().unwrap_or_default(),
            base_color: base.base_color_factor.unwrap_or([1.0; 4]).map(unit),
            metallic: unit(base.metallic_factor.unwrap_or(1.0)),
            roughness: unit(base.roughness_factor.unwrap_or(1.0)),
            emissive: source.emissive_factor.map(|factor| at_least_zero(factor * strength)),
            ior: extensions.ior.ior.map_or(1.5, |ior| if ior == 0.0 { 0.0 } else { at_least_zero(ior).max(1.0) }),
            specular: unit(specular.specular_factor.unwrap_or(1.0)),
            specular_color: specular.specular_color_factor.unwrap_or([1.0; 3]).map(at_least_zero),
            transmission: unit(extensions.transmission.transmission_factor.unwrap_or(0.0)),
            thickness: at_least_zero(volume.thickness_factor.unwrap_or(0.0)),
            attenuation_distance: volume
                .attenuation_distance
                .filter(|&distance| distance > 0.0)
                .unwrap_or(f32::INFINITY),
            attenuation_color: volume.attenuation_color.unwrap_or([1.0; 3]).map(unit),
            normal_scale: source
                .normal_texture
                .as_ref()
                .and_then(|info| info.scale)
                .filter(|scale| scale.is_finite())
                .unwrap_or(1.0),
            alpha: match source.alpha_mode.as_deref() {
                Some("MASK") => Alpha::Mask { cutoff: at_least_zero(source.alpha_cutoff.unwrap_or(0.5)) },
                Some("BLEND") => Alpha::Mask { cutoff: 0.5 },
                _ => Alpha::Opaque,
            },
            double_sided: source.double_sided,
            unlit: extensions.unlit.is_some(),
            base_color_texture: texture(&base.base_color_texture, Use::Color)?,
            metallic_roughness_texture: texture(&base.metallic_roughness_texture, Use::Data)?,
            normal_texture: texture(&source.normal_texture, Use::Data)?,
            emissive_texture: texture(&source.emissive_texture, Use::Color)?,
            transmission_texture: texture(&extensions.transmission.transmission_texture, Use::Data)?,
            specular_texture: texture(&specular.specular_texture, Use::Data)?,
            specular_color_texture: texture(&specular.specular_color_texture, Use::Color)?,
        })
    }

    fn convert_texture(
        &mut self,
        info: Option<&'a TextureInfo>,
        usage: Use,
        requests: &mut TextureRequests<'a>,
    ) -> Result<Option<TextureRef>, String> {
        let Some(info) = info else { return Ok(None) };
        let transform = info.extensions.transform.as_ref();
        let texcoord = transform.and_then(|transform| transform.tex_coord).unwrap_or(info.tex_coord);
        if texcoord > 1 {
            self.warn(format!(
                "texture {} is ignored: it uses coordinate set {texcoord}, and only 0 and 1 are supported",
                info.index
            ));
            return Ok(None);
        }
        let Some(texture) = self.request_texture(info.index, usage == Use::Color, requests)? else {
            self.warn(format!("texture {} is ignored: it has no PNG or JPEG image", info.index));
            return Ok(None);
        };
        let transform = transform.map_or(TextureRef::new(texture).transform, affine);
        Ok(Some(TextureRef { texture, texcoord, transform }))
    }
}

/// Scale, then rotation, then offset. The extension's angles turn counter-clockwise as seen with v pointing down, as the
/// reference viewer has it.
fn affine(transform: &document::TextureTransform) -> [[f32; 3]; 2] {
    let (sin, cos) = transform.rotation.sin_cos();
    let [scale_u, scale_v] = transform.scale.unwrap_or([1.0; 2]);
    let [offset_u, offset_v] = transform.offset;
    let rows = [[cos * scale_u, sin * scale_v, offset_u], [-sin * scale_u, cos * scale_v, offset_v]];
    rows.map(|row| row.map(|value| if value.is_finite() { value } else { 0.0 }))
}

fn unit(value: f32) -> f32 {
    at_least_zero(value).min(1.0)
}

/// Negative values are cut off, overflowing ones brought back, and what is not a number (0 times infinity) becomes 0.
fn at_least_zero(value: f32) -> f32 {
    if value > 0.0 { value.min(f32::MAX) } else { 0.0 }
}
