//! Lists of the scene's surfaces behind each texel of some views: what they are made from and where they lie.

use ash::vk;

use super::list_views::ListView;
use super::options::PhotonOptions;
use crate::frame::geometry::{DrawView, Geometry};
use crate::frame::scene_data::{DrawnInstance, SceneData};
use crate::graph::bindings::BufferRef;
use crate::shaders::groups::PhotonLists;
use crate::shaders::types;

pub(super) const MOST_LEVELS: usize = 4;

/// What the lists are made of.
pub(crate) struct ListInputs<'a> {
    pub(crate) data: &'a SceneData,
    pub(crate) geometry: &'a Geometry,
    /// For the projection `camera`.
    pub(crate) camera: Option<&'a types::Camera>,
    pub(crate) options: &'a PhotonOptions,
}

/// The scene's lists.
#[derive(Clone, Copy)]
pub(crate) struct SceneLists {
    pub(crate) resolution: u32,
    pub(crate) view_count: u32,
    pub(crate) views: BufferRef<[f32; 4]>,
    /// Four words for each texel of each view (glsl/photon_lists/node.glsl).
    pub(crate) pixels: BufferRef<u32>,
    pub(crate) nodes: BufferRef<[u32; 4]>,
    /// How many nodes there are, or would be if the pool held them.
    pub(crate) node_count: BufferRef<u32>,
    pub(crate) blocks: Blocks,
}

/// Occupied depths of blocks of texels, level by level.
#[derive(Clone, Copy)]
pub(crate) struct Blocks {
    pub(crate) slices: BufferRef<[u32; 4]>,
    pub(crate) top: u32,
    /// The first block of each level, from level 1.
    pub(crate) first_of_level: [u32; MOST_LEVELS],
}

impl SceneLists {
    /// What the programs that draw the view `view_index` need to know.
    pub(super) fn drawn(&self, view_index: u32) -> types::DrawnListView {
        let SceneLists { resolution, view_count, nodes, .. } = *self;
        types::DrawnListView { view_index, view_count, resolution, capacity: nodes.count() as u32 }
    }

    /// As passes read them.
    pub(super) fn group(&self) -> PhotonLists {
        PhotonLists {
            list_views: self.views.texels(vk::Format::R32G32B32A32_SFLOAT),
            list_pixels: self.pixels.texels(vk::Format::R32G32B32A32_UINT),
            list_nodes: self.nodes.texels(vk::Format::R32G32B32A32_UINT),
        }
    }
}

/// Which instances a pass for opaque surfaces draws; the others are cut out by a texture's alpha.
pub(super) fn is_solid(drawn: &DrawnInstance) -> bool {
    !(drawn.masked && drawn.textured)
}

/// What is drawn of each view.
pub(super) fn draw_views(views: &[ListView], lists: &SceneLists) -> Vec<DrawView> {
    (0..).zip(views).map(|(index, view)| view.draw_view(lists.drawn(index))).collect()
}
