//! Settings: which method fills each slot, and the options of every piece, addressed as `piece.key`.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::caustics::photons::{
    ListProjection, PhotonFootprint, PhotonGeometry, PhotonKernel, PhotonSettings, PhotonSplatting, PhotonTracing,
};
use crate::diffuse::rsm::RsmSettings;
use crate::diffuse::vpl::{VplSettings, VplShading, VplVisibility};
use crate::direct::shadow_map::ShadowSettings;
use crate::direct::traced::TracedSettings;
use crate::estimator::PathSettings;
use crate::frame::light_options::LightSettings;
use crate::method::{Preset, choices};
use crate::slot::{CausticPaths, PixelFilter, Slot};

/// A setting that does not exist or does not take the value given. One sentence: what, where, what to do.
#[derive(Debug, thiserror::Error)]
pub enum SettingsError {
    /// No technique of this name.
    #[error("there is no technique {0:?}; techniques: {known}", known = Technique::names().join(", "))]
    UnknownTechnique(String),
    /// The slot has no method of this name.
    #[error("the {slot} slot has no method {method:?}; its methods: {known}")]
    UnknownMethod {
        /// The slot asked for.
        slot: Slot,
        /// The method asked for.
        method: String,
        /// The methods there are.
        known: String,
    },
    /// No setting of this name.
    #[error("there is no setting {key:?}; settings: {known}")]
    UnknownKey {
        /// The key asked for.
        key: String,
        /// The keys there are.
        known: String,
    },
    /// The value is of the wrong kind or outside its range.
    #[error("setting {key} cannot be {value:?}: {reason}")]
    BadValue {
        /// The setting.
        key: String,
        /// The value given.
        value: String,
        /// What it takes.
        reason: String,
    },
}

/// A named set of methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Technique {
    /// Direct light alone: shadow maps, no indirect light.
    Direct,
    /// Reflective shadow maps (Dachsbacher & Stamminger 2005): VPLs gathered at every pixel, without visibility.
    Rsm,
    /// VPLs gathered at regions of several sizes, and caustic photons through per-pixel lists (Quyen 2014).
    Hybrid,
    /// Path tracing and light tracing: the reference, at as many samples as time allows.
    Path,
}

impl Technique {
    /// All techniques.
    pub const ALL: [Technique; 4] = [Technique::Direct, Technique::Rsm, Technique::Hybrid, Technique::Path];

    /// The name used on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Technique::Direct => "direct",
            Technique::Rsm => "rsm",
            Technique::Hybrid => "hybrid",
            Technique::Path => "path",
        }
    }

    /// The names of all techniques.
    pub fn names() -> Vec<&'static str> {
        Technique::ALL.map(Technique::name).to_vec()
    }

    /// The technique called `name`.
    pub fn from_name(name: &str) -> Result<Technique, SettingsError> {
        let found = Technique::ALL.into_iter().find(|technique| technique.name() == name);
        found.ok_or_else(|| SettingsError::UnknownTechnique(name.to_owned()))
    }

    /// The methods that make up the technique.
    pub fn methods(self) -> Methods {
        let none = Methods {
            direct: DirectMethod::ShadowMap,
            diffuse: DiffuseMethod::None,
            caustics: CausticsMethod::None,
            specular: SpecularMethod::None,
        };
        match self {
            Technique::Direct => none,
            Technique::Rsm => Methods { diffuse: DiffuseMethod::Rsm, ..none },
            Technique::Hybrid => Methods { diffuse: DiffuseMethod::Vpl, caustics: CausticsMethod::Photons, ..none },
            Technique::Path => Methods {
                direct: DirectMethod::Traced,
                diffuse: DiffuseMethod::Path,
                caustics: CausticsMethod::Path,
                specular: SpecularMethod::Path,
            },
        }
    }
}

