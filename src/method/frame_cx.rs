//! What a method declares its passes with: the graph, and what all methods share of a frame.

use std::rc::Rc;

use crate::frame::caches::{AreaLights, CacheSettings, Caches, allocate, area_lights};
use crate::frame::inputs::FrameInputs;
use crate::frame::light_views::{LightViews, Views};
use crate::frame::rays::TracedScene;
use crate::frame::voxels::{VoxelSettings, Voxels, voxels};
use crate::graph::Graph;
use crate::shaders::groups::SceneRays;
use crate::shaders::types::CacheRays;

/// What a method takes of a frame, besides the G-buffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Inputs {
    /// Light views with their depth.
    pub(crate) light_depth: Views,
    /// What their texels reflect.
    pub(crate) light_flux: Views,
    pub(crate) rays: Rays,
    /// The diffuse light at what mirrors show, if the method of the slot `diffuse` offers it.
    pub(crate) mirrored_light: bool,
    /// Light caches as `volumes` has them, and what these take themselves.
    pub(crate) caches: bool,
    /// All slots: it makes better ones of them ([`super::Method::refine`]).
    pub(crate) slots: bool,
}

impl Inputs {
    /// What two methods take together.
    pub(crate) fn and(self, other: Inputs) -> Inputs {
        Inputs {
            light_depth: self.light_depth.max(other.light_depth),
            light_flux: self.light_flux.max(other.light_flux),
            rays: self.rays.max(other.rays),
            mirrored_light: self.mirrored_light || other.mirrored_light,
            caches: self.caches || other.caches,
            slots: self.slots || other.slots,
        }
    }

    pub(crate) fn light_views(self) -> bool {
        self.light_depth.max(self.light_flux) != Views::None
    }
}

/// What rays are sent to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Rays {
    #[default]
    None,
    /// Surfaces alone: they stand when a light moves.
    ToSurfaces,
    /// Lights too.
    ToLights,
}

/// A frame while a method declares its passes. What is shared was made before, and is read by `&self`: it outlives the borrow.
pub(crate) struct FrameCx<'f, 's> {
    pub(crate) graph: &'f mut Graph<'s>,
    pub(crate) frame: &'f FrameInputs<'f>,
    /// What the method said it takes.
    inputs: Inputs,
}

impl<'f, 's> FrameCx<'f, 's> {
    pub(crate) fn new(graph: &'f mut Graph<'s>, frame: &'f FrameInputs<'f>, inputs: Inputs) -> FrameCx<'f, 's> {
        FrameCx { graph, frame, inputs }
    }

    /// The scene as rays meet it, for a method that sends rays.
    pub(crate) fn rays(&self) -> Option<&'f TracedScene> {
        self.frame.traced.filter(|_| self.inputs.rays != Rays::None)
    }

    /// The lights that shine on light caches; methods that ask alike share them.
    pub(crate) fn area_lights(&mut self, settings: &CacheSettings) -> Rc<AreaLights> {
        self.shared(settings.lights, |cx, rule| area_lights(cx.graph, cx.frame.set, cx.lights(), rule))
    }

    /// Light caches; methods that ask alike share them.
    pub(crate) fn caches(&mut self, settings: &CacheSettings) -> Rc<Caches> {
        self.shared(settings.places, |cx, rule| allocate(cx.graph, cx.frame, rule))
    }

    /// The scene as rays to and from light caches meet it; absent in a frame whose method sends none.
    pub(crate) fn cache_rays(&mut self) -> (SceneRays, CacheRays) {
        let Some(traced) = self.rays() else { return (SceneRays::absent(), CacheRays { shift: [0.0; 3] }) };
        let shift = (self.frame.data.origin - traced.origin).as_vec3().to_array();
        (traced.rays(self.graph), CacheRays { shift })
    }

    /// The scene as voxels; methods that ask alike share them.
    pub(crate) fn voxels(&mut self, settings: &VoxelSettings) -> Rc<Voxels> {
        self.shared(*settings, |cx, settings| voxels(cx.graph, cx.frame, settings))
    }

    /// What several methods share: made where the first of them asks, once for each type and what it is made by.
    pub(crate) fn shared<P: PartialEq + 'static, T: 'static>(
        &mut self,
        parameters: P,
        make: impl FnOnce(&mut Self, &P) -> T,
    ) -> Rc<T> {
        if let Some(known) = self.frame.offers.find::<(P, Rc<T>)>(|(made_by, _)| *made_by == parameters) {
            return known.1.clone();
        }
        let made = Rc::new(make(self, &parameters));
        self.frame.offers.put((parameters, made.clone()));
        made
    }

    /// The views from the lights, and what their texels reflect, for a method that takes them.
    pub(crate) fn lights(&self) -> &'f LightViews {
        self.frame.light_views()
    }
}
