//! The scene: a hierarchy of nodes that place meshes, lights and cameras, and the counting of what changed.
//!
//! Parents always come before their children in `nodes`, so one pass in order composes all transforms and no walk recurses.

use super::animation::{Animation, Pose};
use super::camera::Camera;
use super::emission::Emission;
use super::extent::{Extent, Shape};
use super::light::{Light, PlacedLight};
use super::material::{Material, Texture};
use super::mesh::{Bounds, Instance, Mesh, bounds_of};
use super::{CameraId, LightId, MeshId, NodeId, SceneError};
use glam::{DAffine3, DVec3};
use rayon::prelude::*;
use std::collections::{BTreeMap, HashSet};
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// Frames per second of [`Scene::set_frame`].
pub const FRAME_RATE: f64 = 30.0;

/// A place in the hierarchy, and what stands there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Node {
    /// Name in the file; empty if it has none.
    pub name: String,
    /// The node in whose space `local` is given; `None`: the world.
    pub parent: Option<NodeId>,
    /// Node space to parent space; finite.
    pub local: DAffine3,
    /// A mesh that stands here.
    pub mesh: Option<MeshId>,
    /// A light that shines along -Z from here.
    pub light: Option<LightId>,
    /// A camera that looks along -Z from here.
    pub camera: Option<CameraId>,
}

/// How often each kind of thing changed. Equal counts mean that nothing of the kind changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Revisions {
    /// Meshes and where they stand.
    pub geometry: u64,
    /// Meshes alone: their vertices and triangles. Counted in `geometry` too.
    pub meshes: u64,
    /// Materials and textures.
    pub materials: u64,
    /// Textures alone. Counted in `materials` too.
    pub textures: u64,
    /// Punctual lights, emissive surfaces (their radiance and where they stand), the sky.
    pub lights: u64,
    /// Cameras and where they stand.
    pub camera: u64,
}

/// Tells scenes apart, so that what a renderer keeps of one is never taken for another's. A clone is a scene of its own.
#[derive(Debug)]
struct Identity(u64);

impl Default for Identity {
    fn default() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        Identity(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

impl Clone for Identity {
    fn clone(&self) -> Self {
        Identity::default()
    }
}

/// What is lit, what lights it, and from where it is seen. See the [module](super) for an overview.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The file's stem, or the built-in scene's name.
    pub name: String,
    /// A line on what the scene shows or tests (`asset.extras.description` of a glTF file).
    pub description: Option<String>,
    /// Cameras that stand in rooms which no light gets into (`asset.extras.dark` of a glTF file): whatever a technique shows there came through walls.
    pub dark_cameras: Vec<String>,
    /// What loading had to leave out or change, a sentence each.
    pub warnings: Vec<String>,
    pub(super) meshes: Vec<Mesh>,
    /// [`Revisions::meshes`] when each mesh changed last.
    pub(super) mesh_changes: Vec<u64>,
    /// Of each primitive of each mesh.
    pub(super) shapes: Vec<Vec<OnceLock<Shape>>>,
    pub(super) materials: Vec<Material>,
    pub(super) textures: Vec<Texture>,
    nodes: Vec<Node>,
    placements: Vec<Placement>,
    instances: Vec<Instance>,
    pub(super) lights: Vec<Light>,
    pub(super) cameras: Vec<Camera>,
    animations: Vec<Animation>,
    /// Transforms of animated nodes as they were before any animation.
    pub(super) rest_poses: BTreeMap<NodeId, Pose>,
    pub(super) sky: [f32; 3],
    pub(super) revisions: Revisions,
    identity: Identity,
    bounds: OnceLock<Option<Bounds>>,
    /// Of each primitive of each mesh.
    pub(super) emissions: Vec<Vec<OnceLock<Arc<Emission>>>>,
    pub(super) extent: OnceLock<Extent>,
}

/// What decides how a scene looks, see [`Scene::content`].
pub(super) struct Content<'a> {
    pub(super) meshes: &'a [Mesh],
    pub(super) materials: &'a [Material],
    pub(super) textures: &'a [Texture],
    pub(super) instances: &'a [Instance],
    pub(super) lights: Vec<PlacedLight>,
    pub(super) sky: [f32; 3],
}

