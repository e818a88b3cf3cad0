//! Textures as one list of 8-bit texels with all their mip levels (glsl/lib/texels.glsl).

use rayon::prelude::*;

use crate::scene::{Texture, Wrap};
use crate::vulkan::VulkanError;

const MIRROR: [u32; 2] = [1, 4];
const CLAMP: [u32; 2] = [2, 8];
const NEAREST: u32 = 16;
const SRGB: u32 = 32;

/// All textures of a scene.
pub(super) struct Texels {
    /// First texel, width and height, flags, levels of each texture; one of zeros if there is none.
    pub(super) table: Vec<[u32; 4]>,
    /// At least one.
    pub(super) texels: Vec<[u8; 4]>,
}

impl Texels {
    /// # Errors
    /// More texels than 32 bits count.
    pub(super) fn new(textures: &[Texture]) -> Result<Texels, VulkanError> {
        let chains: Vec<Vec<[u8; 4]>> = textures.par_iter().map(mip_chain).collect();
        let mut made = Texels { table: Vec::new(), texels: Vec::new() };
        for (texture, chain) in textures.iter().zip(&chains) {
            let first = u32::try_from(made.texels.len()).ok().filter(|first| *first < u32::MAX / 2);
            let first = first.ok_or_else(|| VulkanError::TooLarge {
                what: "the scene".to_owned(),
                asked: "more texels than 31 bits count".to_owned(),
                limit: "2³¹".to_owned(),
            })?;
            let levels = 32 - texture.width.max(texture.height).leading_zeros();
            made.table.push([first, texture.width | texture.height << 16, flags(texture), levels]);
            made.texels.extend_from_slice(chain);
        }
        if made.table.is_empty() {
            made.table.push([0; 4]);
        }
        if made.texels.is_empty() {
            made.texels.push([255; 4]);
        }
        Ok(made)
    }
}

fn flags(texture: &Texture) -> u32 {
    let wrap = [0, 1].map(|axis| match texture.wrap[axis] {
        Wrap::Repeat => 0,
        Wrap::Mirror => MIRROR[axis],
        Wrap::Clamp => CLAMP[axis],
    });
    wrap[0] | wrap[1] | if texture.nearest { NEAREST } else { 0 } | if texture.srgb { SRGB } else { 0 }
}

/// A texture and its smaller levels, each the mean of two by two texels (of the last row and column where a side is odd) in linear
/// light.
fn mip_chain(texture: &Texture) -> Vec<[u8; 4]> {
    let mut chain: Vec<[u8; 4]> =
        texture.rgba8.chunks_exact(4).map(|texel| [texel[0], texel[1], texel[2], texel[3]]).collect();
    let decode: Vec<f32> = (0..=255_u8)
        .map(|value| {
            let value = f32::from(value) / 255.0;
            if !texture.srgb {
                value
            } else if value <= 0.04045 {
                value / 12.92
            } else {
                ((value + 0.055) / 1.055).powf(2.4)
            }
        })
        .collect();
    let encode = |value: f32| {
        let encoded = if !texture.srgb {
            value
        } else if value <= 0.003_130_8 {
            value * 12.92
        } else {
            1.055 * value.powf(1.0 / 2.4) - 0.055
        };
        (encoded * 255.0).round() as u8
    };
    let (mut width, mut height, mut first) = (texture.width as usize, texture.height as usize, 0);
    while width.max(height) > 1 {
        let (next_width, next_height) = ((width / 2).max(1), (height / 2).max(1));
        for row in 0..next_height {
            for column in 0..next_width {
                let corner = |index: usize| {
                    let x = (2 * column + index % 2).min(width - 1);
                    let y = (2 * row + index / 2).min(height - 1);
                    chain[first + y * width + x]
                };
                let corners = [0, 1, 2, 3].map(corner);
                let mean =
                    |channel: usize| corners.iter().map(|texel| decode[usize::from(texel[channel])]).sum::<f32>() / 4.0;
                let alpha = corners.iter().map(|texel| u32::from(texel[3])).sum::<u32>();
                chain.push([encode(mean(0)), encode(mean(1)), encode(mean(2)), ((alpha + 2) / 4) as u8]);
            }
        }
        first += width * height;
        (width, height) = (next_width, next_height);
    }
    chain
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(width: u32, height: u32, rgba8: Vec<u8>) -> Texture {
        Texture {
            name: String::new(),
            width,
            height,
            rgba8,
            wrap: [Wrap::Repeat, Wrap::Mirror],
            nearest: false,
            srgb: true,
        }
    }

    #[test]
    fn levels_are_means_in_linear_light() {
        let two = texture(2, 1, vec![0, 0, 0, 255, 255, 255, 255, 255]);
        let chain = mip_chain(&two);
        assert_eq!(chain.len(), 3);
        assert_eq!(chain[2], [188, 188, 188, 255], "half of white is 188 in sRGB");
        let many = texture(5, 3, vec![77; 60]);
        assert_eq!(mip_chain(&many).len(), 15 + 2 + 1);
        assert!(mip_chain(&many).iter().all(|texel| *texel == [77; 4]));
    }

    #[test]
    fn the_table_says_where_each_texture_lies() {
        let made = Texels::new(&[texture(2, 2, vec![1; 16]), texture(1, 1, vec![2; 4])]).expect("small");
        assert_eq!(made.table[0], [0, 2 | 2 << 16, SRGB | MIRROR[1], 2]);
        assert_eq!(made.table[1][0], 5);
        assert_eq!(made.texels[5], [2; 4]);
    }
}
