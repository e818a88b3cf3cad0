//! Adding things to a scene and changing them. What contradicts itself, or refers to what is not there, is refused, so that
//! the rest of the engine need not check again.

use super::camera::Camera;
use super::light::{Light, LightSpec};
use super::material::{Material, Texture};
use super::world::{Node, Scene};
use super::{CameraId, LightId, MaterialId, SceneError, TextureId};
use glam::{DAffine3, DMat3, DVec3};

impl Scene {
    /// Adds a texture.
    ///
    /// # Errors
    /// [`SceneError::InvalidObject`] if the texels do not fill its size.
    pub fn add_texture(&mut self, texture: Texture) -> Result<TextureId, SceneError> {
        let texels = u64::from(texture.width) * u64::from(texture.height);
        if texels == 0 || texels * 4 != texture.rgba8.len() as u64 {
            let fault =
                format!("{}×{} texels do not fit its {} bytes", texture.width, texture.height, texture.rgba8.len());
            return Err(self.invalid("texture", &texture.name, fault));
        }
        self.revisions.materials += 1;
        self.revisions.textures += 1;
        self.textures.push(texture);
        Ok(TextureId(self.textures.len() - 1))
    }

    /// Adds a material.
    ///
    /// # Errors
    /// [`SceneError::UnknownId`] if it uses a texture that does not exist, [`SceneError::InvalidObject`] if a number is not
    /// finite (but for the attenuation distance) or a texture coordinate set is neither 0 nor 1.
    pub fn add_material(&mut self, material: Material) -> Result<MaterialId, SceneError> {
        self.check_material(&material)?;
        self.revisions.materials += 1;
        self.materials.push(material);
        Ok(MaterialId(self.materials.len() - 1))
    }

    /// Replaces a material. Counts as a change of the lights too if it emits or emitted.
    ///
    /// # Errors
    /// As [`Scene::add_material`]; [`SceneError::UnknownId`].
    pub fn set_material(&mut self, id: MaterialId, material: Material) -> Result<(), SceneError> {
        self.check("material", id.0, self.materials.len())?;
        self.check_material(&material)?;
        let old = std::mem::replace(&mut self.materials[id.0], material);
        let new = &self.materials[id.0];
        if old != *new {
            self.revisions.materials += 1;
            self.revisions.lights += u64::from(old.emits() || new.emits());
            let primitives = self.meshes.iter().flat_map(|mesh| &mesh.primitives);
            for (primitive, emission) in primitives.zip(self.emissions.iter_mut().flatten()) {
                if primitive.material == id {
                    emission.take();
                }
            }
        }
        Ok(())
    }

    /// Adds a punctual light; a node must place it before it shines.
    ///
    /// # Errors
    /// [`SceneError::InvalidObject`] if its intensity is negative or not finite, or a spot's angles are out of range.
    pub fn add_light(&mut self, light: Light) -> Result<LightId, SceneError> {
        self.check_light(&light)?;
        self.lights.push(light);
        Ok(LightId(self.lights.len() - 1))
    }

    /// Replaces a light.
    ///
    /// # Errors
    /// As [`Scene::add_light`]; [`SceneError::UnknownId`].
    pub fn set_light(&mut self, id: LightId, light: Light) -> Result<(), SceneError> {
        self.check("light", id.0, self.lights.len())?;
        self.check_light(&light)?;
        self.revisions.lights += u64::from(self.lights[id.0] != light);
        self.lights[id.0] = light;
        Ok(())
    }

    /// Gives animated lights the strength that they have at a time.
    pub(super) fn set_animated_lights(&mut self, seconds: f64) {
        let channels = self.animations().iter().flat_map(|animation| &animation.lights);
        let changed: Vec<(LightId, [f32; 3])> =
            channels.filter_map(|channel| Some((channel.light, channel.intensity(seconds)?))).collect();
        for (id, intensity) in changed {
            let light = Light { intensity, ..self.lights[id.0].clone() };
            if let Err(error) = self.set_light(id, light) {
                tracing::warn!("a light stays as it is at {seconds} s: {error}");
            }
        }
    }

    /// Sets the sky's radiance in W/(m² sr). Channels that are negative or not finite become 0.
    pub fn set_sky(&mut self, radiance: [f32; 3]) {
        let radiance = radiance.map(|channel| if channel.is_finite() { channel.max(0.0) } else { 0.0 });
        self.revisions.lights += u64::from(self.sky != radiance);
        self.sky = radiance;
    }

    /// Adds a camera; a node must place it before one can look through it.
    ///
    /// # Errors
    /// [`SceneError::InvalidObject`] if its projection is out of range.
    pub fn add_camera(&mut self, camera: Camera) -> Result<CameraId, SceneError> {
        self.check_camera(&camera)?;
        self.cameras.push(camera);
        Ok(CameraId(self.cameras.len() - 1))
    }

    /// Replaces a camera.
    ///
    /// # Errors
    /// As [`Scene::add_camera`]; [`SceneError::UnknownId`].
    pub fn set_camera(&mut self, id: CameraId, camera: Camera) -> Result<(), SceneError> {
        self.check("camera", id.0, self.cameras.len())?;
        self.check_camera(&camera)?;
        self.revisions.camera += u64::from(self.cameras[id.0] != camera);
        self.cameras[id.0] = camera;
        Ok(())
    }

    /// Adds a light with its place in the world, for instance from a command line.
    ///
    /// # Errors
    /// As [`Scene::add_light`] and [`Scene::add_node`].
    pub fn add_light_spec(&mut self, spec: &LightSpec) -> Result<LightId, SceneError> {
        let light = self.add_light(spec.light.clone())?;
        let back = (-spec.direction).try_normalize().unwrap_or(DVec3::Z);
        let right = back.any_orthonormal_vector();
        let local = DAffine3 { matrix3: DMat3::from_cols(right, back.cross(right), back), translation: spec.position };
        self.add_node(Node { name: spec.light.name.clone(), local, light: Some(light), ..Node::default() })?;
        Ok(light)
    }

    fn check_material(&self, material: &Material) -> Result<(), SceneError> {
        for texture in material.textures() {
            self.check("texture", texture.texture.0, self.textures.len())?;
        }
        material.fault().map_or(Ok(()), |fault| Err(self.invalid("material", &material.name, fault)))
    }

    fn check_camera(&self, camera: &Camera) -> Result<(), SceneError> {
        camera.fault().map_or(Ok(()), |fault| Err(self.invalid("camera", &camera.name, fault)))
    }

    fn check_light(&self, light: &Light) -> Result<(), SceneError> {
        light.fault().map_or(Ok(()), |fault| Err(self.invalid("light", &light.name, fault)))
    }

    pub(super) fn check(&self, kind: &'static str, index: usize, count: usize) -> Result<(), SceneError> {
        if index < count { Ok(()) } else { Err(SceneError::UnknownId { scene: self.name.clone(), kind, index, count }) }
    }

    pub(super) fn invalid(&self, kind: &str, name: &str, fault: String) -> SceneError {
        SceneError::InvalidObject { scene: self.name.clone(), object: format!("the {kind} {name:?}"), fault }
    }
}
