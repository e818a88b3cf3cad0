//! A hash of all that decides what a scene looks like, and of nothing else: two scenes with the same hash give the same
//! pictures. Names, what no node places, and how the scene came to be as it is are left out.
//!
//! Every struct is taken apart field by field, so that a new field does not compile until somebody decides about it.

use glam::DVec3;
use rayon::prelude::*;

use super::digest::Digest;
use super::world::Content;
use super::{Alpha, Instance, LightKind, Material, Mesh, PlacedLight, Primitive, Scene, Texture, TextureRef, Wrap};

impl Scene {
    /// A hash of what the scene shows as it is now: meshes, where they stand, materials, textures, placed lights, sky. The
    /// same on every machine. Cameras do not count.
    pub fn content_hash(&self) -> [u8; 32] {
        let Content { meshes, materials, textures, instances, lights, sky } = self.content();
        let primitives: Vec<[u8; 32]> =
            meshes.par_iter().flat_map_iter(|Mesh { name: _, primitives }| primitives.iter().map(primitive)).collect();
        let textures: Vec<[u8; 32]> = textures.par_iter().map(texture).collect();

        let mut digest = Digest::new("scene");
        digest.bytes(primitives.as_flattened()).bytes(textures.as_flattened());
        digest.number(materials.len() as u64);
        for it in materials {
            material(&mut digest, it);
        }
        // Instances say which primitive of which mesh they place; the meshes' sizes tell where in the list that is.
        for it in meshes {
            digest.number(it.primitives.len() as u64);
        }
        digest.number(instances.len() as u64);
        for it in instances {
            instance(&mut digest, it);
        }
        digest.number(lights.len() as u64);
        for it in &lights {
            light(&mut digest, it);
        }
        digest.f32s(&sky).finish()
    }
}

fn primitive(primitive: &Primitive) -> [u8; 32] {
    let Primitive { positions, normals, tangents, texcoords, colors, indices, material, source_bytes: _ } = primitive;
    let mut digest = Digest::new("primitive");
    digest.f32s(positions.as_flattened());
    digest.option(normals.as_ref(), |digest, values| digest.f32s(values.as_flattened()));
    digest.option(tangents.as_ref(), |digest, values| digest.f32s(values.as_flattened()));
    for set in texcoords {
        digest.option(set.as_ref(), |digest, values| digest.f32s(values.as_flattened()));
    }
    digest.option(colors.as_ref(), |digest, values| digest.f32s(values.as_flattened()));
    digest.u32s(indices).number(material.0 as u64).finish()
}

fn texture(texture: &Texture) -> [u8; 32] {
    let Texture { name: _, width, height, rgba8, wrap, nearest, srgb } = texture;
    let mut digest = Digest::new("texture");
    digest.u32s(&[*width, *height]).bytes(rgba8);
    for axis in wrap {
        digest.number(match axis {
            Wrap::Repeat => 0,
            Wrap::Mirror => 1,
            Wrap::Clamp => 2,
        });
    }
    digest.flag(*nearest).flag(*srgb).finish()
}

fn material(digest: &mut Digest, material: &Material) {
    let Material {
        name: _,
        base_color,
        metallic,
        roughness,
        emissive,
        ior,
        specular,
        specular_color,
        transmission,
        thickness,
        attenuation_distance,
        attenuation_color,
        normal_scale,
        alpha,
        double_sided,
        unlit,
        base_color_texture,
        metallic_roughness_texture,
        normal_texture,
        emissive_texture,
        transmission_texture,
        specular_texture,
        specular_color_texture,
    } = material;
    digest.f32s(base_color).f32s(emissive).f32s(specular_color).f32s(attenuation_color);
    digest.f32s(&[*metallic, *roughness, *ior, *specular, *transmission]);
    digest.f32s(&[*thickness, *attenuation_distance, *normal_scale]);
    let cutoff = match alpha {
        Alpha::Opaque => None,
        Alpha::Mask { cutoff } => Some(*cutoff),
    };
    digest.option(cutoff, |digest, cutoff| digest.f32s(&[cutoff]));
    digest.flag(*double_sided).flag(*unlit);
    let uses = [
        base_color_texture,
        metallic_roughness_texture,
        normal_texture,
        emissive_texture,
        transmission_texture,
        specular_texture,
        specular_color_texture,
    ];
    for reference in uses {
        digest.option(reference.as_ref(), |digest, TextureRef { texture, texcoord, transform }| {
            digest.number(texture.0 as u64).u32s(&[*texcoord]).f32s(transform.as_flattened())
        });
    }
}

fn instance(digest: &mut Digest, instance: &Instance) {
    let Instance { node: _, mesh, primitive, world, flips_winding: _ } = instance;
    digest.number(mesh.0 as u64).number(*primitive as u64).f64s(&world.to_cols_array());
}

fn light(digest: &mut Digest, light: &PlacedLight) {
    let PlacedLight { node: _, light: _, position, direction, kind, intensity, range } = light;
    // What has no meaning for a kind of light does not count.
    match kind {
        LightKind::Point => vector(digest.number(0), position),
        LightKind::Spot { inner_angle, outer_angle } => {
            vector(digest.number(1), position);
            vector(digest, direction);
            digest.f32s(&[*inner_angle, *outer_angle]);
        }
        LightKind::Directional => vector(digest.number(2), direction),
    }
    digest.f32s(intensity);
    digest.option(*range, |digest, range| digest.f32s(&[range]));
}

fn vector(digest: &mut Digest, vector: &DVec3) {
    digest.f64s(&vector.to_array());
}
