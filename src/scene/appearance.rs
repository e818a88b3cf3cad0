//! What points of a surface reflect by their diffuse lobe and send out by themselves, as shaders find it: textures at their finest, what alpha leaves
//! (glsl/lib/brdf.glsl, glsl/lib/hit_material.glsl).

use super::material::{Alpha, Material, Texture, TextureRef};
use super::mesh::{Instance, Primitive};
use super::world::Scene;

/// The mean of (1 − v·h)⁵ over both directions (glsl/lib/brdf.glsl).
const MEAN_HALF_FRESNEL: f32 = 0.003685;

/// A point's albedo, its radiance in W/(m² sr) on the side that emits, and its share of what is neither metal nor glass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PointLook {
    pub(crate) albedo: [f32; 3],
    pub(crate) emitted: [f32; 3],
    pub(crate) diffuse: f32,
}

/// The points of a primitive.
pub(crate) struct Appearance<'a> {
    primitive: &'a Primitive,
    material: &'a Material,
    textures: &'a [Texture],
}

impl Scene {
    /// How the points of a placed primitive look.
    pub(crate) fn appearance(&self, instance: &Instance) -> Appearance<'_> {
        let (primitive, material) = (self.primitive(instance), self.material_of(instance));
        Appearance { primitive, material, textures: self.textures() }
    }
}

impl Appearance<'_> {
    /// Whether all points look alike.
    pub(crate) fn is_even(&self) -> bool {
        self.primitive.colors.is_none() && self.material.textures().next().is_none()
    }

    /// At a point of a triangle with these weights of its vertices; `None` where alpha leaves nothing.
    pub(crate) fn at(&self, vertices: [u32; 3], weights: [f32; 3]) -> Option<PointLook> {
        let Material { base_color, metallic, transmission, specular, specular_color, emissive, ior, .. } =
            *self.material;
        let texel = |texture: Option<TextureRef>| texture.map_or([1.0; 4], |it| self.texel(it, vertices, weights));
        let (texture, color) = (texel(self.material.base_color_texture), self.vertex_color(vertices, weights));
        let base: [f32; 4] = std::array::from_fn(|channel| base_color[channel] * color[channel] * texture[channel]);
        if let Alpha::Mask { cutoff } = self.material.alpha
            && base[3] < cutoff
        {
            return None;
        }
        let metallic = metallic * texel(self.material.metallic_roughness_texture)[2];
        let transmission = transmission * texel(self.material.transmission_texture)[0];
        let specular = specular * texel(self.material.specular_texture)[3];
        let tint = texel(self.material.specular_color_texture);
        let root_f0 = (ior - 1.0) / (ior + 1.0);
        let mix = |dielectric: f32, metal: f32| dielectric + (metal - dielectric) * metallic;
        let f90 = mix(specular, 1.0);
        let layer = [0, 1, 2].map(|channel| {
            let dielectric = (root_f0 * root_f0 * specular_color[channel] * tint[channel]).min(1.0) * specular;
            let f0 = mix(dielectric, base[channel]);
            f0 + (f90 - f0) * MEAN_HALF_FRESNEL
        });
        let left = 1.0 - layer.into_iter().fold(0.0, f32::max);
        let diffuse = if self.material.unlit { 0.0 } else { ((1.0 - metallic) * (1.0 - transmission)).clamp(0.0, 1.0) };
        let lobe = diffuse * left;
        let glow = texel(self.material.emissive_texture);
        Some(PointLook {
            albedo: [0, 1, 2].map(|channel| (base[channel] * lobe).clamp(0.0, 1.0)),
            emitted: [0, 1, 2].map(|channel| emissive[channel] * glow[channel]),
            diffuse,
        })
    }

    fn texel(&self, texture: TextureRef, vertices: [u32; 3], weights: [f32; 3]) -> [f32; 4] {
        let Some(coordinates) = &self.primitive.texcoords[texture.texcoord as usize] else {
            return self.textures[texture.texture.0].sample(texture.apply([0.0; 2]));
        };
        let corners = vertices.map(|vertex| coordinates[vertex as usize]);
        let at = [0, 1].map(|axis| (0..3).map(|corner| weights[corner] * corners[corner][axis]).sum());
        self.textures[texture.texture.0].sample(texture.apply(at))
    }

    /// Eight bits a channel at the corners, as on the device.
    fn vertex_color(&self, vertices: [u32; 3], weights: [f32; 3]) -> [f32; 4] {
        let Some(colors) = &self.primitive.colors else { return [1.0; 4] };
        let corners = vertices.map(|vertex| colors[vertex as usize].map(|it| (it.clamp(0.0, 1.0) * 255.0).round()));
        [0, 1, 2, 3].map(|channel| (0..3).map(|corner| weights[corner] * corners[corner][channel]).sum::<f32>() / 255.0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{MaterialId, TextureId, Wrap};
    use super::*;

    fn primitive() -> Primitive {
        let corners = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        Primitive {
            positions: vec![[0.0; 3]; 3],
            indices: vec![0, 1, 2],
            texcoords: [Some(corners), None],
            material: MaterialId(0),
            ..Primitive::default()
        }
    }

    /// Left half black and cut away, right half white.
    fn halves() -> Texture {
        let row = [[0, 0, 0, 0], [255; 4]].concat();
        let wrap = [Wrap::Clamp; 2];
        Texture { name: String::new(), width: 2, height: 1, rgba8: row, wrap, nearest: true, srgb: true }
    }

    #[test]
    fn factors_textures_and_the_layer_above_count() {
        let plain = Material { base_color: [0.8, 0.4, 0.2, 1.0], specular: 0.0, ..Material::default() };
        let look = |material: &Material| {
            Appearance { primitive: &primitive(), material, textures: &[halves()] }.at([0, 1, 2], [0.2, 0.7, 0.1])
        };
        let albedo = |material: &Material| look(material).expect("nothing is cut away").albedo;
        assert_eq!(albedo(&plain), [0.8, 0.4, 0.2]);
        assert_eq!(albedo(&Material { transmission: 0.25, ..plain.clone() }), [0.6, 0.3, 0.15]);
        assert_eq!(albedo(&Material { unlit: true, ..plain.clone() }), [0.0; 3]);
        let layered = albedo(&Material { specular: 1.0, ..plain.clone() })[0];
        let layer = 0.04 + 0.96 * MEAN_HALF_FRESNEL;
        assert!((layered - 0.8 * (1.0 - layer)).abs() < 1e-6, "{layered}");
        let glowing = Material {
            emissive: [3.0; 3],
            emissive_texture: Some(TextureRef::new(TextureId(0))),
            base_color_texture: Some(TextureRef::new(TextureId(0))),
            ..plain.clone()
        };
        assert_eq!(look(&glowing), Some(PointLook { albedo: [0.8, 0.4, 0.2], emitted: [3.0; 3], diffuse: 1.0 }));
    }

    #[test]
    fn what_alpha_cuts_away_is_not_there() {
        let material = Material {
            alpha: Alpha::Mask { cutoff: 0.5 },
            base_color_texture: Some(TextureRef::new(TextureId(0))),
            ..Material::default()
        };
        let (primitive, textures) = (primitive(), [halves()]);
        let points = Appearance { primitive: &primitive, material: &material, textures: &textures };
        assert!(!points.is_even());
        assert_eq!(points.at([0, 1, 2], [0.9, 0.1, 0.0]), None);
        assert!(points.at([0, 1, 2], [0.2, 0.7, 0.1]).is_some());
    }
}
