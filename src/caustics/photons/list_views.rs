//! The views that per-pixel lists are drawn from: the camera's, as the paper has it, or parallel ones along fixed axes that hold the whole scene.

use glam::{DVec3, Mat4, Vec3, Vec4};

use super::options::{ListProjection, PhotonOptions};
use crate::frame::geometry::DrawView;
use crate::frame::instances::OrientedBox;
use crate::frame::scene_data::SceneData;
use crate::shaders::types;

/// Texels around the scene. What ends at its bounds, such as a room's floor, ends between two texels then, and lacks no sliver.
const MARGIN: f64 = 1.0;

/// A view as shaders read it (glsl/photon_lists/view.glsl), in eight texels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ListView {
    pub(crate) texels: [Vec4; 8],
}

impl ListView {
    fn perspective(&self) -> bool {
        self.near() > 0.0
    }

    fn near(&self) -> f32 {
        self.texels[4].w
    }

    fn far(&self) -> f32 {
        self.texels[5].w
    }

    /// What is drawn of it into its square; the first view's is the topmost.
    pub(crate) fn draw_view(&self, drawn: types::DrawnListView) -> DrawView {
        let types::DrawnListView { view_index, resolution, .. } = drawn;
        let [x, y, w, depth] = [0, 1, 2, 3].map(|row| self.texels[row]);
        let scale = 2.0 / resolution as f32;
        let z = if self.perspective() { Vec4::W * self.near() } else { Vec4::W - depth / self.far() };
        let matrix = Mat4::from_cols(x * scale - w, y * scale - w, z, w).transpose();
        let rectangle = [0, view_index * resolution, resolution, resolution];
        let push = bytemuck::bytes_of(&drawn).to_vec();
        DrawView::new(&matrix.to_cols_array_2d(), Some((rectangle.map(|side| side as f32), rectangle)), Some(push))
    }
}

/// The views that the settings ask for.
pub(crate) fn list_views(data: &SceneData, camera: Option<&types::Camera>, options: &PhotonOptions) -> Vec<ListView> {
    let side = f64::from(options.resolution);
    match (options.projection, camera) {
        (ListProjection::Camera, Some(camera)) => vec![camera_view(data, camera, side)],
        _ => axes(options.views).into_iter().map(|axes| parallel_view(data, axes, side)).collect(),
    }
}

/// Right, down and forward of each view. Three look along the world's axes. Two leave the vertical and a diagonal that sees both pairs of a room's
/// walls, a single one is the diagonal of space, which sees all six faces alike.
fn axes(views: u32) -> Vec<[DVec3; 3]> {
    let looking = |forward: DVec3, up: DVec3| {
        let right = up.cross(forward).normalize();
        [right, forward.cross(right).normalize(), forward.normalize()]
    };
    match views {
        1 => vec![looking(DVec3::NEG_ONE, DVec3::Y)],
        2 => vec![looking(DVec3::NEG_Y, DVec3::Z), looking(DVec3::new(1.0, 0.0, -1.0), DVec3::Y)],
        _ => vec![looking(DVec3::NEG_Y, DVec3::Z), looking(DVec3::X, DVec3::Y), looking(DVec3::NEG_Z, DVec3::Y)],
    }
}

/// The least and the largest coordinate along `axis` of what matters of the scene's instances: specks far away take no texels.
fn extent(data: &SceneData, axis: DVec3) -> [f64; 2] {
    let of = |bulk: OrientedBox| {
        let along = |vector: [f32; 3]| Vec3::from(vector).as_dvec3().dot(axis);
        let reach: f64 = bulk.half_axes_rs.iter().map(|&half| along(half).abs()).sum();
        [along(bulk.center_rs) - reach, along(bulk.center_rs) + reach]
    };
    let join = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
    let drawn = data.drawn.iter().filter(|drawn| drawn.index_count > 0);
    drawn.filter_map(|drawn| drawn.bulk).map(of).reduce(join).unwrap_or([-1.0, 1.0])
}

fn parallel_view(data: &SceneData, [right, down, forward]: [DVec3; 3], side: f64) -> ListView {
    let least = 1e-3 * data.reach;
    // The texels' edges, and their size.
    let lateral = |axis: DVec3| {
        let [low, high] = extent(data, axis);
        let texel = (high - low).max(least) / (side - 2.0 * MARGIN);
        (low - MARGIN * texel, texel)
    };
    let ((left, width), (top, height)) = (lateral(right), lateral(down));
    let [nearest, farthest] = extent(data, forward);
    let margin = 0.01 * (farthest - nearest).max(least);
    let start = nearest - margin;
    let row = |axis: DVec3, offset: f64, unit: f64| (axis / unit).as_vec3().extend((-offset / unit) as f32);
    let base = right * left + down * top + forward * start;
    ListView {
        texels: [
            row(right, left, width),
            row(down, top, height),
            Vec4::W,
            row(forward, start, 1.0),
            base.as_vec3().extend(0.0),
            forward.as_vec3().extend((farthest + margin - start) as f32),
            (right * width).as_vec3().extend(0.0),
            (down * height).as_vec3().extend(width.max(height) as f32),
        ],
    }
}

/// What the camera sees, on a square of texels whatever the picture's shape.
fn camera_view(data: &SceneData, camera: &types::Camera, side: f64) -> ListView {
    let vector = |axis: [f32; 3]| Vec3::from(axis).as_dvec3();
    let (eye, forward) = (vector(camera.position_rs), vector(camera.forward));
    let [right, down] = [camera.right_scaled, camera.down_scaled].map(vector);
    let half = 0.5 * side;
    // Metres from a texel to the next: at distance 1 in perspective, everywhere in a parallel view.
    let (across, below) = (right / half, down / half);
    let corner = -right - down;
    let along = forward.as_vec3().extend(-forward.dot(eye) as f32);
    let perspective = camera.depth_range == 0.0;
    let near = f64::from(camera.near);
    let far = (extent(data, forward)[1] - forward.dot(eye)).max(2.0 * near) * 1.01;
    let w = if perspective { along } else { Vec4::W };
    // x = w·(ndc + 1)·side/2.
    let lateral = |axis: DVec3| {
        let unit = axis * (half / axis.length_squared());
        unit.as_vec3().extend(-unit.dot(eye) as f32) + w * half as f32
    };
    ListView {
        texels: [
            lateral(right),
            lateral(down),
            w,
            along,
            (if perspective { eye } else { eye + corner }).as_vec3().extend(if perspective {
                near as f32
            } else {
                0.0
            }),
            (if perspective { forward + corner } else { forward }).as_vec3().extend(far as f32),
            across.as_vec3().extend(0.0),
            below.as_vec3().extend(across.length().max(below.length()) as f32),
        ],
    }
}
