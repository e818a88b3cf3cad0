//! Which pieces a frame consists of: the settings' methods, as far as the scene and the request need them.

use std::rc::Rc;

use super::estimates::Means;
use super::frame::FrameRequest;
use super::methods::{Filler, MethodEntry};
use super::settings::Settings;
use crate::frame::camera::camera;
use crate::frame::compose::{MEANS_AT_ONCE, compose, estimated};
use crate::frame::gbuffer::{GBuffer, View, gbuffer};
use crate::frame::geometry::Geometry;
use crate::frame::inputs::{FrameInputs, FrameTime};
use crate::frame::light_set::LightSet;
use crate::frame::light_views::light_views;
use crate::frame::offers::Offers;
use crate::frame::rays::TracedScene;
use crate::frame::scene_data::SceneData;
use crate::frame::stored_light::StoredLight;
use crate::frame::tonemap::tonemap;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::method::{Error, FrameCx, Inputs};
use crate::scene::{Facts, Scene};
use crate::slot::Slot;

/// What a declared frame offers; absent where a method, the scene or the request leaves it out.
pub(crate) struct Declared {
    /// The slots that something fills.
    slots: Vec<(Slot, ImageRef)>,
    pub(crate) image: Option<ImageRef>,
    /// Present if a method that ran keeps its light on surfaces.
    pub(crate) stored_light: Option<Rc<StoredLight>>,
    pub(crate) display: Option<BufferRef<u32>>,
}

impl Declared {
    /// The image of a slot, if anything fills it.
    pub(crate) fn slot(&self, slot: Slot) -> Option<ImageRef> {
        self.slots.iter().find(|(known, _)| *known == slot).map(|(_, image)| *image)
    }
}

impl Declared {
    /// What somebody outside gets to see: the slots asked for, and the image.
    pub(crate) fn shown(&self, request: &FrameRequest) -> Vec<(String, ImageRef)> {
        let slots = Slot::ALL.into_iter().filter(|&slot| request.shows(slot));
        let slots = slots.filter_map(|slot| Some((slot.to_string(), self.slot(slot)?)));
        slots.chain(self.image.filter(|_| request.shows_image()).map(|image| ("image".to_owned(), image))).collect()
    }
}

/// A scene as it is on the device.
pub(crate) struct Prepared<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) data: &'a SceneData,
    pub(crate) lights: &'a LightSet,
    /// Present if a wanted slot is filled by rays and something shines.
    pub(crate) traced: Option<&'a TracedScene>,
    /// Present if an estimator fills a wanted slot.
    pub(crate) means: Option<&'a Means>,
}

/// A method that a frame wants, what it takes, and why the scene or the options leave it nothing to do.
pub(crate) struct Wanted {
    pub(crate) method: &'static MethodEntry,
    pub(crate) inputs: Inputs,
    pub(crate) skipped: Option<&'static str>,
    /// Whether its slot is asked for, not only what it offers to other methods.
    pub(crate) shown: bool,
}

/// The methods of the slots that a request wants.
pub(crate) fn wanted_methods(
    settings: &Settings,
    facts: &Facts,
    set: &LightSet,
    wants: impl Fn(Slot) -> bool + Copy,
) -> Vec<Wanted> {
    let method = |slot: Slot| {
        let Some(Filler::Method(method)) = settings.methods.filler(slot) else { return None };
        let inputs = (method.inputs)(settings);
        let unlit = inputs.light_views() && set.lights.is_empty();
        let skipped = unlit.then_some("no light").or_else(|| (method.skip)(settings, facts));
        Some(Wanted { method, inputs, skipped, shown: wants(slot) })
    };
    let all: Vec<Wanted> = Slot::ALL.into_iter().filter_map(method).collect();
    // What makes slots better takes part whichever of them is wanted, and looks at direct light.
    let refined =
        Slot::ALL.into_iter().any(wants) && all.iter().any(|method| method.skipped.is_none() && method.inputs.slots);
    let mirrored =
        |method: &Wanted| (method.shown || refined) && method.skipped.is_none() && method.inputs.mirrored_light;
    let mirrored = all.iter().any(mirrored);
    let offers = |wanted: &Wanted| {
        wanted.skipped.is_none()
            && (mirrored && wanted.method.lights_mirrored
                || refined && (wanted.inputs.slots || wanted.method.slot == Slot::Direct))
    };
    all.into_iter().filter(|wanted| wanted.shown || offers(wanted)).collect()
}

/// What the methods that run take together.
pub(crate) fn inputs_of(methods: &[Wanted]) -> Inputs {
    let running = methods.iter().filter(|wanted| wanted.skipped.is_none());
    running.fold(Inputs::default(), |all, wanted| all.and(wanted.inputs))
}

/// What the methods of a frame share, while it is declared.
pub(crate) struct Shared {
    facts: Facts,
    geometry: Geometry,
    view: View,
    time: FrameTime,
    stored_light: Option<u32>,
    pub(crate) surface: GBuffer,
}

