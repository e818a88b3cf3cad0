//! What contents depend on, as tables name it.

/// What a content depends on, for the reasons that tables give.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Dependence(u8);

impl Dependence {
    pub(crate) const NONE: Dependence = Dependence(0);
    pub(crate) const GEOMETRY: Dependence = Dependence(1);
    pub(crate) const MATERIALS: Dependence = Dependence(2);
    pub(crate) const LIGHTS: Dependence = Dependence(4);
    pub(crate) const CAMERA: Dependence = Dependence(8);
    const NAMES: [&'static str; 4] = ["geometry", "materials", "lights", "camera"];

    pub(super) fn reason(self) -> String {
        let names: Vec<_> =
            (0..).zip(Dependence::NAMES).filter(|(bit, _)| self.0 >> bit & 1 == 1).map(|(_, name)| name).collect();
        if names.is_empty() { "unchanged".to_owned() } else { format!("unchanged: {}", names.join(", ")) }
    }
}

impl std::ops::BitOr for Dependence {
    type Output = Dependence;

    fn bitor(self, other: Dependence) -> Dependence {
        Dependence(self.0 | other.0)
    }
}
