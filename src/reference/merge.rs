//! Putting shards together.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::blocks::SAMPLES_PER_CHUNK;
use super::error::ReferenceError;
use super::file::ReferenceFile;
use super::shard::chunks_of;

/// The reference that shards make together, to the bit as if one machine had made it; in any order, and also of whole
/// references and of what was merged before.
///
/// # Errors
/// A file that cannot be used; files of different references; samples that are missing or there twice.
pub fn merge(paths: &[PathBuf]) -> Result<ReferenceFile, ReferenceError> {
    let mut files = paths.iter().map(|path| Ok((path, ReferenceFile::read(path)?)));
    let (first_path, mut merged) = files.next().unwrap_or(Err(ReferenceError::NothingToMerge))?;
    let mut spp = wanted(&merged);
    for file in files {
        let (path, file): (&PathBuf, ReferenceFile) = file?;
        if file.about.key != merged.about.key {
            return Err(different(first_path, &merged, path, &file));
        }
        spp = spp.max(wanted(&file));
        merged.spent.add(&file.spent);
        for block in file.state.into_blocks() {
            merged
                .state
                .insert(block)
                .map_err(|overlap| ReferenceError::Double { path: path.clone(), samples: samples(&overlap.0) })?;
        }
    }
    let missing = merged.state.missing(0..chunks_of(spp).max(merged.state.end()));
    if !missing.is_empty() {
        let missing: Vec<String> = missing.iter().map(samples).collect();
        return Err(ReferenceError::Missing { samples: missing.join(", ") });
    }
    merged.shard = None;
    Ok(merged)
}

/// Samples per pixel of the reference that the file is a part of.
fn wanted(file: &ReferenceFile) -> u32 {
    file.shard.map_or(0, |(_, spp)| spp)
}

/// Samples per pixel as people count them, from 1.
fn samples(chunks: &Range<u32>) -> String {
    format!("{} to {}", chunks.start * SAMPLES_PER_CHUNK + 1, chunks.end * SAMPLES_PER_CHUNK)
}

/// Says in what the first thing is that the two references differ in.
fn different(first: &Path, one: &ReferenceFile, second: &Path, other: &ReferenceFile) -> ReferenceError {
    let names = ["scene_hash", "size", "camera_view", "estimator", "bounces", "caustics", "filter", "seed"];
    let name = names.into_iter().find(|name| one.about.attribute(name) != other.about.attribute(name));
    let what = match name {
        Some("scene_hash") => "the scene".to_owned(),
        Some("camera_view") => "the camera".to_owned(),
        Some(name) => format!("{name}, {} and {}", one.about.attribute(name), other.about.attribute(name)),
        None => "the key".to_owned(),
    };
    ReferenceError::Different { first: first.to_owned(), second: second.to_owned(), what }
}