choices! {
    /// How the `direct` slot is filled.
    DirectMethod {
        /// Not at all.
        None = "none",
        /// Filtered, normal-offset shadow maps.
        ShadowMap = "shadow-map",
        /// Rays to the lights: exact shadows; noise where light comes from surfaces or the sky.
        Traced = "traced",
    }
}
choices! {
    /// How the `diffuse` slot is filled.
    DiffuseMethod {
        /// Not at all.
        None = "none",
        /// Reflective shadow maps: VPLs gathered at every pixel.
        Rsm = "rsm",
        /// Virtual point lights, gathered at regions of several sizes.
        Vpl = "vpl",
        /// Path tracing.
        Path = "path",
    }
}
choices! {
    /// How the `caustics` slot is filled.
    CausticsMethod {
        /// Not at all.
        None = "none",
        /// Photons from the specular surfaces that lights see, splatted.
        Photons = "photons",
        /// Path tracing and light tracing.
        Path = "path",
    }
}
choices! {
    /// How the `specular` slot is filled.
    SpecularMethod {
        /// Not at all.
        None = "none",
        /// Path tracing.
        Path = "path",
    }
}

/// The method of each slot. `emission` has no choice: it is what the surfaces emit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
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

impl Methods {
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

    /// Whether paths are traced for some slot besides `direct`.
    pub fn traces_paths(&self) -> bool {
        self.diffuse == DiffuseMethod::Path
            || self.caustics == CausticsMethod::Path
            || self.specular == SpecularMethod::Path
    }

    /// Chooses the method of one slot by name.
    pub fn set(&mut self, slot: Slot, method: &str) -> Result<(), SettingsError> {
        let unknown =
            |known: &[&str]| SettingsError::UnknownMethod { slot, method: method.to_owned(), known: known.join(", ") };
        match slot {
            Slot::Emission => return Err(unknown(&["surface"])),
            Slot::Direct => {
                self.direct = DirectMethod::from_name(method).ok_or_else(|| unknown(DirectMethod::NAMES))?
            }
            Slot::Diffuse => {
                self.diffuse = DiffuseMethod::from_name(method).ok_or_else(|| unknown(DiffuseMethod::NAMES))?
            }
            Slot::Caustics => {
                self.caustics = CausticsMethod::from_name(method).ok_or_else(|| unknown(CausticsMethod::NAMES))?
            }
            Slot::Specular => {
                self.specular = SpecularMethod::from_name(method).ok_or_else(|| unknown(SpecularMethod::NAMES))?
            }
        }
        Ok(())
    }
}

/// Everything that decides how a frame is made, apart from the scene, the view and the size.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// The technique that the methods come from, before any was replaced.
    pub technique: Technique,
    /// The preset that the options come from, before any was changed.
    pub preset: Preset,
    /// The method of each slot.
    pub methods: Methods,
    /// What stands for the lights.
    pub lights: LightSettings,
    /// Shadow-map filtering.
    pub shadow: ShadowSettings,
    /// Options of the `traced` method.
    pub traced: TracedSettings,
    /// Options of the `rsm` method.
    pub rsm: RsmSettings,
    /// Options of the `vpl` method.
    pub vpl: VplSettings,
    /// Options of the `photons` method.
    pub photons: PhotonSettings,
    /// Options of the `path` methods.
    pub path: PathSettings,
}

