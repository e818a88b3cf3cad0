//! Hashes of values by their bits: the same on every machine and in every process.

/// Takes in values and gives a hash of 256 bits (BLAKE3). Numbers are taken as little-endian bytes and lists with their
/// lengths, so that no two different sequences of calls take in the same bytes.
#[derive(Clone, Default)]
pub(crate) struct Digest(blake3::Hasher);

impl Digest {
    /// An empty digest for one kind of thing: those of different kinds never agree.
    pub(crate) fn new(kind: &str) -> Digest {
        let mut digest = Digest::default();
        digest.text(kind);
        digest
    }

    pub(crate) fn number(&mut self, value: u64) -> &mut Digest {
        self.0.update(&value.to_le_bytes());
        self
    }

    pub(crate) fn flag(&mut self, value: bool) -> &mut Digest {
        self.number(u64::from(value))
    }

    pub(crate) fn f32s(&mut self, values: &[f32]) -> &mut Digest {
        self.words(values, |value| value.to_le_bytes())
    }

    pub(crate) fn f64s(&mut self, values: &[f64]) -> &mut Digest {
        self.words(values, |value| value.to_le_bytes())
    }

    pub(crate) fn u32s(&mut self, values: &[u32]) -> &mut Digest {
        self.words(values, |value| value.to_le_bytes())
    }

    pub(crate) fn bytes(&mut self, values: &[u8]) -> &mut Digest {
        self.number(values.len() as u64);
        self.0.update(values);
        self
    }

    pub(crate) fn text(&mut self, value: &str) -> &mut Digest {
        self.bytes(value.as_bytes())
    }

    /// Whether there is a value, and the value.
    pub(crate) fn option<T>(
        &mut self,
        value: Option<T>,
        add: impl FnOnce(&mut Digest, T) -> &mut Digest,
    ) -> &mut Digest {
        self.flag(value.is_some());
        if let Some(value) = value {
            add(self, value);
        }
        self
    }

    /// The hash of what was taken in so far.
    pub(crate) fn finish(&self) -> [u8; 32] {
        *self.0.finalize().as_bytes()
    }

    fn words<T: Copy, const SIZE: usize>(&mut self, values: &[T], bytes: impl Fn(T) -> [u8; SIZE]) -> &mut Digest {
        self.number(values.len() as u64);
        // In portions that stay in the cache, for meshes have millions of values.
        for portion in values.chunks(4096) {
            self.0.update(&portion.iter().flat_map(|&value| bytes(value)).collect::<Vec<u8>>());
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hash_is_of_the_bits_and_of_nothing_else() {
        let digest = || Digest::new("test");
        assert_ne!(digest().text("ab").text("c").finish(), digest().text("a").text("bc").finish());
        assert_ne!(digest().f32s(&[0.0]).finish(), digest().f32s(&[-0.0]).finish());
        assert_ne!(digest().f32s(&[1.0, 2.0]).finish(), digest().f32s(&[1.0]).f32s(&[2.0]).finish());
        assert_ne!(digest().finish(), Digest::new("other").finish());
        // The same on every machine: this is what BLAKE3 makes of these bytes.
        let known = blake3::hash(b"\x04\0\0\0\0\0\0\0test\x01\0\0\0\0\0\0\0\0\0\x80\x3f");
        assert_eq!(digest().f32s(&[1.0]).finish(), *known.as_bytes());
    }
}
