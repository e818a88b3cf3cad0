//! Vertices and indices of all meshes on the device, a buffer for each attribute. Where a mesh changes and keeps its numbers of them, its own are sent and no others.

use std::sync::Arc;

use ash::vk;
use bytemuck::Pod;
use glam::{DMat3, DVec3};

use super::closed_meshes::solids;
use super::drawn_triangles::DrawnTriangles;
use super::instances::{Place, area_of};
use crate::scene::{Mesh, Primitive, Scene, Shape};
use crate::vulkan::{Buffer, Device, VulkanError, buffer_with, overwrite};

/// A vertex stream that some primitives may lack; a scene in which all lack it binds one element with stride 0.
#[derive(Clone)]
pub(crate) struct Stream {
    pub(crate) buffer: Arc<Buffer>,
    pub(crate) stride: u32,
}

pub(crate) struct MeshData {
    /// f32x3, metres in object space, from the primitive's own centre ([`Shape`]).
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
    vertex_count: usize,
    attributes: Attributes,
    /// [`Scene::mesh_changes`] of what is there.
    changes: Vec<u64>,
    /// Bytes sent to the device so far.
    pub(super) sent: u64,
}

/// What some primitive of the scene has.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Attributes {
    normals: bool,
    tangents: bool,
    texcoords: [bool; 2],
    colors: bool,
}

/// Vertices and indices of one mesh or of several, as they are sent.
#[derive(Default)]
struct Vertices {
    positions: Vec<[f32; 3]>,
    normals: Vec<[i16; 4]>,
    tangents: Vec<[i16; 4]>,
    texcoords: [Vec<[f32; 2]>; 2],
    colors: Vec<[u8; 4]>,
    indices: Vec<u32>,
}

impl MeshData {
    pub(super) fn upload(device: &Arc<Device>, scene: &Scene) -> Result<MeshData, VulkanError> {
        let attributes = Attributes::of(scene);
        let mut all = Vertices::default();
        let mut places = Vec::new();
        let mut shapes = scene.shapes().into_iter();
        for mesh in scene.meshes() {
            let start = [all.indices.len(), all.positions.len()];
            let shapes: Vec<&Shape> = shapes.by_ref().take(mesh.primitives.len()).collect();
            places.push(all.add(mesh, &shapes, attributes, start)?);
        }
        all.complete(attributes);
        let texel = vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER;
        let vertex = vk::BufferUsageFlags::VERTEX_BUFFER;
        let mut sent = 0;
        let mut buffer = |name: &str, bytes: &[u8], usage| {
            sent += bytes.len() as u64;
            buffer_with(device, name, bytes, usage)
        };
        let mut stream = |name: &str, bytes: &[u8], stride: u32, usage| {
            let alone = bytes.len() as u64 == u64::from(stride);
            Ok::<_, VulkanError>(Stream { buffer: buffer(name, bytes, usage)?, stride: if alone { 0 } else { stride } })
        };
        let [texcoords0, texcoords1] = &all.texcoords;
        Ok(MeshData {
            positions: stream("scene.positions", bytemuck::cast_slice(&all.positions), 12, vertex | texel)?,
            normals: stream("scene.normals", bytemuck::cast_slice(&all.normals), 8, vertex)?,
            tangents: stream("scene.tangents", bytemuck::cast_slice(&all.tangents), 8, vertex)?,
            texcoords: [
                stream("scene.texcoords.0", bytemuck::cast_slice(texcoords0), 8, vertex)?,
                stream("scene.texcoords.1", bytemuck::cast_slice(texcoords1), 8, vertex)?,
            ],
            colors: stream("scene.colors", bytemuck::cast_slice(&all.colors), 4, vertex)?,
            indices: buffer(
                "scene.indices",
                bytemuck::cast_slice(&all.indices),
                vk::BufferUsageFlags::INDEX_BUFFER | texel,
            )?,
            places,
            vertex_count: all.positions.len(),
            attributes,
            changes: scene.mesh_changes().to_vec(),
            sent,
        })
    }

