//! Which pieces a frame consists of: the settings' methods, as far as the scene and the request need them.

use super::frame::FrameRequest;
use super::settings::{CausticsMethod, DiffuseMethod, DirectMethod, Settings};
use crate::caustics::photons::{PhotonInputs, PhotonTracing, photons};
use crate::diffuse::rsm::{Rsm, rsm};
use crate::diffuse::vpl::{Vpl, VplInputs, VplVisibility, vpl};
use crate::direct::shadow_map::shadow_map;
use crate::direct::traced::traced;
use crate::frame::camera::camera;
use crate::frame::compose::compose;
use crate::frame::gbuffer::{GBuffer, View, gbuffer};
use crate::frame::geometry::Geometry;
use crate::frame::light_set::LightSet;
use crate::frame::light_views::{LightViews, ReflectiveViews, light_views};
use crate::frame::rays::TracedScene;
use crate::frame::scene_data::SceneData;
use crate::frame::tonemap::tonemap;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::scene::{Facts, Scene};
use crate::shaders::types;
use crate::slot::Slot;

/// What a declared frame offers; absent where a method, the scene or the request leaves it out.
pub(crate) struct Declared {
    pub(crate) gbuffer: GBuffer,
    pub(crate) lights: Option<LightViews>,
    pub(crate) reflective: Option<ReflectiveViews>,
    pub(crate) rsm: Option<Rsm>,
    pub(crate) vpl: Option<Vpl>,
    pub(crate) caustics: Option<ImageRef>,
    direct: Option<ImageRef>,
    pub(crate) image: Option<ImageRef>,
    pub(crate) display: Option<BufferRef<u32>>,
}

impl Declared {
    /// The image of a slot, if anything fills it.
    pub(crate) fn slot(&self, slot: Slot) -> Option<ImageRef> {
        match slot {
            Slot::Emission => self.gbuffer.emission,
            Slot::Direct => self.direct,
            Slot::Diffuse => self.vpl.as_ref().map(|vpl| vpl.diffuse).or(self.rsm.as_ref().map(|rsm| rsm.diffuse)),
            Slot::Caustics => self.caustics,
            Slot::Specular => None,
        }
    }
}

/// A scene as it is on the device.
pub(crate) struct Prepared<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) data: &'a SceneData,
    pub(crate) lights: &'a LightSet,
    /// Present if a wanted slot is filled by rays and something shines.
    pub(crate) traced: Option<&'a TracedScene>,
}

/// Whether the passes that fill `slot` send rays through the scene's hierarchy, if something shines.
pub(crate) fn sends_rays(settings: &Settings, facts: &Facts, slot: Slot) -> bool {
    let vpl_rays = settings.vpl.visibility == VplVisibility::Traced || settings.vpl.bounces > 1;
    match slot {
        Slot::Emission | Slot::Specular => false,
        Slot::Direct => settings.methods.direct == DirectMethod::Traced,
        Slot::Diffuse => {
            let piece = DiffusePiece::of(settings, facts);
            settings.methods.diffuse == DiffuseMethod::Vpl && vpl_rays && piece.is_some_and(|it| it.skipped.is_none())
        }
        Slot::Caustics => {
            let piece = CausticsPiece::of(settings, facts);
            settings.photons.trace == PhotonTracing::Bvh && piece.is_some_and(|it| it.skipped.is_none())
        }
    }
}

/// Declares the frame.
pub(crate) fn declare(
    graph: &mut Graph<'_>,
    prepared: &Prepared<'_>,
    settings: &Settings,
    request: &FrameRequest,
) -> Declared {
    let Prepared { scene, data, lights: set, traced } = *prepared;
    let facts = scene.facts();
    let image_wanted = request.image || request.tonemap.is_some();
    let wants = |slot: Slot| request.wants(slot);
    let shows_emission = facts.emissive || scene.materials().iter().any(|material| material.unlit);
    let emission = wants(Slot::Emission) && (shows_emission || (facts.sky && request.slots.contains(&Slot::Emission)));
    let geometry = Geometry::import(graph, data);
    let view = View {
        camera: camera(&request.camera, request.size, data.origin),
        size: request.size,
        sky: scene.sky(),
        emission,
    };
    let gbuffer = gbuffer(graph, data, &geometry, &facts, &view);

    let mut declared = Declared {
        gbuffer,
        lights: None,
        reflective: None,
        rsm: None,
        vpl: None,
        caustics: None,
        direct: None,
        image: None,
        display: None,
    };
    let frame = Frame { data, geometry: &geometry, camera: &view.camera, set, traced, settings, facts: &facts };
    declare_light(graph, &mut declared, &frame, wants);

    if image_wanted {
        let image = compose(graph, &declared.gbuffer, scene.sky(), |slot| declared.slot(slot));
        declared.image = Some(image);
        declared.display = request.tonemap.map(|curve| tonemap(graph, image, curve));
    }
    declared
}

struct Frame<'a> {
    data: &'a SceneData,
    geometry: &'a Geometry,
    camera: &'a types::Camera,
    set: &'a LightSet,
    traced: Option<&'a TracedScene>,
    settings: &'a Settings,
    facts: &'a Facts,
}

