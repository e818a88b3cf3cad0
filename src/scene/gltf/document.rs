//! The glTF 2.0 document: only the properties that the loader uses, in the precision in which it uses them.
//!
//! Written by hand rather than taken from a crate for three reasons. Transforms must be read in f64, or a scene 10⁶ m
//! from the origin moves by centimetres. A fault in a part that nobody uses must not stop the rest: each array element is
//! an [`Element`], whose fault is reported when, and only when, something asks for it. And vendor extensions change
//! properties that the core calls required (`KHR_animation_pointer` has targets without a node).

use serde::de::{DeserializeOwned, IgnoredAny};
use serde::{Deserialize, Deserializer};
use serde_json::Value;

/// One element of a top-level array: what it says, or why it says nothing. Boxed, so that an array of faults is small.
pub(super) struct Element<T>(Result<Box<T>, Box<str>>);

impl<'de, T: DeserializeOwned> Deserialize<'de> for Element<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = Value::deserialize(deserializer)?;
        let element = serde_json::from_value(value).map(Box::new);
        Ok(Element(element.map_err(|error| error.to_string().into())))
    }
}

/// Element `index` of a section; `kind` names the section in the fault ("mesh", "accessor").
pub(super) fn get<'a, T>(section: &'a [Element<T>], index: usize, kind: &str) -> Result<&'a T, String> {
    match section.get(index) {
        Some(Element(Ok(value))) => Ok(value),
        Some(Element(Err(fault))) => Err(format!("{kind} {index} is not valid glTF ({fault})")),
        None => {
            let count = section.len();
            Err(format!("{kind} {index} is referred to, but the file has {count} of that kind"))
        }
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    pub(super) asset: Asset,
    pub(super) scene: Option<usize>,
    #[serde(default)]
    pub(super) scenes: Vec<Element<SceneRoots>>,
    #[serde(default)]
    pub(super) nodes: Vec<Element<Node>>,
    #[serde(default)]
    pub(super) meshes: Vec<Element<Mesh>>,
    #[serde(default)]
    pub(super) accessors: Vec<Element<Accessor>>,
    #[serde(default)]
    pub(super) buffer_views: Vec<Element<BufferView>>,
    #[serde(default)]
    pub(super) buffers: Vec<Element<Buffer>>,
    #[serde(default)]
    pub(super) materials: Vec<Element<Material>>,
    #[serde(default)]
    pub(super) textures: Vec<Element<Texture>>,
    #[serde(default)]
    pub(super) images: Vec<Element<Image>>,
    #[serde(default)]
    pub(super) samplers: Vec<Element<Sampler>>,
    #[serde(default)]
    pub(super) cameras: Vec<Element<Camera>>,
    #[serde(default)]
    pub(super) animations: Vec<Element<Animation>>,
    #[serde(default)]
    pub(super) extensions_used: Vec<String>,
    #[serde(default)]
    pub(super) extensions_required: Vec<String>,
    #[serde(default)]
    extensions: Value,
}

impl Document {
    /// The lights of KHR_lights_punctual; each element is still to be read, so that one bad light spoils no other.
    pub(super) fn light(&self, index: usize) -> Result<Light, String> {
        let lights = &self.extensions["KHR_lights_punctual"]["lights"];
        let count = lights.as_array().map_or(0, Vec::len);
        let light =
            lights.get(index).ok_or(format!("light {index} is referred to, but the file has {count} lights"))?;
        Light::deserialize(light).map_err(|fault| format!("light {index} is not valid glTF ({fault})"))
    }
}

#[derive(Deserialize)]
pub(super) struct Asset {
    pub(super) version: String,
    #[serde(default)]
    pub(super) extras: Value,
}

#[derive(Deserialize)]
pub(super) struct SceneRoots {
    #[serde(default)]
    pub(super) nodes: Vec<usize>,
}

