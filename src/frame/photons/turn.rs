//! Which photons are sent at a time, and what is to be known of them everywhere.

/// Which of all photons are sent: number `first` and every `stride`-th from there on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Turn {
    pub(crate) first: u32,
    pub(crate) stride: u32,
}

impl Turn {
    pub(crate) const ALL: Turn = Turn { first: 0, stride: 1 };

    /// Its photons, of so many.
    pub(crate) fn count(self, all: u32) -> u32 {
        all.saturating_sub(self.first).div_ceil(self.stride)
    }
}

/// What decides about the discs that photons are spread over (glsl/photons/landing.glsl).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Discs {
    pub(crate) scale: f32,
    /// How far apart neighbours land, in place of the length of the way.
    pub(crate) by_beams: bool,
}

/// How photons are sent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sending {
    /// The method's piece, `slot/name`.
    pub(crate) piece: &'static str,
    pub(crate) turn: Turn,
    /// Stages of rays: specular events at most.
    pub(crate) stages: usize,
    pub(crate) discs: Discs,
}

impl Sending {
    /// The name of a pass; of several turns each has its own.
    pub(crate) fn pass(&self, name: &str) -> String {
        let Sending { piece, turn, .. } = self;
        if turn.stride == 1 { format!("{piece}/{name}") } else { format!("{piece}/{name}.{}", turn.first) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_share_all_photons() {
        for (all, stride) in [(10_000, 8), (7, 8), (1, 1), (0, 3)] {
            let turns = (0..stride).map(|first| Turn { first, stride }.count(all));
            assert_eq!(turns.sum::<u32>(), all);
        }
    }
}
