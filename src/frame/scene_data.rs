//! The scene on the device: vertex streams, indices, instances, materials, textures. Uploaded when they change.

use std::sync::Arc;

use glam::DVec3;

pub(crate) use super::instances::DrawnInstance;
use super::instances::{instances_of, surface_area};
use super::materials::MaterialData;
use super::mesh_data::MeshData;
use super::sent_list::SentList;
use crate::graph::hash_of;
use crate::scene::{Extent, Scene};
use crate::shaders::types;
use crate::vulkan::{Buffer, Device, Pipelines, VulkanError};

/// Everything of a scene that passes read, with a key for each part.
pub(crate) struct SceneData {
    pub(crate) identity: u64,
    /// Where render space has its zero: of the scene at rest, see [`Extent`](crate::scene::Extent).
    pub(crate) origin: DVec3,
    /// Of what matters, in render space.
    pub(crate) middle_rs: DVec3,
    /// Of what matters around it at rest, metres; what lengths that nobody asked for are a share of.
    pub(crate) radius: f64,
    /// How far from the middle what matters reaches now, metres.
    pub(crate) reach: f64,
    /// Of the surfaces within reach, m².
    pub(crate) area: f64,
    pub(crate) meshes: MeshData,
    mesh_key: u64,
    instances: SentList<types::Instance>,
    pub(crate) instance_key: u64,
    pub(crate) drawn: Vec<DrawnInstance>,
    pub(crate) materials: MaterialData,
    pub(crate) material_key: u64,
}

impl SceneData {
    /// Uploads what changed since `held`, or everything.
    pub(crate) fn update(
        device: &Arc<Device>,
        pipelines: &Pipelines,
        held: Option<SceneData>,
        scene: &Scene,
    ) -> Result<SceneData, VulkanError> {
        let revisions = scene.revisions();
        let mesh_key = hash_of(&(scene.identity(), revisions.meshes));
        let material_key = hash_of(&(scene.identity(), revisions.materials));
        let Extent { origin, middle, radius } = scene.extent();
        let place = origin.to_array().map(f64::to_bits);
        let instance_key = hash_of(&(scene.identity(), revisions.geometry, revisions.materials, place));
        let Some(mut data) = held.filter(|data| data.identity == scene.identity()) else {
            return SceneData::new(device, pipelines, scene, [mesh_key, material_key, instance_key]);
        };
        if data.mesh_key != mesh_key {
            data.meshes.update(device, scene)?;
            data.mesh_key = mesh_key;
        }
        if data.material_key != material_key {
            data.materials.update(device, pipelines, scene)?;
            data.material_key = material_key;
        }
        if data.instance_key != instance_key {
            (data.origin, data.middle_rs, data.radius, data.reach) = (origin, middle - origin, radius, scene.reach());
            let meshes = (&data.meshes.places[..], &data.materials.cutouts[..]);
            let (records, drawn) = instances_of(scene, meshes, data.reach);
            data.instances.update(device, records)?;
            data.drawn = drawn;
            data.area = surface_area(scene, &data.meshes.places, data.reach);
            data.instance_key = instance_key;
        }
        Ok(data)
    }

    fn new(
        device: &Arc<Device>,
        pipelines: &Pipelines,
        scene: &Scene,
        [mesh_key, material_key, instance_key]: [u64; 3],
    ) -> Result<SceneData, VulkanError> {
        let (Extent { origin, middle, radius }, reach) = (scene.extent(), scene.reach());
        let meshes = MeshData::upload(device, scene)?;
        let materials = MaterialData::upload(device, pipelines, scene)?;
        let (records, drawn) = instances_of(scene, (&meshes.places, &materials.cutouts), reach);
        Ok(SceneData {
            identity: scene.identity(),
            origin,
            middle_rs: middle - origin,
            radius,
            reach,
            area: surface_area(scene, &meshes.places, reach),
            meshes,
            mesh_key,
            instances: SentList::new(device, "scene.instances", records)?,
            instance_key,
            drawn,
            materials,
            material_key,
        })
    }

    /// Names a record for each instance.
    pub(crate) fn instances(&self) -> &Arc<Buffer> {
        &self.instances.buffer
    }

    /// Bytes that were sent to the device so far.
    pub(crate) fn sent(&self) -> u64 {
        self.meshes.sent + self.instances.sent + self.materials.sent()
    }

    /// Device memory that the scene holds, bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.meshes.bytes() + self.instances.buffer.bytes() + self.materials.bytes()
    }

    /// The kinds of textures, as the shaders' bits, that the instances which `takes` accepts read.
    pub(crate) fn texture_kinds(&self, takes: impl Fn(&DrawnInstance) -> bool) -> u32 {
        self.drawn.iter().filter(|drawn| takes(drawn)).fold(0, |kinds, drawn| kinds | drawn.texture_kinds)
    }

    /// Whether some drawn material reads textures.
    pub(crate) fn textured(&self) -> bool {
        self.drawn.iter().any(|drawn| drawn.textured)
    }
}
