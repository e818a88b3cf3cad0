//! Views from lights: the frustum of each, and its rectangle in the one atlas that they share.
//!
//! A view maps atlas texels to tangents, tangent = origin + (texel − rectangle)·step, and tangents to rays: at distance 1
//! before a perspective view, in metres across an orthographic one (glsl/lib/lights.glsl).

use glam::{DMat3, DVec3};

use super::camera::view_projection;
use crate::shaders::types;

/// Sides of tiles and rectangles are multiples of this, so that a tile lies in one view.
pub(crate) const TILE: u32 = 16;

/// More texels than this in the atlas (of 24 bytes each) and the views are drawn at half their resolution.
const MOST_TEXELS: u64 = 32 << 20;

/// One view before it has a place in the atlas.
#[derive(Clone, Debug)]
pub(crate) struct ViewShape {
    /// Columns right, down, forward; unit vectors in world axes.
    axes: DMat3,
    origin_rs: DVec3,
    near: f64,
    /// Orthographic: the way from the near plane to the far one, which the origin lies in; perspective: 0.
    depth_range: f64,
    /// Half extent of what carries flux, in tangent units or metres; the view itself is larger by the guard band.
    half_extent: [f64; 2],
    /// Only the upper half (negative `down`) is looked at.
    upper_half: bool,
    /// Side of the longer edge, texels.
    resolution: u32,
    /// The largest radiant intensity (perspective) or irradiance (orthographic) of a channel.
    strength: f64,
    pub(crate) light: u32,
}

/// Texels beyond the lit part of a view on each side, for the shadow filter.
fn guard(filter_radius: u32) -> u32 {
    filter_radius + 2
}

/// What all views of one light share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ViewSource {
    pub(crate) origin_rs: DVec3,
    pub(crate) near: f64,
    pub(crate) resolution: u32,
    pub(crate) strength: f64,
    pub(crate) light: u32,
}

impl ViewShape {
    fn perspective(source: ViewSource, axes: DMat3, tangent: f64, upper_half: bool) -> ViewShape {
        let ViewSource { origin_rs, near, resolution, strength, light } = source;
        ViewShape {
            axes,
            origin_rs,
            near,
            depth_range: 0.0,
            half_extent: [tangent; 2],
            upper_half,
            resolution,
            strength,
            light,
        }
    }

    /// One view along `axes`' third column, as wide as the half angle whose tangent is given.
    pub(crate) fn cone(source: ViewSource, axes: DMat3, tangent: f64) -> Vec<ViewShape> {
        vec![ViewShape::perspective(source, axes, tangent, false)]
    }

    /// Six faces of a cube: forward, right, left, down, up, back (as `view_towards` in glsl/lib/lights.glsl counts).
    pub(crate) fn cube(source: ViewSource, axes: DMat3) -> Vec<ViewShape> {
        let mut faces = ViewShape::five(source, axes, false);
        let [right, down, forward] = [axes.x_axis, axes.y_axis, axes.z_axis];
        faces.push(ViewShape::perspective(source, DMat3::from_cols(-right, down, -forward), 1.0, false));
        faces
    }

    /// The hemisphere around forward: the cube's front face and the nearer halves of its sides.
    pub(crate) fn hemicube(source: ViewSource, axes: DMat3) -> Vec<ViewShape> {
        ViewShape::five(source, axes, true)
    }

    fn five(source: ViewSource, axes: DMat3, upper_half: bool) -> Vec<ViewShape> {
        let [right, down, forward] = [axes.x_axis, axes.y_axis, axes.z_axis];
        // The sides look outwards with the front's normal pointing up in them.
        let side = |outwards: DVec3| DMat3::from_cols((-forward).cross(outwards), -forward, outwards);
        let mut faces = vec![ViewShape::perspective(source, axes, 1.0, false)];
        faces.extend(
            [right, -right, down, -down]
                .map(|outwards| ViewShape::perspective(source, side(outwards), 1.0, upper_half)),
        );
        faces
    }

