//! The materials of a scene on the device, and what alpha leaves of their surfaces.

use std::sync::Arc;

use super::sent_list::SentList;
use super::textures::{MaterialTextureSets, TextureArrays, slots_of};
use crate::scene::{Alpha, Cutout, Material, Primitive, Scene, cutout};
use crate::shaders::types;
use crate::vulkan::{Buffer, Device, MaterialSets, Pipelines, VulkanError};

/// Whether alpha may cut a primitive out point by point.
pub(super) fn is_cut(of_material: Cutout, masked: bool, primitive: &Primitive) -> bool {
    of_material == Cutout::PerPoint || masked && primitive.colors.is_some()
}

/// The materials, how they read textures, the textures, and a set of bindings for each material.
pub(crate) struct MaterialData {
    records: SentList<types::Material>,
    uses: SentList<types::MaterialTextures>,
    textures: Option<MaterialTextureSets>,
    /// What alpha leaves of the surfaces of each where no vertex colours are.
    pub(super) cutouts: Vec<Cutout>,
    /// Bytes of textures that were sent so far.
    sent_texels: u64,
}

impl MaterialData {
    pub(super) fn upload(
        device: &Arc<Device>,
        pipelines: &Pipelines,
        scene: &Scene,
    ) -> Result<MaterialData, VulkanError> {
        let mut data = MaterialData {
            records: SentList::new(device, "scene.materials", Vec::new())?,
            uses: SentList::new(device, "scene.material_textures", Vec::new())?,
            textures: None,
            cutouts: Vec::new(),
            sent_texels: 0,
        };
        data.update(device, pipelines, scene)?;
        Ok(data)
    }

    /// Sends the materials that changed, and textures that are new.
    pub(super) fn update(
        &mut self,
        device: &Arc<Device>,
        pipelines: &Pipelines,
        scene: &Scene,
    ) -> Result<(), VulkanError> {
        let materials = scene.materials();
        self.records.update(device, materials.iter().map(material_record).collect())?;
        // Vertex colours alone may cut surfaces out: the programs that do so bind textures too.
        let reads = !scene.textures().is_empty() || materials.iter().any(|material| material.alpha != Alpha::Opaque);
        let mut uses = Vec::new();
        let held = self.textures.take();
        if reads {
            let (arrays, sent) = TextureArrays::upload(device, scene, held.as_ref())?;
            self.sent_texels += sent;
            uses.extend(materials.iter().map(|material| arrays.uses_of(material)));
            self.textures = Some(MaterialTextureSets::new(device, pipelines, scene, arrays)?);
        }
        self.uses.update(device, uses)?;
        self.cutouts = materials.iter().map(|material| cutout(material, scene.textures(), false)).collect();
        Ok(())
    }

    /// A record for each material.
    pub(super) fn records(&self) -> &Arc<Buffer> {
        &self.records.buffer
    }

    /// How each reads its textures, where any does.
    pub(super) fn uses(&self) -> &Arc<Buffer> {
        &self.uses.buffer
    }

    /// A set of bindings for each, where any reads textures.
    pub(super) fn sets(&self) -> Option<&Arc<MaterialSets>> {
        self.textures.as_ref().map(|textures| &textures.sets)
    }

    /// Bytes that were sent to the device so far.
    pub(super) fn sent(&self) -> u64 {
        self.records.sent + self.uses.sent + self.sent_texels
    }

    /// Device memory, bytes.
    pub(super) fn bytes(&self) -> u64 {
        let textures = self.textures.as_ref().map_or(0, MaterialTextureSets::bytes);
        self.records.buffer.bytes() + self.uses.buffer.bytes() + textures
    }
}

pub(crate) fn material_record(material: &Material) -> types::Material {
    types::Material {
        base_color: material.base_color,
        emissive: if material.unlit { [0.0; 3] } else { material.emissive },
        metallic: material.metallic,
        specular_color: material.specular_color,
        specular: material.specular,
        roughness: material.roughness,
        ior: material.ior,
        transmission: material.transmission,
        normal_scale: material.normal_scale,
        alpha_cutoff: match material.alpha {
            Alpha::Opaque => -1.0,
            Alpha::Mask { cutoff } => cutoff,
        },
        flags: u32::from(material.double_sided) | u32::from(material.unlit) << 1 | texture_kinds(material),
        medium: packed_medium(material),
    }
}

/// As `medium_of` of glsl/lib/scene.glsl takes it apart.
fn packed_medium(material: &Material) -> [u32; 2] {
    let [red, green, blue, closed] = material.medium();
    let [red, green, blue] = [red, green, blue].map(|absorption| absorption.to_bits() >> 10 & 0x1F_FFFF);
    [red | green << 21, green >> 11 | blue << 10 | u32::from(closed > 0.0) << 31]
}

/// The bits of glsl/lib/scene.glsl.
pub(crate) fn texture_kinds(material: &Material) -> u32 {
    (2..).zip(slots_of(material)).filter(|(_, texture)| texture.is_some()).map(|(bit, _)| 1 << bit).sum()
}
