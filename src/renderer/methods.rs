//! All methods as data: what the renderer asks of whichever is chosen. Made from the list in `method/`.

use std::sync::Arc;

use super::choices::{DirectMethod, Methods};
use super::settings::Settings;
use crate::estimator::{Estimating, Estimator, Samples};
use crate::frame::caches::CacheSight;
use crate::frame::light_views::Views;
use crate::frame::voxels;
use crate::graph::bindings::ImageRef;
use crate::method::{Error, FrameCx, Inputs, Method, Rays, for_all_methods};
use crate::scene::Facts;
use crate::slot::{CausticPaths, LightPaths, PixelFilter, Slot};
use crate::vulkan::{Pipelines, VulkanError};

/// Declares a method's passes with its options out of all settings.
type Declare = fn(&mut FrameCx<'_, '_>, &Settings) -> Result<Option<ImageRef>, Error>;

/// Likewise those that make other slots better.
type Refine = fn(&mut FrameCx<'_, '_>, &Settings, &[(Slot, ImageRef)]);

/// Makes an estimator on a device.
type Open = fn(&Arc<Pipelines>) -> Result<Box<dyn Estimating>, VulkanError>;

/// A method, with its options taken from all settings.
pub(crate) struct MethodEntry {
    pub(crate) slot: Slot,
    pub(crate) name: &'static str,
    pub(crate) light_paths: fn(&Settings) -> LightPaths,
    pub(crate) inputs: fn(&Settings) -> Inputs,
    pub(crate) skip: fn(&Settings, &Facts) -> Option<&'static str>,
    pub(crate) reduced: fn(&Settings) -> Option<String>,
    pub(crate) lead_in: fn(&Settings) -> u32,
    pub(crate) shaders: fn(&Settings, bool) -> Vec<&'static str>,
    pub(crate) lights_mirrored: bool,
    pub(crate) shows_lamps: bool,
    pub(crate) follows_lamps: bool,
    pub(crate) prepare: fn(&mut FrameCx<'_, '_>, &Settings),
    pub(crate) declare: Declare,
    pub(crate) refine: Refine,
}

/// An estimator, likewise.
pub(crate) struct EstimatorEntry {
    pub(crate) name: &'static str,
    pub(crate) slots: &'static [Slot],
    pub(crate) first_pass: [&'static str; 2],
    pub(crate) light_paths: fn(&Settings) -> LightPaths,
    pub(crate) filter: fn(&Settings) -> PixelFilter,
    pub(crate) samples: fn(&Settings) -> Samples,
    pub(crate) shaders: &'static [&'static str],
    pub(crate) open: Open,
}

