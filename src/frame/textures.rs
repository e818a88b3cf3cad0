//! Textures without bindless descriptors: images of one size and encoding share a 2D array, a material's set binds the
//! arrays that its textures lie in, and its record says which layers. Compute passes can bind the few arrays themselves.

use std::collections::BTreeMap;
use std::sync::Arc;

use ash::vk;

use crate::graph::bindings::BindingSet;
use crate::scene::{Material, Scene, Texture, TextureRef, Wrap};
use crate::shaders::{gbuffer, types};
use crate::vulkan::program::{BindingKind, ImageDim};
use crate::vulkan::{
    Descriptor, Device, Image, ImageInfo, MaterialSets, Pipelines, SamplerKind, SubresourceView, VulkanError,
    image_with,
};

/// Where a texture lies.
#[derive(Clone, Copy)]
struct Layer {
    array: usize,
    layer: u32,
}

/// Textures of one size and encoding.
struct TextureArray {
    /// Width, height, sRGB.
    kind: (u32, u32, bool),
    /// Of the scene's textures, those in its layers. They never change; more may come.
    members: Vec<usize>,
    image: Arc<Image>,
}

/// All textures of a scene.
pub(crate) struct TextureArrays {
    arrays: Vec<TextureArray>,
    /// What a material without a texture of some kind binds in its place.
    none: Arc<Image>,
    layers: Vec<Layer>,
}

impl TextureArrays {
    /// The textures of a scene, with those arrays of `held`, of the same scene, that have no more of them than before; and the bytes of all others.
    pub(super) fn upload(
        device: &Arc<Device>,
        scene: &Scene,
        held: Option<&MaterialTextureSets>,
    ) -> Result<(TextureArrays, u64), VulkanError> {
        let held = held.map(|held| &held.textures);
        let mut groups: BTreeMap<(u32, u32, bool), Vec<usize>> = BTreeMap::new();
        for (index, texture) in scene.textures().iter().enumerate() {
            groups.entry((texture.width, texture.height, texture.srgb)).or_default().push(index);
        }
        let mut sent = 0;
        let mut array = |name: &str, (width, height, srgb), texels: &[&[u8]]| {
            let image = image_with(device, name, array_info(width, height, srgb, texels.len()), texels)?;
            sent += image.bytes();
            Ok::<_, VulkanError>(image)
        };
        let none = match held {
            Some(held) => held.none.clone(),
            None => array("scene.textures.none", (1, 1, false), &[&[255; 4]])?,
        };
        let mut made = TextureArrays {
            arrays: Vec::new(),
            none,
            layers: vec![Layer { array: 0, layer: 0 }; scene.textures().len()],
        };
        let most = device.limits().max_image_array_layers as usize;
        for (kind, members) in groups {
            for members in members.chunks(most) {
                for (layer, &member) in (0..).zip(members) {
                    made.layers[member] = Layer { array: made.arrays.len(), layer };
                }
                let alike = |array: &&TextureArray| array.kind == kind && array.members == members;
                let held = held.and_then(|held| held.arrays.iter().find(alike));
                let image = match held {
                    Some(held) => held.image.clone(),
                    None => {
                        let texels: Vec<&[u8]> =
                            members.iter().map(|&member| scene.textures()[member].rgba8.as_slice()).collect();
                        let (width, height, srgb) = kind;
                        let name = format!("scene.textures.{width}x{height}{}", if srgb { ".srgb" } else { "" });
                        array(&name, kind, &texels)?
                    }
                };
                made.arrays.push(TextureArray { kind, members: members.to_vec(), image });
            }
        }
        Ok((made, sent))
    }

    /// How `material` reads its textures.
    pub(super) fn uses_of(&self, material: &Material) -> types::MaterialTextures {
        texture_uses(material, |texture| self.layers[texture.texture.0].layer)
    }
}

