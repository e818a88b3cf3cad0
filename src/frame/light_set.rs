//! The lights of a frame: punctual lights as they are, a bounded number of cosine emitters for all emissive surfaces, a
//! bounded number of directional lights for the sky; and the views from them.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

use super::scene_data::SceneData;
use super::view_layout::{Atlas, LaidOutView, ViewShape, ViewSource};
use crate::graph::hash_of;
use crate::scene::{LightKind, PlacedLight, Scene};
use crate::shaders::types;
use crate::vulkan::Device;

const POINT: u32 = 0;
const SPOT: u32 = 1;
const DIRECTIONAL: u32 = 2;
const EMITTER: u32 = 3;

/// A spot wider than this half angle (tangent 3.7) is seen through a cube instead of one stretched view.
const WIDEST_CONE: f64 = 75.5 * PI / 180.0;

/// The near plane of a light's view over its distance from the origin, 512 units in the last place: of what is nearer rounding may decide whether it lies before
/// the light or behind it. Depth is reversed and float32, near/z, so that a near plane costs no precision however close it is.
const NEAR: f64 = 1.0 / 32768.0;
/// The same over the scene's radius, for a light that stands on the origin.
const LEAST_NEAR: f64 = 1e-9;
/// How far before its surface an emitter's view along the normal stands where vertices are rounded coarsely, over its near plane and over the scene's radius. Such a
/// rasteriser (SwiftShader) takes which way a triangle faces from its corners as they are projected, not as they are clipped: a corner in the plane
/// of the eye overflows, and walls that end in the emitter's plane would be missing.
const LIFT: f64 = 2.0;
const LEAST_LIFT: f64 = 2e-6;

/// What stands for the lights, and how large their views are, in texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct LightDetail {
    /// Side of a spot, directional or point-face light view.
    pub(crate) resolution: u32,
    /// Cosine emitters that stand for all emissive surfaces together.
    pub(crate) emitter_samples: u32,
    /// Side of an emitter sample's hemicube top.
    pub(crate) emitter_resolution: u32,
    /// Directional lights that stand for the sky.
    pub(crate) sky_samples: u32,
    /// Half width of the filter over depths.
    pub(crate) filter_radius: u32,
}

/// All lights of a frame and their views.
#[derive(Clone, Debug, Default)]
pub(crate) struct LightSet {
    /// Names the lights and the surfaces that their views are made for.
    pub(crate) key: u64,
    pub(crate) lights: Vec<types::Light>,
    /// The first ones are no samples of anything.
    pub(crate) punctual_count: u32,
    pub(crate) atlas: Atlas,
}

impl LightSet {
    /// The lights of the scene as it is now; `held` if nothing that they depend on changed.
    pub(crate) fn update(
        held: LightSet,
        scene: &Scene,
        data: &SceneData,
        detail: LightDetail,
        device: &Device,
    ) -> LightSet {
        let revisions = scene.revisions();
        // Directional views are fitted to the geometry.
        let place = data.origin.to_array().map(f64::to_bits);
        let key = hash_of(&(scene.identity(), revisions.geometry, revisions.lights, detail, place));
        if held.key == key {
            return held;
        }
        let lifted = device.traits().plane_depths;
        let mut builder = Builder { data, detail, lifted, lights: Vec::new(), shapes: Vec::new(), corners: None };
        builder.add_punctual(scene);
        let punctual_count = builder.lights.len() as u32;
        builder.add_emitters(scene);
        builder.add_sky(scene);
        let largest_side = device.limits().max_image_dimension2_d;
        let atlas = Atlas::new(builder.shapes, detail.filter_radius, largest_side);
        LightSet { key, lights: builder.lights, punctual_count, atlas }
    }
}

impl LightSet {
    /// The views of all lights, or of the punctual ones, which come first.
    pub(crate) fn views_of(&self, punctual: bool) -> &[LaidOutView] {
        let end = self.atlas.views.partition_point(|view| !punctual || view.record.light < self.punctual_count);
        &self.atlas.views[..end]
    }
}

struct Builder<'a> {
    data: &'a SceneData,
    detail: LightDetail,
    /// Whether views along the normals of emitters stand before their surfaces.
    lifted: bool,
    lights: Vec<types::Light>,
    shapes: Vec<ViewShape>,
    /// All vertices in render space, gathered when the first directional light needs them.
    corners: Option<Vec<DVec3>>,
}