/// What fills a slot.
#[derive(Clone, Copy)]
pub(crate) enum Filler {
    Method(&'static MethodEntry),
    Estimator(&'static EstimatorEntry),
}

/// What a method takes, and what light caches take that it lights.
fn with_caches(inputs: Inputs, settings: &Settings) -> Inputs {
    if !inputs.caches {
        return inputs;
    }
    let rays = if settings.volumes.cache_settings().traces() { Rays::ToSurfaces } else { Rays::None };
    inputs.and(Inputs { light_depth: Views::All, light_flux: Views::All, rays, ..Inputs::default() })
}

impl MethodEntry {
    /// The programs that the method may run, those of light caches that it lights included.
    pub(super) fn programs(&self, settings: &Settings, software: bool) -> Vec<&'static str> {
        let mut shaders = (self.shaders)(settings, software);
        if (self.inputs)(settings).caches {
            shaders.push("caches/*");
            if let CacheSight::Cones(voxel_settings) = settings.volumes.cache_settings().sight {
                shaders.extend(voxels::shaders(&voxel_settings));
            }
        }
        shaders
    }
}

macro_rules! entries {
    ($slot:ident { $($module:ident => $method:ident($options:ident),)* }) => {
        &[$(MethodEntry {
            slot: <crate::$slot::$module::$method as Method>::SLOT,
            name: <crate::$slot::$module::$method as Method>::NAME,
            light_paths: |settings| <crate::$slot::$module::$method as Method>::light_paths(&settings.$module),
            inputs: |settings| with_caches(<crate::$slot::$module::$method as Method>::inputs(&settings.$module), settings),
            skip: |settings, facts| <crate::$slot::$module::$method as Method>::skip(&settings.$module, facts),
            reduced: |settings| <crate::$slot::$module::$method as Method>::reduced(&settings.$module),
            lead_in: |settings| <crate::$slot::$module::$method as Method>::lead_in(&settings.$module),
            shaders: |settings, software| <crate::$slot::$module::$method as Method>::shaders(&settings.$module, software),
            lights_mirrored: <crate::$slot::$module::$method as Method>::LIGHTS_MIRRORED,
            shows_lamps: <crate::$slot::$module::$method as Method>::SHOWS_LAMPS,
            follows_lamps: <crate::$slot::$module::$method as Method>::FOLLOWS_LAMPS,
            prepare: |cx, settings| <crate::$slot::$module::$method as Method>::prepare(cx, &settings.$module),
            declare: |cx, settings| <crate::$slot::$module::$method as Method>::declare(cx, &settings.$module),
            refine: |cx, settings, slots| <crate::$slot::$module::$method as Method>::refine(cx, &settings.$module, slots),
        }),*]
    };
}

macro_rules! estimator_entries {
    ({ $($estimator:ident => $type:ident($options:ident),)* }) => {
        &[$(EstimatorEntry {
            name: <crate::estimator::$estimator::$type as Estimator>::NAME,
            slots: <crate::estimator::$estimator::$type as Estimator>::SLOTS,
            first_pass: <crate::estimator::$estimator::$type as Estimator>::FIRST_PASS,
            light_paths: |settings| <crate::estimator::$estimator::$type as Estimator>::light_paths(&settings.$estimator),
            filter: |settings| <crate::estimator::$estimator::$type as Estimator>::filter(&settings.$estimator),
            samples: |settings| <crate::estimator::$estimator::$type as Estimator>::samples(&settings.$estimator),
            shaders: <crate::estimator::$estimator::$type as Estimator>::SHADERS,
            open: |pipelines| <crate::estimator::$estimator::$type as Estimator>::open(pipelines),
        }),*]
    };
}

macro_rules! tables {
    (direct $direct:tt diffuse $diffuse:tt caustics $caustics:tt specular $specular:tt estimator $estimator:tt) => {
        static DIRECT: &[MethodEntry] = entries! { direct $direct };
        static DIFFUSE: &[MethodEntry] = entries! { diffuse $diffuse };
        static CAUSTICS: &[MethodEntry] = entries! { caustics $caustics };
        static SPECULAR: &[MethodEntry] = entries! { specular $specular };
        static ESTIMATORS: &[EstimatorEntry] = estimator_entries! { $estimator };
    };
}
for_all_methods! { tables }

/// All methods and estimators with these options: their names, and the programs that they may run.
pub(super) fn all_methods(
    settings: &Settings,
    software: bool,
    of_inputs: fn(Inputs) -> &'static [&'static str],
) -> Vec<(&'static str, Vec<&'static str>)> {
    let methods = [DIRECT, DIFFUSE, CAUSTICS, SPECULAR].into_iter().flatten().map(|method| {
        let mut shaders = method.programs(settings, software);
        shaders.extend(of_inputs((method.inputs)(settings)));
        (method.name, shaders)
    });
    methods.chain(ESTIMATORS.iter().map(|estimator| (estimator.name, estimator.shaders.to_vec()))).collect()
}

impl Methods {
    /// The estimator that fills some slot, if one does. It then fills `direct` and `emission` too where rays are asked for.
    pub(crate) fn estimator(&self) -> Option<&'static EstimatorEntry> {
        let indirect = [Slot::Diffuse, Slot::Caustics, Slot::Specular];
        indirect.into_iter().find_map(|slot| ESTIMATORS.iter().find(|entry| entry.name == self.name_of(slot)))
    }

    /// What fills `slot`: nothing in particular for emission.
    pub(crate) fn filler(&self, slot: Slot) -> Option<Filler> {
        let name = self.name_of(slot);
        let along = self.direct == DirectMethod::Traced && [Slot::Emission, Slot::Direct].contains(&slot);
        let estimator = self.estimator().filter(|entry| entry.slots.contains(&slot) && (along || entry.name == name));
        let methods = match slot {
            Slot::Emission => &[],
            Slot::Direct => DIRECT,
            Slot::Diffuse => DIFFUSE,
            Slot::Caustics => CAUSTICS,
            Slot::Specular => SPECULAR,
        };
        let method = methods.iter().find(|entry| entry.name == name);
        estimator.map(Filler::Estimator).or(method.map(Filler::Method))
    }
}

