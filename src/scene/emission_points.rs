//! The light of single points of an emissive primitive, as rays find it: the radiance of the finest texels where alpha leaves
//! something of the surface (glsl/lib/coverage.glsl, glsl/lib/emissive_points.glsl).

use super::mesh::Primitive;
use super::{Alpha, Material, Texture, TextureRef};

/// Rays read alpha from half floats: what equals the cutoff may round to less by so much of it.
const ALPHA_ROUNDING: f32 = 1.0 - 1.0 / 2048.0;

pub(super) fn luminance(color: [f32; 3]) -> f32 {
    0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]
}

/// A texture and the coordinates by which a primitive reads it.
struct TextureRead<'a> {
    texture: &'a Texture,
    reference: TextureRef,
    coordinates: Option<&'a [[f32; 2]]>,
}

impl<'a> TextureRead<'a> {
    fn new(reference: TextureRef, primitive: &'a Primitive, textures: &'a [Texture]) -> TextureRead<'a> {
        let coordinates = primitive.texcoords[reference.texcoord as usize].as_deref();
        TextureRead { texture: &textures[reference.texture.0], reference, coordinates }
    }

    /// At the corners of a triangle; without coordinates all lie at the origin.
    fn corners(&self, vertices: &[u32]) -> [[f32; 2]; 3] {
        [0, 1, 2].map(|corner| {
            self.reference
                .apply(self.coordinates.map_or([0.0; 2], |coordinates| coordinates[vertices[corner] as usize]))
        })
    }
}

/// What decides the light of a primitive's points.
pub(super) struct EmissionPoints<'a> {
    material: &'a Material,
    emissive: Option<TextureRead<'a>>,
    /// Alpha texture and vertex colours, where alpha decides point by point.
    opacity: Option<TextureRead<'a>>,
    colors: Option<&'a [[f32; 4]]>,
    /// Nothing is there below.
    cutoff: f32,
}

impl<'a> EmissionPoints<'a> {
    pub(super) fn new(primitive: &'a Primitive, material: &'a Material, textures: &'a [Texture], cut: bool) -> Self {
        let read = |reference: TextureRef| TextureRead::new(reference, primitive, textures);
        let cutoff = match material.alpha {
            Alpha::Mask { cutoff } if cut => cutoff * ALPHA_ROUNDING,
            _ => -1.0,
        };
        EmissionPoints {
            material,
            emissive: material.emissive_texture.map(read),
            opacity: material.base_color_texture.filter(|_| cut).map(read),
            colors: primitive.colors.as_deref().filter(|_| cut),
            cutoff,
        }
    }

    /// The whole texture is black.
    pub(super) fn all_dark(&self) -> bool {
        self.emissive.as_ref().is_some_and(|read| !read.texture.rgba8.chunks_exact(4).any(glows))
    }

    pub(super) fn of_triangle(&'a self, vertices: &[u32]) -> TrianglePoints<'a> {
        let byte = |channel: f32| (channel.clamp(0.0, 1.0) * 255.0).round() / 255.0;
        let alpha = |corner: usize| self.colors.map_or(1.0, |colors| byte(colors[vertices[corner] as usize][3]));
        TrianglePoints {
            points: self,
            emissive: self.emissive.as_ref().map(|read| read.corners(vertices)),
            opacity: self.opacity.as_ref().map(|read| read.corners(vertices)),
            alpha: [0, 1, 2].map(alpha),
        }
    }
}

/// The same for one triangle.
pub(super) struct TrianglePoints<'a> {
    points: &'a EmissionPoints<'a>,
    emissive: Option<[[f32; 2]; 3]>,
    opacity: Option<[[f32; 2]; 3]>,
    /// Of the vertex colours.
    alpha: [f32; 3],
}

impl TrianglePoints<'_> {
    /// The most texels that an edge runs along; `None` if no texture matters.
    pub(super) fn texels(&self) -> Option<f32> {
        let reads = [(&self.points.emissive, self.emissive), (&self.points.opacity, self.opacity)];
        let longest = reads.into_iter().filter_map(|(read, corners)| {
            let (texture, corners) = (read.as_ref()?.texture, corners?);
            let (low, high) = box_of(corners);
            let width = (high[0] - low[0]) * texture.width as f32;
            Some(width.max((high[1] - low[1]) * texture.height as f32))
        });
        longest.reduce(f32::max)
    }

    /// Radiance at weights of corners 1 and 2, if there is any.
    pub(super) fn radiance(&self, place: [f64; 2]) -> Option<[f32; 3]> {
        let weights = weights_of(place);
        let mut alpha = self.points.material.base_color[3] * weighted(weights, self.alpha);
        if let (Some(read), Some(corners)) = (&self.points.opacity, self.opacity) {
            alpha *= read.texture.sample(at(weights, corners))[3];
        }
        if alpha < self.points.cutoff {
            return None;
        }
        let mut radiance = self.points.material.emissive;
        if let (Some(read), Some(corners)) = (&self.points.emissive, self.emissive) {
            let texel = read.texture.sample(at(weights, corners));
            radiance = [0, 1, 2].map(|channel| radiance[channel] * texel[channel]);
        }
        (luminance(radiance) > 0.0).then_some(radiance)
    }

    /// The most that any point can send out.
    pub(super) fn brightest(&self) -> [f32; 3] {
        self.points.material.emissive
    }

    /// Whether some point between three may shine; no means that surely none does.
    pub(super) fn may_shine(&self, places: [[f64; 2]; 3]) -> bool {
        let weights = places.map(weights_of);
        let box_in = |corners: [[f32; 2]; 3]| box_of(weights.map(|weights| at(weights, corners)));
        if let (Some(read), Some(corners)) = (&self.points.emissive, self.emissive) {
            let (low, high) = box_in(corners);
            if !read.texture.any_texel(low, high, glows) {
                return false;
            }
        }
        // An eighth of an 8-bit step for rounding.
        let vertex = weights.map(|weights| weighted(weights, self.alpha)).into_iter().fold(0.0, f32::max);
        let factor = self.points.material.base_color[3] * vertex;
        let (cutoff, rounding) = (self.points.cutoff, 1.0 / 2048.0);
        match (&self.points.opacity, self.opacity) {
            (Some(read), Some(corners)) => {
                let (low, high) = box_in(corners);
                let opaque = |texel: &[u8]| factor * f32::from(texel[3]) / 255.0 + rounding >= cutoff;
                read.texture.any_texel(low, high, opaque)
            }
            _ => factor + rounding >= cutoff,
        }
    }
}

fn glows(texel: &[u8]) -> bool {
    texel[..3].iter().any(|&channel| channel > 0)
}

fn weights_of([b1, b2]: [f64; 2]) -> [f32; 3] {
    [(1.0 - b1 - b2) as f32, b1 as f32, b2 as f32]
}

fn weighted(weights: [f32; 3], corners: [f32; 3]) -> f32 {
    weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2]
}

fn at(weights: [f32; 3], corners: [[f32; 2]; 3]) -> [f32; 2] {
    [0, 1].map(|axis| weighted(weights, corners.map(|corner| corner[axis])))
}

fn box_of(corners: [[f32; 2]; 3]) -> ([f32; 2], [f32; 2]) {
    let axis = |axis: usize| corners.map(|corner| corner[axis]);
    let low = [0, 1].map(|it| axis(it).into_iter().fold(f32::INFINITY, f32::min));
    let high = [0, 1].map(|it| axis(it).into_iter().fold(f32::NEG_INFINITY, f32::max));
    (low, high)
}
