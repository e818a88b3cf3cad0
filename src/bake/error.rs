//! Why nothing was baked, each said in one sentence.

use crate::renderer::Error;

/// Why a scene could not be baked.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BakeError {
    /// The light maps could not be made.
    #[error(transparent)]
    Render(#[from] Error),
    /// No surface has a light map.
    #[error(
        "{scene} has nothing to bake: no light, no diffuse surface, or no bounce; add a light with --light or --sky, and leave lightmaps.bounces above 0"
    )]
    Nothing {
        /// The scene's name.
        scene: String,
    },
    /// Light maps by photons do not tell direct light from the rest.
    #[error(
        "light is baked with lightmaps.source=rays alone, since photons do not tell direct light from the rest; leave that setting or the preset paper out"
    )]
    Photons,
    /// The light maps do not fit in one image.
    #[error(
        "the light maps need an image of {width}x{height} texels, and viewers take {most} a side; take larger texels with --texel"
    )]
    TooLarge {
        /// Of the image.
        width: u32,
        /// Likewise.
        height: u32,
        /// A side.
        most: u32,
    },
    /// glTF has vertices in floats.
    #[error(
        "{scene} reaches farther than a .glb can say, which is 3e38 m; leave out what lies as far away, or scale the scene"
    )]
    Beyond {
        /// The scene's name.
        scene: String,
    },
    /// A `.glb` cannot hold as much.
    #[error(
        "the baked scene has {0} bytes, more than a .glb can hold; take larger texels with --texel, or bake a part of the scene"
    )]
    TooLong(u64),
    /// An image could not be encoded.
    #[error("an image of the baked scene cannot be encoded: {0}")]
    Image(#[from] png::EncodingError),
}
