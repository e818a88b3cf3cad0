//! Draw lists: which instances a pass draws, with which vertex streams, in which groups.

use ash::vk;

use super::mesh_data::Stream;
use super::scene_data::{DrawnInstance, SceneData};
use crate::graph::{Dependence, DrawCall, DrawGroup, DrawList, Graph, hash_of};
use crate::shaders::types;

pub(crate) use crate::shaders::groups::Geometry;
use crate::vulkan::{DepthState, RasterState, VertexAttribute, VertexLayout};

/// The format of lists of structs that are read as texels (glsl/lib/scene.glsl).
const RECORDS: vk::Format = vk::Format::R32G32B32A32_UINT;

impl Geometry {
    pub(crate) fn import(graph: &mut Graph<'_>, data: &SceneData) -> Geometry {
        let placed = Dependence::GEOMETRY;
        let (instance_key, material_key) = (data.instance_key, data.material_key);
        let instances =
            graph.import_buffer::<types::Instance>("scene.instances", data.instances(), instance_key, placed);
        let indices = graph.import_buffer::<u32>("scene.indices", &data.meshes.indices, instance_key, placed);
        let positions =
            graph.import_buffer::<f32>("scene.positions", &data.meshes.positions.buffer, instance_key, placed);
        let materials = graph.import_buffer::<types::Material>(
            "scene.materials",
            data.materials.records(),
            material_key,
            Dependence::MATERIALS,
        );
        let uses = graph.import_buffer::<types::MaterialTextures>(
            "scene.material_textures",
            data.materials.uses(),
            material_key,
            Dependence::MATERIALS,
        );
        Geometry {
            instances: instances.texels(RECORDS),
            drawn_materials: materials.texels(RECORDS),
            indices: indices.texels(vk::Format::R32_UINT),
            positions: positions.texels(vk::Format::R32_SFLOAT),
            drawn_textures: uses.texels(RECORDS),
        }
    }
}

/// The vertex attributes that a program reads, by their shader locations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Attributes {
    /// Position.
    Depth,
    /// Position, texture coordinates, colour.
    DepthMasked,
    /// Position, normal, colour.
    Plain,
    /// Position, normal, texture coordinates, colour.
    ReflectiveTextured,
    /// All.
    Textured,
}

impl Attributes {
    fn streams(self, data: &SceneData) -> Vec<(u32, vk::Format, Stream)> {
        let meshes = &data.meshes;
        let position = (0, vk::Format::R32G32B32_SFLOAT, meshes.positions.clone());
        let normal = (1, vk::Format::R16G16B16A16_SNORM, meshes.normals.clone());
        let tangent = (2, vk::Format::R16G16B16A16_SNORM, meshes.tangents.clone());
        let texcoords = [0, 1].map(|set| (3 + set as u32, vk::Format::R32G32_SFLOAT, meshes.texcoords[set].clone()));
        let color = (5, vk::Format::R8G8B8A8_UNORM, meshes.colors.clone());
        let [texcoord0, texcoord1] = texcoords;
        match self {
            Attributes::Depth => vec![position],
            Attributes::DepthMasked => vec![position, texcoord0, texcoord1, color],
            Attributes::Plain => vec![position, normal, color],
            Attributes::ReflectiveTextured => vec![position, normal, texcoord0, texcoord1, color],
            Attributes::Textured => vec![position, normal, tangent, texcoord0, texcoord1, color],
        }
    }

    fn binds_materials(self) -> bool {
        matches!(self, Attributes::DepthMasked | Attributes::ReflectiveTextured | Attributes::Textured)
    }

    /// The state of a pass that draws the scene with these attributes into a reverse-Z depth attachment.
    pub(crate) fn raster_state(self, data: &SceneData) -> RasterState {
        let mut vertices = VertexLayout::default();
        for (buffer, (location, format, stream)) in (0..).zip(self.streams(data)) {
            vertices.strides.push(stream.stride);
            vertices.attributes.push(VertexAttribute { location, buffer, format });
        }
        let depth = Some(DepthState { compare: vk::CompareOp::GREATER, write: true });
        RasterState { vertices, topology: vk::PrimitiveTopology::TRIANGLE_LIST, depth, ..RasterState::default() }
    }
}