    /// The view from so many metres forward of where it is.
    pub(crate) fn lifted(&self, metres: f64) -> ViewShape {
        ViewShape { origin_rs: self.origin_rs + self.axes.z_axis * metres, ..self.clone() }
    }

    /// A parallel view of the box `low` to `high`, given in the axes' coordinates, that begins at `start` or where the box does.
    ///
    /// Its depth counts from the far end, where the box is: reversed, it is as precise there as if the view began at the box, however far
    /// before it something casts its shadow.
    pub(crate) fn parallel(source: ViewSource, axes: DMat3, [low, high]: [DVec3; 2], start: f64) -> Vec<ViewShape> {
        let middle = (low + high) * 0.5;
        let size = (high - low).max(DVec3::splat(1e-6 * (high - low).max_element()).max(DVec3::splat(1e-30)));
        // A little more depth keeps rounding from clipping its ends.
        let end = high.z + 0.01 * size.z;
        let depth_range = (end - start.min(low.z)) * 1.0001 + 0.01 * size.z;
        let origin_rs = axes * DVec3::new(middle.x, middle.y, end);
        let ViewSource { resolution, strength, light, .. } = source;
        let half_extent = [size.x * 0.5, size.y * 0.5];
        vec![ViewShape {
            axes,
            origin_rs,
            near: 0.0,
            depth_range,
            half_extent,
            upper_half: false,
            resolution,
            strength,
            light,
        }]
    }

    /// Tangent units or metres between texels.
    fn step(&self, filter_radius: u32) -> f64 {
        let inner = self.resolution.saturating_sub(2 * guard(filter_radius)).max(1);
        2.0 * self.half_extent[0].max(self.half_extent[1]) / f64::from(inner)
    }

    /// Width and height of the rectangle in texels.
    fn rect_size(&self, filter_radius: u32) -> [u32; 2] {
        let step = self.step(filter_radius);
        let side = |half: f64| {
            let texels = (2.0 * half / step).round() as u32 + 2 * guard(filter_radius);
            texels.next_multiple_of(TILE).min(self.resolution)
        };
        let [width, height] = self.half_extent.map(side);
        let half = (height / 2 + guard(filter_radius)).next_multiple_of(TILE).min(height);
        [width, if self.upper_half { half } else { height }]
    }

    fn record(&self, filter_radius: u32, rect_origin: [u32; 2]) -> LaidOutView {
        let step = self.step(filter_radius);
        let rect_size = self.rect_size(filter_radius);
        let full = if self.upper_half { [rect_size[0]; 2] } else { rect_size };
        let reach = full.map(|texels| 0.5 * f64::from(texels) * step);
        let [right, down, forward] = [self.axes.x_axis, self.axes.y_axis, self.axes.z_axis].map(|axis| axis.as_vec3());
        let origin = self.origin_rs.as_vec3();
        let (near, depth_range) = (self.near as f32, self.depth_range as f32);
        let start = if depth_range > 0.0 { -depth_range } else { near };
        let clip =
            view_projection(origin, [right * reach[0] as f32, down * reach[1] as f32, forward], start, depth_range);
        let signed = |texels: u32| i32::try_from(texels).unwrap_or(i32::MAX);
        let lit = self.half_extent.map(|half| half as f32);
        let record = types::LightView {
            view_projection: clip.to_cols_array_2d(),
            origin_rs: origin.to_array(),
            near,
            right: right.to_array(),
            depth_range,
            down: down.to_array(),
            tangent_step: step as f32,
            forward: forward.to_array(),
            // The flux of a texel in the middle under the strongest light: values are around 1 and below.
            flux_scale: ((self.strength * step * step) as f32).max(f32::MIN_POSITIVE),
            tangent_origin: reach.map(|reach| -reach as f32),
            lit_low: lit.map(|lit| -lit),
            lit_high: lit,
            rect_origin: rect_origin.map(signed),
            rect_size: rect_size.map(signed),
            light: self.light,
            reserved: 0,
        };
        LaidOutView { record, full_size: full }
    }
}