impl Shared {
    /// Declares what the camera sees.
    pub(crate) fn declare(
        graph: &mut Graph<'_>,
        scene: &Scene,
        data: &SceneData,
        request: &FrameRequest,
        settings: &Settings,
    ) -> Shared {
        let facts = scene.facts();
        let shows_emission = facts.emissive || scene.materials().iter().any(|material| material.unlit);
        let refined = settings.refines_slots();
        let sky_asked = facts.sky && (refined || request.slots.contains(&Slot::Emission));
        let geometry = Geometry::import(graph, data);
        let view = View {
            camera: camera(&request.camera, request.size, data.origin),
            size: request.size,
            sky: scene.sky(),
            emission: (refined || request.wants(Slot::Emission)) && (shows_emission || sky_asked),
        };
        let surface = gbuffer(graph, data, &geometry, &facts, &view);
        let time = FrameTime { index: request.index, step: request.time_step };
        Shared { facts, geometry, view, time, stored_light: request.stored_light, surface }
    }

    /// Declares the light views that the methods take.
    pub(crate) fn inputs<'a>(
        &'a self,
        graph: &mut Graph<'_>,
        data: &'a SceneData,
        set: &'a LightSet,
        traced: Option<&'a TracedScene>,
        inputs: Inputs,
        settings: &Settings,
    ) -> FrameInputs<'a> {
        let of = (inputs.light_depth, inputs.light_flux);
        let lights = inputs.light_views().then(|| light_views(graph, data, &self.geometry, set, of));
        FrameInputs {
            data,
            facts: &self.facts,
            geometry: &self.geometry,
            camera: &self.view.camera,
            sky: self.view.sky,
            time: self.time,
            surface: &self.surface,
            set,
            caches: settings.volumes.cache_settings(),
            lights,
            traced,
            stored_light: self.stored_light,
            offers: Offers::default(),
            mirrored_lamps: settings.methods.shows_lamps(),
            follows_lamps: settings.follows_lamps(),
        }
    }
}

/// Declares the frame.
///
/// # Errors
/// What a method asks for and the device does not allow.
pub(crate) fn declare(
    graph: &mut Graph<'_>,
    prepared: &Prepared<'_>,
    settings: &Settings,
    request: &FrameRequest,
) -> Result<Declared, Error> {
    let Prepared { scene, data, lights, traced, means } = *prepared;
    let shared = Shared::declare(graph, scene, data, request, settings);
    let methods = wanted_methods(settings, &shared.facts, lights, |slot| request.wants(slot));
    if lights.lights.is_empty() && methods.iter().any(|wanted| wanted.inputs.light_views()) {
        graph.skip("light-views", "no light");
    }
    let frame = shared.inputs(graph, data, lights, traced, inputs_of(&methods), settings);
    let mut slots: Vec<(Slot, ImageRef)> = Vec::new();
    let shows_emission = request.wants(Slot::Emission) && settings.methods.filler(Slot::Emission).is_none();
    slots.extend(shared.surface.emission.filter(|_| shows_emission).map(|emission| (Slot::Emission, emission)));
    let mut declare = |graph: &mut Graph<'_>, wanted: &Wanted| {
        let method = wanted.method;
        if let Some(reason) = wanted.skipped {
            graph.skip(&format!("{}/{}", method.slot, method.name), reason);
            return Ok(());
        }
        let image = (method.declare)(&mut FrameCx::new(graph, &frame, wanted.inputs), settings)?;
        slots.extend(image.filter(|_| wanted.shown).map(|image| (method.slot, image)));
        Ok::<(), Error>(())
    };
    let running = || methods.iter().filter(|wanted| wanted.skipped.is_none());
    let (direct, others): (Vec<&Wanted>, Vec<&Wanted>) =
        methods.iter().partition(|wanted| wanted.method.slot == Slot::Direct);
    direct.into_iter().try_for_each(|wanted| declare(graph, wanted))?;
    for Wanted { method, inputs, .. } in running() {
        (method.prepare)(&mut FrameCx::new(graph, &frame, *inputs), settings);
    }
    others.into_iter().try_for_each(|wanted| declare(graph, wanted))?;
    for Wanted { method, inputs, .. } in running().filter(|wanted| wanted.inputs.slots) {
        (method.refine)(&mut FrameCx::new(graph, &frame, *inputs), settings, &slots);
    }
    for (&slot, pixels) in means.into_iter().flat_map(|means| &means.slots) {
        let fills = request.wants(slot) && matches!(settings.methods.filler(slot), Some(Filler::Estimator(_)));
        if let (true, Some(means)) = (fills, means) {
            slots.push((slot, estimated(graph, slot, request.size, (pixels, means.key), MEANS_AT_ONCE)));
        }
    }
    let stored_light = frame.offers.get();
    let mut declared = Declared { slots, image: None, stored_light, display: None };
    if request.wants_image() {
        let image = compose(graph, &shared.surface, scene.sky(), |slot| declared.slot(slot));
        declared.image = Some(image);
        declared.display = request.tonemap.map(|curve| tonemap(graph, image, curve));
    }
    Ok(declared)
}