/// The view that draws are made for.
pub(crate) struct DrawView {
    /// Planes (x, y, z, w) of the frustum in render space; a point is inside where x·px + y·py + z·pz + w ≥ 0.
    planes: Vec<[f32; 4]>,
    pub(crate) viewport: Option<([f32; 4], [u32; 4])>,
    pub(crate) push: Option<Vec<u8>>,
}

impl DrawView {
    /// Of a matrix that maps render space to clip space, columns first, reverse-Z.
    pub(crate) fn new(
        view_projection: &[[f32; 4]; 4],
        viewport: Option<([f32; 4], [u32; 4])>,
        push: Option<Vec<u8>>,
    ) -> DrawView {
        let row = |index: usize| [0, 1, 2, 3].map(|column| view_projection[column][index]);
        let [x, y, z, w] = [row(0), row(1), row(2), row(3)];
        let plane = |sign: f32, axis: [f32; 4]| [0, 1, 2, 3].map(|index| w[index] + sign * axis[index]);
        // Left, right, top, bottom, near (z ≤ w); reversed depth 0 is infinitely far when perspective.
        DrawView {
            planes: vec![plane(1.0, x), plane(-1.0, x), plane(1.0, y), plane(-1.0, y), plane(-1.0, z)],
            viewport,
            push,
        }
    }

    fn sees(&self, drawn: &DrawnInstance) -> bool {
        self.planes.iter().all(|[a, b, c, d]| {
            let along = |v: [f32; 3]| a * v[0] + b * v[1] + c * v[2];
            let reach: f32 = drawn.whole.half_axes_rs.iter().map(|&axis| along(axis).abs()).sum();
            // A little more than the box, for the rounding of its corners.
            along(drawn.whole.center_rs) + d + reach * 1.0001 + 1e-6 * (along(drawn.whole.center_rs).abs() + d.abs())
                >= 0.0
        })
    }
}

/// The draws of the instances that `takes` accepts, in each view.
pub(crate) fn draw_list(
    data: &SceneData,
    attributes: Attributes,
    views: &[DrawView],
    takes: impl Fn(&DrawnInstance) -> bool,
) -> DrawList {
    let mut groups: Vec<DrawGroup> = Vec::new();
    let by_material = attributes.binds_materials();
    for view in views {
        let mut calls: Vec<(Option<usize>, DrawCall)> = Vec::new();
        for (instance, drawn) in (0..).zip(&data.drawn) {
            if drawn.index_count > 0 && takes(drawn) && view.sees(drawn) {
                let DrawnInstance { index_count, first_index, vertex_offset, material, .. } = *drawn;
                calls.push((
                    by_material.then_some(material),
                    DrawCall { index_count, first_index, vertex_offset, instance },
                ));
            }
        }
        calls.sort_by_key(|(material, call)| (*material, call.instance));
        for run in calls.chunk_by(|a, b| a.0 == b.0) {
            groups.push(DrawGroup {
                viewport: view.viewport,
                push: view.push.clone(),
                material: run[0].0,
                calls: run.iter().map(|(_, call)| *call).collect(),
            });
        }
    }
    let described: Vec<_> = groups
        .iter()
        .map(|group| (format!("{:?}", group.viewport), &group.push, group.material, &group.calls))
        .collect();
    let key = hash_of(&(described, data.instance_key, if by_material { data.material_key } else { 0 }));
    DrawList {
        vertices: attributes.streams(data).into_iter().map(|(_, _, stream)| stream.buffer).collect(),
        indices: data.meshes.indices.clone(),
        materials: data.materials.sets().filter(|_| by_material).cloned(),
        groups,
        key,
        dependence: Dependence::GEOMETRY,
    }
}