/// A view with its place in the atlas.
#[derive(Clone, Debug)]
pub(crate) struct LaidOutView {
    pub(crate) record: types::LightView,
    /// Size of the viewport; larger than the rectangle where only its upper half is drawn.
    pub(crate) full_size: [u32; 2],
}

/// All views in one atlas.
#[derive(Clone, Debug, Default)]
pub(crate) struct Atlas {
    pub(crate) size: [u32; 2],
    pub(crate) views: Vec<LaidOutView>,
    /// All tiles of all views, view by view, along Hilbert's curve inside a view, so that neighbours in the list are neighbours
    /// on the surface.
    pub(crate) tiles: Vec<types::LightTile>,
}

impl Atlas {
    /// Finds every view a rectangle: shelves of falling height. Views that together take more than the atlas may hold are
    /// drawn at half their resolution until they fit.
    pub(crate) fn new(mut shapes: Vec<ViewShape>, filter_radius: u32, largest_side: u32) -> Atlas {
        if shapes.is_empty() {
            return Atlas::default();
        }
        let texels = |shapes: &[ViewShape]| -> u64 {
            shapes
                .iter()
                .map(|shape| shape.rect_size(filter_radius).iter().map(|&side| u64::from(side)).product::<u64>())
                .sum()
        };
        let mut halved = false;
        while texels(&shapes) > MOST_TEXELS && shapes.iter().any(|shape| shape.resolution > 2 * TILE) {
            halved = true;
            for shape in &mut shapes {
                shape.resolution = (shape.resolution / 2).next_multiple_of(TILE).max(2 * TILE);
            }
        }
        if halved {
            tracing::warn!(
                "{} light views are drawn at a lower resolution, so that they fit into one atlas of {MOST_TEXELS} texels",
                shapes.len()
            );
        }
        let widest = shapes.iter().map(|shape| shape.rect_size(filter_radius)[0]).max().unwrap_or(TILE);
        let square = (texels(&shapes) as f64).sqrt() as u32;
        let width = (square.next_multiple_of(TILE).max(widest)).min(largest_side / TILE * TILE).max(widest);
        let mut order: Vec<usize> = (0..shapes.len()).collect();
        order.sort_by_key(|&index| std::cmp::Reverse(shapes[index].rect_size(filter_radius)[1]));
        let mut origins = vec![[0, 0]; shapes.len()];
        let (mut x, mut y, mut shelf) = (0, 0, 0);
        for index in order {
            let [rect_width, rect_height] = shapes[index].rect_size(filter_radius);
            if x + rect_width > width {
                (x, y, shelf) = (0, y + shelf, 0);
            }
            origins[index] = [x, y];
            x += rect_width;
            shelf = shelf.max(rect_height);
        }
        let views: Vec<LaidOutView> =
            shapes.iter().zip(&origins).map(|(shape, &origin)| shape.record(filter_radius, origin)).collect();
        let tiles = (0..).zip(&views).flat_map(|(index, view)| tiles_of(index, &view.record)).collect();
        Atlas { size: [width, y + shelf], views, tiles }
    }
}

fn tiles_of(view: u32, record: &types::LightView) -> Vec<types::LightTile> {
    let [columns, rows] = record.rect_size.map(|side| side.cast_unsigned() / TILE);
    let side = columns.max(rows).next_power_of_two();
    let places = (0..side * side).map(|index| tile_of_curve(index, side));
    let inside = places.filter(|([column, row], _)| *column < columns && *row < rows);
    inside
        .map(|(place, orientation)| {
            let at = |axis: usize| record.rect_origin[axis] + (place[axis] * TILE).cast_signed();
            types::LightTile { origin: [at(0), at(1)], view, orientation }
        })
        .collect()
}

