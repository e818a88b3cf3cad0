//! What a method declares its passes with: the graph, and what all methods share of a frame.

use std::rc::Rc;

use crate::frame::inputs::FrameInputs;
use crate::frame::light_views::LightViews;
use crate::frame::rays::TracedScene;
use crate::frame::voxels::{VoxelSettings, Voxels, voxels};
use crate::graph::Graph;

/// What a method takes of a frame, besides the G-buffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Inputs {
    /// Light views with their depth.
    pub(crate) light_depth: bool,
    /// What their texels reflect.
    pub(crate) light_flux: bool,
    pub(crate) rays: Rays,
    /// The diffuse light at what mirrors show, if the method of the slot `diffuse` offers it.
    pub(crate) mirrored_light: bool,
    /// All slots: it makes better ones of them ([`super::Method::refine`]).
    pub(crate) slots: bool,
}

impl Inputs {
    /// What two methods take together.
    pub(crate) fn and(self, other: Inputs) -> Inputs {
        Inputs {
            light_depth: self.light_depth || other.light_depth,
            light_flux: self.light_flux || other.light_flux,
            rays: self.rays.max(other.rays),
            mirrored_light: self.mirrored_light || other.mirrored_light,
            slots: self.slots || other.slots,
        }
    }

    pub(crate) fn light_views(self) -> bool {
        self.light_depth || self.light_flux
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