impl Builder<'_> {
    /// `extent`: of the surface that the view stands on, metres.
    fn source(&self, origin_rs: DVec3, extent: f64, resolution: u32, intensity: [f32; 3]) -> ViewSource {
        let strength = f64::from(intensity.into_iter().fold(0.0, f32::max));
        ViewSource {
            origin_rs,
            near: (origin_rs.length().max(extent) * NEAR).max(LEAST_NEAR * self.data.radius),
            resolution: resolution.next_multiple_of(16),
            strength,
            light: self.lights.len() as u32,
        }
    }

    fn add(&mut self, mut light: types::Light, shapes: Vec<ViewShape>) {
        light.first_view = self.shapes.len() as u32;
        light.view_count = shapes.len() as u32;
        self.shapes.extend(shapes);
        self.lights.push(light);
    }

    fn add_punctual(&mut self, scene: &Scene) {
        for placed in shining_lights(scene) {
            let axes = axes_of(scene.world_transform(placed.node).matrix3);
            let source = self.source(placed.position - self.data.origin, 0.0, self.detail.resolution, placed.intensity);
            let light = punctual_light(&placed, self.data.origin);
            let shapes = match placed.kind {
                LightKind::Point => ViewShape::cube(source, axes),
                LightKind::Spot { outer_angle, .. } if f64::from(outer_angle) > WIDEST_CONE => {
                    ViewShape::cube(source, axes)
                }
                LightKind::Spot { outer_angle, .. } => ViewShape::cone(source, axes, f64::from(outer_angle).tan()),
                LightKind::Directional => self.parallel(scene, source, axes),
            };
            self.add(light, shapes);
        }
    }

    fn add_emitters(&mut self, scene: &Scene) {
        for sample in scene.emitter_samples(self.detail.emitter_samples as usize) {
            if sample.power.iter().all(|&channel| channel <= 0.0) {
                continue;
            }
            // The view turns with the surface, so that a turned scene keeps its picture.
            let node = scene.world_transform(sample.node).matrix3;
            let sides: &[f64] = if sample.two_sided { &[1.0, -1.0] } else { &[1.0] };
            for side in sides {
                let normal = sample.normal * *side;
                let intensity = sample.power.map(|power| (f64::from(power) / (PI * sides.len() as f64)) as f32);
                let position = sample.position - self.data.origin;
                let source = self.source(position, sample.area.sqrt(), self.detail.emitter_resolution, intensity);
                let light = types::Light {
                    position_rs: position.as_vec3().to_array(),
                    kind: EMITTER,
                    direction: normal.as_vec3().to_array(),
                    first_view: 0,
                    intensity,
                    area_over_pi: (sample.area / PI) as f32,
                    spot_scale: 0.0,
                    spot_offset: 1.0,
                    range: 0.0,
                    view_count: 0,
                };
                let mut shapes = ViewShape::hemicube(source, axes_around(normal, node));
                if self.lifted {
                    shapes[0] = shapes[0].lifted((LIFT * source.near).max(LEAST_LIFT * self.data.radius));
                }
                self.add(light, shapes);
            }
        }
    }

    /// The sky of radiance L as n directional lights of irradiance 4πL/n, spread evenly (spherical Fibonacci points).
    fn add_sky(&mut self, scene: &Scene) {
        let sky = scene.sky();
        if sky.iter().all(|&channel| channel <= 0.0) || scene.bounds().is_none() {
            return;
        }
        let count = self.detail.sky_samples;
        let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
        for index in 0..count {
            let share = f64::from(index) + 0.5;
            let (height, azimuth) = (1.0 - 2.0 * share / f64::from(count), 2.0 * PI * share / golden);
            let width = (1.0 - height * height).sqrt();
            let direction = -DVec3::new(width * azimuth.cos(), height, width * azimuth.sin());
            let intensity = sky.map(|radiance| (f64::from(radiance) * 4.0 * PI / f64::from(count)) as f32);
            let light = types::Light {
                position_rs: [0.0; 3],
                kind: DIRECTIONAL,
                direction: direction.as_vec3().to_array(),
                first_view: 0,
                intensity,
                area_over_pi: 0.0,
                spot_scale: 0.0,
                spot_offset: 1.0,
                range: 0.0,
                view_count: 0,
            };
            let source = self.source(DVec3::ZERO, 0.0, self.detail.resolution, intensity);
            let shapes = self.parallel(scene, source, axes_around(direction, DMat3::IDENTITY));
            self.add(light, shapes);
        }
    }

    /// A parallel view that just holds what matters of the scene. Every vertex counts, not the corners of a box: a scene that turns
    /// together with its light keeps its view. What is farther away casts its shadow into the view, and gets none.
    fn parallel(&mut self, scene: &Scene, source: ViewSource, axes: DMat3) -> Vec<ViewShape> {
        let origin = self.data.origin;
        let corners = self.corners.get_or_insert_with(|| vertices_of(scene, origin));
        let middle = self.data.middle_rs;
        let (to_view, within) = (axes.transpose(), (self.data.reach * (1.0 + 1e-9)).powi(2));
        let (mut low, mut high, mut start) = (DVec3::INFINITY, DVec3::NEG_INFINITY, f64::INFINITY);
        for corner in corners {
            let point = to_view * *corner;
            start = start.min(point.z);
            if corner.distance_squared(middle) <= within {
                low = low.min(point);
                high = high.max(point);
            }
        }
        if low.x > high.x { Vec::new() } else { ViewShape::parallel(source, axes, [low, high], start) }
    }
}