/// What a node's place in the world comes to.
#[derive(Clone, Debug)]
struct Placement {
    world: DAffine3,
    children: Vec<NodeId>,
    instances: Range<usize>,
}

impl Scene {
    /// A scene without anything in it.
    pub fn empty(name: &str) -> Scene {
        Scene { name: name.to_owned(), ..Scene::default() }
    }

    /// A number that no other scene of this process has; clones differ from their originals.
    pub fn identity(&self) -> u64 {
        self.identity.0
    }

    /// All meshes.
    pub fn meshes(&self) -> &[Mesh] {
        &self.meshes
    }

    /// All materials.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// All textures.
    pub fn textures(&self) -> &[Texture] {
        &self.textures
    }

    /// All nodes, parents before their children.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// All punctual lights; [`Scene::placed_lights`] says where they are.
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// All cameras; [`Scene::camera_view`] says where they are.
    pub fn cameras(&self) -> &[Camera] {
        &self.cameras
    }

    /// All animations.
    pub fn animations(&self) -> &[Animation] {
        &self.animations
    }

    /// Radiance of the sky in W/(m² sr), alike from all directions.
    pub fn sky(&self) -> [f32; 3] {
        self.sky
    }

    /// All placed primitives, in the order of nodes and primitives.
    pub fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// How often each kind of thing changed.
    pub fn revisions(&self) -> Revisions {
        self.revisions
    }

    /// Node space to world space. The identity for a node that does not exist.
    pub fn world_transform(&self, node: NodeId) -> DAffine3 {
        self.placements.get(node.0).map_or(DAffine3::IDENTITY, |placement| placement.world)
    }

    /// All placed punctual lights, in the order of nodes.
    pub fn placed_lights(&self) -> Vec<PlacedLight> {
        let placed = self.nodes.iter().zip(&self.placements).enumerate();
        placed
            .filter_map(|(index, (node, placement))| {
                let id = node.light?;
                let light = &self.lights[id.0];
                Some(PlacedLight {
                    node: NodeId(index),
                    light: id,
                    position: placement.world.translation,
                    direction: (-placement.world.matrix3.z_axis).try_normalize().unwrap_or(DVec3::NEG_Z),
                    kind: light.kind,
                    intensity: light.intensity,
                    range: light.range,
                })
            })
            .collect()
    }

