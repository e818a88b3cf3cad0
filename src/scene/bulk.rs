//! Where a [`Scene`] is, at rest, and what of it matters now (`extent`).

use super::animation::Pose;
use super::extent::{Bulk, Extent, Shape, reach_of};
use super::mesh::{Bounds, Instance, bounds_of};
use super::{NodeId, Scene};
use glam::{DAffine3, DVec3};
use rayon::prelude::*;

impl Scene {
    /// Where the scene is, with all animated nodes at rest: the same at any time of an animation, so that no frame depends on those before.
    pub(crate) fn extent(&self) -> Extent {
        let at_rest = || {
            let mut worlds: Vec<DAffine3> = Vec::with_capacity(self.nodes().len());
            for (index, node) in self.nodes().iter().enumerate() {
                let local = self.rest_poses.get(&NodeId(index)).map_or(node.local, Pose::transform);
                worlds.push(node.parent.map_or(DAffine3::IDENTITY, |parent| worlds[parent.0]) * local);
            }
            // On all cores, where they are not known yet.
            self.shapes();
            let things: Vec<_> = self.instances().iter().map(|it| self.shape(it).placed(&worlds[it.node.0])).collect();
            let bulk = Bulk::of(&things);
            bulk.extent(self.bounds_within(bulk.middle, bulk.reach, |it| worlds[it.node.0]))
        };
        *self.extent.get_or_init(at_rest)
    }

    /// How far from the middle of [`Scene::extent`] what matters of the scene as it is now reaches, metres.
    pub(crate) fn reach(&self) -> f64 {
        let Extent { middle, radius, .. } = self.extent();
        let things: Vec<_> = self.instances().iter().map(|it| self.shape(it).placed(&it.world)).collect();
        let reach = reach_of(&things, middle);
        if reach > 0.0 && reach.is_finite() { reach } else { radius }
    }

    /// The tight box around what matters of the scene as it is now: no speck far away belongs to it. `None` if there are no triangles.
    pub(crate) fn bulk(&self) -> Option<Bounds> {
        self.bounds_within(self.extent().middle, self.reach(), |it| it.world)
    }

    fn bounds_within(&self, middle: DVec3, reach: f64, world: impl Fn(&Instance) -> DAffine3 + Sync) -> Option<Bounds> {
        let within = |point: &DVec3| point.distance(middle) <= reach * (1.0 + 1e-9);
        let of = |it: &Instance| bounds_of(self.primitive(it), &world(it), within);
        self.instances().par_iter().filter_map(of).reduce_with(Bounds::union)
    }

    /// Whether an instance is part of what matters, `reach` far from the middle.
    pub(crate) fn is_within(&self, instance: &Instance, reach: f64) -> bool {
        self.shape(instance).placed(&instance.world).nearest(self.extent().middle) <= reach
    }

    /// Where the bulk of each primitive of each mesh is, one after the other.
    pub(crate) fn shapes(&self) -> Vec<&Shape> {
        let primitives: Vec<_> = self.meshes().iter().flat_map(|mesh| &mesh.primitives).collect();
        let places: Vec<_> = self.shapes.iter().flatten().collect();
        primitives.par_iter().zip(places).map(|(primitive, shape)| shape.get_or_init(|| Shape::of(primitive))).collect()
    }

