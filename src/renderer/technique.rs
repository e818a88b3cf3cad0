//! Techniques: named sets of methods.

use super::choices::{CausticsMethod, DiffuseMethod, DirectMethod, Methods, SpecularMethod};
use crate::method::Preset;

/// No technique of this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no technique {0:?}; techniques: {known}", known = Technique::names().join(", "))]
pub struct UnknownTechnique(pub String);

/// A technique is a name, the methods of its slots (shadow maps for `direct`, none elsewhere unless it says so), and what it sets otherwise than
/// the presets do.
macro_rules! techniques {
    ($(
        $(#[$doc:meta])*
        $technique:ident, $name:literal { $($slot:ident: $choice:ident::$method:ident),* }
        $({ $($preset:ident: $($key:literal = $value:literal),+;)+ })?
    )*) => {
        /// A named set of methods.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
        #[non_exhaustive]
        pub enum Technique {
            $($(#[$doc])* #[serde(rename = $name)] $technique,)*
        }

        impl Technique {
            /// All techniques.
            pub const ALL: [Technique; [$($name),*].len()] = [$(Technique::$technique),*];

            /// The name used on the command line.
            pub fn name(self) -> &'static str {
                match self { $(Technique::$technique => $name),* }
            }

            /// The methods that make up the technique.
            pub fn methods(self) -> Methods {
                match self { $(Technique::$technique => Methods { $($slot: $choice::$method,)* ..Methods::DIRECT_ALONE }),* }
            }

            /// What the technique sets otherwise than the preset, as `piece.key`.
            pub(super) fn adjustments(self, preset: Preset) -> &'static [(&'static str, u32)] {
                match self { $(Technique::$technique => {
                    $($(if preset.name() == stringify!($preset) { return &[$(($key, $value)),+]; })+)?
                })* }
                let _ = preset;
                &[]
            }
        }
    };
}

techniques! {
    /// Direct light alone: shadow maps, no indirect light.
    Direct, "direct" {}
    /// Reflective shadow maps (Dachsbacher & Stamminger 2005): VPLs gathered at every pixel, without visibility.
    Rsm, "rsm" { diffuse: DiffuseMethod::Rsm }
    /// VPLs gathered at regions of several sizes, and caustic photons through per-pixel lists (Quyen 2014). Views of 1024² would take a third of
    /// its time.
    Hybrid, "hybrid" { diffuse: DiffuseMethod::Vpl, caustics: CausticsMethod::Photons } {
        high: "lights.resolution" = 512, "shadow.filter_radius" = 1;
    }
    /// Light caches around what the camera sees, lit by virtual area lights (Reich 2015): diffuse light, and glossy reflections of it.
    Volumes, "volumes" { diffuse: DiffuseMethod::Volumes, specular: SpecularMethod::RadianceMaps }
    /// Light between area particles along links that were traced once (Chang, Park & Ihm), direct light by rays: geometry takes seconds, lights and
    /// camera move freely.
    Particles, "particles" { direct: DirectMethod::Traced, diffuse: DiffuseMethod::Particles, specular: SpecularMethod::Trace }
    /// Light maps that are renewed where light changed, caustic photons that are kept, and maps of the surroundings of glossy objects (Larsen &
    /// Christensen 2004).
    Lightmaps, "lightmaps" {
        diffuse: DiffuseMethod::Lightmaps, caustics: CausticsMethod::Points, specular: SpecularMethod::Cubemap
    }
    /// Path tracing and light tracing: the reference, at as many samples as time allows.
    Path, "path" {
        direct: DirectMethod::Traced, diffuse: DiffuseMethod::Path, caustics: CausticsMethod::Path, specular: SpecularMethod::Path
    }
    /// Stochastic progressive photon mapping: the reference for caustics that are seen in mirrors or through glass.
    Sppm, "sppm" {
        direct: DirectMethod::Traced, diffuse: DiffuseMethod::Sppm, caustics: CausticsMethod::Sppm, specular: SpecularMethod::Sppm
    }
}

impl Technique {
    /// The names of all techniques.
    pub fn names() -> Vec<&'static str> {
        Technique::ALL.map(Technique::name).to_vec()
    }

    /// The technique called `name`.
    ///
    /// # Errors
    /// Another name; the message lists those there are.
    pub fn from_name(name: &str) -> Result<Technique, UnknownTechnique> {
        let found = Technique::ALL.into_iter().find(|technique| technique.name() == name);
        found.ok_or_else(|| UnknownTechnique(name.to_owned()))
    }
}