impl Settings {
    /// The settings of `technique` at `preset`.
    pub fn new(technique: Technique, preset: Preset) -> Settings {
        let lights = LightSettings { resolution: 512, emitter_samples: 8, emitter_resolution: 128, sky_samples: 16 };
        let default = Settings {
            technique,
            preset,
            methods: technique.methods(),
            lights,
            shadow: ShadowSettings { filter_radius: 1, normal_offset: 0.05 },
            traced: TracedSettings { samples: 4 },
            rsm: RsmSettings { vpls: 256 },
            vpl: VplSettings {
                count: 256,
                bounces: 1,
                visibility: VplVisibility::None,
                shading: VplShading::Auto,
                levels: 7,
                depth_threshold: 0.01,
                normal_threshold: 0.1,
                ism_resolution: 32,
                ism_points: 2048,
            },
            photons: PhotonSettings {
                max: 38_000,
                bounces: 2,
                trace: PhotonTracing::Bvh,
                geometry: PhotonGeometry::Lists,
                projection: ListProjection::Scene,
                views: 3,
                resolution: 128,
                splat: PhotonSplatting::Auto,
                downscale: 1,
                kernel: PhotonKernel::Gaussian,
                footprint: PhotonFootprint::Beam,
                radius: 1.0,
            },
            path: PathSettings { spp: 64, bounces: None, filter: PixelFilter::Center, seed: 0 },
        };
        let lights = default.lights.clone();
        match preset {
            Preset::Default => default,
            Preset::Draft => Settings {
                lights: LightSettings { resolution: 256, emitter_samples: 4, emitter_resolution: 64, sky_samples: 8 },
                traced: TracedSettings { samples: 1 },
                rsm: RsmSettings { vpls: 64 },
                vpl: VplSettings { count: 64, ..default.vpl },
                photons: PhotonSettings { max: 9_500, downscale: 2, ..default.photons },
                path: PathSettings { spp: 16, ..default.path },
                ..default
            },
            Preset::High => Settings {
                lights: LightSettings {
                    // Views of 1024² would take a third of the time of `hybrid`.
                    resolution: if technique == Technique::Hybrid { 512 } else { 1024 },
                    emitter_samples: 32,
                    emitter_resolution: 256,
                    sky_samples: 64,
                },
                shadow: ShadowSettings {
                    filter_radius: if technique == Technique::Hybrid { 1 } else { 2 },
                    ..default.shadow
                },
                traced: TracedSettings { samples: 16 },
                rsm: RsmSettings { vpls: 1024 },
                vpl: VplSettings { count: 320, bounces: 16, visibility: VplVisibility::Traced, ..default.vpl },
                photons: PhotonSettings { bounces: 4, ..default.photons },
                path: PathSettings { spp: 256, ..default.path },
                ..default
            },
            // Dachsbacher & Stamminger 2005, section 5: maps of 512², 400 samples a pixel. Quyen 2014, chapter 4: maps of 512², 256 VPLs,
            // lists and rays of 128² from the camera, irradiance at a quarter of the resolution.
            Preset::Paper => Settings {
                lights: LightSettings { resolution: 512, ..lights },
                rsm: RsmSettings { vpls: 400 },
                vpl: VplSettings { count: 256, shading: VplShading::Stencil, ..default.vpl },
                photons: PhotonSettings {
                    max: 38_146,
                    bounces: 1,
                    trace: PhotonTracing::Lines,
                    projection: ListProjection::Camera,
                    splat: PhotonSplatting::Discs,
                    downscale: 4,
                    footprint: PhotonFootprint::Way,
                    ..default.photons
                },
                ..default
            },
        }
    }

    /// Scatterings between the light and the first visible surface that the methods account for, at most; `None`: no limit. What
    /// a reference of equal light paths is limited to.
    pub fn bounces(&self) -> Option<u32> {
        let Methods { direct: _, diffuse, caustics, specular } = self.methods;
        let diffuse = self.diffuse_bounces(diffuse);
        let caustics = match caustics {
            CausticsMethod::None => Some(0),
            CausticsMethod::Photons => Some(self.photons.bounces),
            CausticsMethod::Path => self.path.bounces,
        };
        let specular = match specular {
            SpecularMethod::None => Some(0),
            SpecularMethod::Path => self.path.bounces,
        };
        [diffuse, caustics, specular].into_iter().try_fold(0, |most, bounces| Some(bounces?.max(most)))
    }