    /// Sends the meshes that changed; all of them if numbers of vertices or indices did, or which attributes there are.
    pub(super) fn update(&mut self, device: &Arc<Device>, scene: &Scene) -> Result<(), VulkanError> {
        if !self.overwrite_changed(device, scene)? {
            let sent = self.sent;
            *self = MeshData::upload(device, scene)?;
            self.sent += sent;
        }
        Ok(())
    }

    /// Whether it could be done.
    fn overwrite_changed(&mut self, device: &Arc<Device>, scene: &Scene) -> Result<bool, VulkanError> {
        let (meshes, changes, attributes) = (scene.meshes(), scene.mesh_changes(), self.attributes);
        if changes.len() != self.changes.len() || Attributes::of(scene) != attributes {
            return Ok(false);
        }
        let shapes = scene.shapes();
        let mut first_shape = 0;
        for index in 0..meshes.len() {
            let mesh = &meshes[index];
            let shapes = &shapes[first_shape..first_shape + mesh.primitives.len()];
            first_shape += shapes.len();
            if changes[index] == self.changes[index] || shapes.is_empty() {
                continue;
            }
            let held = &self.places[index];
            let start = [held[0].first_index as usize, held[0].vertex_offset as usize];
            let mut vertices = Vertices::default();
            let places = vertices.add(mesh, shapes, attributes, start)?;
            let alike = |(new, held): (&Place, &Place)| {
                (new.first_index, new.index_count, new.vertex_offset)
                    == (held.first_index, held.index_count, held.vertex_offset)
            };
            let rest = self.places[index + 1..].iter().flatten().next();
            let end = rest.map_or(self.vertex_count, |place| place.vertex_offset as usize);
            let fits = start[1] + vertices.positions.len() == end;
            if !fits || !places.iter().zip(held).all(alike) || !self.overwrite(device, &vertices, start)? {
                return Ok(false);
            }
            self.places[index] = places;
        }
        self.changes = changes.to_vec();
        Ok(true)
    }

    /// Whether it could be done: nobody else may hold the buffers.
    fn overwrite(
        &mut self,
        device: &Arc<Device>,
        vertices: &Vertices,
        [index, vertex]: [usize; 2],
    ) -> Result<bool, VulkanError> {
        fn bytes<T: Pod>(elements: &[T], first: usize) -> (u64, &[u8]) {
            ((first * size_of::<T>()) as u64, bytemuck::cast_slice(elements))
        }
        let [texcoords0, texcoords1] = &mut self.texcoords;
        let lists = [
            (&mut self.positions.buffer, bytes(&vertices.positions, vertex)),
            (&mut self.normals.buffer, bytes(&vertices.normals, vertex)),
            (&mut self.tangents.buffer, bytes(&vertices.tangents, vertex)),
            (&mut texcoords0.buffer, bytes(&vertices.texcoords[0], vertex)),
            (&mut texcoords1.buffer, bytes(&vertices.texcoords[1], vertex)),
            (&mut self.colors.buffer, bytes(&vertices.colors, vertex)),
            (&mut self.indices, bytes(&vertices.indices, index)),
        ];
        for (buffer, part) in lists {
            if part.1.is_empty() {
                continue;
            }
            if !overwrite(device, buffer, &[part])? {
                return Ok(false);
            }
            self.sent += part.1.len() as u64;
        }
        Ok(true)
    }

    /// Device memory, bytes.
    pub(super) fn bytes(&self) -> u64 {
        let [texcoords0, texcoords1] = &self.texcoords;
        let streams = [&self.positions, &self.normals, &self.tangents, texcoords0, texcoords1, &self.colors];
        streams.iter().map(|stream| stream.buffer.bytes()).sum::<u64>() + self.indices.bytes()
    }
}

impl Attributes {
    fn of(scene: &Scene) -> Attributes {
        let any = |has: &dyn Fn(&Primitive) -> bool| scene.meshes().iter().flat_map(|mesh| &mesh.primitives).any(has);
        Attributes {
            normals: any(&|primitive| primitive.normals.is_some()),
            tangents: any(&|primitive| primitive.tangents.is_some()),
            texcoords: [0, 1].map(|set| any(&|primitive| primitive.texcoords[set].is_some())),
            colors: any(&|primitive| primitive.colors.is_some()),
        }
    }
}

