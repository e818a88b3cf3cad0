//! Why there is no reference, each said in one sentence.

use std::path::PathBuf;

use crate::method::Error;
use crate::output::OutputError;

/// Why a reference could not be made, read or merged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReferenceError {
    /// The samples could not be made.
    #[error(transparent)]
    Render(#[from] Error),
    /// A file could not be read or written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A file that is no reference, is damaged, or is of another version.
    #[error("{path} cannot be used as a reference: {reason}", path = .path.display())]
    Unusable {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// No files to merge.
    #[error("there is nothing to merge; name the files of the shards")]
    NothingToMerge,
    /// Two files of different references.
    #[error("{first} and {second} are parts of different references: they differ in {what}", first = .first.display(), second = .second.display())]
    Different {
        /// A file.
        first: PathBuf,
        /// Another file.
        second: PathBuf,
        /// What they differ in.
        what: String,
    },
    /// Samples in two files.
    #[error("the samples {samples} of {path} are in another of the files too; leave one of them out", path = .path.display())]
    Double {
        /// The file that has them again.
        path: PathBuf,
        /// The samples of every pixel, `17 to 32`.
        samples: String,
    },
    /// Samples in no file.
    #[error("the samples {samples} are in none of the files; add the shards that have them")]
    Missing {
        /// The samples of every pixel, `17 to 32, 65 to 80`.
        samples: String,
    },
    /// A shard without samples.
    #[error(
        "shard {shard} of {spp} samples per pixel is empty, for samples come in portions of {portion}; ask for fewer shards or more samples"
    )]
    EmptyShard {
        /// The shard.
        shard: super::Shard,
        /// Samples per pixel of the whole.
        spp: u32,
        /// Samples that are made together.
        portion: u32,
    },
    /// More samples than can be counted.
    #[error("{0} samples per pixel are more than the {max} that a reference can have", max = super::blocks::MAX_SPP)]
    TooManySamples(u32),
    /// The cache has no such reference.
    #[error("the cache has no reference whose key begins with {0:?}; irradia reference --list shows what there is")]
    NotCached(String),
}