    /// What a reference of equal light paths shows in `slot`: the limit of scatterings, and which caustics. Slots that no indirect method
    /// fills go with `diffuse`.
    pub fn light_paths(&self, slot: Slot) -> (Option<u32>, CausticPaths) {
        let Methods { direct: _, diffuse, caustics, specular } = self.methods;
        match slot {
            Slot::Caustics if caustics == CausticsMethod::Photons => {
                (Some(self.photons.bounces), CausticPaths::Specular)
            }
            Slot::Caustics if caustics == CausticsMethod::Path => (self.path.bounces, CausticPaths::All),
            Slot::Specular if specular == SpecularMethod::Path => (self.path.bounces, CausticPaths::All),
            _ => (self.diffuse_bounces(diffuse), CausticPaths::All),
        }
    }

    fn diffuse_bounces(&self, method: DiffuseMethod) -> Option<u32> {
        match method {
            DiffuseMethod::None => Some(0),
            DiffuseMethod::Rsm => Some(1),
            DiffuseMethod::Vpl => Some(self.vpl.bounces),
            DiffuseMethod::Path => self.path.bounces,
        }
    }

    /// Where in a pixel the methods sample light: at its centre, unless paths are traced otherwise.
    pub fn filter(&self) -> PixelFilter {
        if self.methods.traces_paths() { self.path.filter } else { PixelFilter::Center }
    }

    /// All settings that `set` takes, as `piece.key`.
    pub fn keys(&self) -> Vec<String> {
        let mut keys = Vec::new();
        for (piece, options) in self.pieces() {
            keys.extend(options.keys().map(|key| format!("{piece}.{key}")));
        }
        keys
    }

