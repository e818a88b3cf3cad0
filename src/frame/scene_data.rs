//! The scene on the device: vertex streams, indices, instances, materials, textures. Uploaded when they change.

use std::sync::Arc;

use ash::vk;
use glam::{DMat3, DVec3};

use super::closed_meshes::solids;
use super::drawn_triangles::DrawnTriangles;
pub(crate) use super::instances::DrawnInstance;
use super::instances::{Place, area_of, instances_of, surface_area};
use super::materials::{cutouts_of, upload_materials};
use super::sent_list::SentList;
use super::textures::MaterialTextureSets;
use crate::graph::hash_of;
use crate::scene::{Cutout, Extent, Primitive, Scene, Shape};
use crate::shaders::types;
use crate::vulkan::{Buffer, Device, Pipelines, VulkanError, buffer_with};

/// A vertex stream that some primitives may lack; a scene in which all lack it binds one element with stride 0.
#[derive(Clone)]
pub(crate) struct Stream {
    pub(crate) buffer: Arc<Buffer>,
    pub(crate) stride: u32,
}

/// All vertex and index data of a scene, one buffer a stream.
pub(crate) struct MeshData {
    /// f32x3, metres in object space, from the primitive's own centre ([`Shape`](crate::scene::Shape)).
    pub(crate) positions: Stream,
    /// snorm16x4.
    pub(crate) normals: Stream,
    /// snorm16x4; w is the sign of the bitangent.
    pub(crate) tangents: Stream,
    /// f32x2 each.
    pub(crate) texcoords: [Stream; 2],
    /// unorm8x4, linear.
    pub(crate) colors: Stream,
    /// u32.
    pub(crate) indices: Arc<Buffer>,
    /// Where each primitive of each mesh lies: `places[mesh][primitive]`.
    pub(super) places: Vec<Vec<Place>>,
}

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
    /// Bytes sent to the device so far, but for the list of instances.
    sent: u64,
    pub(crate) instance_key: u64,
    pub(crate) drawn: Vec<DrawnInstance>,
    pub(crate) materials: Arc<Buffer>,
    pub(crate) material_textures: Arc<Buffer>,
    pub(crate) material_key: u64,
    pub(crate) texture_sets: Option<MaterialTextureSets>,
    /// Of each material where no vertex colours are.
    cutouts: Vec<Cutout>,
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
        let held = held.filter(|data| data.identity == scene.identity());
        let sent = held.as_ref().map_or(0, SceneData::sent);
        let Some(mut data) = held.filter(|data| data.mesh_key == mesh_key) else {
            let mut data = SceneData::new(device, pipelines, scene, [mesh_key, material_key, instance_key])?;
            data.sent += sent;
            return Ok(data);
        };
        if data.material_key != material_key {
            let made = upload_materials(device, pipelines, scene)?;
            (data.materials, data.material_textures, data.texture_sets) = made;
            data.cutouts = cutouts_of(scene);
            data.material_key = material_key;
            data.sent += data.material_bytes();
        }
        if data.instance_key != instance_key {
            (data.origin, data.middle_rs, data.radius, data.reach) = (origin, middle - origin, radius, scene.reach());
            let meshes = (&data.meshes.places[..], &data.cutouts[..]);
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
        let (materials, material_textures, texture_sets) = upload_materials(device, pipelines, scene)?;
        let cutouts = cutouts_of(scene);
        let (records, drawn) = instances_of(scene, (&meshes.places, &cutouts), reach);
        let mut data = SceneData {
            identity: scene.identity(),
            origin,
            middle_rs: middle - origin,
            radius,
            reach,
            area: surface_area(scene, &meshes.places, reach),
            meshes,
            mesh_key,
            instances: SentList::new(device, "scene.instances", records)?,
            sent: 0,
            instance_key,
            drawn,
            materials,
            material_textures,
            material_key,
            texture_sets,
            cutouts,
        };
        data.sent = data.bytes() - data.instances.buffer.bytes();
        Ok(data)
    }

    /// Names a record for each instance.
    pub(crate) fn instances(&self) -> &Arc<Buffer> {
        &self.instances.buffer
    }

    /// Bytes that were sent to the device so far.
    pub(crate) fn sent(&self) -> u64 {
        self.sent + self.instances.sent
    }

    fn material_bytes(&self) -> u64 {
        let textures = self.texture_sets.as_ref().map_or(0, MaterialTextureSets::bytes);
        self.materials.bytes() + self.material_textures.bytes() + textures
    }

    /// Device memory that the scene holds, bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let meshes = &self.meshes;
        let [texcoord0, texcoord1] = &meshes.texcoords;
        let streams = [&meshes.positions, &meshes.normals, &meshes.tangents, texcoord0, texcoord1, &meshes.colors];
        let streams: u64 = streams.iter().map(|stream| stream.buffer.bytes()).sum();
        streams + meshes.indices.bytes() + self.instances.buffer.bytes() + self.material_bytes()
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