    /// Where the bulk of an instance's primitive is, in the primitive's own space.
    pub(crate) fn shape(&self, instance: &Instance) -> &Shape {
        let shape = &self.shapes[instance.mesh.0][instance.primitive];
        shape.get_or_init(|| Shape::of(self.primitive(instance)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Primitive;
    use super::super::{Animation, Channel, Interpolation, Mesh, Node, Property};
    use super::*;

    /// A box around its own zero, as one primitive of twelve triangles.
    fn cube(half: f32) -> Primitive {
        let corner = |index: u32| [0, 1, 2].map(|axis| if index >> axis & 1 == 0 { -half } else { half });
        let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
        let indices = faces.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
        Primitive { positions: (0..8).map(corner).collect(), indices, ..Primitive::default() }
    }

    fn speck() -> Primitive {
        let positions = vec![[0.0; 3], [1e-3, 0.0, 0.0], [0.0, 1e-3, 0.0]];
        Primitive { positions, indices: vec![0, 1, 2], ..Primitive::default() }
    }

    fn scene(things: &[(Primitive, DVec3)]) -> Scene {
        let mut scene = Scene::empty("things");
        scene.add_material(super::super::Material::default()).expect("sound");
        for (primitive, at) in things {
            place(&mut scene, primitive.clone(), *at);
        }
        scene
    }

    fn place(scene: &mut Scene, primitive: Primitive, at: DVec3) -> NodeId {
        let mesh = scene.add_mesh(Mesh { name: String::new(), primitives: vec![primitive] }).expect("sound");
        let node = Node { mesh: Some(mesh), local: DAffine3::from_translation(at), ..Node::default() };
        scene.add_node(node).expect("finite")
    }

    #[test]
    fn far_things_decide_about_nothing() {
        let alone = scene(&[(cube(1.0), DVec3::ZERO)]).extent();
        assert_eq!((alone.origin, alone.middle, alone.radius), (DVec3::ZERO, DVec3::ZERO, 3.0_f64.sqrt()));
        for distance in [30.0, 1e2, 1e3, 1e4, 1e6] {
            for way in [DVec3::X, DVec3::new(-0.6, 0.0, 0.8)] {
                let scene = scene(&[(speck(), way * distance), (cube(1.0), DVec3::ZERO)]);
                assert_eq!(scene.extent(), alone, "a speck at {distance} m");
                assert_eq!(scene.bulk().map(|bounds| bounds.radius()), Some(alone.radius));
            }
        }
        let many = (0..60).map(|index| (speck(), DVec3::new(1e5 + f64::from(index), 2e4, 0.0)));
        assert_eq!(scene(&many.chain([(cube(1.0), DVec3::ZERO)]).collect::<Vec<_>>()).extent(), alone, "many specks");
        let mountain = (cube(5e3), DVec3::new(0.0, 0.0, -1e6));
        assert_eq!(scene(&[mountain, (cube(1.0), DVec3::ZERO)]).extent(), alone, "a mountain");
        // In the same primitive.
        let mut primitive = cube(1.0);
        primitive.positions.extend([[1e6, 0.0, 0.0], [1e6, 1.0, 0.0], [1e6, 0.0, 1.0]]);
        primitive.indices.extend([8, 9, 10]);
        assert_eq!(scene(&[(primitive, DVec3::ZERO)]).extent(), alone, "a triangle of the same primitive");
    }

    #[test]
    fn near_things_count() {
        let tree = scene(&[(cube(1.0), DVec3::ZERO), (cube(0.5), DVec3::X * 40.0)]);
        assert!(tree.bulk().expect("it is there").max.x == 40.5);
        let hill = scene(&[(cube(1.0), DVec3::ZERO), (cube(1e3), DVec3::X * 1e4)]);
        assert!(hill.extent().radius > 5e3);
    }

    #[test]
    fn the_origin_lies_at_the_finest_surface_on_a_grid() {
        let at = DVec3::new(4e3, 0.0, -3e3);
        let ground = Primitive { indices: vec![0, 1, 3, 0, 3, 2], ..cube(5e3) };
        let toy = |count: u32| (0..count).map(|index| (cube(1e-3), at + DVec3::X * 0.01 * f64::from(index)));
        let extent = scene(&[vec![(ground, DVec3::Y * 5e3)], toy(4).collect()].concat()).extent();
        assert!(extent.origin.distance(at) < 4096.0 && extent.radius > 5e3, "{extent:?}");
        let moved = scene(&[(cube(1.0), DVec3::new(1e6 + 0.25, -7e5, 3e5))]).extent();
        assert_eq!((moved.origin, moved.origin % 1.0), (DVec3::new(1e6, -7e5, 3e5), DVec3::ZERO));
    }

    #[test]
    fn time_does_not_move_the_origin_and_editing_does() {
        let mut scene = scene(&[(cube(1.0), DVec3::ZERO)]);
        let node = place(&mut scene, cube(0.5), DVec3::X * 3.0);
        let at_rest = scene.extent();
        let values = vec![[3.0, 0.0, 0.0, 0.0], [500.0, 0.0, 0.0, 0.0]];
        let channel = Channel {
            node,
            property: Property::Translation,
            interpolation: Interpolation::Linear,
            times: vec![0.0, 1.0],
            values,
        };
        scene.add_animation(Animation { channels: vec![channel], ..Animation::default() }).expect("the node is there");
        scene.set_time(1.0);
        assert_eq!(scene.extent(), at_rest);
        assert_eq!(scene.bulk().map(|bounds| bounds.max.x), Some(1.0), "it has flown away");
        place(&mut scene, cube(8.0), DVec3::X * 100.0);
        assert_ne!(scene.extent(), at_rest);
    }
}
