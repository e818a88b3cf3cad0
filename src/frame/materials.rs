//! The materials of a scene on the device, and what alpha leaves of their surfaces.

use std::sync::Arc;

use ash::vk;

use super::textures::{MaterialTextureSets, TextureArrays, slots_of};
use crate::scene::{Alpha, Cutout, Material, Primitive, Scene, cutout};
use crate::shaders::types;
use crate::vulkan::{Buffer, Device, Pipelines, VulkanError, buffer_with};

/// What alpha leaves of each material where no vertex colours are.
pub(super) fn cutouts_of(scene: &Scene) -> Vec<Cutout> {
    scene.materials().iter().map(|material| cutout(material, scene.textures(), false)).collect()
}

/// Whether alpha may cut a primitive out point by point.
pub(super) fn is_cut(of_material: Cutout, masked: bool, primitive: &Primitive) -> bool {
    of_material == Cutout::PerPoint || masked && primitive.colors.is_some()
}

/// The list of materials, that of how they read textures, and a set of bindings for each.
type Materials = (Arc<Buffer>, Arc<Buffer>, Option<MaterialTextureSets>);

pub(super) fn upload_materials(
    device: &Arc<Device>,
    pipelines: &Pipelines,
    scene: &Scene,
) -> Result<Materials, VulkanError> {
    let usage = vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER;
    let records: Vec<types::Material> = scene.materials().iter().map(material_record).collect();
    let materials = buffer_with(device, "scene.materials", bytemuck::cast_slice(&records), usage)?;
    // Vertex colours alone may cut surfaces out: the programs that do so bind textures too.
    let reads =
        !scene.textures().is_empty() || scene.materials().iter().any(|material| material.alpha != Alpha::Opaque);
    let (uses, sets) = if reads {
        let arrays = TextureArrays::upload(device, scene)?;
        let uses: Vec<types::MaterialTextures> =
            scene.materials().iter().map(|material| arrays.uses_of(material)).collect();
        (uses, Some(MaterialTextureSets::new(device, pipelines, scene, arrays)?))
    } else {
        (Vec::new(), None)
    };
    Ok((materials, buffer_with(device, "scene.material_textures", bytemuck::cast_slice(&uses), usage)?, sets))
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