    /// What decides how the scene looks. The rest is names, bookkeeping, and what instances and placed lights follow from.
    pub(super) fn content(&self) -> Content<'_> {
        let Scene {
            name: _,
            description: _,
            dark_cameras: _,
            warnings: _,
            meshes,
            mesh_changes: _,
            shapes: _,
            materials,
            textures,
            nodes: _,
            placements: _,
            instances,
            lights: _,
            cameras: _,
            animations: _,
            rest_poses: _,
            sky,
            revisions: _,
            identity: _,
            bounds: _,
            emissions: _,
            extent: _,
        } = self;
        Content { meshes, materials, textures, instances, lights: self.placed_lights(), sky: *sky }
    }

    /// The tight box around all triangles in world space; `None` if there are none. Cached until the geometry changes.
    pub fn bounds(&self) -> Option<Bounds> {
        let all = || {
            self.instances
                .par_iter()
                .filter_map(|it| bounds_of(self.primitive(it), &it.world, |_| true))
                .reduce_with(Bounds::union)
        };
        *self.bounds.get_or_init(all)
    }

    pub(super) fn primitive(&self, instance: &Instance) -> &super::Primitive {
        &self.meshes[instance.mesh.0].primitives[instance.primitive]
    }

    pub(super) fn material_of(&self, instance: &Instance) -> &Material {
        &self.materials[self.primitive(instance).material.0]
    }

    /// Adds a node and so whatever it places.
    ///
    /// # Errors
    /// [`SceneError::UnknownId`] if its parent or what it places does not exist; [`SceneError::InvalidObject`] if its
    /// transform is not finite.
    pub fn add_node(&mut self, node: Node) -> Result<NodeId, SceneError> {
        let referred = [
            ("node", node.parent.map(|id| id.0), self.nodes.len()),
            ("mesh", node.mesh.map(|id| id.0), self.meshes.len()),
            ("light", node.light.map(|id| id.0), self.lights.len()),
            ("camera", node.camera.map(|id| id.0), self.cameras.len()),
        ];
        for (kind, index, count) in referred {
            index.map_or(Ok(()), |index| self.check(kind, index, count))?;
        }
        let id = NodeId(self.nodes.len());
        let world = self.compose(&node)?;
        let start = self.instances.len();
        if let Some(mesh) = node.mesh {
            let flips_winding = world.matrix3.determinant() < 0.0;
            let count = self.meshes[mesh.0].primitives.len();
            self.instances.extend((0..count).map(|primitive| Instance {
                node: id,
                mesh,
                primitive,
                world,
                flips_winding,
            }));
        }
        if let Some(parent) = node.parent {
            self.placements[parent.0].children.push(id);
        }
        self.nodes.push(node);
        self.placements.push(Placement { world, children: Vec::new(), instances: start..self.instances.len() });
        self.count_moved(&[id]);
        self.extent = OnceLock::new();
        Ok(id)
    }

    /// Moves a node, and with it all that hangs below it.
    ///
    /// # Errors
    /// [`SceneError::UnknownId`]; [`SceneError::InvalidObject`] if a transform in the world would not be finite, in which case
    /// nothing moves.
    pub fn set_local_transform(&mut self, node: NodeId, local: DAffine3) -> Result<(), SceneError> {
        self.check("node", node.0, self.nodes.len())?;
        self.extent = OnceLock::new();
        self.move_nodes(&[(node, local)])
    }

    /// Moves nodes while the scene is being watched, as an animation does: where render space has its zero and how large the scene counts stay as they were when it
    /// was first shown, so that what did not move need not be made again.
    ///
    /// # Errors
    /// As [`Scene::set_local_transform`]; nothing moves then.
    pub fn animate(&mut self, locals: &[(NodeId, DAffine3)]) -> Result<(), SceneError> {
        for (node, _) in locals {
            self.check("node", node.0, self.nodes.len())?;
        }
        self.move_nodes(locals)
    }

    fn move_nodes(&mut self, locals: &[(NodeId, DAffine3)]) -> Result<(), SceneError> {
        let changed: Vec<_> = locals.iter().copied().filter(|&(id, local)| self.nodes[id.0].local != local).collect();
        let mut moved: Vec<NodeId> = changed.iter().map(|&(id, _)| id).collect();
        let mut seen: HashSet<NodeId> = moved.iter().copied().collect();
        let mut next = 0;
        while let Some(&id) = moved.get(next) {
            moved.extend(self.placements[id.0].children.iter().filter(|child| seen.insert(**child)));
            next += 1;
        }
        moved.sort_unstable(); // parents first again

        let worlds_before: Vec<DAffine3> = moved.iter().map(|id| self.placements[id.0].world).collect();
        let locals_before: Vec<DAffine3> = changed.iter().map(|(id, _)| self.nodes[id.0].local).collect();
        changed.iter().for_each(|&(id, local)| self.nodes[id.0].local = local);
        for id in &moved {
            match self.compose(&self.nodes[id.0]) {
                Ok(world) => self.placements[id.0].world = world,
                Err(error) => {
                    changed.iter().zip(locals_before).for_each(|((id, _), local)| self.nodes[id.0].local = local);
                    moved.iter().zip(worlds_before).for_each(|(id, world)| self.placements[id.0].world = world);
                    return Err(error);
                }
            }
        }
        for id in &moved {
            let placement = &self.placements[id.0];
            let flips_winding = placement.world.matrix3.determinant() < 0.0;
            for instance in &mut self.instances[placement.instances.clone()] {
                (instance.world, instance.flips_winding) = (placement.world, flips_winding);
            }
        }
        self.count_moved(&moved);
        Ok(())
    }

    /// Puts all animated nodes where they are at a time, in seconds, and gives animated lights the strength that they have then. Before the first and after the last keyframe they stand
    /// still. What an animation does not touch stays; an animated node's transform is that of the file but for what is animated.
    pub fn set_time(&mut self, seconds: f64) {
        let mut poses = self.rest_poses.clone();
        for channel in self.animations.iter().flat_map(|animation| &animation.channels) {
            if let Some(pose) = poses.get_mut(&channel.node) {
                pose.apply(channel, seconds);
            }
        }
        let locals: Vec<_> = poses.iter().map(|(&node, pose)| (node, pose.transform())).collect();
        if let Err(error) = self.move_nodes(&locals) {
            tracing::warn!("the animation stands still at {seconds} s: {error}");
        }
        self.set_animated_lights(seconds);
    }

    /// [`Scene::set_time`] for a frame of a sequence: frame N is at N/30 s.
    pub fn set_frame(&mut self, frame: u32) {
        self.set_time(f64::from(frame) / FRAME_RATE);
    }

    /// Adds an animation; the present transforms of its nodes are those from which it departs.
    ///
    /// # Errors
    /// [`SceneError::UnknownId`] if it moves a node, or changes a light, that does not exist.
    pub fn add_animation(&mut self, animation: Animation) -> Result<(), SceneError> {
        for channel in &animation.channels {
            self.check("node", channel.node.0, self.nodes.len())?;
        }
        for channel in &animation.lights {
            self.check("light", channel.light.0, self.lights.len())?;
        }
        for channel in &animation.channels {
            let local = &self.nodes[channel.node.0].local;
            self.rest_poses.entry(channel.node).or_insert_with(|| Pose::of(local));
        }
        self.animations.push(animation);
        self.extent = OnceLock::new();
        Ok(())
    }

    /// Gives the nodes that the file describes by parts those parts, which a matrix does not always give back.
    pub(super) fn set_rest_pose(&mut self, node: NodeId, pose: Pose) {
        if let Some(rest) = self.rest_poses.get_mut(&node) {
            *rest = pose;
            self.extent = OnceLock::new();
        }
    }

    /// Counts the changes that moving, or adding, these nodes makes.
    fn count_moved(&mut self, moved: &[NodeId]) {
        let any = |test: &dyn Fn(&Node, &[Instance]) -> bool| {
            let changed = moved
                .iter()
                .any(|id| test(&self.nodes[id.0], &self.instances[self.placements[id.0].instances.clone()]));
            u64::from(changed)
        };
        let geometry = any(&|_, instances| !instances.is_empty());
        let lights =
            any(&|node, instances| node.light.is_some() || instances.iter().any(|it| self.material_of(it).emits()));
        let camera = any(&|node, _| node.camera.is_some());
        self.revisions.geometry += geometry;
        self.revisions.lights += lights;
        self.revisions.camera += camera;
        if geometry != 0 {
            self.bounds = OnceLock::new();
        }
    }

    /// Forgets where the scene is and how far it reaches.
    pub(super) fn forget_bounds(&mut self) {
        self.bounds = OnceLock::new();
        self.extent = OnceLock::new();
    }

    fn compose(&self, node: &Node) -> Result<DAffine3, SceneError> {
        let parent = node.parent.map_or(DAffine3::IDENTITY, |parent| self.placements[parent.0].world);
        let world = parent * node.local;
        match world.is_finite() && node.local.is_finite() {
            true => Ok(world),
            false => Err(self.invalid("node", &node.name, "its transform in the world is not finite".into())),
        }
    }
}
