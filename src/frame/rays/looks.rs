//! What surfaces are made of, as rays meet it: materials, and textures as plain texels. It stands while materials do.

use std::sync::Arc;

use super::sobol::sobol_points;
use super::texels::Texels;
use super::uploaded::{FLOATS, HALVES, Uploaded, WORDS};
use crate::frame::materials::{material_record, texture_kinds};
use crate::frame::textures::texture_uses;
use crate::graph::hash_of;
use crate::scene::{Cutout, Facts, Material, Scene, TextureRef, cutout, has_specular_lobe};
use crate::shaders::types;
use crate::vulkan::{Device, VulkanError};

/// What a dielectric with the usual index reflects of light from all around: 0.04 + 0.96/21.
const MEAN_FRESNEL: f64 = 0.0857;

pub(super) struct Looks {
    pub(super) key: u64,
    pub(super) materials: Uploaded,
    pub(super) media: Uploaded,
    pub(super) uses: Uploaded,
    pub(super) table: Uploaded,
    pub(super) texels: Uploaded,
    /// The points that rays are drawn by: they never change, and are kept with what changes least.
    pub(super) sobol: Uploaded,
    /// What alpha leaves of the surfaces of each material.
    pub(super) cutouts: Vec<Cutout>,
    /// The kinds of textures that any material reads, as the shaders' bits.
    pub(super) texture_kinds: u32,
    /// How many sides of each material's surfaces have a diffuse lobe.
    pub(super) diffuse_sides: Vec<u32>,
    /// The largest share of light that some material with a diffuse lobe reflects, textures aside.
    pub(super) greatest_albedo: f64,
}

impl Looks {
    pub(super) fn key(scene: &Scene, facts: &Facts) -> u64 {
        hash_of(&(scene.identity(), scene.revisions().materials, facts.vertex_colors))
    }

    /// Of a scene as it is now; the textures of `held` where they are the same.
    pub(super) fn update(
        device: &Arc<Device>,
        scene: &Scene,
        facts: &Facts,
        held: Option<&Looks>,
    ) -> Result<Looks, VulkanError> {
        let key = Looks::key(scene, facts);
        let textures_key = hash_of(&(scene.identity(), scene.revisions().textures));
        let [table, texels] = match held.filter(|held| held.texels.key == textures_key) {
            Some(held) => [held.table.clone(), held.texels.clone()],
            None => {
                let Texels { table, texels } = Texels::new(scene.textures())?;
                [
                    Uploaded::new(device, "traced.texture_table", &table, WORDS, textures_key)?,
                    Uploaded::new(device, "traced.texels", &texels, HALVES, textures_key)?,
                ]
            }
        };
        let sobol = match held {
            Some(held) => held.sobol.clone(),
            None => Uploaded::new(device, "traced.sobol", &sobol_points(), WORDS, hash_of(&"sobol"))?,
        };
        let all = scene.materials();
        let materials: Vec<types::Material> = all.iter().map(material_record).collect();
        let media: Vec<[f32; 4]> = all.iter().map(Material::medium).collect();
        let number = |texture: TextureRef| u32::try_from(texture.texture.0).unwrap_or(0);
        let uses: Vec<types::MaterialTextures> = all.iter().map(|material| texture_uses(material, number)).collect();
        Ok(Looks {
            key,
            materials: Uploaded::new(device, "traced.materials", &materials, WORDS, key)?,
            media: Uploaded::new(device, "traced.media", &media, FLOATS, key)?,
            uses: Uploaded::new(device, "traced.material_textures", &uses, WORDS, key)?,
            table,
            texels,
            sobol,
            cutouts: all.iter().map(|material| cutout(material, scene.textures(), facts.vertex_colors)).collect(),
            texture_kinds: all.iter().fold(0, |kinds, material| kinds | texture_kinds(material)),
            diffuse_sides: all.iter().map(diffuse_sides).collect(),
            greatest_albedo: all.iter().map(reflected).fold(0.0, f64::max),
        })
    }

    pub(super) fn bytes(&self) -> u64 {
        let all = [&self.materials, &self.media, &self.uses, &self.table, &self.texels, &self.sobol];
        all.iter().map(|list| list.bytes()).sum()
    }
}

/// Whether it has a diffuse lobe anywhere.
pub(crate) fn is_diffuse(material: &Material) -> bool {
    diffuse_sides(material) > 0
}

fn diffuse_sides(material: &Material) -> u32 {
    match (reflected(material) > 0.0, material.double_sided) {
        (false, _) => 0,
        (true, false) => 1,
        (true, true) => 2,
    }
}

/// The most that a material with a diffuse lobe reflects of light anywhere, in the brightest channel: textures may be white, and leave metal or glass out. Its specular
/// layer reflects what it keeps from that lobe.
fn reflected(material: &Material) -> f64 {
    let [red, green, blue, _] = material.base_color;
    let least = |factor: f32, textured: bool| if textured { 0.0 } else { factor };
    let metallic = least(material.metallic, material.metallic_roughness_texture.is_some());
    let transmission = least(material.transmission, material.transmission_texture.is_some());
    let lobe = (1.0 - metallic) * (1.0 - transmission) * if material.unlit { 0.0 } else { 1.0 };
    let diffuse = f64::from(red.max(green).max(blue) * lobe).clamp(0.0, 1.0);
    let layer = if has_specular_lobe(material) { MEAN_FRESNEL } else { 0.0 };
    if diffuse > 0.0 { diffuse + layer * (1.0 - diffuse) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::TextureId;

    /// glTF's factors are 1 by default where textures decide.
    #[test]
    fn textures_may_leave_metal_and_glass_out() {
        let texture = Some(TextureRef::new(TextureId(0)));
        let metal = Material { metallic: 1.0, ..Material::default() };
        let glass = Material { transmission: 1.0, double_sided: true, ..Material::default() };
        assert_eq!([&metal, &glass].map(diffuse_sides), [0, 0]);
        let metal = Material { metallic_roughness_texture: texture, ..metal };
        let glass = Material { transmission_texture: texture, ..glass };
        assert_eq!([&metal, &glass].map(diffuse_sides), [1, 2]);
        assert!(reflected(&metal) > 0.99 && diffuse_sides(&Material { unlit: true, ..metal }) == 0);
    }
}