#[derive(Deserialize)]
pub(super) struct Node {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) children: Vec<usize>,
    pub(super) matrix: Option<Box<[f64; 16]>>,
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
    pub(super) mesh: Option<usize>,
    pub(super) camera: Option<usize>,
    pub(super) skin: Option<IgnoredAny>,
    #[serde(default)]
    extensions: Value,
}

impl Node {
    /// Index of the node's KHR_lights_punctual light.
    pub(super) fn light(&self) -> Option<usize> {
        let index = self.extensions["KHR_lights_punctual"]["light"].as_u64()?;
        usize::try_from(index).ok()
    }
}

#[derive(Deserialize)]
pub(super) struct Mesh {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) primitives: Vec<Element<Primitive>>,
}

#[derive(Deserialize)]
pub(super) struct Primitive {
    #[serde(default)]
    pub(super) attributes: Attributes,
    pub(super) indices: Option<usize>,
    pub(super) material: Option<usize>,
    #[serde(default = "triangles")]
    pub(super) mode: u64,
    #[serde(default)]
    pub(super) targets: Value,
}

fn triangles() -> u64 {
    4
}

#[derive(Deserialize, Default)]
pub(super) struct Attributes {
    #[serde(rename = "POSITION")]
    pub(super) positions: Option<usize>,
    #[serde(rename = "NORMAL")]
    pub(super) normals: Option<usize>,
    #[serde(rename = "TANGENT")]
    pub(super) tangents: Option<usize>,
    #[serde(rename = "TEXCOORD_0")]
    pub(super) texcoords_0: Option<usize>,
    #[serde(rename = "TEXCOORD_1")]
    pub(super) texcoords_1: Option<usize>,
    #[serde(rename = "COLOR_0")]
    pub(super) colors: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<usize>,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: u64,
    #[serde(default)]
    pub(super) normalized: bool,
    pub(super) count: u64,
    #[serde(rename = "type")]
    pub(super) shape: String,
    pub(super) sparse: Option<Sparse>,
}

#[derive(Deserialize)]
pub(super) struct Sparse {
    pub(super) count: u64,
    pub(super) indices: SparsePart,
    pub(super) values: SparsePart,
}

/// Where the indices or the values of a sparse accessor lie; `component_type` belongs to indices alone.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparsePart {
    pub(super) buffer_view: usize,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: Option<u64>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: usize,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
    pub(super) byte_stride: Option<u64>,
}

#[derive(Deserialize)]
pub(super) struct Buffer {
    pub(super) uri: Option<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) pbr_metallic_roughness: MetallicRoughness,
    pub(super) normal_texture: Option<TextureInfo>,
    pub(super) emissive_texture: Option<TextureInfo>,
    #[serde(default)]
    pub(super) emissive_factor: [f32; 3],
    pub(super) alpha_mode: Option<String>,
    pub(super) alpha_cutoff: Option<f32>,
    #[serde(default)]
    pub(super) double_sided: bool,
    #[serde(default)]
    pub(super) extensions: MaterialExtensions,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct MetallicRoughness {
    pub(super) base_color_factor: Option<[f32; 4]>,
    pub(super) base_color_texture: Option<TextureInfo>,
    pub(super) metallic_factor: Option<f32>,
    pub(super) roughness_factor: Option<f32>,
    pub(super) metallic_roughness_texture: Option<TextureInfo>,
}

