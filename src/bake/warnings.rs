//! What whoever bakes should know of the scene, in a sentence each.

use std::collections::BTreeSet;

use glam::DVec3;

use super::geometry::primitive_of;
use super::looks::SurfaceLooks;
use crate::frame::rays::{TriangleChart, is_diffuse};
use crate::scene::{Instance, Scene};

/// Names that a sentence lists.
const NAMES: usize = 4;
/// A surface is all diffuse, or not at all, to so much.
const WHOLE: f32 = 1e-3;

pub(super) fn warn_of_detail(found: u32, asked: u32) {
    if found < asked {
        tracing::warn!(
            "there is no room for as many texels: --detail is {found}, not {asked}; take larger texels with --texel to have it"
        );
    }
}

pub(super) fn warn_of_looks(scene: &Scene, charts: &[Option<TriangleChart>], looks: &[SurfaceLooks]) {
    let parted = |looks: &&SurfaceLooks| (WHOLE..1.0 - WHOLE).contains(&looks.diffuse);
    let parted: BTreeSet<&str> =
        looks.iter().filter(parted).map(|looks| scene.materials()[looks.material.0].name.as_str()).collect();
    if !parted.is_empty() {
        tracing::warn!(
            "there is metal or glass beside diffuse light in {}: surfaces that are metal or glass for the most part keep their material, and the others have their diffuse light alone",
            listed(&parted)
        );
    }
    let unlit = unlit(scene, charts);
    if !unlit.is_empty() {
        tracing::warn!(
            "surfaces of {} are too small or too far away for light maps: they keep their material, and are black without other lights",
            listed(&unlit)
        );
    }
}

/// Names of materials whose diffuse light was found nowhere on some triangle.
fn unlit<'a>(scene: &'a Scene, charts: &[Option<TriangleChart>]) -> BTreeSet<&'a str> {
    let (mut names, mut start) = (BTreeSet::new(), 0);
    for instance in scene.instances() {
        let primitive = primitive_of(scene, instance);
        let material = &scene.materials()[primitive.material.0];
        let mut triangles = primitive.indices.chunks_exact(3).zip(&charts[start..]);
        start += primitive.triangle_count();
        let corners = |indices: &[u32]| [0, 1, 2].map(|corner| primitive.positions[indices[corner] as usize]);
        let without = |(indices, chart): (&[u32], &Option<_>)| chart.is_none() && has_area(instance, corners(indices));
        if is_diffuse(material) && triangles.any(without) {
            names.insert(material.name.as_str());
        }
    }
    names
}

fn has_area(instance: &Instance, corners: [[f32; 3]; 3]) -> bool {
    let [a, b, c] = corners.map(|at| instance.world.transform_vector3(DVec3::from(at.map(f64::from))));
    (b - a).cross(c - a).length_squared() > 0.0
}

/// As "a, b, and 3 more".
fn listed(names: &BTreeSet<&str>) -> String {
    let quoted = names
        .iter()
        .take(NAMES)
        .map(|name| if name.is_empty() { "nameless materials".to_owned() } else { format!("\"{name}\"") });
    let list = quoted.collect::<Vec<_>>().join(", ");
    if names.len() > NAMES { format!("{list} and {} more", names.len() - NAMES) } else { list }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Material, Mesh, Node, Primitive};

    fn triangle(scene: &mut Scene, material: Material, across: f32) {
        let material = scene.add_material(material).expect("sound");
        let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, across, 0.0]];
        let primitives = vec![Primitive { positions, indices: vec![0, 1, 2], material, ..Primitive::default() }];
        let mesh = scene.add_mesh(Mesh { name: String::new(), primitives }).expect("sound");
        scene.add_node(Node { mesh: Some(mesh), ..Node::default() }).expect("sound");
    }

    #[test]
    fn diffuse_surfaces_without_light_are_named() {
        let mut scene = Scene::empty("far");
        let named = |name: &str, metallic| Material { name: name.to_owned(), metallic, ..Material::default() };
        triangle(&mut scene, named("lit", 0.0), 1.0);
        triangle(&mut scene, named("metal", 1.0), 1.0);
        triangle(&mut scene, named("nothing", 0.0), 0.0);
        triangle(&mut scene, named("far", 0.0), 1.0);
        let chart = TriangleChart { corners: [[0.0; 2]; 3], firsts: [Some(0), None], size: [1, 1], surface: 0 };
        assert_eq!(unlit(&scene, &[Some(chart), None, None, None]), BTreeSet::from(["far"]));
    }

    #[test]
    fn long_lists_are_cut_short() {
        assert_eq!(listed(&BTreeSet::from(["b", "a"])), "\"a\", \"b\"");
        assert_eq!(listed(&BTreeSet::from(["1", "2", "3", "4", "5", "6"])), "\"1\", \"2\", \"3\", \"4\" and 2 more");
    }
}
