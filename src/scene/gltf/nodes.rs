//! The active scene's nodes with their transforms, lights, cameras and animations.

use super::accessor::Integers;
use super::document::{self, get};
use super::loader::Loader;
use crate::scene::animation::{Animation, Channel, Interpolation, Pose, Property, unit_quaternion};
use crate::scene::{Camera, CameraId, Light, LightId, LightKind, MeshId, Node, NodeId, Projection};
use glam::{DAffine3, DMat4, DVec3};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

/// A node of the active scene; `parent` is its place in the list of branches, which has parents before children.
pub(super) struct Branch<'a> {
    index: usize,
    parent: Option<usize>,
    pub(super) node: &'a document::Node,
}

/// The lights that nodes place, by their numbers in the file; `None` for those that are left out.
pub(super) type LightIds = HashMap<usize, Option<LightId>>;

impl<'a> Loader<'a> {
    /// All nodes below the active scene's roots, depth first. A node that is reached twice, hence every cycle, is a fault.
    pub(super) fn read_tree(&mut self) -> Result<Vec<Branch<'a>>, String> {
        let document = self.document;
        let mut pending: Vec<(usize, Option<usize>)> =
            self.roots()?.into_iter().rev().map(|root| (root, None)).collect();
        let mut reached = vec![false; document.nodes.len()];
        let mut tree = Vec::new();
        while let Some((index, parent)) = pending.pop() {
            let node = get(&document.nodes, index, "node")?;
            if std::mem::replace(&mut reached[index], true) {
                return Err(format!(
                    "node {index} is reached twice; a node may have only one parent, and none below itself"
                ));
            }
            pending.extend(node.children.iter().rev().map(|&child| (child, Some(tree.len()))));
            tree.push(Branch { index, parent, node });
        }
        Ok(tree)
    }

    /// The default scene's roots, else the first scene's, else every node that is nobody's child.
    fn roots(&mut self) -> Result<Vec<usize>, String> {
        let document = self.document;
        if let (None, true) = (document.scene, document.scenes.is_empty()) {
            if !document.nodes.is_empty() {
                self.warn("the file has no scene; all its nodes are shown".into());
            }
            let nodes = (0..document.nodes.len()).filter_map(|index| get(&document.nodes, index, "node").ok());
            let children: HashSet<usize> = nodes.flat_map(|node| node.children.iter().copied()).collect();
            return Ok((0..document.nodes.len()).filter(|index| !children.contains(index)).collect());
        }
        Ok(get(&document.scenes, document.scene.unwrap_or(0), "scene")?.nodes.clone())
    }

    pub(super) fn add_nodes(
        &mut self,
        tree: &[Branch],
        meshes: &HashMap<usize, MeshId>,
    ) -> Result<(Vec<NodeId>, LightIds), String> {
        let mut ids = Vec::with_capacity(tree.len());
        let (mut cameras, mut lights) = (HashMap::new(), LightIds::new());
        let mut skinned = 0;
        for branch in tree {
            let node = branch.node;
            skinned += usize::from(node.mesh.is_some() && node.skin.is_some());
            let placed = Node {
                name: node.name.clone().unwrap_or_default(),
                parent: branch.parent.map(|parent| ids[parent]),
                local: local_transform(node),
                mesh: node.mesh.map(|mesh| meshes[&mesh]),
                light: node.light().and_then(|light| *lights.entry(light).or_insert_with(|| self.add_light(light))),
                camera: node
                    .camera
                    .and_then(|camera| *cameras.entry(camera).or_insert_with(|| self.add_camera(camera))),
            };
            let id = self.scene.add_node(placed).map_err(|error| format!("node {}: {error}", branch.index))?;
            ids.push(id);
        }
        if skinned > 0 {
            self.warn(format!("skins are not supported: {skinned} skinned meshes are shown as they were modelled"));
        }
        Ok((ids, lights))
    }

    /// A light that is not valid is left out: the rest of the scene is sound without it.
    fn add_light(&mut self, index: usize) -> Option<LightId> {
        let added = self.document.light(index).and_then(|light| {
            let light = convert_light(&light)?;
            self.scene.add_light(light).map_err(|error| error.to_string())
        });
        added.map_err(|fault| self.warn(format!("light {index} is left out: {fault}"))).ok()
    }

    fn add_camera(&mut self, index: usize) -> Option<CameraId> {
        let added = get(&self.document.cameras, index, "camera").and_then(|camera| {
            let projection = convert_projection(camera).ok_or("its projection is missing or of no known kind")?;
            let camera = Camera { name: camera.name.clone().unwrap_or_default(), projection };
            self.scene.add_camera(camera).map_err(|error| error.to_string())
        });
        added.map_err(|fault| self.warn(format!("camera {index} is left out: {fault}"))).ok()
    }

    /// Adds all animations, without the channels that move nothing in the active scene or are not valid.
    pub(super) fn add_animations(
        &mut self,
        tree: &[Branch],
        ids: &[NodeId],
        light_ids: &LightIds,
    ) -> Result<(), String> {
        let nodes: HashMap<usize, usize> = tree.iter().enumerate().map(|(at, branch)| (branch.index, at)).collect();
        for index in 0..self.document.animations.len() {
            let animation = match get(&self.document.animations, index, "animation") {
                Ok(animation) => animation,
                Err(fault) => {
                    self.warn(format!("an animation is left out: {fault}"));
                    continue;
                }
            };
            let (mut channels, mut lights) = (Vec::new(), Vec::new());
            let mut poses = BTreeMap::new();
            for number in 0..animation.channels.len() {
                match self.read_channel(animation, number, &nodes) {
                    Ok(Some((at, mut channel))) => {
                        channel.node = ids[at];
                        poses.insert(ids[at], pose(tree[at].node));
                        channels.push(channel);
                    }
                    Ok(None) => match self.read_light_channel(animation, number, light_ids) {
                        Ok(channel) => lights.extend(channel),
                        Err(fault) => self.warn(format!("animation {index}, channel {number} is left out: {fault}")),
                    },
                    Err(fault) => self.warn(format!("animation {index}, channel {number} is left out: {fault}")),
                }
            }
            if !channels.is_empty() || !lights.is_empty() {
                let animation = Animation { name: animation.name.clone().unwrap_or_default(), channels, lights };
                self.scene.add_animation(animation).map_err(|error| error.to_string())?;
                poses
                    .into_iter()
                    .filter_map(|(id, pose)| Some((id, pose?)))
                    .for_each(|(id, pose)| self.scene.set_rest_pose(id, pose));
            }
        }
        Ok(())
    }

    /// A channel and the branch that it moves; `None` if it moves none, or morph targets.
    fn read_channel(
        &self,
        animation: &document::Animation,
        number: usize,
        nodes: &HashMap<usize, usize>,
    ) -> Result<Option<(usize, Channel)>, String> {
        let channel = get(&animation.channels, number, "channel")?;
        let property = match channel.target.path.as_str() {
            "translation" => Property::Translation,
            "rotation" => Property::Rotation,
            "scale" => Property::Scale,
            // Morph weights, and what is no part of a node.
            _ => return Ok(None),
        };
        let Some(&at) = channel.target.node.and_then(|node| nodes.get(&node)) else {
            return Ok(None);
        };
        let sampler = get(&animation.samplers, channel.sampler, "sampler")?;
        let (interpolation, values_per_key) = interpolation_of(sampler)?;
        let times = self.times(sampler)?;
        let values: Vec<[f32; 4]> = if property == Property::Rotation {
            self.accessors.vectors::<4>(sampler.output, Integers::Normalized)?
        } else {
            let vectors = self.accessors.vectors::<3>(sampler.output, Integers::Normalized)?;
            vectors.into_iter().map(|[x, y, z]| [x, y, z, 0.0]).collect()
        };
        if values.len() != times.len() * values_per_key {
            return Err(format!("it has {} values for {} times", values.len(), times.len()));
        }
        if !values.iter().flatten().all(|value| value.is_finite()) {
            return Err("a value is not finite".into());
        }
        Ok(Some((at, Channel { node: NodeId(0), property, interpolation, times, values })))
    }

    /// The times of a sampler's keyframes.
    pub(super) fn times(&self, sampler: &document::AnimationSampler) -> Result<Vec<f32>, String> {
        let times = self.accessors.scalars(sampler.input)?;
        let grows = times.is_sorted_by(|a, b| a < b) && times.iter().all(|time| time.is_finite());
        if times.is_empty() || !grows { Err("its times do not grow".into()) } else { Ok(times) }
    }
}

