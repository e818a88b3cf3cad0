//! The scene on the device: vertex streams, indices, instances, materials, textures. Uploaded when they change.

use std::sync::Arc;

use ash::vk;
use glam::{DAffine3, DMat3, DVec3};

use super::drawn_triangles::drawn_indices;
use super::materials::{cutouts_of, is_cut, texture_kinds, upload_materials};
use super::textures::MaterialTextureSets;
use crate::graph::hash_of;
use crate::scene::{Alpha, Bounds, Cutout, Instance, Material, Primitive, Scene, has_specular_lobe};
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
    /// f32x3, metres in object space.
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
    places: Vec<Vec<Place>>,
}

#[derive(Clone, Copy)]
struct Place {
    first_index: u32,
    index_count: u32,
    vertex_offset: i32,
    bounds: [[f32; 3]; 2],
    /// In object space, m².
    area: f64,
}

/// One instance as the host needs it to draw: what to draw, with which material, and where it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawnInstance {
    pub(crate) first_index: u32,
    /// 0 if alpha leaves nothing of it.
    pub(crate) index_count: u32,
    pub(crate) vertex_offset: i32,
    pub(crate) material: usize,
    /// The programs that read textures draw it: its material has some, or alpha cuts it out point by point.
    pub(crate) textured: bool,
    /// Which kinds, as the shaders' bits.
    pub(crate) texture_kinds: u32,
    pub(crate) masked: bool,
    /// The material reflects or transmits specularly.
    pub(crate) specular: bool,
    /// Corners of its box in render space, for culling.
    pub(crate) center_rs: [f32; 3],
    pub(crate) half_axes_rs: [[f32; 3]; 3],
}

/// Everything of a scene that passes read, with a key for each part.
pub(crate) struct SceneData {
    identity: u64,
    pub(crate) origin: DVec3,
    /// Half the diagonal of the scene's bounds when it was first seen, metres; the length that tolerances scale with.
    pub(crate) radius: f64,
    /// Of all surfaces, m².
    pub(crate) area: f64,
    pub(crate) meshes: MeshData,
    mesh_key: u64,
    pub(crate) instances: Arc<Buffer>,
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
        let mesh_key = hash_of(&(scene.identity(), scene.meshes().len()));
        let material_key = hash_of(&(scene.identity(), revisions.materials));
        let instance_key = hash_of(&(scene.identity(), revisions.geometry, revisions.materials));
        let Some(mut data) = held.filter(|data| data.identity == scene.identity() && data.mesh_key == mesh_key) else {
            return SceneData::new(device, pipelines, scene, [mesh_key, material_key, instance_key]);
        };
        if data.material_key != material_key {
            let made = upload_materials(device, pipelines, scene)?;
            (data.materials, data.material_textures, data.texture_sets) = made;
            data.cutouts = cutouts_of(scene);
            data.material_key = material_key;
        }
        if data.instance_key != instance_key {
            (data.instances, data.drawn) = upload_instances(device, scene, (&data.meshes, &data.cutouts), data.origin)?;
            data.area = surface_area(scene, &data.meshes);
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
        let bounds = scene.bounds().unwrap_or(Bounds { min: DVec3::splat(-1.0), max: DVec3::splat(1.0) });
        let meshes = MeshData::upload(device, scene)?;
        let (materials, material_textures, texture_sets) = upload_materials(device, pipelines, scene)?;
        let cutouts = cutouts_of(scene);
        let (instances, drawn) = upload_instances(device, scene, (&meshes, &cutouts), bounds.center())?;
        Ok(SceneData {
            identity: scene.identity(),
            origin: bounds.center(),
            radius: bounds.radius().max(1e-9),
            area: surface_area(scene, &meshes),
            meshes,
            mesh_key,
            instances,
            instance_key,
            drawn,
            materials,
            material_textures,
            material_key,
            texture_sets,
            cutouts,
        })
    }