#[derive(Deserialize, Default)]
pub(super) struct MaterialExtensions {
    #[serde(rename = "KHR_materials_emissive_strength", default)]
    pub(super) emissive_strength: EmissiveStrength,
    #[serde(rename = "KHR_materials_ior", default)]
    pub(super) ior: Ior,
    #[serde(rename = "KHR_materials_specular", default)]
    pub(super) specular: Specular,
    #[serde(rename = "KHR_materials_transmission", default)]
    pub(super) transmission: Transmission,
    #[serde(rename = "KHR_materials_volume", default)]
    pub(super) volume: Volume,
    #[serde(rename = "KHR_materials_unlit")]
    pub(super) unlit: Option<Value>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct EmissiveStrength {
    pub(super) emissive_strength: Option<f32>,
}

#[derive(Deserialize, Default)]
pub(super) struct Ior {
    pub(super) ior: Option<f32>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct Specular {
    pub(super) specular_factor: Option<f32>,
    pub(super) specular_color_factor: Option<[f32; 3]>,
    pub(super) specular_texture: Option<TextureInfo>,
    pub(super) specular_color_texture: Option<TextureInfo>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct Transmission {
    pub(super) transmission_factor: Option<f32>,
    pub(super) transmission_texture: Option<TextureInfo>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct Volume {
    pub(super) thickness_factor: Option<f32>,
    pub(super) attenuation_distance: Option<f32>,
    pub(super) attenuation_color: Option<[f32; 3]>,
}

/// A material's use of a texture; `scale` belongs to normal textures alone.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureInfo {
    pub(super) index: usize,
    #[serde(default)]
    pub(super) tex_coord: u32,
    pub(super) scale: Option<f32>,
    #[serde(default)]
    pub(super) extensions: TextureInfoExtensions,
}

#[derive(Deserialize, Default)]
pub(super) struct TextureInfoExtensions {
    #[serde(rename = "KHR_texture_transform")]
    pub(super) transform: Option<TextureTransform>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextureTransform {
    #[serde(default)]
    pub(super) offset: [f32; 2],
    #[serde(default)]
    pub(super) rotation: f32,
    pub(super) scale: Option<[f32; 2]>,
    pub(super) tex_coord: Option<u32>,
}

#[derive(Deserialize)]
pub(super) struct Texture {
    pub(super) name: Option<String>,
    pub(super) source: Option<usize>,
    pub(super) sampler: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Image {
    pub(super) name: Option<String>,
    pub(super) uri: Option<String>,
    pub(super) buffer_view: Option<usize>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct Sampler {
    pub(super) mag_filter: Option<u64>,
    pub(super) wrap_s: Option<u64>,
    pub(super) wrap_t: Option<u64>,
}

#[derive(Deserialize)]
pub(super) struct Camera {
    pub(super) name: Option<String>,
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) perspective: Option<Perspective>,
    pub(super) orthographic: Option<Orthographic>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Perspective {
    pub(super) aspect_ratio: Option<f64>,
    pub(super) yfov: f64,
    pub(super) znear: f64,
}

#[derive(Deserialize)]
pub(super) struct Orthographic {
    pub(super) xmag: f64,
    pub(super) ymag: f64,
    pub(super) znear: f64,
    pub(super) zfar: f64,
}

#[derive(Deserialize)]
pub(super) struct Light {
    pub(super) name: Option<String>,
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) color: Option<[f32; 3]>,
    pub(super) intensity: Option<f32>,
    pub(super) range: Option<f32>,
    pub(super) spot: Option<SpotCone>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SpotCone {
    pub(super) inner_cone_angle: Option<f32>,
    pub(super) outer_cone_angle: Option<f32>,
}

#[derive(Deserialize)]
pub(super) struct Animation {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) channels: Vec<Element<Channel>>,
    #[serde(default)]
    pub(super) samplers: Vec<Element<AnimationSampler>>,
}

#[derive(Deserialize)]
pub(super) struct Channel {
    pub(super) sampler: usize,
    pub(super) target: Target,
}

#[derive(Deserialize)]
pub(super) struct Target {
    pub(super) node: Option<usize>,
    pub(super) path: String,
    #[serde(default)]
    extensions: Value,
}

impl Target {
    /// What KHR_animation_pointer points to.
    pub(super) fn pointer(&self) -> Option<&str> {
        self.extensions["KHR_animation_pointer"]["pointer"].as_str()
    }
}

#[derive(Deserialize)]
pub(super) struct AnimationSampler {
    pub(super) input: usize,
    pub(super) output: usize,
    pub(super) interpolation: Option<String>,
}
