//! What of the tessellation the picture shows, with lists of the area particles that light it.

use std::sync::Arc;

use super::super::formats::{WORD, WORDS4};
use super::super::geometry::ParticleSpace;
use super::super::options::{ParticleLists, ParticlesOptions};
use super::found::Found;
use super::lists::{EstimationLists, Parts};
use super::spots::{Seen, Spots};
use crate::frame::rays::{Tessellation, TracedScene};
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, TexelBuffer};
use crate::shaders::particles::{MeshCorners, MeshFit, MeshFitPush, MeshUsed, MeshUsedPush};

/// What the picture shows of the tessellation.
pub(crate) struct MeshReceivers {
    pub(super) tessellation: TexelBuffer,
    pub(super) spots: Spots,
    /// Radiance particles.
    pub(super) particles: Found,
    pub(super) lists: EstimationLists,
}

/// The tessellation by the options, or by how far area particles are apart.
fn tessellation(scene: &TracedScene, options: &ParticlesOptions, particle_count: u32) -> Arc<Tessellation> {
    let own = (scene.diffuse_area() / f64::from(particle_count)).sqrt();
    scene.tessellation(if options.spacing > 0.0 { options.spacing } else { own.max(1e-30) })
}

impl MeshReceivers {
    /// Finds the radiance particles that are shown, and marks the area particles of `marks` that are read where light cannot be interpolated.
    pub(crate) fn find(
        graph: &mut Graph<'_>,
        scene: &TracedScene,
        space: &ParticleSpace,
        seen: Seen<'_>,
        options: &ParticlesOptions,
        marks: BufferRef<u32>,
    ) -> MeshReceivers {
        let made = tessellation(scene, options, space.count);
        let tessellation = made.texels(graph);
        let spots = Spots::declare(graph, seen);
        let subtriangle_marks = spots.mark(graph, space, seen, &tessellation, &made);
        let most = spots.count().min(made.subtriangle_count as usize);
        let subtriangles = Found::declare(graph, "subtriangles", subtriangle_marks, most);
        let particle_marks = Found::marks(graph, "radiance_particles", made.point_count);
        let pass = MeshCorners {
            tessellation: tessellation.clone(),
            subtriangles: subtriangles.numbers.texels(WORD),
            found: subtriangles.head.texels(WORD),
            marks: particle_marks.read_write(),
        };
        graph.pass("diffuse/particles/find/corners", pass).threads_indirect(subtriangles.head, 0);
        let most = (3 * most).min(made.point_count as usize);
        let particles = Found::declare(graph, "radiance_particles", particle_marks, most);
        let all_count = if options.lists == ParticleLists::All { made.point_count } else { 0 };
        let parts = Parts { space, tessellation: &tessellation, found: &particles };
        let lists = EstimationLists::declare(graph, &parts, all_count);

        let views = graph.buffer::<[f32; 4]>("particles.views", 3 * subtriangles.numbers.count());
        let counts = graph.buffer::<u32>("particles.unfit_counts", 1);
        graph.fill_buffer("diffuse/particles/find/clear-unfit-counts", counts, 0);
        let pass = MeshFit {
            scene_rays: space.rays.clone(),
            particles: space.group.clone(),
            tessellation: tessellation.clone(),
            subtriangles: subtriangles.numbers.texels(WORD),
            found: subtriangles.head.texels(WORD),
            particle_marks: particles.marks.texels(WORD),
            marked_before: particles.starts.texels(WORD),
            slots: lists.slots.texels(WORDS4),
            views: views.start(),
            counts: counts.read_write(),
            push: MeshFitPush { all_slots: u32::from(all_count > 0) },
        };
        let pass = graph.pass("diffuse/particles/find/fit", pass);
        let pass = pass.count("subtriangles", subtriangles.head, 3).count("unfit", counts, 0);
        pass.threads_indirect(subtriangles.head, 0);
        spots.find_homes(graph, space, seen, (&subtriangles, views), marks);
        MeshReceivers { tessellation, spots, particles, lists }
    }

    /// Marks the area particles in the lists of those that were found; adds them to word 1 of `counts`.
    pub(crate) fn mark_used(&self, graph: &mut Graph<'_>, used: BufferRef<u32>, counts: BufferRef<u32>) {
        let pass = MeshUsed {
            numbers: self.particles.numbers.texels(WORD),
            found: self.particles.head.texels(WORD),
            starts: self.lists.starts.texels(WORD),
            entries: self.lists.entries.texels(WORD),
            used: used.read_write(),
            counts: counts.read_write(),
            push: MeshUsedPush { all_lists: u32::from(self.lists.of_all) },
        };
        let pass = graph.pass("diffuse/particles/find/used-by-lists", pass);
        let pass = pass.count("radiance particles", self.particles.head, 3).count("particles", counts, 1);
        pass.threads_indirect(self.particles.head, 0);
    }
}