    /// Sets `piece.key` to a value written as on the command line.
    ///
    /// # Errors
    /// An unknown key lists the known ones; a bad value says what the setting takes.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), SettingsError> {
        let bad = |reason: String| SettingsError::BadValue { key: key.to_owned(), value: value.to_owned(), reason };
        let mut document = serde_json::to_value(&*self).map_err(|error| bad(error.to_string()))?;
        let known = self.keys();
        let place = key.split_once('.').filter(|_| known.iter().any(|name| name == key));
        let place = place.and_then(|(piece, option)| document.get_mut(piece)?.get_mut(option));
        let Some(place) = place else {
            return Err(SettingsError::UnknownKey { key: key.to_owned(), known: known.join(", ") });
        };
        *place = serde_json::from_str(value).unwrap_or_else(|_| Value::String(value.to_owned()));
        let changed: Settings = serde_json::from_value(document).map_err(|error| bad(error.to_string()))?;
        changed.check(key).map_err(bad)?;
        *self = changed;
        Ok(())
    }

    /// The options of every piece as one JSON object, `{"lights": {…}, …}`.
    pub fn options(&self) -> Map<String, Value> {
        self.pieces().into_iter().map(|(piece, options)| (piece, Value::Object(options))).collect()
    }

    fn pieces(&self) -> Vec<(String, Map<String, Value>)> {
        let Ok(Value::Object(document)) = serde_json::to_value(self) else { return Vec::new() };
        let choices = ["technique", "preset", "methods"];
        let pieces = document.into_iter().filter(|(name, _)| !choices.contains(&name.as_str()));
        pieces
            .filter_map(|(name, value)| if let Value::Object(options) = value { Some((name, options)) } else { None })
            .collect()
    }

    fn check(&self, key: &str) -> Result<(), String> {
        let within = |value: u32, low: u32, high: u32| {
            if (low..=high).contains(&value) { Ok(()) } else { Err(format!("it takes {low} to {high}")) }
        };
        let between = |value: f64, low: f64, high: f64| {
            if (low..=high).contains(&value) { Ok(()) } else { Err(format!("it takes {low} to {high}")) }
        };
        match key {
            "lights.resolution" => within(self.lights.resolution, 16, 4096),
            "lights.emitter_samples" => within(self.lights.emitter_samples, 0, 256),
            "lights.emitter_resolution" => within(self.lights.emitter_resolution, 16, 1024),
            "lights.sky_samples" => within(self.lights.sky_samples, 1, 256),
            "shadow.filter_radius" => within(self.shadow.filter_radius, 0, 4),
            "shadow.normal_offset" => between(self.shadow.normal_offset, 0.0, 16.0),
            "traced.samples" => within(self.traced.samples, 0, 1024),
            "rsm.vpls" => within(self.rsm.vpls, 0, 32768),
            "vpl.count" => within(self.vpl.count, 0, 65536),
            "vpl.bounces" => within(self.vpl.bounces, 0, 16),
            "vpl.levels" => within(self.vpl.levels, 1, 7),
            "vpl.depth_threshold" => between(self.vpl.depth_threshold, 0.0, 1.0),
            "vpl.normal_threshold" => between(self.vpl.normal_threshold, 0.0, 2.0),
            "vpl.ism_resolution" => within(self.vpl.ism_resolution, 8, 128),
            "vpl.ism_points" => within(self.vpl.ism_points, 16, 65536),
            "photons.max" => within(self.photons.max, 0, 1 << 22),
            "photons.bounces" => within(self.photons.bounces, 0, 16),
            "photons.views" => within(self.photons.views, 1, 3),
            "photons.resolution" => within(self.photons.resolution, 16, 1024),
            "photons.downscale" if ![1, 2, 4].contains(&self.photons.downscale) => Err("it takes 1, 2 or 4".to_owned()),
            "photons.radius" => between(self.photons.radius, 0.01, 100.0),
            "path.spp" => within(self.path.spp, 1, 1 << 20),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_can_be_set_to_its_own_value() {
        let mut settings = Settings::new(Technique::Rsm, Preset::Default);
        let before = settings.clone();
        for key in settings.keys() {
            let (piece, option) = key.split_once('.').expect("keys have a piece");
            let value = settings.options()[piece][option].to_string();
            settings.set(&key, &value).expect("its own value is within its range");
        }
        assert_eq!(settings, before);
    }

    #[test]
    fn methods_say_what_they_account_for() {
        let of = |technique| Settings::new(technique, Preset::Default);
        assert_eq!((of(Technique::Direct).bounces(), of(Technique::Rsm).bounces()), (Some(0), Some(1)));
        let mut path = of(Technique::Path);
        assert_eq!(path.bounces(), None);
        path.path.bounces = Some(3);
        assert_eq!((path.bounces(), path.filter()), (Some(3), PixelFilter::Center));
        path.path.filter = PixelFilter::Box;
        assert_eq!(path.filter(), PixelFilter::Box);
        let rsm = Settings { path: path.path, ..of(Technique::Rsm) };
        assert_eq!((rsm.bounces(), rsm.filter()), (Some(1), PixelFilter::Center));
        let filled = |technique| Slot::ALL.into_iter().filter(move |slot| of(technique).methods.fills(*slot));
        assert!(filled(Technique::Direct).eq([Slot::Emission, Slot::Direct]));
        assert!(filled(Technique::Rsm).eq([Slot::Emission, Slot::Direct, Slot::Diffuse]));
    }

    #[test]
    fn wrong_settings_say_what_would_be_right() {
        let mut settings = Settings::new(Technique::Rsm, Preset::Default);
        let unknown = settings.set("rsm.vlps", "3").expect_err("no such key").to_string();
        assert!(unknown.contains("rsm.vpls"), "{unknown}");
        let range = settings.set("lights.resolution", "5").expect_err("too small").to_string();
        assert!(range.contains("16 to 4096"), "{range}");
        assert!(settings.set("rsm.vpls", "many").is_err());
        assert!(settings.set("methods.diffuse", "rsm").is_err());
        settings.set("rsm.vpls", "512").expect("within its range");
        assert_eq!(settings.rsm.vpls, 512);
    }
}