/// How `material` reads its textures, of which `layer` says where they lie.
pub(crate) fn texture_uses(material: &Material, layer: impl Fn(TextureRef) -> u32) -> types::MaterialTextures {
    let identity = types::TextureUse { u_row: [1.0, 0.0, 0.0], v_row: [0.0, 1.0, 0.0], layer: 0, texcoord: 0 };
    let read = |texture: Option<TextureRef>| {
        texture.map_or(identity, |texture| types::TextureUse {
            u_row: texture.transform[0],
            v_row: texture.transform[1],
            layer: layer(texture),
            texcoord: texture.texcoord,
        })
    };
    types::MaterialTextures {
        base_color: read(material.base_color_texture),
        metallic_roughness: read(material.metallic_roughness_texture),
        normal: read(material.normal_texture),
        emissive: read(material.emissive_texture),
        specular: read(material.specular_texture),
        specular_color: read(material.specular_color_texture),
        transmission: read(material.transmission_texture),
    }
}

fn array_info(width: u32, height: u32, srgb: bool, layers: usize) -> ImageInfo {
    ImageInfo {
        format: if srgb { vk::Format::R8G8B8A8_SRGB } else { vk::Format::R8G8B8A8_UNORM },
        extent: [width, height, 1],
        mips: 32 - width.max(height).leading_zeros(),
        layers: u32::try_from(layers).unwrap_or(u32::MAX),
        volume: false,
    }
}

/// A descriptor set for each material of a scene that has textures.
pub(crate) struct MaterialTextureSets {
    pub(crate) sets: Arc<MaterialSets>,
    textures: TextureArrays,
}

impl MaterialTextureSets {
    pub(super) fn new(
        device: &Arc<Device>,
        pipelines: &Pipelines,
        scene: &Scene,
        textures: TextureArrays,
    ) -> Result<MaterialTextureSets, VulkanError> {
        let descriptor = |texture: Option<TextureRef>| -> Result<Descriptor, VulkanError> {
            let place = texture.map(|texture| textures.layers[texture.texture.0].array);
            let kind = texture
                .map(|texture| sampler_of(&scene.textures()[texture.texture.0]))
                .unwrap_or(SamplerKind::NearestClamp);
            let image = place.map_or(&textures.none, |place| &textures.arrays[place].image);
            let what = SubresourceView {
                dim: ImageDim::D2Array,
                mips: 0..image.info.mips,
                layers: 0..image.info.layers,
                aspect: vk::ImageAspectFlags::COLOR,
                format: image.info.format,
            };
            Ok(Descriptor::Image {
                view: image.view(&what)?,
                layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
                sampler: pipelines.sampler(kind)?,
            })
        };
        let mut sets = Vec::new();
        for material in scene.materials() {
            let kind = BindingKind::SampledImage(ImageDim::D2Array);
            let set = (0..).zip(slots_of(material)).map(|(binding, texture)| Ok((binding, kind, descriptor(texture)?)));
            sets.push(set.collect::<Result<Vec<_>, VulkanError>>()?);
        }
        // Every program that reads textures declares the same set.
        let layout = pipelines.set_layout(<gbuffer::Textured as BindingSet>::PROGRAM, 1)?;
        Ok(MaterialTextureSets { sets: Arc::new(MaterialSets::new(device, layout, &sets)?), textures })
    }

    pub(super) fn bytes(&self) -> u64 {
        let arrays = self.textures.arrays.iter().map(|array| array.image.bytes());
        arrays.sum::<u64>() + self.textures.none.bytes()
    }
}

/// A material's textures in the order in which shaders bind and number them (glsl/geometry/material_textures.glsl).
pub(crate) fn slots_of(material: &Material) -> [Option<TextureRef>; 7] {
    [
        material.base_color_texture,
        material.metallic_roughness_texture,
        material.normal_texture,
        material.emissive_texture,
        material.specular_texture,
        material.specular_color_texture,
        material.transmission_texture,
    ]
}

fn sampler_of(texture: &Texture) -> SamplerKind {
    let wrap = texture.wrap.map(|wrap| match wrap {
        Wrap::Repeat => vk::SamplerAddressMode::REPEAT,
        Wrap::Mirror => vk::SamplerAddressMode::MIRRORED_REPEAT,
        Wrap::Clamp => vk::SamplerAddressMode::CLAMP_TO_EDGE,
    });
    SamplerKind::Texture { wrap, nearest: texture.nearest }
}
