//! Materials and textures: glTF 2.0's metallic-roughness model with the extensions that irradia supports.

use super::TextureId;

/// How a surface scatters, transmits and emits light. Factors multiply their textures.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the file; empty if it has none.
    pub name: String,
    /// Linear RGB reflectance and opacity, 0 to 1.
    pub base_color: [f32; 4],
    /// 0 dielectric to 1 metal.
    pub metallic: f32,
    /// 0 mirror to 1; GGX alpha is its square.
    pub roughness: f32,
    /// Emitted radiance in W/(m² sr), linear RGB; KHR_materials_emissive_strength is multiplied in.
    pub emissive: [f32; 3],
    /// Index of refraction, at least 1; or 0, which means a Fresnel reflectance of 1 (KHR_materials_ior).
    pub ior: f32,
    /// Strength of the dielectric's specular lobe, 0 to 1 (KHR_materials_specular).
    pub specular: f32,
    /// Colour of the dielectric's reflectance at normal incidence, linear RGB, at least 0 (KHR_materials_specular).
    pub specular_color: [f32; 3],
    /// Share of the non-metallic base that transmits rather than scatters, 0 to 1 (KHR_materials_transmission).
    pub transmission: f32,
    /// Above 0 the surface is the border of a closed solid and refracts; 0 is a thin wall (KHR_materials_volume). Metres.
    pub thickness: f32,
    /// Distance in metres after which light inside has become `attenuation_color`; infinite without absorption.
    pub attenuation_distance: f32,
    /// See `attenuation_distance`; linear RGB, 0 to 1.
    pub attenuation_color: [f32; 3],
    /// Factor on the x and y of the normal texture.
    pub normal_scale: f32,
    /// What the base colour's alpha means.
    pub alpha: Alpha,
    /// Whether the back face is shaded, and emits, as the front face does.
    pub double_sided: bool,
    /// The base colour is shown as it is and scatters nothing; such a surface lights nothing either (KHR_materials_unlit).
    pub unlit: bool,
    /// sRGB colour and linear alpha.
    pub base_color_texture: Option<TextureRef>,
    /// Roughness in G, metallic in B.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Tangent-space normals.
    pub normal_texture: Option<TextureRef>,
    /// sRGB.
    pub emissive_texture: Option<TextureRef>,
    /// Transmission in R.
    pub transmission_texture: Option<TextureRef>,
    /// Specular strength in A.
    pub specular_texture: Option<TextureRef>,
    /// sRGB.
    pub specular_color_texture: Option<TextureRef>,
}

impl Default for Material {
    /// glTF's default material, except that it is not metallic: white, rough, dielectric of ior 1.5.
    fn default() -> Self {
        Material {
            name: String::new(),
            base_color: [1.0; 4],
            metallic: 0.0,
            roughness: 1.0,
            emissive: [0.0; 3],
            ior: 1.5,
            specular: 1.0,
            specular_color: [1.0; 3],
            transmission: 0.0,
            thickness: 0.0,
            attenuation_distance: f32::INFINITY,
            attenuation_color: [1.0; 3],
            normal_scale: 1.0,
            alpha: Alpha::Opaque,
            double_sided: false,
            unlit: false,
            base_color_texture: None,
            metallic_roughness_texture: None,
            normal_texture: None,
            emissive_texture: None,
            transmission_texture: None,
            specular_texture: None,
            specular_color_texture: None,
        }
    }
}

impl Material {
    /// Whether the surface sends light of its own into the scene. Unlit surfaces do not.
    pub fn emits(&self) -> bool {
        !self.unlit && self.emissive.iter().any(|&channel| channel > 0.0)
    }

    /// Absorption in 1/m, and 1 where the surface bounds a medium (KHR_materials_volume: x = −ln(color)/distance).
    pub(crate) fn medium(&self) -> [f32; 4] {
        let bounds_medium = self.transmission > 0.0 && self.thickness > 0.0;
        if !bounds_medium {
            return [0.0; 4];
        }
        // An opaque medium absorbs within a thousandth of its distance.
        let absorption = |color: f32| {
            (-color.max(1e-30).ln() / self.attenuation_distance).min(1e3 / self.attenuation_distance).max(0.0)
        };
        let [red, green, blue] = self.attenuation_color.map(absorption);
        [red, green, blue, 1.0]
    }

