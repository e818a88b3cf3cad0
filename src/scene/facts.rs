//! What a scene contains: the facts by which passes are skipped.

use super::{Alpha, LightKind, Material, Scene};

/// Below this roughness a specular lobe is narrow enough to make visible caustics and reflections.
const GLOSSY_ROUGHNESS: f32 = 0.5;

/// What a scene contains. Only what a node places counts. Each fact errs towards `true`: a texture counts as having every value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Facts {
    /// Some surface has a texture of any kind.
    pub textured: bool,
    /// Some surface is cut out by its alpha.
    pub alpha_masked: bool,
    /// Some surface has a normal texture and the tangents to use it.
    pub normal_mapped: bool,
    /// Some surface has a diffuse lobe: neither metal, nor wholly transmissive, nor unlit.
    pub diffuse: bool,
    /// Some surface has a specular lobe of any width: metal, or a dielectric whose specular factor and Fresnel reflectance are
    /// above 0, or transmissive. Without one, the slots `specular` and `caustics` are black.
    pub specular: bool,
    /// Some surface has a specular lobe with a roughness below 0.5, or a roughness texture: what paths from the lights of the
    /// reference are sent for.
    pub glossy: bool,
    /// Some surface has a specular lobe of a roughness of 0.5 or more, and no roughness texture.
    pub broad: bool,
    /// Some surface transmits light.
    pub transmissive: bool,
    /// Some surface emits at some point that alpha and its emissive texture leave.
    pub emissive: bool,
    /// Some mesh has vertex colours.
    pub vertex_colors: bool,
    /// Some animation moves a node.
    pub animated: bool,
    /// The sky emits.
    pub sky: bool,
    /// Placed lights without area, of all kinds.
    pub punctual_lights: usize,
    /// Those that are points.
    pub point_lights: usize,
    /// Those that are spots.
    pub spot_lights: usize,
    /// Those that are directional.
    pub directional_lights: usize,
    /// Triangles of all instances.
    pub triangles: u64,
}

impl Facts {
    /// Whether anything in the scene sends out light.
    pub fn lit(&self) -> bool {
        self.sky || self.emissive || self.punctual_lights > 0
    }
}

impl Scene {
    /// What the scene contains now.
    pub fn facts(&self) -> Facts {
        let mut facts = Facts { sky: self.sky().iter().any(|&channel| channel > 0.0), ..Facts::default() };
        for instance in self.instances() {
            let (primitive, material) = (self.primitive(instance), self.material_of(instance));
            if primitive.indices.is_empty() {
                continue;
            }
            facts.triangles += primitive.triangle_count() as u64;
            facts.vertex_colors |= primitive.colors.is_some();
            facts.normal_mapped |= material.normal_texture.is_some() && primitive.tangents.is_some();
            facts.textured |= material.textures().next().is_some();
            facts.alpha_masked |= material.alpha != Alpha::Opaque;
            facts.emissive |= !facts.emissive && self.shines(instance);
            facts.diffuse |= has_diffuse_lobe(material);
            facts.specular |= has_specular_lobe(material);
            facts.glossy |= is_glossy(material);
            facts.broad |= has_specular_lobe(material) && !is_glossy(material);
            facts.transmissive |= transmits(material);
        }
        for light in self.placed_lights().iter().filter(|light| light.intensity.iter().any(|&channel| channel > 0.0)) {
            facts.punctual_lights += 1;
            match light.kind {
                LightKind::Point => facts.point_lights += 1,
                LightKind::Spot { .. } => facts.spot_lights += 1,
                LightKind::Directional => facts.directional_lights += 1,
            }
        }
        facts.animated = self.animations().iter().any(|animation| !animation.channels.is_empty());
        facts
    }
}

fn has_diffuse_lobe(material: &Material) -> bool {
    let metal = material.metallic >= 1.0 && material.metallic_roughness_texture.is_none();
    let glass = material.transmission >= 1.0 && material.transmission_texture.is_none();
    !material.unlit && !metal && !glass
}

/// Whether the material reflects or transmits specularly anywhere.
pub(crate) fn has_specular_lobe(material: &Material) -> bool {
    let colored = material.specular_color.iter().any(|&channel| channel > 0.0);
    let dielectric = material.specular > 0.0 && material.ior != 1.0 && colored;
    !material.unlit && (material.metallic > 0.0 || dielectric || transmits(material))
}

/// Whether the material has a specular lobe anywhere that is narrow enough to make visible caustics.
pub(crate) fn is_glossy(material: &Material) -> bool {
    has_specular_lobe(material)
        && (material.roughness < GLOSSY_ROUGHNESS || material.metallic_roughness_texture.is_some())
}

fn transmits(material: &Material) -> bool {
    !material.unlit
        && material.transmission > 0.0
        && (material.metallic < 1.0 || material.metallic_roughness_texture.is_some())
}
