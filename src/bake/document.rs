//! The baked file: one node and mesh for each of the scene's nodes that places some, below one that stands where the scene's own coordinates have their zero in floats.

use serde_json::{Map, Value, json};

use super::BakeError;
use super::atlas::Atlas;
use super::cameras::cameras;
use super::geometry::{Arrays, Group, Place, groups, primitive_of};
use super::glb::Glb;
use super::light::Light;
use super::materials::Materials;
use super::textures::Textures;
use crate::frame::rays::TriangleChart;
use crate::scene::{Extent, Instance, Scene};

/// The bytes of the file.
///
/// # Errors
/// It is too long, it has vertices beyond the range of floats, or an image cannot be encoded.
pub(super) fn write(
    scene: &Scene,
    charts: &[Option<TriangleChart>],
    atlas: &Atlas,
    light: &Light,
) -> Result<Vec<u8>, BakeError> {
    let Extent { origin, radius, .. } = scene.extent();
    let place = Place { origin, radius };
    let mut glb = Glb::default();
    let mut textures = Textures::default();
    let number = textures.add_atlas(&mut glb, atlas.size, &light.emissive)?;
    let mut materials = Materials::new(scene, textures, number);
    let (mut meshes, mut nodes): (Vec<Value>, Vec<Value>) = Default::default();
    let mut start = 0;
    for of_node in scene.instances().chunk_by(|a, b| a.node == b.node) {
        let mut primitives = Vec::new();
        for instance in of_node {
            let end = start + primitive_of(scene, instance).triangle_count();
            for (look, group) in groups(scene, instance, &charts[start..end], atlas, light) {
                let material = materials.number(&mut glb, look)?;
                let arrays = group.arrays(scene, instance, look, place)?;
                primitives.push(primitive(&mut glb, &group, &arrays, material));
            }
            start = end;
        }
        if !primitives.is_empty() {
            let name = name_of(scene, &of_node[0]);
            nodes.push(json!({ "name": name, "mesh": meshes.len() }));
            meshes.push(json!({ "name": name, "primitives": primitives }));
        }
    }
    let (cameras, placed) = cameras(scene, origin);
    nodes.extend(placed);
    let root = json!({
        "name": scene.name,
        "translation": origin.to_array(),
        "children": (0..nodes.len()).collect::<Vec<_>>(),
    });
    nodes.push(root);

    let Materials { textures: Textures { textures, images, samplers, .. }, written, extensions, .. } = materials;
    let description = format!("{}, with its diffuse light baked", scene.name);
    let mut document = Map::new();
    let sections: [(&str, Value); 11] = [
        (
            "asset",
            json!({
                "version": "2.0",
                "generator": concat!("irradia ", env!("CARGO_PKG_VERSION")),
                "extras": { "description": description },
            }),
        ),
        ("extensionsUsed", json!(extensions)),
        ("scene", 0.into()),
        ("scenes", json!([{ "nodes": [nodes.len() - 1] }])),
        ("nodes", nodes.into()),
        ("meshes", meshes.into()),
        ("materials", written.into()),
        ("textures", textures.into()),
        ("images", images.into()),
        ("samplers", samplers.into()),
        ("cameras", cameras.into()),
    ];
    document.extend(sections.into_iter().map(|(name, section)| (name.to_owned(), section)));
    glb.finish(document)
}

fn primitive(glb: &mut Glb, group: &Group, arrays: &Arrays, material: usize) -> Value {
    let mut attributes = json!({ "POSITION": glb.positions(&arrays.positions) });
    if let Some(normals) = &arrays.normals {
        attributes["NORMAL"] = glb.vectors(normals).into();
    }
    for (set, coordinates) in arrays.texcoords.iter().enumerate() {
        if let Some(coordinates) = coordinates {
            attributes[format!("TEXCOORD_{set}")] = glb.vectors(coordinates).into();
        }
    }
    if let Some(colors) = &arrays.colors {
        attributes["COLOR_0"] = glb.vectors(colors).into();
    }
    json!({ "attributes": attributes, "indices": glb.indices(&group.indices), "material": material })
}

/// The node's, or else the mesh's.
fn name_of(scene: &Scene, instance: &Instance) -> String {
    let node = &scene.nodes()[instance.node.0].name;
    let mesh = &scene.meshes()[instance.mesh.0].name;
    [node, mesh].into_iter().find(|name| !name.is_empty()).cloned().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use glam::{DAffine3, DVec3};

    use super::*;
    use crate::image::ColorImage;
    use crate::scene::{Material, Mesh, Node, Primitive};

    /// A mesh without light maps, at another scale.
    fn written(scale: f64) -> Result<Vec<u8>, BakeError> {
        let mut scene = Scene::empty("large");
        let material = scene.add_material(Material::default()).expect("sound");
        let positions = vec![[0.0; 3], [1e10, 0.0, 0.0], [0.0, 1e10, 0.0]];
        let primitives = vec![Primitive { positions, indices: vec![0, 1, 2], material, ..Primitive::default() }];
        let mesh = scene.add_mesh(Mesh { name: String::new(), primitives }).expect("sound");
        let local = DAffine3::from_scale(DVec3::splat(scale));
        scene.add_node(Node { mesh: Some(mesh), local, ..Node::default() }).expect("sound");
        let atlas = Atlas::new(&[None])?;
        let texel_count = (atlas.size[0] * atlas.size[1]) as usize;
        let light = Light {
            irradiance: ColorImage::black(atlas.size),
            parts: BTreeMap::new(),
            emissive: vec![[0; 3]; texel_count],
            kept: Vec::new(),
            exponents: Vec::new(),
        };
        write(&scene, &[None], &atlas, &light)
    }

    /// JSON has no infinity.
    #[test]
    fn what_floats_do_not_reach_is_refused() {
        assert!(written(1e20).is_ok());
        let message = written(1e30).expect_err("floats end at 3e38").to_string();
        assert!(message.contains("large reaches farther"), "{message}");
    }
}
