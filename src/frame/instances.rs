//! Instances on the device and as the host draws them; their area.

use glam::{DAffine3, DMat3, DVec3};

use super::materials::{is_cut, texture_kinds};
use crate::scene::{Alpha, Cutout, Instance, Material, Primitive, Scene, has_specular_lobe};
use crate::shaders::types;

/// A primitive among all meshes' data.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) first_index: u32,
    pub(super) index_count: u32,
    pub(super) vertex_offset: i32,
    pub(super) bounds: [[f32; 3]; 2],
    /// In object space, m².
    pub(super) area: f64,
    /// The box of the solid that it bounds, if it does (`closed_meshes`).
    pub(super) solid: Option<[[f32; 3]; 2]>,
}

/// One instance as the host needs it to draw: what to draw, with which material, and where it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawnInstance {
    pub(crate) first_index: u32,
    /// 0 if alpha leaves nothing of it.
    pub(crate) index_count: u32,
    pub(crate) vertex_offset: i32,
    pub(crate) material: usize,
    /// The programs that read textures draw it: its material has some, or alpha cuts it out point by point.
    pub(crate) textured: bool,
    /// Which kinds, as the shaders' bits.
    pub(crate) texture_kinds: u32,
    pub(crate) masked: bool,
    /// The solid that it bounds, or helps to bound.
    pub(crate) solid: Option<OrientedBox>,
    /// The material reflects or transmits specularly.
    pub(crate) specular: bool,
    /// For culling.
    pub(crate) whole: OrientedBox,
    /// Around what matters of it; `None` if nothing does.
    pub(crate) bulk: Option<OrientedBox>,
}

/// A box in render space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OrientedBox {
    pub(crate) center_rs: [f32; 3],
    pub(crate) half_axes_rs: [[f32; 3]; 3],
}

impl OrientedBox {
    fn of(to_render: &DAffine3, low: DVec3, high: DVec3) -> OrientedBox {
        let half = (high - low) * 0.5;
        let [x, y, z] = [to_render.matrix3.x_axis, to_render.matrix3.y_axis, to_render.matrix3.z_axis];
        OrientedBox {
            center_rs: to_render.transform_point3((low + high) * 0.5).as_vec3().to_array(),
            half_axes_rs: [x * half.x, y * half.y, z * half.z].map(|axis| axis.as_vec3().to_array()),
        }
    }
}

/// The area of a primitive that is moved by a linear map, m².
pub(super) fn area_of(primitive: &Primitive, linear: DMat3) -> f64 {
    let corner = |index: u32| linear * DVec3::from(primitive.positions[index as usize].map(f64::from));
    let triangles = primitive.indices.chunks_exact(3).map(|indices| [0, 1, 2].map(|place| corner(indices[place])));
    triangles.map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
}

/// The area of all instances within reach, m². Only those whose transform is no similarity are measured triangle by triangle.
pub(super) fn surface_area(scene: &Scene, places: &[Vec<Place>], reach: f64) -> f64 {
    let area = |instance: &Instance| {
        let linear = instance.world.matrix3;
        let scale2 = linear.x_axis.length_squared();
        let stretch = (linear.transpose() * linear - DMat3::from_diagonal(DVec3::splat(scale2))).to_cols_array();
        if stretch.into_iter().all(|entry| entry.abs() <= 1e-6 * scale2) {
            scale2 * places[instance.mesh.0][instance.primitive].area
        } else {
            area_of(&scene.meshes()[instance.mesh.0].primitives[instance.primitive], linear)
        }
    };
    scene.instances().iter().filter(|instance| scene.is_within(instance, reach)).map(area).sum()
}

/// The records of all instances, and how each is drawn.
pub(super) fn instances_of(
    scene: &Scene,
    (places, cutouts): (&[Vec<Place>], &[Cutout]),
    reach: f64,
) -> (Vec<types::Instance>, Vec<DrawnInstance>) {
    let origin = scene.extent().origin;
    let mut records = Vec::new();
    let mut drawn = Vec::new();
    for instance in scene.instances() {
        let place = places[instance.mesh.0][instance.primitive];
        let primitive = &scene.meshes()[instance.mesh.0].primitives[instance.primitive];
        let shape = scene.shape(instance);
        records.push(instance_record(
            instance,
            primitive,
            place,
            instance.world.transform_point3(shape.center) - origin,
        ));
        let material = &scene.materials()[primitive.material.0];
        let to_render = DAffine3 { translation: instance.world.translation - origin, ..instance.world };
        let bulk = scene.is_within(instance, reach).then(|| OrientedBox::of(&to_render, shape.low, shape.high));
        let mut drawn_instance =
            DrawnInstance { bulk, ..drawn_instance(place, primitive.material.0, material, &to_render) };
        match cutouts[primitive.material.0] {
            Cutout::Nothing => drawn_instance.index_count = 0,
            cutout => drawn_instance.textured |= is_cut(cutout, drawn_instance.masked, primitive),
        }
        drawn.push(drawn_instance);
    }
    (records, drawn)
}

const FLAT_NORMALS: u32 = 1;
const FLIPPED: u32 = 2;
const HAS_COLORS: u32 = 4;
const HAS_TANGENTS: u32 = 8;

/// `center_rs`: where the zero of the uploaded vertices lies in render space.
fn instance_record(instance: &Instance, primitive: &Primitive, place: Place, center_rs: DVec3) -> types::Instance {
    let world = instance.world;
    let [a, b, c] = [world.matrix3.x_axis, world.matrix3.y_axis, world.matrix3.z_axis];
    let translation = center_rs;
    let row = |axis: usize| [a[axis] as f32, b[axis] as f32, c[axis] as f32, translation[axis] as f32];
    // Any positive factor will do: the largest component becomes 1, so that no scale under- or overflows.
    let cofactors = [b.cross(c), c.cross(a), a.cross(b)];
    let largest = cofactors.iter().map(|column| column.abs().max_element()).fold(f64::MIN_POSITIVE, f64::max);
    let [cofactor_x, cofactor_y, cofactor_z] = cofactors.map(|column| (column / largest).as_vec3().to_array());
    let flag = |present: bool, bit: u32| if present { bit } else { 0 };
    types::Instance {
        object_to_render: [row(0), row(1), row(2)],
        cofactor_x,
        cofactor_y,
        cofactor_z,
        material: u32::try_from(primitive.material.0).unwrap_or(0),
        flags: flag(primitive.normals.is_none(), FLAT_NORMALS)
            | flag(instance.flips_winding, FLIPPED)
            | flag(primitive.colors.is_some(), HAS_COLORS)
            | flag(primitive.tangents.is_some(), HAS_TANGENTS),
        first_index: place.first_index,
        vertex_offset: place.vertex_offset,
        reserved: [0; 3],
    }
}

fn drawn_instance(place: Place, index: usize, material: &Material, to_render: &DAffine3) -> DrawnInstance {
    let [low, high] = place.bounds.map(|corner| DVec3::from(corner.map(f64::from)));
    DrawnInstance {
        first_index: place.first_index,
        index_count: place.index_count,
        vertex_offset: place.vertex_offset,
        material: index,
        textured: material.textures().next().is_some(),
        texture_kinds: texture_kinds(material),
        masked: material.alpha != Alpha::Opaque,
        solid: place.solid.map(|bounds| {
            let [low, high] = bounds.map(|corner| DVec3::from(corner.map(f64::from)));
            OrientedBox::of(to_render, low, high)
        }),
        specular: has_specular_lobe(material),
        whole: OrientedBox::of(to_render, low, high),
        bulk: None,
    }
}