/// How a sampler interpolates, and how many values a keyframe of it has.
pub(super) fn interpolation_of(sampler: &document::AnimationSampler) -> Result<(Interpolation, usize), String> {
    match sampler.interpolation.as_deref() {
        None | Some("LINEAR") => Ok((Interpolation::Linear, 1)),
        Some("STEP") => Ok((Interpolation::Step, 1)),
        Some("CUBICSPLINE") => Ok((Interpolation::CubicSpline, 3)),
        Some(other) => Err(format!("its interpolation {other:?} is not known")),
    }
}

/// Translation, rotation and scale as the file gives them; `None` for a node with a matrix.
fn pose(node: &document::Node) -> Option<Pose> {
    node.matrix.is_none().then(|| Pose {
        translation: node.translation.map_or(DVec3::ZERO, DVec3::from),
        rotation: unit_quaternion(node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0])),
        scale: node.scale.map_or(DVec3::ONE, DVec3::from),
    })
}

fn local_transform(node: &document::Node) -> DAffine3 {
    match (&node.matrix, pose(node)) {
        (Some(matrix), _) => DAffine3::from_mat4(DMat4::from_cols_array(matrix)),
        (None, pose) => pose.map_or(DAffine3::IDENTITY, |pose| pose.transform()),
    }
}

fn convert_light(light: &document::Light) -> Result<Light, String> {
    let kind = match light.kind.as_str() {
        "point" => LightKind::Point,
        "directional" => LightKind::Directional,
        "spot" => {
            let cone = light.spot.as_ref().ok_or("it is a spot without a cone")?;
            let outer_angle = cone.outer_cone_angle.unwrap_or(FRAC_PI_4).min(FRAC_PI_2);
            LightKind::Spot { inner_angle: cone.inner_cone_angle.unwrap_or(0.0).min(outer_angle), outer_angle }
        }
        other => return Err(format!("its kind {other:?} is not known")),
    };
    let strength = light.intensity.unwrap_or(1.0);
    Ok(Light {
        name: light.name.clone().unwrap_or_default(),
        kind,
        intensity: light.color.unwrap_or([1.0; 3]).map(|channel| channel * strength),
        range: light.range.filter(|range| range.is_finite() && *range > 0.0),
    })
}

fn convert_projection(camera: &document::Camera) -> Option<Projection> {
    match camera.kind.as_str() {
        "perspective" => camera.perspective.as_ref().map(|it| Projection::Perspective {
            vertical_fov: it.yfov,
            aspect: it.aspect_ratio,
            near: it.znear,
        }),
        "orthographic" => camera.orthographic.as_ref().map(|it| Projection::Orthographic {
            half_width: it.xmag,
            half_height: it.ymag,
            near: it.znear,
            far: it.zfar,
        }),
        _ => None,
    }
}
