//! Materials.

use std::ffi::c_char;

use super::super::border::call;
use super::super::descriptor::{boolean, descriptors, read, write};
use super::super::status::{Fault, Status};
use super::super::text::optional_text;
use super::handle::{Id, SceneHandle, add, index_of};
use crate::scene::{Alpha, Material, MaterialId, TextureId, TextureRef};

/// One use of a texture.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct TextureUse {
    /// The texture; 0: none.
    pub texture: Id,
    /// Set of texture coordinates, 0 or 1.
    pub texcoord: u32,
    /// 2×3, row after row, applied to (u, v, 1); all zero: the identity.
    pub transform: [f32; 6],
}

/// How a surface scatters, transmits and emits light, as glTF 2.0 and its KHR extensions say. Factors multiply their textures.
/// irradia_material_default() fills it with the default material, white and rough.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct MaterialDescriptor {
    /// sizeof(irradia_material_descriptor).
    pub size: usize,
    /// Null: none. Read by irradia_scene_get_material() as null: irradia_scene_name() has it.
    pub name: *const c_char,
    /// Linear red, green, blue reflectance and opacity, 0 to 1.
    pub base_color: [f32; 4],
    /// 0 dielectric to 1 metal.
    pub metallic: f32,
    /// 0 mirror to 1; GGX alpha is its square.
    pub roughness: f32,
    /// Emitted radiance, linear, W/(m² sr).
    pub emissive: [f32; 3],
    /// Index of refraction, at least 1; 0: a Fresnel reflectance of 1.
    pub ior: f32,
    /// Strength of a dielectric's specular lobe, 0 to 1.
    pub specular: f32,
    /// Colour of a dielectric's reflectance at normal incidence, linear.
    pub specular_color: [f32; 3],
    /// Share of the base that transmits rather than scatters, 0 to 1.
    pub transmission: f32,
    /// Above 0: the border of a closed solid, which refracts; 0: a thin wall. Metres.
    pub thickness: f32,
    /// Metres after which light inside has become `attenuation_color`; infinite without absorption.
    pub attenuation_distance: f32,
    /// Linear, 0 to 1.
    pub attenuation_color: [f32; 3],
    /// Factor on x and y of the normal texture.
    pub normal_scale: f32,
    /// The surface is there where alpha is at least this, 0 to 1; negative: everywhere.
    pub alpha_cutoff: f32,
    /// 1: the back is shaded, and emits, as the front is.
    pub double_sided: u32,
    /// 1: the base colour is shown as it is, scatters nothing and lights nothing.
    pub unlit: u32,
    /// Colour in sRGB, alpha linear.
    pub base_color_texture: TextureUse,
    /// Roughness in green, metallic in blue.
    pub metallic_roughness_texture: TextureUse,
    /// Normals in tangent space.
    pub normal_texture: TextureUse,
    /// sRGB.
    pub emissive_texture: TextureUse,
    /// Transmission in red.
    pub transmission_texture: TextureUse,
    /// Specular strength in alpha.
    pub specular_texture: TextureUse,
    /// sRGB.
    pub specular_color_texture: TextureUse,
}

descriptors! {
    MaterialDescriptor = "material descriptor", size_of::<MaterialDescriptor>();
}

fn texture_of(given: TextureUse) -> Option<TextureRef> {
    let index = given.texture.checked_sub(1)?;
    let [a, b, c, d, e, f] = given.transform;
    let mut texture = TextureRef::new(TextureId(index as usize));
    texture.texcoord = given.texcoord;
    if given.transform != [0.0; 6] {
        texture.transform = [[a, b, c], [d, e, f]];
    }
    Some(texture)
}

fn use_of(texture: Option<TextureRef>) -> TextureUse {
    let none = TextureUse { texture: 0, texcoord: 0, transform: [0.0; 6] };
    texture.map_or(none, |TextureRef { texture: TextureId(index), texcoord, transform: [[a, b, c], [d, e, f]] }| {
        let texture = u32::try_from(index + 1).unwrap_or(u32::MAX);
        TextureUse { texture, texcoord, transform: [a, b, c, d, e, f] }
    })
}

/// # Safety
/// `descriptor` is null, which is a fault, or a descriptor.
unsafe fn material(descriptor: *const MaterialDescriptor) -> Result<Material, Fault> {
    // SAFETY: the caller's.
    let given = unsafe { read(descriptor) }?;
    if given.alpha_cutoff.is_nan() {
        return Err(Fault::argument("the material's alpha cutoff is not a number"));
    }
    let textures = [
        given.base_color_texture,
        given.metallic_roughness_texture,
        given.normal_texture,
        given.emissive_texture,
        given.transmission_texture,
        given.specular_texture,
        given.specular_color_texture,
    ];
    if textures.iter().flat_map(|texture| texture.transform).any(|number| !number.is_finite()) {
        return Err(Fault::argument("a texture's transform has a number that is not finite"));
    }
    // SAFETY: the caller's.
    let name = unsafe { optional_text(given.name, "the material's name") }?.unwrap_or_default().to_owned();
    let [base_color, metallic_roughness, normal, emissive, transmission, specular, specular_color] =
        textures.map(texture_of);
    Ok(Material {
        name,
        base_color: given.base_color,
        metallic: given.metallic,
        roughness: given.roughness,
        emissive: given.emissive,
        ior: given.ior,
        specular: given.specular,
        specular_color: given.specular_color,
        transmission: given.transmission,
        thickness: given.thickness,
        attenuation_distance: given.attenuation_distance,
        attenuation_color: given.attenuation_color,
        normal_scale: given.normal_scale,
        alpha: if given.alpha_cutoff < 0.0 { Alpha::Opaque } else { Alpha::Mask { cutoff: given.alpha_cutoff } },
        double_sided: boolean(given.double_sided, "double_sided")?,
        unlit: boolean(given.unlit, "unlit")?,
        base_color_texture: base_color,
        metallic_roughness_texture: metallic_roughness,
        normal_texture: normal,
        emissive_texture: emissive,
        transmission_texture: transmission,
        specular_texture: specular,
        specular_color_texture: specular_color,
    })
}

