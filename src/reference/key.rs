//! What tells references apart: a hash of everything that decides what they show.

use crate::scene::{CameraView, Digest, Projection, Scene};
use crate::slot::Slot;

use super::request::{Estimator, ReferenceRequest};

/// Counts the changes of how references are made; those of another version are not used. Raise it with every change that
/// makes other samples of the same request: sampling, materials, lights, slots.
pub const REFERENCE_VERSION: u32 = 3;

/// A hash of scene, view, size, transport and seed: 64 hexadecimal digits. Names do not count.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ReferenceKey(String);

impl ReferenceKey {
    /// Digits of the key in the names of cached files.
    pub const PREFIX_DIGITS: usize = 16;

    /// The key of what `request` asks of `scene`.
    pub fn of(scene: &Scene, request: &ReferenceRequest) -> ReferenceKey {
        let ReferenceRequest { size, camera, estimator, bounces, caustics, mirrors, filter, seed } = request;
        let mut digest = Digest::new("reference");
        digest.u32s(&[REFERENCE_VERSION, super::CHUNK_SAMPLES, Slot::ALL.len() as u32]);
        digest.bytes(&scene.content_hash()).u32s(size);
        add_camera(&mut digest, camera);
        digest.text(estimator_name(*estimator)).text(caustics.name()).text(filter.name());
        digest.option(*bounces, |digest, bounces| digest.u32s(&[bounces])).u32s(&[*seed]);
        // Without such a limit the keys are those of before there was one.
        if let Some(mirrors) = mirrors {
            digest.text("mirrors").u32s(&[*mirrors]);
        }
        ReferenceKey(hexadecimal(&digest.finish()))
    }

    /// A key written down; `None` if the text is none.
    pub fn parse(text: &str) -> Option<ReferenceKey> {
        let sound = text.len() == 64 && text.bytes().all(|digit| matches!(digit, b'0'..=b'9' | b'a'..=b'f'));
        sound.then(|| ReferenceKey(text.to_owned()))
    }

    /// All digits.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The first digits, which tell keys apart in practice.
    pub fn prefix(&self) -> &str {
        &self.0[..Self::PREFIX_DIGITS]
    }
}

impl std::fmt::Display for ReferenceKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

/// The name of an estimator on the command line and in files.
pub fn estimator_name(estimator: Estimator) -> &'static str {
    match estimator {
        Estimator::Path => "path",
        Estimator::Sppm => "sppm",
        Estimator::Auto => "auto",
    }
}

pub(crate) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn add_camera(digest: &mut Digest, camera: &CameraView) {
    let CameraView { world, projection, name: _, automatic: _ } = camera;
    digest.f64s(&world.to_cols_array());
    match projection {
        // The picture's own shape decides, not the one that the camera was made for.
        Projection::Perspective { vertical_fov, aspect: _, near } => digest.number(0).f64s(&[*vertical_fov, *near]),
        Projection::Orthographic { half_width, half_height, near, far } => {
            digest.number(1).f64s(&[*half_width, *half_height, *near, *far])
        }
    };
}
