//! What alpha leaves of a surface, material by material.

use super::{Alpha, Material, Texture};

/// What its alpha leaves of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Cutout {
    Everything,
    Nothing,
    /// A texture or vertex colours decide.
    PerPoint,
}

pub(crate) fn cutout(material: &Material, textures: &[Texture], vertex_colors: bool) -> Cutout {
    let Alpha::Mask { cutoff } = material.alpha else { return Cutout::Everything };
    let (mut least, mut most) = (material.base_color[3], material.base_color[3]);
    if let Some(texture) = material.base_color_texture {
        let alphas = || textures[texture.texture.0].rgba8.chunks_exact(4).map(|texel| f32::from(texel[3]) / 255.0);
        least *= alphas().fold(1.0, f32::min);
        most *= alphas().fold(0.0, f32::max);
    }
    if vertex_colors {
        least = 0.0;
    }
    match (least >= cutoff, most < cutoff) {
        (true, _) => Cutout::Everything,
        (_, true) => Cutout::Nothing,
        _ => Cutout::PerPoint,
    }
}