/// The tile that Hilbert's curve through `side`² tiles reaches at `index`, and how the curve through the tile's own texels
/// is turned there: bit 0 transposed, bit 1 turned by half (glsl/lib/hilbert.glsl).
fn tile_of_curve(index: u32, side: u32) -> ([u32; 2], u32) {
    let (mut cell, mut orientation, mut rest) = ([0, 0], 0, index);
    let mut half = 1;
    while half < side {
        let right = rest >> 1 & 1;
        let below = (rest ^ right) & 1;
        if below == 0 {
            if right == 1 {
                cell = cell.map(|at| half - 1 - at);
                orientation ^= 2;
            }
            cell = [cell[1], cell[0]];
            orientation ^= 1;
        }
        cell = [cell[0] + half * right, cell[1] + half * below];
        rest >>= 2;
        half *= 2;
    }
    (cell, orientation)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(resolution: u32, light: u32) -> ViewSource {
        ViewSource { origin_rs: DVec3::ZERO, near: 0.01, resolution, strength: 1.0, light }
    }

    #[test]
    fn rectangles_lie_in_the_atlas_and_do_not_overlap() {
        let mut shapes = ViewShape::cube(source(512, 0), DMat3::IDENTITY);
        shapes.extend(ViewShape::hemicube(source(128, 1), DMat3::IDENTITY));
        shapes.extend(ViewShape::cone(source(256, 2), DMat3::IDENTITY, 0.7));
        shapes.extend(ViewShape::parallel(
            source(512, 3),
            DMat3::IDENTITY,
            [DVec3::splat(-1.0), DVec3::new(4.0, 1.0, 1.0)],
            -1.0,
        ));
        let atlas = Atlas::new(shapes, 1, 16384);
        let mut taken = vec![false; (atlas.size[0] * atlas.size[1]) as usize];
        let mut texels = 0;
        for view in &atlas.views {
            let ([x, y], [width, height]) =
                (view.record.rect_origin.map(i32::cast_unsigned), view.record.rect_size.map(i32::cast_unsigned));
            assert!(x + width <= atlas.size[0] && y + height <= atlas.size[1]);
            assert_eq!((x % TILE, y % TILE, width % TILE, height % TILE), (0, 0, 0, 0));
            texels += width * height;
            for row in y..y + height {
                for column in x..x + width {
                    let place = &mut taken[(row * atlas.size[0] + column) as usize];
                    assert!(!std::mem::replace(place, true), "two views share a texel");
                }
            }
        }
        assert_eq!(atlas.tiles.len() as u32 * TILE * TILE, texels, "every texel lies in one tile");
    }

    #[test]
    fn the_curve_through_all_texels_of_a_square_view_has_no_jump() {
        use crate::frame::twins::hilbert_decode;
        let path = (0..64).flat_map(|index| {
            let (tile, orientation) = tile_of_curve(index, 8);
            (0..256)
                .map(move |texel| hilbert_decode(texel, orientation).to_array().map(i32::cast_unsigned))
                .map(move |[x, y]| [tile[0] * TILE + x, tile[1] * TILE + y])
        });
        let path: Vec<[u32; 2]> = path.collect();
        for pair in path.windows(2) {
            assert_eq!(pair[0][0].abs_diff(pair[1][0]) + pair[0][1].abs_diff(pair[1][1]), 1, "{pair:?}");
        }
    }

    #[test]
    fn too_many_views_are_drawn_smaller() {
        let shapes = (0..40).flat_map(|light| ViewShape::cube(source(2048, light), DMat3::IDENTITY)).collect();
        let atlas = Atlas::new(shapes, 1, 16384);
        assert_eq!(atlas.views.len(), 240);
        assert!(u64::from(atlas.size[0]) * u64::from(atlas.size[1]) <= 2 * MOST_TEXELS);
    }

    #[test]
    fn cube_faces_look_where_the_shader_expects_them() {
        let faces = ViewShape::cube(source(64, 0), DMat3::IDENTITY);
        let forward: Vec<DVec3> = faces.iter().map(|face| face.axes.z_axis).collect();
        assert_eq!(forward, [DVec3::Z, DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::NEG_Z]);
        for face in faces {
            assert!((face.axes.determinant() - 1.0).abs() < 1e-12, "right × down = forward");
        }
    }
}