fn descriptor_of(material: &Material) -> MaterialDescriptor {
    MaterialDescriptor {
        size: size_of::<MaterialDescriptor>(),
        name: std::ptr::null(),
        base_color: material.base_color,
        metallic: material.metallic,
        roughness: material.roughness,
        emissive: material.emissive,
        ior: material.ior,
        specular: material.specular,
        specular_color: material.specular_color,
        transmission: material.transmission,
        thickness: material.thickness,
        attenuation_distance: material.attenuation_distance,
        attenuation_color: material.attenuation_color,
        normal_scale: material.normal_scale,
        alpha_cutoff: match material.alpha {
            Alpha::Opaque => -1.0,
            Alpha::Mask { cutoff } => cutoff,
        },
        double_sided: u32::from(material.double_sided),
        unlit: u32::from(material.unlit),
        base_color_texture: use_of(material.base_color_texture),
        metallic_roughness_texture: use_of(material.metallic_roughness_texture),
        normal_texture: use_of(material.normal_texture),
        emissive_texture: use_of(material.emissive_texture),
        transmission_texture: use_of(material.transmission_texture),
        specular_texture: use_of(material.specular_texture),
        specular_color_texture: use_of(material.specular_color_texture),
    }
}

/// Fills a descriptor, whose size is set, with the default material: white, rough, a dielectric of index 1.5, opaque.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_material_default(descriptor: *mut MaterialDescriptor) -> Status {
    call(|_| {
        // SAFETY: the host's pointer is what the header asks for.
        unsafe { write(descriptor, &descriptor_of(&Material::default())) }
    })
}

/// Adds a material.
///
/// `id`: receives its identifier; may be null.
///
/// Errors: IRRADIA_ERROR_SCENE for numbers out of range and textures that are not there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_add_material(
    scene: *mut SceneHandle,
    descriptor: *const MaterialDescriptor,
    id: *mut Id,
) -> Status {
    // SAFETY: the host's pointers are what the header asks for.
    unsafe { add(scene, id, |state| Ok(state.scene.add_material(material(descriptor)?)?.0)) }
}

/// Fills a descriptor, whose size is set, with a material of the scene, to be changed and set again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_get_material(
    scene: *const SceneHandle,
    id: Id,
    descriptor: *mut MaterialDescriptor,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let state = unsafe { border.enter(scene) }?;
        let material = state.scene.materials().get(index_of(id, "material")?);
        let material = material.ok_or_else(|| Fault::argument(format!("the scene has no material {id}")))?;
        // SAFETY: as above.
        unsafe { write(descriptor, &descriptor_of(material)) }
    })
}

/// Replaces a material. One that stays the same costs nothing in the next frame. A name of null keeps the old one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn irradia_scene_set_material(
    scene: *mut SceneHandle,
    id: Id,
    descriptor: *const MaterialDescriptor,
) -> Status {
    call(|border| {
        // SAFETY: the host's pointers are what the header asks for.
        let (state, mut material) = unsafe { (border.enter(scene)?, material(descriptor)?) };
        let index = index_of(id, "material")?;
        if material.name.is_empty() {
            material.name = state.scene.materials().get(index).map(|old| old.name.clone()).unwrap_or_default();
        }
        Ok(state.scene.set_material(MaterialId(index), material)?)
    })
}

#[cfg(test)]
mod tests {
    use std::ffi::CString;

    use super::*;

    #[test]
    fn a_material_comes_back_as_it_was() {
        let texture = TextureRef { texture: TextureId(3), texcoord: 1, transform: [[2.0, 0.0, 0.5], [0.0, 3.0, 0.0]] };
        let mut before = Material { name: "gold".to_owned(), metallic: 1.0, ..Material::default() };
        (before.emissive_texture, before.alpha) = (Some(texture), Alpha::Mask { cutoff: 0.25 });
        let name = CString::new("gold").expect("no zero");
        let mut descriptor = descriptor_of(&before);
        descriptor.name = name.as_ptr();
        // SAFETY: a descriptor with its size and a name that is alive.
        assert_eq!(unsafe { material(&descriptor) }.expect("a material"), before);
    }
}
