//! Which pieces a frame consists of: the settings' methods, as far as the scene and the request need them.

use super::{DiffuseMethod, DirectMethod, FrameRequest, Settings, Slot};
use crate::diffuse::rsm::{Rsm, rsm};
use crate::frame::camera::camera;
use crate::frame::compose::compose;
use crate::frame::direct::shadow_map;
use crate::frame::gbuffer::{GBuffer, View, gbuffer};
use crate::frame::geometry::Geometry;
use crate::frame::light_set::LightSet;
use crate::frame::light_views::{LightViews, ReflectiveViews, light_views};
use crate::frame::scene_data::SceneData;
use crate::frame::tonemap::tonemap;
use crate::frame::traced_direct::traced;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef};
use crate::reference::traced_scene::TracedScene;
use crate::scene::{Facts, Scene};

/// What a declared frame offers; absent where a method, the scene or the request leaves it out.
pub(crate) struct Declared {
    pub(crate) gbuffer: GBuffer,
    pub(crate) lights: Option<LightViews>,
    pub(crate) reflective: Option<ReflectiveViews>,
    pub(crate) rsm: Option<Rsm>,
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
            Slot::Diffuse => self.rsm.as_ref().map(|rsm| rsm.diffuse),
            Slot::Caustics | Slot::Specular => None,
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

    let mut declared =
        Declared { gbuffer, lights: None, reflective: None, rsm: None, direct: None, image: None, display: None };
    let frame = Frame { data, geometry: &geometry, set, traced, settings, facts: &facts };
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
    set: &'a LightSet,
    traced: Option<&'a TracedScene>,
    settings: &'a Settings,
    facts: &'a Facts,
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
    let direct = settings.methods.direct == DirectMethod::ShadowMap && wants(Slot::Direct);
    let indirect = settings.methods.diffuse == DiffuseMethod::Rsm && wants(Slot::Diffuse);
    let reason = if frame.set.lights.is_empty() { Some("no light") } else { None };
    if let Some(reason) = reason {
        for (used, piece) in
            [(direct || indirect, "light-views"), (direct, "direct/shadow-map"), (indirect, "diffuse/rsm")]
        {
            if used {
                graph.skip(piece, reason);
            }
        }
        return;
    }
    let rsm_reason = match (frame.facts.diffuse, settings.rsm.vpls) {
        (false, _) => Some("no diffuse surface"),
        (_, 0) => Some("no VPLs asked for"),
        _ => None,
    };
    let gathers = indirect && rsm_reason.is_none();
    if direct || gathers {
        let (lights, reflective) = light_views(graph, frame.data, frame.geometry, frame.set, gathers);
        if direct {
            declared.direct = Some(shadow_map(graph, &declared.gbuffer, &lights, &settings.shadow));
        }
        if let Some(reflective) = reflective {
            declared.rsm = Some(rsm(graph, &declared.gbuffer, frame.set, &lights, reflective, &settings.rsm));
        }
        (declared.lights, declared.reflective) = (Some(lights), reflective);
    }
    if let (true, Some(reason)) = (indirect, rsm_reason) {
        graph.skip("diffuse/rsm", reason);
    }
}
