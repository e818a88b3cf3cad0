//! Which pass is to blame for a frame that shows what no light can be.

use super::declare::{Prepared, declare};
use super::estimates::Means;
use super::frame::FrameRequest;
use super::render::{Fault, Renderer, want};
use crate::frame::check::PassChecks;
use crate::graph::{Graph, Timing};
use crate::method::Error;
use crate::scene::Scene;

impl Renderer {
    /// Makes the frame again with a check after each pass, and says which wrote such values first.
    pub(super) fn explain(
        &mut self,
        scene: &Scene,
        request: &FrameRequest,
        means: Option<&Means>,
        fault: Fault,
    ) -> Error {
        self.store.invalidate();
        let pass = self.first_at_fault(scene, request, means);
        self.store.invalidate();
        match pass {
            Ok(pass) => Error::NotFinite { what: fault.what, pixels: fault.pixels, pass },
            Err(error) => error,
        }
    }

    /// Which pass of the frame writes such values first, if any does.
    #[cfg(test)]
    pub(crate) fn blame(&mut self, scene: &Scene, request: &FrameRequest) -> Result<Option<String>, Error> {
        let means = self.estimate(scene, request, &mut crate::graph::FrameTimings::default())?;
        self.first_at_fault(scene, request, means.as_deref())
    }

    /// The passes of the frame that leave words of what they say they write whole.
    #[cfg(test)]
    pub(crate) fn unwritten(&mut self, scene: &Scene, request: &FrameRequest) -> Result<Vec<(String, usize)>, Error> {
        let means = self.estimate(scene, request, &mut crate::graph::FrameTimings::default())?;
        let traced = self.prepare(scene, request)?;
        let data = self.data.as_ref().expect("prepared above");
        let (lights, traced) = (&self.lights, traced.as_deref());
        let prepared = Prepared { scene, data, lights, traced, means: means.as_deref() };
        let settings = &self.settings;
        let found = crate::graph::proof::unwritten(&mut self.store, |graph| {
            let declared = declare(graph, &prepared, settings, request).expect("what the frame declares");
            want(graph, &declared, request);
        });
        Ok(found?)
    }

    fn first_at_fault(
        &mut self,
        scene: &Scene,
        request: &FrameRequest,
        means: Option<&Means>,
    ) -> Result<Option<String>, Error> {
        let traced = self.prepare(scene, request)?;
        let data = self.data.as_ref().expect("prepared above");
        let prepared = Prepared { scene, data, lights: &self.lights, traced: traced.as_deref(), means };
        // Which buffers hold floats is known once all passes are.
        let mut graph = Graph::new(&mut self.store);
        let declared = declare(&mut graph, &prepared, &self.settings, request)?;
        let radiance = declared.shown(request).iter().map(|(_, image)| graph.name_of(*image).to_owned()).collect();
        let texels = graph.float_texels();

        let mut graph = Graph::new(&mut self.store);
        let checks = PassChecks::declare(&mut graph, radiance, texels);
        let declared = declare(&mut graph, &prepared, &self.settings, request)?;
        want(&mut graph, &declared, request);
        let faults = checks.read_back(&mut graph);
        let mut executed = graph.run(Timing::Frame)?;
        let first = faults.first(|read_back| executed.take(read_back));
        Ok(first.and_then(|(index, _)| checks.pass(index)))
    }
}
