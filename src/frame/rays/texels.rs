//! Textures as one list of linear half-float texels with all their mip levels (glsl/lib/texels.glsl). Decoded once here, an sRGB texel
//! costs a ray four loads instead of four loads and twelve powers.

use half::f16;
use rayon::prelude::*;

use crate::scene::{Texture, Wrap};
use crate::vulkan::VulkanError;

const MIRROR: [u32; 2] = [1, 4];
const CLAMP: [u32; 2] = [2, 8];
const NEAREST: u32 = 16;

/// All textures of a scene.
pub(super) struct Texels {
    /// First texel, width and height, flags, levels of each texture; one of zeros if there is none.
    pub(super) table: Vec<[u32; 4]>,
    /// At least one.
    pub(super) texels: Vec<[f16; 4]>,
}

impl Texels {
    /// # Errors
    /// More texels than 32 bits count.
    pub(super) fn new(textures: &[Texture]) -> Result<Texels, VulkanError> {
        let chains: Vec<Vec<[f16; 4]>> = textures.par_iter().map(mip_chain).collect();
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
            made.texels.push([f16::ONE; 4]);
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
    wrap[0] | wrap[1] | if texture.nearest { NEAREST } else { 0 }
}

/// A texture and its smaller levels, each the mean of two by two texels (of the last row and column where a side is odd), linear.
fn mip_chain(texture: &Texture) -> Vec<[f16; 4]> {
    let linear: Vec<f32> = (0..=255_u8).map(|value| f32::from(value) / 255.0).collect();
    let color: Vec<f32> = linear
        .iter()
        .map(|&value| match (texture.srgb, value <= 0.04045) {
            (false, _) => value,
            // IEC 61966-2-1
            (true, true) => value / 12.92,
            (true, false) => ((value + 0.055) / 1.055).powf(2.4),
        })
        .collect();
    let decode = |texel: &[u8]| {
        let [r, g, b, a] = [0, 1, 2, 3].map(|channel| usize::from(texel[channel]));
        [color[r], color[g], color[b], linear[a]]
    };
    let mut level: Vec<[f32; 4]> = texture.rgba8.chunks_exact(4).map(decode).collect();
    let (mut width, mut height) = (texture.width as usize, texture.height as usize);
    let mut chain: Vec<[f16; 4]> = level.iter().map(|texel| texel.map(f16::from_f32)).collect();
    while width.max(height) > 1 {
        let size = [(width / 2).max(1), (height / 2).max(1)];
        let mean = |column: usize, row: usize| {
            let corner = |index: usize| {
                let x = (2 * column + index % 2).min(width - 1);
                let y = (2 * row + index / 2).min(height - 1);
                level[y * width + x]
            };
            let corners = [0, 1, 2, 3].map(corner);
            [0, 1, 2, 3].map(|channel| corners.iter().map(|texel| texel[channel]).sum::<f32>() / 4.0)
        };
        level = (0..size[1])
            .flat_map(|row| (0..size[0]).map(move |column| (column, row)))
            .map(|(x, y)| mean(x, y))
            .collect();
        chain.extend(level.iter().map(|texel| texel.map(f16::from_f32)));
        [width, height] = size;
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
        assert_eq!(chain[2], [0.5, 0.5, 0.5, 1.0].map(f16::from_f32));
        let many = texture(5, 3, vec![77; 60]);
        assert_eq!(mip_chain(&many).len(), 15 + 2 + 1);
        let [first, ..] = mip_chain(&many)[..] else { panic!("no texels") };
        assert!(mip_chain(&many).iter().all(|texel| *texel == first));
    }

    #[test]
    fn the_table_says_where_each_texture_lies() {
        let made = Texels::new(&[texture(2, 2, vec![1; 16]), texture(1, 1, vec![2; 4])]).expect("small");
        assert_eq!(made.table[0], [0, 2 | 2 << 16, MIRROR[1], 2]);
        assert_eq!(made.table[1][0], 5);
        assert_eq!(made.texels[5][3], f16::from_f32(2.0 / 255.0));
    }
}
