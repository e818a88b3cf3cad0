//! Textures of the baked file: the scene's own where its materials stay, and the atlas.

use std::collections::HashMap;

use serde_json::{Value, json};

use super::BakeError;
use super::glb::Glb;
use crate::scene::{Scene, TextureId, Wrap};

const NEAREST: u32 = 9728;
const LINEAR: u32 = 9729;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;

/// What of a texture is of use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Channels {
    All,
    /// What cuts black surfaces out.
    Alpha,
}

/// The textures written so far.
#[derive(Default)]
pub(super) struct Textures {
    pub(super) textures: Vec<Value>,
    pub(super) images: Vec<Value>,
    pub(super) samplers: Vec<Value>,
    known: HashMap<(TextureId, Channels), usize>,
}

impl Textures {
    fn add(&mut self, glb: &mut Glb, png: &[u8], sampler: Value) -> usize {
        let sampler = match self.samplers.iter().position(|known| *known == sampler) {
            Some(known) => known,
            None => {
                self.samplers.push(sampler);
                self.samplers.len() - 1
            }
        };
        self.images.push(json!({ "bufferView": glb.file(png), "mimeType": "image/png" }));
        self.textures.push(json!({ "source": self.images.len() - 1, "sampler": sampler }));
        self.textures.len() - 1
    }

    /// The number of the atlas. It has no smaller levels: there texels of one surface would run into another's.
    pub(super) fn add_atlas(&mut self, glb: &mut Glb, size: [u32; 2], pixels: &[[u8; 3]]) -> Result<usize, BakeError> {
        let png = encode(size, pixels.as_flattened(), png::ColorType::Rgb)?;
        let clamp = wrap_code(Wrap::Clamp);
        let sampler = json!({ "magFilter": LINEAR, "minFilter": LINEAR, "wrapS": clamp, "wrapT": clamp });
        Ok(self.add(glb, &png, sampler))
    }

    /// The number of one of the scene's.
    pub(super) fn number(
        &mut self,
        glb: &mut Glb,
        scene: &Scene,
        id: TextureId,
        channels: Channels,
    ) -> Result<usize, BakeError> {
        if let Some(known) = self.known.get(&(id, channels)) {
            return Ok(*known);
        }
        let texture = &scene.textures()[id.0];
        let (size, mut pixels) = ([texture.width, texture.height], texture.rgba8.clone());
        if channels == Channels::Alpha {
            pixels.chunks_exact_mut(4).for_each(|pixel| pixel[..3].fill(0));
        }
        let (magnified, made_smaller) =
            if texture.nearest { (NEAREST, NEAREST) } else { (LINEAR, LINEAR_MIPMAP_LINEAR) };
        let [wrap_s, wrap_t] = texture.wrap.map(wrap_code);
        let sampler = json!({ "magFilter": magnified, "minFilter": made_smaller, "wrapS": wrap_s, "wrapT": wrap_t });
        let number = self.add(glb, &encode(size, &pixels, png::ColorType::Rgba)?, sampler);
        self.known.insert((id, channels), number);
        Ok(number)
    }
}

fn wrap_code(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => 10497,
        Wrap::Mirror => 33648,
        Wrap::Clamp => 33071,
    }
}

fn encode(size: [u32; 2], bytes: &[u8], color: png::ColorType) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, size[0], size[1]);
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    writer.finish()?;
    Ok(file)
}
