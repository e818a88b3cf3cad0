//! A reference's file: an EXR that any viewer opens, with the image and its slots; and, as further layers, the sums from which
//! more samples or other shards go on without losing a bit.
//!
//! | layer | what |
//! |---|---|
//! | (none) | the image |
//! | `SLOT` | a slot of it |
//! | `state.HALF.LEVEL.INDEX.SLOT` | sums of a half over block (LEVEL, INDEX), see `blocks`; left out where they are zero |

use std::collections::BTreeMap;
use std::path::Path;

use super::about::{About, Spent};
use super::blocks::{Block, HALVES, MAX_LEVEL, SlotPixels, State};
use super::{Reference, ReferenceError, ReferenceKey, Shard};
use crate::output::{Attributes, OutputError, SealedError, Target, read_sealed_layers, write_sealed_layers};
use crate::slot::Slot;

/// A reference or a shard of one, with all that is needed to go on with it.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceFile {
    pub(crate) about: About,
    pub(crate) spent: Spent,
    /// Which shard of how many samples per pixel it is; `None` for a whole reference.
    pub(crate) shard: Option<(Shard, u32)>,
    pub(crate) state: State,
}

impl ReferenceFile {
    pub(crate) fn new(about: About) -> ReferenceFile {
        ReferenceFile { about, spent: Spent::default(), shard: None, state: State::default() }
    }

    /// What tells it from other references; shards of one reference have the same key.
    pub fn key(&self) -> &ReferenceKey {
        &self.about.key
    }

    /// Samples of every pixel.
    pub fn spp(&self) -> u32 {
        self.state.samples()
    }

    /// The images that the samples come to, with their noise.
    pub fn reference(&self) -> Reference {
        Reference::of(&self.about, &self.spent, &self.state)
    }

    /// Writes the file, whole or not at all.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, target: impl Into<Target>) -> Result<(), OutputError> {
        let reference = self.reference();
        let mut layers: Vec<(String, &[[f32; 3]])> = vec![(String::new(), &reference.image.pixels)];
        layers.extend(reference.slots.iter().map(|(slot, image)| (slot.name().to_owned(), &image.pixels[..])));
        layers.extend(state_layers(&self.state));
        write_sealed_layers(&target.into(), self.about.size, &layers, &self.attributes(&reference))
    }

    /// Reads a file that [`ReferenceFile::write`] wrote.
    ///
    /// # Errors
    /// [`ReferenceError::Unusable`] for a file that is no reference, is damaged, or was made by another version.
    pub fn read(path: &Path) -> Result<ReferenceFile, ReferenceError> {
        let unusable = |reason: String| ReferenceError::Unusable { path: path.to_owned(), reason };
        let read = read_sealed_layers(path).map_err(|error| match error {
            SealedError::Output(error) => error.into(),
            SealedError::Broken => damaged(path),
            SealedError::Unsealed => unusable("it is none, or a damaged one".to_owned()),
        })?;
        let about = About::read(read.size, &read.attributes).map_err(unusable)?;
        let shard = match read.attributes.get("shard") {
            None => None,
            Some(text) => Some(read_shard(text, &read.attributes).ok_or_else(|| damaged(path))?),
        };
        let pixel_count = read.size[0] as usize * read.size[1] as usize;
        let state = read_state(read.layers, pixel_count).ok_or_else(|| damaged(path))?;
        Ok(ReferenceFile { about, spent: Spent::read(&read.attributes), shard, state })
    }

    fn attributes(&self, reference: &Reference) -> Attributes {
        let mut attributes = self.about.attributes.clone();
        let mut add = |name: &str, value: String| drop(attributes.insert(name.to_owned(), value));
        add("irradia", env!("CARGO_PKG_VERSION").to_owned());
        add("spp", reference.spp.to_string());
        add("samples_per_second", reference.samples_per_second.to_string());
        add("rays_per_second", reference.rays_per_second.to_string());
        for (name, value) in self.spent.attributes() {
            add(name, value);
        }
        for (part, noise) in &reference.noise {
            add(&format!("noise.{part}.rmse"), noise.rmse.to_string());
            add(&format!("noise.{part}.rrmse"), noise.rrmse.to_string());
        }
        if let Some((shard, spp)) = self.shard {
            add("shard", shard.to_string());
            add("shard_spp", spp.to_string());
        }
        attributes
    }
}

fn damaged(path: &Path) -> ReferenceError {
    let reason = "its samples are damaged or incomplete; delete it and make it anew".to_owned();
    ReferenceError::Unusable { path: path.to_owned(), reason }
}

fn read_shard(text: &str, attributes: &Attributes) -> Option<(Shard, u32)> {
    Some((Shard::parse(text).ok()?, attributes.get("shard_spp")?.parse().ok()?))
}

fn layer_name(half: usize, level: u32, index: u32, slot: Slot) -> String {
    format!("state.{half}.{level}.{index}.{slot}")
}

fn state_layers(state: &State) -> Vec<(String, &[[f32; 3]])> {
    let mut layers: Vec<(String, &[[f32; 3]])> = Vec::new();
    for block in state.blocks() {
        for half in HALVES {
            for (slot, pixels) in Slot::ALL.into_iter().zip(&block.halves[half]) {
                // A block all of whose slots are zero is still to be found in the file, by its first.
                let zero = slot != Slot::ALL[0] && pixels.as_flattened().iter().all(|value| value.to_bits() == 0);
                if !zero {
                    layers.push((layer_name(half, block.level, block.index, slot), pixels));
                }
            }
        }
    }
    layers
}

/// The blocks of a file's layers; `None` if they are not what was written.
fn read_state(mut layers: BTreeMap<String, Vec<[f32; 3]>>, pixel_count: usize) -> Option<State> {
    let places: Vec<(u32, u32)> = layers.keys().filter_map(|name| block_place(name)).collect();
    let mut state = State::default();
    for (level, index) in places {
        if level > MAX_LEVEL || index >= 1 << (MAX_LEVEL - level) {
            return None;
        }
        let mut half = |half: usize| -> SlotPixels {
            Slot::ALL.map(|slot| {
                layers.remove(&layer_name(half, level, index, slot)).unwrap_or_else(|| vec![[0.0; 3]; pixel_count])
            })
        };
        let halves = HALVES.map(&mut half);
        state.insert(Block { level, index, halves }).ok()?;
    }
    let rest_is_known = layers.keys().all(|name| !name.starts_with("state."));
    (state.chunk_count() > 0 && rest_is_known).then_some(state)
}

/// Level and index of the block whose first layer has this name.
fn block_place(name: &str) -> Option<(u32, u32)> {
    let (level, rest) = name.strip_prefix("state.0.")?.split_once('.')?;
    let (index, slot) = rest.split_once('.')?;
    if slot == Slot::ALL[0].name() { Some((level.parse().ok()?, index.parse().ok()?)) } else { None }
}
