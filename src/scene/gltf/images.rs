//! Images: found, checked against limits, decoded in parallel, and shared by the textures that use them.

use super::document::{self, get};
use super::loader::Loader;
use super::pixels::{self, Claim};
use crate::scene::{LoadOptions, Texture, TextureId, Wrap};
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};
use std::sync::atomic::{AtomicU64, Ordering};

/// Where an image's bytes are.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Source<'a> {
    View(usize),
    Uri(&'a str),
}

/// All in which two textures can differ.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Key<'a> {
    source: Source<'a>,
    wrap: [Wrap; 2],
    nearest: bool,
    srgb: bool,
}

/// The textures that materials asked for so far, in the order of their ids.
#[derive(Default)]
pub(super) struct TextureRequests<'a> {
    ids: HashMap<Key<'a>, TextureId>,
    requests: Vec<(Key<'a>, String)>,
}

struct Decoded {
    width: u32,
    height: u32,
    rgba8: Vec<u8>,
}

impl<'a> Loader<'a> {
    /// The id that texture `index` will have when it is used as colour (`srgb`) or as data. `None` if it has no image that the
    /// core of glTF can read.
    pub(super) fn request_texture(
        &self,
        index: usize,
        srgb: bool,
        requests: &mut TextureRequests<'a>,
    ) -> Result<Option<TextureId>, String> {
        let document = self.document;
        let texture = get(&document.textures, index, "texture")?;
        let Some(source) = texture.source else {
            return Ok(None);
        };
        let image = get(&document.images, source, "image")?;
        let default_sampler = document::Sampler::default();
        let sampler =
            texture.sampler.map_or(Ok(&default_sampler), |sampler| get(&document.samplers, sampler, "sampler"))?;
        let source = match (image.buffer_view, &image.uri) {
            (Some(view), _) => Source::View(view),
            (None, Some(uri)) => Source::Uri(uri),
            (None, None) => {
                return Err(format!("image {source} has neither a uri nor a buffer view"));
            }
        };
        let key = Key {
            source,
            wrap: [wrap(sampler.wrap_s), wrap(sampler.wrap_t)],
            nearest: sampler.mag_filter == Some(9728),
            srgb,
        };
        let next = TextureId(requests.ids.len());
        Ok(Some(*requests.ids.entry(key).or_insert_with(|| {
            let name = texture.name.clone().or(image.name.clone()).unwrap_or_default();
            requests.requests.push((key, name));
            next
        })))
    }

    /// Decodes every image that was asked for and adds the textures.
    pub(super) fn add_textures(&mut self, requests: TextureRequests<'a>) -> Result<(), String> {
        let mut uses: HashMap<Source, usize> = HashMap::new();
        requests.requests.iter().for_each(|(key, _)| *uses.entry(key.source).or_default() += 1);
        let mut seen = HashSet::new();
        let keys = requests.requests.iter().map(|(key, _)| key.source);
        let sources: Vec<Source> = keys.filter(|source| seen.insert(*source)).collect();
        let total = AtomicU64::new(0);
        let decoded = sources.par_iter().map(|&source| {
            let what = match source {
                Source::View(view) => format!("the image in buffer view {view}"),
                Source::Uri(uri) => {
                    format!("the image {:?}", uri.chars().take(60).collect::<String>())
                }
            };
            self.decode(source, uses[&source] as u64, &total).map_err(|fault| format!("{what}: {fault}"))
        });
        let decoded: Vec<Decoded> = decoded.collect::<Result<_, String>>()?;
        let mut images: HashMap<Source, Decoded> = sources.into_iter().zip(decoded).collect();
        for (key, name) in requests.requests {
            let Some(image) = images.get_mut(&key.source) else {
                continue;
            };
            let left = uses.entry(key.source).or_default();
            *left -= 1;
            let rgba8 = if *left == 0 { std::mem::take(&mut image.rgba8) } else { image.rgba8.clone() };
            let (width, height) = (image.width, image.height);
            let texture = Texture { name, width, height, rgba8, wrap: key.wrap, nearest: key.nearest, srgb: key.srgb };
            self.scene.add_texture(texture).map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    fn decode(&self, source: Source, copies: u64, total: &AtomicU64) -> Result<Decoded, String> {
        let file;
        let bytes = match source {
            Source::View(view) => self.storage.view(self.document, view)?,
            Source::Uri(uri) => {
                file = self.storage.resolve(uri)?;
                &file
            }
        };
        // The header alone is read first: what it claims decides whether anything is allocated.
        let Claim { size: [width, height], least_bytes } = pixels::claim(bytes)?;
        let texels = u64::from(width) * u64::from(height);
        let LoadOptions { image_side, texture_bytes, .. } = *self.options;
        if least_bytes > bytes.len() as u64 {
            let held = bytes.len();
            return Err(format!(
                "its {held} bytes claim {width}×{height} texels, which take {least_bytes} at the least; export it again"
            ));
        }
        if width.max(height) > image_side {
            return Err(format!(
                "it has {width}×{height} texels, more than {image_side} a side (LoadOptions::image_side); make it smaller"
            ));
        }
        let claimed = texels.saturating_mul(4).saturating_mul(copies);
        if total.fetch_add(claimed, Ordering::Relaxed).saturating_add(claimed) > texture_bytes {
            return Err(format!(
                "the scene's textures need more than {} MiB; make them smaller, or allow more by --max-texture-mib \
                 (LoadOptions::texture_bytes)",
                texture_bytes >> 20
            ));
        }
        let rgba8 = pixels::decode(bytes)?;
        if rgba8.len() as u64 != texels * 4 {
            return Err(format!("it does not hold the {width}×{height} texels that it claims"));
        }
        Ok(Decoded { width, height, rgba8 })
    }
}

fn wrap(code: Option<u64>) -> Wrap {
    match code {
        Some(33071) => Wrap::Clamp,
        Some(33648) => Wrap::Mirror,
        _ => Wrap::Repeat,
    }
}