impl MeshData {
    fn upload(device: &Arc<Device>, scene: &Scene) -> Result<MeshData, VulkanError> {
        let primitives: Vec<&Primitive> = scene.meshes().iter().flat_map(|mesh| &mesh.primitives).collect();
        let drawn: Vec<DrawnTriangles> = primitives.iter().map(|primitive| DrawnTriangles::of(primitive)).collect();
        let indices: Vec<u32> = drawn.iter().flat_map(|drawn| &drawn.indices).copied().collect();
        let mut rest = drawn.iter();
        let mut places = Vec::new();
        let (mut first_index, mut vertex_offset) = (0_u32, 0_i32);
        for mesh in scene.meshes() {
            let boxes: Vec<_> = mesh.primitives.iter().map(|primitive| box_of(&primitive.positions)).collect();
            let solids = solids(&mesh.primitives, &boxes);
            let mut place = |(primitive, (bounds, solid))| {
                let drawn = rest.next().expect("one for each primitive");
                let index_count = narrow(drawn.indices.len())?;
                let area = area_of(primitive, DMat3::IDENTITY);
                let place = Place { first_index, index_count, vertex_offset, bounds, area, solid };
                first_index = first_index.checked_add(index_count).ok_or_else(too_many)?;
                vertex_offset = i32::try_from(drawn.vertices.len())
                    .ok()
                    .and_then(|count| vertex_offset.checked_add(count))
                    .ok_or_else(too_many)?;
                Ok(place)
            };
            places.push(
                mesh.primitives
                    .iter()
                    .zip(boxes.into_iter().zip(solids))
                    .map(&mut place)
                    .collect::<Result<Vec<_>, VulkanError>>()?,
            );
        }
        let shapes = scene.shapes().into_iter();
        let primitives: Vec<(&Primitive, &DrawnTriangles)> = primitives.into_iter().zip(&drawn).collect();
        let centred = |((primitive, drawn), shape): (&(&Primitive, &DrawnTriangles), &Shape)| {
            let center = shape.center;
            let from_center = move |position| (DVec3::from(wide(position)) - center).as_vec3().to_array();
            drawn.of_vertices(&primitive.positions).map(from_center).collect::<Vec<[f32; 3]>>()
        };
        let positions: Vec<[f32; 3]> = primitives.iter().zip(shapes).flat_map(centred).collect();
        let texel = vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER;
        let vertex = vk::BufferUsageFlags::VERTEX_BUFFER;
        let stream = |name: &str, bytes: &[u8], stride: u32, usage| {
            let buffer = buffer_with(device, name, bytes, usage)?;
            Ok::<_, VulkanError>(Stream {
                buffer,
                stride: if bytes.len() as u64 == u64::from(stride) { 0 } else { stride },
            })
        };
        let normals = gather(
            &primitives,
            [0, 0, i16::MAX, 0],
            |primitive| primitive.normals.as_deref(),
            |&[x, y, z]| [snorm(x), snorm(y), snorm(z), 0],
        );
        let tangents = gather(
            &primitives,
            [i16::MAX, 0, 0, i16::MAX],
            |primitive| primitive.tangents.as_deref(),
            |tangent| tangent.map(snorm),
        );
        let colors =
            gather(&primitives, [u8::MAX; 4], |primitive| primitive.colors.as_deref(), |color| color.map(unorm));
        let texcoords =
            |set: usize| gather(&primitives, [0.0_f32; 2], |primitive| primitive.texcoords[set].as_deref(), |&uv| uv);
        Ok(MeshData {
            positions: stream("scene.positions", bytemuck::cast_slice(&positions), 12, vertex | texel)?,
            normals: stream("scene.normals", bytemuck::cast_slice(&normals), 8, vertex)?,
            tangents: stream("scene.tangents", bytemuck::cast_slice(&tangents), 8, vertex)?,
            texcoords: [
                stream("scene.texcoords.0", bytemuck::cast_slice(&texcoords(0)), 8, vertex)?,
                stream("scene.texcoords.1", bytemuck::cast_slice(&texcoords(1)), 8, vertex)?,
            ],
            colors: stream("scene.colors", bytemuck::cast_slice(&colors), 4, vertex)?,
            indices: buffer_with(
                device,
                "scene.indices",
                bytemuck::cast_slice(&indices),
                vk::BufferUsageFlags::INDEX_BUFFER | texel,
            )?,
            places,
        })
    }
}

/// One element a vertex, or a single `default` if no primitive has the attribute.
fn gather<'p, S: 'p, T: Copy>(
    primitives: &[(&'p Primitive, &DrawnTriangles)],
    default: T,
    attribute: impl Fn(&'p Primitive) -> Option<&'p [S]>,
    convert: impl Fn(&S) -> T,
) -> Vec<T> {
    if primitives.iter().all(|(primitive, _)| attribute(primitive).is_none()) {
        return vec![default];
    }
    let mut elements = Vec::with_capacity(primitives.iter().map(|(_, drawn)| drawn.vertices.len()).sum());
    for (primitive, drawn) in primitives {
        match attribute(primitive) {
            Some(values) => elements.extend(drawn.vertices.iter().map(|vertex| convert(&values[*vertex as usize]))),
            None => elements.extend(std::iter::repeat_n(default, drawn.vertices.len())),
        }
    }
    elements
}

fn snorm(value: f32) -> i16 {
    (value.clamp(-1.0, 1.0) * f32::from(i16::MAX)).round() as i16
}

fn unorm(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}

fn too_many() -> VulkanError {
    VulkanError::TooLarge {
        what: "the scene".to_owned(),
        asked: "more vertices or indices than 31 bits count".to_owned(),
        limit: "2³¹".to_owned(),
    }
}

fn wide(position: [f32; 3]) -> [f64; 3] {
    position.map(f64::from)
}

fn narrow(count: usize) -> Result<u32, VulkanError> {
    u32::try_from(count).map_err(|_| too_many())
}

fn box_of(positions: &[[f32; 3]]) -> [[f32; 3]; 2] {
    let mut bounds = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    for position in positions {
        for axis in 0..3 {
            bounds[0][axis] = bounds[0][axis].min(position[axis]);
            bounds[1][axis] = bounds[1][axis].max(position[axis]);
        }
    }
    if positions.is_empty() { [[0.0; 3]; 2] } else { bounds }
}