    /// Device memory that the scene holds, bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let meshes = &self.meshes;
        let [texcoord0, texcoord1] = &meshes.texcoords;
        let streams = [&meshes.positions, &meshes.normals, &meshes.tangents, texcoord0, texcoord1, &meshes.colors];
        let streams: u64 = streams.iter().map(|stream| stream.buffer.bytes()).sum();
        let buffers = [&meshes.indices, &self.instances, &self.materials, &self.material_textures];
        let buffers: u64 = buffers.iter().map(|buffer| buffer.bytes()).sum();
        streams + buffers + self.texture_sets.as_ref().map_or(0, MaterialTextureSets::bytes)
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
        let vertices: usize = primitives.iter().map(|primitive| primitive.positions.len()).sum();
        let mut indices: Vec<u32> = Vec::new();
        let mut places = Vec::new();
        let (mut first_index, mut vertex_offset) = (0_u32, 0_i32);
        for mesh in scene.meshes() {
            let mut place = |primitive: &Primitive| {
                let drawn = drawn_indices(primitive);
                let index_count = narrow(drawn.len())?;
                indices.extend(drawn);
                let bounds = box_of(&primitive.positions);
                let area = area_of(primitive, DMat3::IDENTITY);
                let place = Place { first_index, index_count, vertex_offset, bounds, area };
                first_index = first_index.checked_add(index_count).ok_or_else(too_many)?;
                vertex_offset = i32::try_from(primitive.positions.len())
                    .ok()
                    .and_then(|count| vertex_offset.checked_add(count))
                    .ok_or_else(too_many)?;
                Ok(place)
            };
            places.push(mesh.primitives.iter().map(&mut place).collect::<Result<Vec<_>, VulkanError>>()?);
        }
        let positions: Vec<[f32; 3]> =
            primitives.iter().flat_map(|primitive| primitive.positions.iter().copied()).collect();
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
            vertices,
            [0, 0, i16::MAX, 0],
            |primitive| primitive.normals.as_deref(),
            |&[x, y, z]| [snorm(x), snorm(y), snorm(z), 0],
        );
        let tangents = gather(
            &primitives,
            vertices,
            [i16::MAX, 0, 0, i16::MAX],
            |primitive| primitive.tangents.as_deref(),
            |tangent| tangent.map(snorm),
        );
        let colors = gather(
            &primitives,
            vertices,
            [u8::MAX; 4],
            |primitive| primitive.colors.as_deref(),
            |color| color.map(unorm),
        );
        let texcoords = |set: usize| {
            gather(&primitives, vertices, [0.0_f32; 2], |primitive| primitive.texcoords[set].as_deref(), |&uv| uv)
        };
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
    primitives: &[&'p Primitive],
    vertices: usize,
    default: T,
    attribute: impl Fn(&'p Primitive) -> Option<&'p [S]>,
    convert: impl Fn(&S) -> T,
) -> Vec<T> {
    if primitives.iter().all(|primitive| attribute(primitive).is_none()) {
        return vec![default];
    }
    let mut elements = Vec::with_capacity(vertices);
    for primitive in primitives {
        match attribute(primitive) {
            Some(values) => elements.extend(values.iter().map(&convert)),
            None => elements.extend(std::iter::repeat_n(default, primitive.positions.len())),
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

/// The area of a primitive that is moved by a linear map, m².
fn area_of(primitive: &Primitive, linear: DMat3) -> f64 {
    let corner = |index: u32| linear * DVec3::from(primitive.positions[index as usize].map(f64::from));
    let triangles = primitive.indices.chunks_exact(3).map(|indices| [0, 1, 2].map(|place| corner(indices[place])));
    triangles.map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
}

/// The area of all instances, m². Only those whose transform is no similarity are measured triangle by triangle.
fn surface_area(scene: &Scene, meshes: &MeshData) -> f64 {
    let area = |instance: &Instance| {
        let linear = instance.world.matrix3;
        let scale2 = linear.x_axis.length_squared();
        let stretch = (linear.transpose() * linear - DMat3::from_diagonal(DVec3::splat(scale2))).to_cols_array();
        if stretch.into_iter().all(|entry| entry.abs() <= 1e-6 * scale2) {
            scale2 * meshes.places[instance.mesh.0][instance.primitive].area
        } else {
            area_of(&scene.meshes()[instance.mesh.0].primitives[instance.primitive], linear)
        }
    };
    scene.instances().iter().map(area).sum()
}

fn upload_instances(
    device: &Arc<Device>,
    scene: &Scene,
    (meshes, cutouts): (&MeshData, &[Cutout]),
    origin: DVec3,
) -> Result<(Arc<Buffer>, Vec<DrawnInstance>), VulkanError> {
    let mut records = Vec::new();
    let mut drawn = Vec::new();
    for instance in scene.instances() {
        let place = meshes.places[instance.mesh.0][instance.primitive];
        let primitive = &scene.meshes()[instance.mesh.0].primitives[instance.primitive];
        records.push(instance_record(instance, primitive, place, origin));
        let index = primitive.material.0;
        let mut instance = drawn_instance(instance, place, index, &scene.materials()[index], origin);
        match cutouts[index] {
            Cutout::Nothing => instance.index_count = 0,
            cutout => instance.textured |= is_cut(cutout, instance.masked, primitive),
        }
        drawn.push(instance);
    }
    let buffer = buffer_with(
        device,
        "scene.instances",
        bytemuck::cast_slice(&records),
        vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER,
    )?;
    Ok((buffer, drawn))
}

const FLAT_NORMALS: u32 = 1;
const FLIPPED: u32 = 2;
const HAS_COLORS: u32 = 4;
const HAS_TANGENTS: u32 = 8;

fn instance_record(instance: &Instance, primitive: &Primitive, place: Place, origin: DVec3) -> types::Instance {
    let world = instance.world;
    let [a, b, c] = [world.matrix3.x_axis, world.matrix3.y_axis, world.matrix3.z_axis];
    let translation = world.translation - origin;
    let row = |axis: usize| [a[axis] as f32, b[axis] as f32, c[axis] as f32, translation[axis] as f32];
    // Any positive factor will do: the largest component becomes 1, so that no scale under- or overflows.
    let cofactors = [b.cross(c), c.cross(a), a.cross(b)];
    let largest = cofactors.iter().map(|column| column.abs().max_element()).fold(f64::MIN_POSITIVE, f64::max);
    let [cofactor_x, cofactor_y, cofactor_z] = cofactors.map(|column| (column / largest).as_vec3().to_array());
    let flag = |present: bool, bit: u32| if present { bit } else { 0 };
    types::Instance {
        object_to_render: [row(0), row(1), row(2)],
        cofactor_x,
        cofactor_y,
        cofactor_z,
        material: u32::try_from(primitive.material.0).unwrap_or(0),
        flags: flag(primitive.normals.is_none(), FLAT_NORMALS)
            | flag(instance.flips_winding, FLIPPED)
            | flag(primitive.colors.is_some(), HAS_COLORS)
            | flag(primitive.tangents.is_some(), HAS_TANGENTS),
        first_index: place.first_index,
        vertex_offset: place.vertex_offset,
        reserved: [0; 3],
    }
}

fn drawn_instance(
    instance: &Instance,
    place: Place,
    index: usize,
    material: &Material,
    origin: DVec3,
) -> DrawnInstance {
    let [low, high] = place.bounds.map(|corner| DVec3::from(corner.map(f64::from)));
    let to_render = DAffine3 { matrix3: instance.world.matrix3, translation: instance.world.translation - origin };
    let half = (high - low) * 0.5;
    let axes =
        [to_render.matrix3.x_axis * half.x, to_render.matrix3.y_axis * half.y, to_render.matrix3.z_axis * half.z];
    DrawnInstance {
        first_index: place.first_index,
        index_count: place.index_count,
        vertex_offset: place.vertex_offset,
        material: index,
        textured: material.textures().next().is_some(),
        texture_kinds: texture_kinds(material),
        masked: material.alpha != Alpha::Opaque,
        specular: has_specular_lobe(material),
        center_rs: to_render.transform_point3((low + high) * 0.5).as_vec3().to_array(),
        half_axes_rs: axes.map(|axis| axis.as_vec3().to_array()),
    }
}