impl Vertices {
    /// Adds a mesh, of whose indices and vertices the first are the `start`-th of all. Where its primitives lie.
    fn add(
        &mut self,
        mesh: &Mesh,
        shapes: &[&Shape],
        attributes: Attributes,
        [mut index, mut vertex]: [usize; 2],
    ) -> Result<Vec<Place>, VulkanError> {
        let boxes: Vec<_> = mesh.primitives.iter().map(|primitive| box_of(&primitive.positions)).collect();
        let solids = solids(&mesh.primitives, &boxes);
        let mut places = Vec::new();
        for (((primitive, shape), bounds), solid) in mesh.primitives.iter().zip(shapes).zip(boxes).zip(solids) {
            let drawn = DrawnTriangles::of(primitive);
            places.push(Place {
                first_index: narrow(index)?,
                index_count: narrow(drawn.indices.len())?,
                vertex_offset: i32::try_from(vertex).map_err(|_| too_many())?,
                bounds,
                area: area_of(primitive, DMat3::IDENTITY),
                solid,
            });
            index += drawn.indices.len();
            vertex += drawn.vertices.len();
            self.add_primitive(primitive, &drawn, shape.center, attributes);
        }
        narrow(index)?;
        i32::try_from(vertex).map_err(|_| too_many())?;
        Ok(places)
    }

    fn add_primitive(&mut self, primitive: &Primitive, drawn: &DrawnTriangles, center: DVec3, attributes: Attributes) {
        let from_center = |position: [f32; 3]| (DVec3::from(position.map(f64::from)) - center).as_vec3().to_array();
        self.positions.extend(drawn.of_vertices(&primitive.positions).map(from_center));
        self.indices.extend(&drawn.indices);
        let vertices = &drawn.vertices;
        if attributes.normals {
            let normals = primitive.normals.as_deref();
            gather(&mut self.normals, vertices, normals, NORMAL, |&[x, y, z]| [snorm(x), snorm(y), snorm(z), 0]);
        }
        if attributes.tangents {
            let tangents = primitive.tangents.as_deref();
            gather(&mut self.tangents, vertices, tangents, TANGENT, |tangent| tangent.map(snorm));
        }
        for set in [0, 1] {
            if attributes.texcoords[set] {
                let texcoords = primitive.texcoords[set].as_deref();
                gather(&mut self.texcoords[set], vertices, texcoords, TEXCOORD, |&texcoord| texcoord);
            }
        }
        if attributes.colors {
            gather(&mut self.colors, vertices, primitive.colors.as_deref(), COLOR, |color| color.map(unorm));
        }
    }

    /// An attribute that no primitive has is a single element.
    fn complete(&mut self, attributes: Attributes) {
        fn fill<T>(has: bool, elements: &mut Vec<T>, default: T) {
            if !has {
                elements.push(default);
            }
        }
        fill(attributes.normals, &mut self.normals, NORMAL);
        fill(attributes.tangents, &mut self.tangents, TANGENT);
        for set in [0, 1] {
            fill(attributes.texcoords[set], &mut self.texcoords[set], TEXCOORD);
        }
        fill(attributes.colors, &mut self.colors, COLOR);
    }
}

/// What vertices have that were given nothing.
const NORMAL: [i16; 4] = [0, 0, i16::MAX, 0];
const TANGENT: [i16; 4] = [i16::MAX, 0, 0, i16::MAX];
const TEXCOORD: [f32; 2] = [0.0; 2];
const COLOR: [u8; 4] = [u8::MAX; 4];

/// One element a vertex.
fn gather<S, T: Copy>(
    elements: &mut Vec<T>,
    vertices: &[u32],
    values: Option<&[S]>,
    default: T,
    convert: impl Fn(&S) -> T,
) {
    match values {
        Some(values) => elements.extend(vertices.iter().map(|vertex| convert(&values[*vertex as usize]))),
        None => elements.extend(std::iter::repeat_n(default, vertices.len())),
    }
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