    /// Says which number is out of the range that its field describes so far that shading would break.
    pub(super) fn fault(&self) -> Option<String> {
        let numbers = [
            ("base colour", &self.base_color[..]),
            ("metallic factor", &[self.metallic]),
            ("roughness", &[self.roughness]),
            ("emitted radiance", &self.emissive),
            ("index of refraction", &[self.ior]),
            ("specular factor", &[self.specular]),
            ("specular colour", &self.specular_color),
            ("transmission", &[self.transmission]),
            ("thickness", &[self.thickness]),
            ("attenuation colour", &self.attenuation_color),
        ];
        if let Some((what, _)) =
            numbers.iter().find(|(_, values)| !values.iter().all(|value| value.is_finite() && *value >= 0.0))
        {
            return Some(format!("its {what} is negative or not finite"));
        }
        if !self.normal_scale.is_finite() || self.attenuation_distance.is_nan() || self.attenuation_distance <= 0.0 {
            return Some("its normal scale is not finite or its attenuation distance is not above 0".into());
        }
        let set = self.textures().map(|texture| texture.texcoord).find(|&set| set > 1);
        set.map(|set| format!("it uses texture coordinate set {set}; there are only 0 and 1"))
    }

    /// Every texture that is used, base colour first.
    pub fn textures(&self) -> impl Iterator<Item = TextureRef> {
        [
            self.base_color_texture,
            self.metallic_roughness_texture,
            self.normal_texture,
            self.emissive_texture,
            self.transmission_texture,
            self.specular_texture,
            self.specular_color_texture,
        ]
        .into_iter()
        .flatten()
    }
}

/// What the base colour's alpha means.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Alpha {
    /// Nothing.
    Opaque,
    /// The surface is there where alpha is at least `cutoff`. glTF's BLEND is loaded as a cutoff of 0.5.
    Mask {
        /// 0 to 1.
        cutoff: f32,
    },
}

/// One use of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureRef {
    /// The texture.
    pub texture: TextureId,
    /// Texture coordinate set, 0 or 1.
    pub texcoord: u32,
    /// Row-major 2×3 affine map applied to the texture coordinates (KHR_texture_transform): u' is the first row times (u, v, 1).
    pub transform: [[f32; 3]; 2],
}

impl TextureRef {
    /// The texture as it is, on coordinate set 0.
    pub fn new(texture: TextureId) -> Self {
        TextureRef { texture, texcoord: 0, transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] }
    }

    /// Texture coordinates after the transform.
    pub fn apply(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        self.transform.map(|[a, b, c]| a * u + b * v + c)
    }
}

/// Decoded texels and how to sample them.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Name of the texture or of its image; empty if they have none.
    pub name: String,
    /// Texels in a row, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// `width · height · 4` bytes, top row first. Grey and 16-bit images are converted.
    pub rgba8: Vec<u8>,
    /// What happens outside 0 to 1, along u and v.
    pub wrap: [Wrap; 2],
    /// Whether magnified texels stay squares.
    pub nearest: bool,
    /// Whether RGB is sRGB-encoded; it follows from the texture's use. Alpha is always linear.
    pub srgb: bool,
}

impl Texture {
    /// The texel nearest to (u, v), wrapped, as linear RGBA.
    pub fn texel(&self, [u, v]: [f32; 2]) -> [f32; 4] {
        let column = self.wrap[0].texel(u, self.width);
        let row = self.wrap[1].texel(v, self.height);
        let at = (row as usize * self.width as usize + column as usize) * 4;
        let [r, g, b, a] = std::array::from_fn(|channel| f32::from(self.rgba8[at + channel]) / 255.0);
        if self.srgb { [srgb_to_linear(r), srgb_to_linear(g), srgb_to_linear(b), a] } else { [r, g, b, a] }
    }
}

/// What a texture shows outside its borders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Wrap {
    /// Starts again.
    #[default]
    Repeat,
    /// Turns back.
    Mirror,
    /// Its border.
    Clamp,
}

impl Wrap {
    fn texel(self, coordinate: f32, size: u32) -> u32 {
        let wrapped = match self {
            Wrap::Repeat => coordinate.rem_euclid(1.0),
            Wrap::Mirror => 1.0 - (coordinate.rem_euclid(2.0) - 1.0).abs(),
            Wrap::Clamp => coordinate.clamp(0.0, 1.0),
        };
        // A coordinate that is not a number becomes 0 in the conversion.
        ((wrapped * size as f32) as u32).min(size - 1)
    }
}

/// IEC 61966-2-1.
pub(super) fn srgb_to_linear(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}
