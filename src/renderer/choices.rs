//! The choices of each slot, made from the list in `method/`.

use crate::estimator::Estimator;
use crate::method::{Method, for_all_methods};
use crate::slot::Slot;

macro_rules! choice {
    ($choice:ident $slot:ident
     { $($module:ident => $method:ident($options:ident),)* }
     { $($estimator:ident => $estimator_type:ident($estimator_options:ident),)* }) => {
        #[doc = concat!("How the `", stringify!($slot), "` slot is filled.")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum $choice {
            /// Not at all.
            None,
            $(
                #[doc = concat!("The method `", stringify!($module), "`.")]
                $method,
            )*
            $(
                #[doc = concat!("The estimator `", stringify!($estimator), "`.")]
                $estimator_type,
            )*
        }

        impl $choice {
            const ALL: &[$choice] =
                &[$choice::None, $($choice::$method,)* $($choice::$estimator_type,)*];
            /// The names of all choices.
            pub const NAMES: &[&str] = &[
                "none",
                $(<crate::$slot::$module::$method as Method>::NAME,)*
                $(<crate::estimator::$estimator::$estimator_type as Estimator>::NAME,)*
            ];

            /// The name used on the command line.
            pub fn name(self) -> &'static str {
                $choice::NAMES[self as usize]
            }

            fn from_name(name: &str) -> Option<$choice> {
                $choice::ALL.iter().copied().find(|choice| choice.name() == name)
            }
        }

        impl serde::Serialize for $choice {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }
    };
}

macro_rules! choices {
    (direct $direct:tt diffuse $diffuse:tt caustics $caustics:tt specular $specular:tt estimator $estimator:tt) => {
        choice! { DirectMethod direct $direct {} }
        choice! { DiffuseMethod diffuse $diffuse $estimator }
        choice! { CausticsMethod caustics $caustics $estimator }
        choice! { SpecularMethod specular $specular $estimator }
    };
}
for_all_methods! { choices }

/// The method of each slot. `emission` has no choice: it is what the surfaces emit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize)]
#[non_exhaustive]
pub struct Methods {
    /// The method of the `direct` slot.
    pub direct: DirectMethod,
    /// The method of the `diffuse` slot.
    pub diffuse: DiffuseMethod,
    /// The method of the `caustics` slot.
    pub caustics: CausticsMethod,
    /// The method of the `specular` slot.
    pub specular: SpecularMethod,
}

/// A slot has no method of this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the {slot} slot has no method {method:?}; its methods: {known}")]
pub struct UnknownMethod {
    /// The slot asked for.
    pub slot: Slot,
    /// The method asked for.
    pub method: String,
    /// The methods there are.
    pub known: String,
}

impl Methods {
    /// No method but for direct light.
    pub(super) const DIRECT_ALONE: Methods = Methods {
        direct: DirectMethod::ShadowMap,
        diffuse: DiffuseMethod::None,
        caustics: CausticsMethod::None,
        specular: SpecularMethod::None,
    };

    /// The name of the method that fills `slot`; `surface` for emission.
    pub fn name_of(&self, slot: Slot) -> &'static str {
        match slot {
            Slot::Emission => "surface",
            Slot::Direct => self.direct.name(),
            Slot::Diffuse => self.diffuse.name(),
            Slot::Caustics => self.caustics.name(),
            Slot::Specular => self.specular.name(),
        }
    }

    /// Whether something fills `slot`: a method, or for emission the surfaces themselves.
    pub fn fills(&self, slot: Slot) -> bool {
        self.name_of(slot) != "none"
    }

    /// The names that [`Methods::set`] takes for a slot.
    pub fn names(slot: Slot) -> &'static [&'static str] {
        match slot {
            Slot::Emission => &["surface"],
            Slot::Direct => DirectMethod::NAMES,
            Slot::Diffuse => DiffuseMethod::NAMES,
            Slot::Caustics => CausticsMethod::NAMES,
            Slot::Specular => SpecularMethod::NAMES,
        }
    }

    /// Chooses the method of one slot by name.
    ///
    /// # Errors
    /// A name that the slot does not have; the message lists those it has.
    pub fn set(&mut self, slot: Slot, method: &str) -> Result<(), UnknownMethod> {
        let unknown = || UnknownMethod { slot, method: method.to_owned(), known: Methods::names(slot).join(", ") };
        match slot {
            Slot::Emission => return Err(unknown()),
            Slot::Direct => self.direct = DirectMethod::from_name(method).ok_or_else(unknown)?,
            Slot::Diffuse => self.diffuse = DiffuseMethod::from_name(method).ok_or_else(unknown)?,
            Slot::Caustics => self.caustics = CausticsMethod::from_name(method).ok_or_else(unknown)?,
            Slot::Specular => self.specular = SpecularMethod::from_name(method).ok_or_else(unknown)?,
        }
        Ok(())
    }
}