impl<'a> Frame<'a> {
    /// What rays meet, where the passes of `slot` send any: the others must not depend on it.
    fn traced_for(&self, slot: Slot) -> Option<&'a TracedScene> {
        self.traced.filter(|_| sends_rays(self.settings, self.facts, slot))
    }
}

fn declare_light(graph: &mut Graph<'_>, declared: &mut Declared, frame: &Frame<'_>, wants: impl Fn(Slot) -> bool) {
    let settings = frame.settings;
    if settings.methods.direct == DirectMethod::Traced && wants(Slot::Direct) {
        match frame.traced {
            Some(scene) => {
                declared.direct = traced(graph, &declared.gbuffer, scene, frame.data.origin, &settings.traced);
            }
            None => graph.skip("direct", "no light"),
        }
    }
    let wants_direct = settings.methods.direct == DirectMethod::ShadowMap && wants(Slot::Direct);
    let diffuse = DiffusePiece::of(settings, frame.facts).filter(|_| wants(Slot::Diffuse));
    let caustics = CausticsPiece::of(settings, frame.facts).filter(|_| wants(Slot::Caustics));
    let unlit = frame.set.lights.is_empty().then_some("no light");
    let direct_reason = unlit;
    let diffuse_reason = diffuse.as_ref().and_then(|piece| unlit.or(piece.skipped));
    let caustics_reason = caustics.as_ref().and_then(|piece| unlit.or(piece.skipped));
    let gathers = diffuse.is_some() && diffuse_reason.is_none();
    let splats = caustics.is_some() && caustics_reason.is_none();
    if let (Some(reason), true) = (unlit, wants_direct || diffuse.is_some() || caustics.is_some()) {
        graph.skip("light-views", reason);
    }
    if let (Some(reason), true) = (direct_reason, wants_direct) {
        graph.skip("direct/shadow-map", reason);
    }
    if unlit.is_none() && (wants_direct || gathers || splats) {
        let (lights, reflective) = light_views(graph, frame.data, frame.geometry, frame.set, gathers);
        if wants_direct {
            declared.direct = Some(shadow_map(graph, &declared.gbuffer, &lights, &settings.shadow));
        }
        if let Some(reflective) = reflective {
            declare_diffuse(graph, declared, frame, &lights, reflective);
        }
        if splats {
            let inputs = PhotonInputs {
                buffer: &declared.gbuffer,
                data: frame.data,
                geometry: frame.geometry,
                facts: frame.facts,
                camera: frame.camera,
                set: frame.set,
                lights: &lights,
                traced: frame.traced_for(Slot::Caustics),
                settings: &settings.photons,
            };
            declared.caustics = photons(graph, &inputs);
        }
        (declared.lights, declared.reflective) = (Some(lights), reflective);
    }
    for (piece, reason) in
        [(diffuse.map(|piece| piece.name), diffuse_reason), (caustics.map(|piece| piece.name), caustics_reason)]
    {
        if let (Some(piece), Some(reason)) = (piece, reason) {
            graph.skip(piece, reason);
        }
    }
}

/// A method that VPLs are drawn for, and why the scene or the settings leave it nothing to do.
struct DiffusePiece {
    name: &'static str,
    skipped: Option<&'static str>,
}

impl DiffusePiece {
    fn of(settings: &Settings, facts: &Facts) -> Option<DiffusePiece> {
        let (name, count) = match settings.methods.diffuse {
            DiffuseMethod::Rsm => ("diffuse/rsm", settings.rsm.vpls),
            DiffuseMethod::Vpl => ("diffuse/vpl", if settings.vpl.bounces == 0 { 0 } else { settings.vpl.count }),
            DiffuseMethod::None | DiffuseMethod::Path => return None,
        };
        let skipped = match (facts.diffuse, count) {
            (false, _) => Some("no diffuse surface"),
            (_, 0) => Some("no VPLs asked for"),
            _ => None,
        };
        Some(DiffusePiece { name, skipped })
    }
}

/// Likewise for photons.
struct CausticsPiece {
    name: &'static str,
    skipped: Option<&'static str>,
}

impl CausticsPiece {
    fn of(settings: &Settings, facts: &Facts) -> Option<CausticsPiece> {
        if settings.methods.caustics != CausticsMethod::Photons {
            return None;
        }
        let skipped = match (facts.specular, facts.diffuse, settings.photons.max.min(settings.photons.bounces)) {
            (false, ..) => Some("no specular or transmissive surface"),
            (_, false, _) => Some("no diffuse surface"),
            (.., 0) => Some("no photons asked for"),
            _ => None,
        };
        Some(CausticsPiece { name: "caustics/photons", skipped })
    }
}

fn declare_diffuse(
    graph: &mut Graph<'_>,
    declared: &mut Declared,
    frame: &Frame<'_>,
    lights: &LightViews,
    reflective: ReflectiveViews,
) {
    let settings = frame.settings;
    if settings.methods.diffuse == DiffuseMethod::Vpl {
        let inputs = VplInputs {
            buffer: &declared.gbuffer,
            data: frame.data,
            geometry: frame.geometry,
            set: frame.set,
            lights,
            reflective,
            traced: frame.traced_for(Slot::Diffuse),
            settings: &settings.vpl,
        };
        declared.vpl = Some(vpl(graph, &inputs));
    } else {
        declared.rsm = Some(rsm(graph, &declared.gbuffer, frame.set, lights, reflective, &settings.rsm));
    }
}