impl Methods {
    /// Whether mirrors show lamps and the sky in the slot `direct`.
    pub(super) fn shows_lamps(&self) -> bool {
        self.filler(Slot::Direct).is_some_and(|filler| match filler {
            Filler::Method(method) => method.shows_lamps,
            Filler::Estimator(_) => true,
        })
    }
}

impl Settings {
    /// Whether a method of the slot `specular` shows lamps and the sky in mirrors, where that of the slot `direct` does not.
    pub(super) fn follows_lamps(&self) -> bool {
        matches!(self.methods.filler(Slot::Specular), Some(Filler::Method(method)) if method.follows_lamps)
    }

    /// Whether a method makes all slots better that methods fill.
    pub(super) fn refines_slots(&self) -> bool {
        let refines =
            |slot| matches!(self.methods.filler(slot), Some(Filler::Method(method)) if (method.inputs)(self).slots);
        Slot::ALL.into_iter().any(refines)
    }

    /// What the settings ask for and their methods do less of, a sentence each. A renderer that takes the settings warns of it.
    pub fn reduced(&self) -> Vec<String> {
        let methods = Slot::ALL.into_iter().filter_map(|slot| match self.methods.filler(slot) {
            Some(Filler::Method(method)) => (method.reduced)(self),
            _ => None,
        });
        methods.chain(self.mirrors_without_diffuse()).collect()
    }

    /// That what mirrors show lacks diffuse light, if it does.
    fn mirrors_without_diffuse(&self) -> Option<String> {
        let Some(Filler::Method(specular)) = self.methods.filler(Slot::Specular) else { return None };
        let offered =
            matches!(self.methods.filler(Slot::Diffuse), Some(Filler::Method(diffuse)) if diffuse.lights_mirrored);
        let offering: Vec<&str> =
            DIFFUSE.iter().filter(|entry| entry.lights_mirrored).map(|entry| entry.name).collect();
        let inputs = (specular.inputs)(self);
        let centers =
            if inputs.slots { ", and samples no more of the slot diffuse than centres of pixels" } else { "" };
        (inputs.mirrored_light && !offered).then(|| {
            format!(
                "{} shows what mirrors show by direct light alone{centers}: --diffuse {} offers no other; these do: {}",
                specular.name,
                self.methods.name_of(Slot::Diffuse),
                offering.join(", ")
            )
        })
    }

    /// Frames that come before the first one that is worth a look, for methods that keep something over frames: zero if none does.
    pub fn lead_in(&self) -> u32 {
        let methods = Slot::ALL.into_iter().filter_map(|slot| match self.methods.filler(slot) {
            Some(Filler::Method(method)) => Some((method.lead_in)(self)),
            _ => None,
        });
        methods.max().unwrap_or(0)
    }

    /// Scatterings between the light and the first visible surface that the methods account for, at most; `None`: no limit. What
    /// a reference of equal light paths is limited to.
    pub fn bounces(&self) -> Option<u32> {
        let indirect = [Slot::Diffuse, Slot::Caustics, Slot::Specular];
        let mut filled = indirect.into_iter().filter(|slot| self.methods.fills(*slot));
        filled.try_fold(0, |most, slot| Some(self.light_paths(slot).bounces?.max(most)))
    }

    /// What a reference of equal light paths shows in `slot`. Slots that no indirect method fills go with `diffuse`.
    pub fn light_paths(&self, slot: Slot) -> LightPaths {
        let indirect = [Slot::Diffuse, Slot::Caustics, Slot::Specular].contains(&slot);
        // What leaves one of the two is in the other.
        let specular = if slot == Slot::Direct { self.light_paths(Slot::Specular) } else { LightPaths::default() };
        if [CausticPaths::Unmirrored, CausticPaths::Mirrored].contains(&specular.caustics) {
            return specular;
        }
        let own = self.own_light_paths(slot, indirect);
        match own.mirrors {
            // Of small lamps photons alone find what mirrors show then, and they know no limits.
            Some(_) if self.mirrors_have_caustics() => {
                LightPaths { caustics: CausticPaths::Mirrored, ..LightPaths::default() }
            }
            // What mirrors show is as bright as what the method of the slot `diffuse` says of it.
            Some(_) => LightPaths { bounces: self.mirrored_bounces(), ..own },
            None => own,
        }
    }