/// The placed punctual lights that are not black.
pub(crate) fn shining_lights(scene: &Scene) -> Vec<PlacedLight> {
    let mut lights = scene.placed_lights();
    lights.retain(|placed| placed.intensity.iter().any(|&channel| channel > 0.0));
    lights
}

/// A punctual light as shaders know it, in render space, without views.
pub(crate) fn punctual_light(placed: &PlacedLight, origin: DVec3) -> types::Light {
    let (kind, (spot_scale, spot_offset)) = match placed.kind {
        LightKind::Point => (POINT, (0.0, 1.0)),
        LightKind::Directional => (DIRECTIONAL, (0.0, 1.0)),
        LightKind::Spot { inner_angle, outer_angle } => {
            (SPOT, spot_falloff(f64::from(inner_angle), f64::from(outer_angle)))
        }
    };
    types::Light {
        position_rs: (placed.position - origin).as_vec3().to_array(),
        kind,
        direction: placed.direction.as_vec3().to_array(),
        first_view: 0,
        intensity: placed.intensity,
        area_over_pi: 0.0,
        spot_scale,
        spot_offset,
        range: placed.range.unwrap_or(0.0),
        view_count: 0,
    }
}

fn vertices_of(scene: &Scene, origin: DVec3) -> Vec<DVec3> {
    let mut vertices = Vec::new();
    for instance in scene.instances() {
        let primitive = &scene.meshes()[instance.mesh.0].primitives[instance.primitive];
        vertices.extend(
            primitive
                .positions
                .iter()
                .map(|&position| instance.world.transform_point3(DVec3::from(position.map(f64::from))) - origin),
        );
    }
    vertices
}

/// glTF 2.0, KHR_lights_punctual: attenuation = clamp(cosθ·scale + offset, 0, 1)².
fn spot_falloff(inner: f64, outer: f64) -> (f32, f32) {
    let scale = 1.0 / (inner.cos() - outer.cos()).max(0.001);
    (scale as f32, (-outer.cos() * scale) as f32)
}

/// Right, down and forward of a light's node, which shines along its -Z.
fn axes_of(node: DMat3) -> DMat3 {
    axes_around(-node.z_axis, node)
}

/// Right, down and forward, with forward given and right as near as can be to the node's x axis.
fn axes_around(forward: DVec3, node: DMat3) -> DMat3 {
    let forward = forward.try_normalize().unwrap_or(DVec3::NEG_Z);
    let across = |axis: DVec3| {
        let axis = axis.try_normalize()?;
        let right = axis - forward * forward.dot(axis);
        (right.length_squared() > 1e-3).then(|| right.normalize())
    };
    let right = across(node.x_axis).or_else(|| across(node.y_axis)).unwrap_or_else(|| forward.any_orthonormal_vector());
    DMat3::from_cols(right, forward.cross(right), forward)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_right_handed_towards_down_and_forward() {
        for forward in [DVec3::X, DVec3::NEG_Y, DVec3::new(1.0, 2.0, -3.0)] {
            let axes = axes_around(forward, DMat3::IDENTITY);
            assert!((axes.determinant() - 1.0).abs() < 1e-12);
            assert!(axes.z_axis.abs_diff_eq(forward.normalize(), 1e-12));
        }
    }

    #[test]
    fn spot_falloff_is_one_inside_and_zero_outside() {
        let (scale, offset) = spot_falloff(0.3, 0.6);
        let at = |angle: f32| (angle.cos() * scale + offset).clamp(0.0, 1.0).powi(2);
        assert!((at(0.3) - 1.0).abs() < 1e-5 && at(0.6) < 1e-5 && at(0.45) > 0.1);
    }
}