    fn mirrors_have_caustics(&self) -> bool {
        matches!(self.methods.filler(Slot::Caustics), Some(Filler::Method(method)) if method.lights_mirrored)
    }

    /// Scatterings between the light and what mirrors show, at most.
    fn mirrored_bounces(&self) -> Option<u32> {
        match self.methods.filler(Slot::Diffuse) {
            Some(Filler::Method(method)) if method.lights_mirrored => self.light_paths(Slot::Diffuse).bounces,
            _ => Some(0),
        }
    }

    fn own_light_paths(&self, slot: Slot, indirect: bool) -> LightPaths {
        match self.methods.filler(slot).filter(|_| indirect) {
            Some(Filler::Method(method)) => (method.light_paths)(self),
            Some(Filler::Estimator(estimator)) => (estimator.light_paths)(self),
            None if slot == Slot::Diffuse => LightPaths::up_to(0),
            None => LightPaths { caustics: Default::default(), ..self.light_paths(Slot::Diffuse) },
        }
    }

    /// Where in a pixel the methods sample light: at its centre, unless an estimator does otherwise, or some method makes it the mean over the pixel where the two
    /// differ.
    pub fn filter(&self) -> PixelFilter {
        let center = if self.refines_slots() { PixelFilter::Box } else { PixelFilter::Center };
        self.methods.estimator().map_or(center, |estimator| (estimator.filter)(self))
    }
}

#[cfg(test)]
mod tests {
    use super::super::technique::Technique;
    use super::*;
    use crate::method::Preset;

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
        let rsm = of(Technique::Rsm).with(|rsm| rsm.path = path.path.clone());
        assert_eq!((rsm.bounces(), rsm.filter()), (Some(1), PixelFilter::Center));
        let caustics = |slot| of(Technique::Particles).light_paths(slot).caustics;
        assert_eq!([Slot::Direct, Slot::Specular].map(caustics), [CausticPaths::Unmirrored; 2]);
        assert_eq!([Slot::Emission, Slot::Diffuse, Slot::Caustics].map(caustics), [CausticPaths::All; 3]);
        let maps = of(Technique::Volumes).light_paths(Slot::Specular);
        assert_eq!((maps.bounces, maps.caustics, maps.mirrors), (Some(1), CausticPaths::None, None), "L D S E");
        let specular = |changes: &[(&str, &str)]| {
            let mut settings = of(Technique::Particles);
            changes.iter().for_each(|(key, value)| settings.set(key, value).expect("a setting"));
            let LightPaths { bounces, mirrors, .. } = settings.light_paths(Slot::Specular);
            (bounces, mirrors, settings.light_paths(Slot::Direct) == settings.light_paths(Slot::Specular))
        };
        assert_eq!(specular(&[]), (None, Some(8), true));
        assert_eq!(specular(&[("particles.bounces", "2"), ("trace.depth", "3")]), (Some(3), Some(3), true));
        let cubemap = of(Technique::Lightmaps).light_paths(Slot::Specular);
        assert_eq!((cubemap.bounces, cubemap.caustics, cubemap.mirrors), (None, CausticPaths::Mirrored, None));
        let mut uncaustic = of(Technique::Lightmaps);
        uncaustic.methods.caustics = of(Technique::Particles).methods.caustics;
        let cubemap = uncaustic.light_paths(Slot::Specular);
        assert_eq!((cubemap.bounces, cubemap.caustics, cubemap.mirrors), (None, CausticPaths::Unmirrored, Some(4)));
        // What mirrors show is lit directly alone where the method of the slot `diffuse` says nothing of it.
        let mut rsm = of(Technique::Rsm);
        rsm.methods.specular = of(Technique::Particles).methods.specular;
        assert_eq!(
            (rsm.light_paths(Slot::Specular).bounces, rsm.light_paths(Slot::Diffuse).bounces),
            (Some(0), Some(1))
        );
        let filled = |technique| Slot::ALL.into_iter().filter(move |slot| of(technique).methods.fills(*slot));
        assert!(filled(Technique::Direct).eq([Slot::Emission, Slot::Direct]));
        assert!(filled(Technique::Rsm).eq([Slot::Emission, Slot::Direct, Slot::Diffuse]));
    }
}
