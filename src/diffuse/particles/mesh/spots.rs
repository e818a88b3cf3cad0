//! Where pixels, and points that mirrors show, lie on the tessellation (glsl/particles/mesh_spots.glsl). The G-buffer does not say which triangle a pixel shows; a
//! short ray does, as for points in mirrors.

use ash::vk;

use super::super::formats::WORD;
use super::super::geometry::ParticleSpace;
use super::found::Found;
use crate::frame::gbuffer::GBuffer;
use crate::frame::mirrored::MirroredPoints;
use crate::frame::rays::Tessellation;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ImageRef, TexelBuffer};
use crate::shaders::particles::{
    MeshHomes, MeshHomesPush, MeshMirroredHomes, MeshMirroredSeen, MeshSeen, MeshSeenPush,
};

/// Of all that the picture reads.
pub(super) struct Spots {
    pub(super) pixels: ImageRef,
    /// List by list.
    pub(super) mirrored: Vec<BufferRef<[u32; 4]>>,
}

/// What is seen: the picture's surface, the way from its origin to that of rays, and what mirrors show.
pub(crate) type Seen<'a> = (&'a GBuffer, [f32; 3], Option<&'a MirroredPoints>);

impl Spots {
    pub(super) fn declare(graph: &mut Graph<'_>, (surface, _, points): Seen<'_>) -> Spots {
        let pixels = graph.image("particles.spots", vk::Format::R32G32B32A32_UINT, surface.size);
        let lists = points.iter().flat_map(|points| &points.lists).enumerate();
        let mirrored = lists
            .map(|(number, list)| graph.buffer(&format!("particles.mirrored_spots.{number}"), list.points.count()))
            .collect();
        Spots { pixels, mirrored }
    }

    /// How many there are at most.
    pub(super) fn count(&self) -> usize {
        let [width, height] = self.pixels.size();
        width as usize * height as usize + self.mirrored.iter().map(BufferRef::count).sum::<usize>()
    }

    /// Finds and marks the subtriangle of each.
    pub(super) fn mark(
        &self,
        graph: &mut Graph<'_>,
        space: &ParticleSpace,
        (surface, shift, points): Seen<'_>,
        tessellation: &TexelBuffer,
        made: &Tessellation,
    ) -> BufferRef<u32> {
        let marks = Found::marks(graph, "subtriangles", made.subtriangle_count);
        let pass = MeshSeen {
            scene_rays: space.rays.clone(),
            surface: surface.group.clone(),
            spots: self.pixels.write(),
            marks: marks.read_write(),
            tessellation: tessellation.clone(),
            push: MeshSeenPush { shift },
        };
        let pass = graph.pass("diffuse/particles/find/seen", pass);
        let pass = pass.note("all radiance particles", u64::from(made.point_count));
        let pass = pass.note("triangles cut less finely", u64::from(made.coarser));
        pass.pixels(surface.size);
        let lists = points.iter().flat_map(|points| &points.lists).zip(&self.mirrored).enumerate();
        for (number, (list, spots)) in lists {
            let pass = MeshMirroredSeen {
                scene_rays: space.rays.clone(),
                mirrored: list.group(),
                spots: spots.start(),
                marks: marks.read_write(),
                tessellation: tessellation.clone(),
            };
            let pass = graph.pass(&format!("diffuse/particles/find/mirrored.{number}"), pass);
            pass.threads_indirect(list.arguments, 0);
        }
        marks
    }

    /// Finds which radiance particles are read where not all of the subtriangle's are, and marks the area particles of those that read none. `views`: of the subtriangles
    /// that were found.
    pub(super) fn find_homes(
        &self,
        graph: &mut Graph<'_>,
        space: &ParticleSpace,
        (surface, shift, points): Seen<'_>,
        (subtriangles, views): (&Found, BufferRef<[f32; 4]>),
        marks: BufferRef<u32>,
    ) {
        let counts = graph.buffer::<u32>("particles.home_counts", 2);
        graph.fill_buffer("diffuse/particles/find/clear-home-counts", counts, 0);
        let pass = MeshHomes {
            scene_rays: space.rays.clone(),
            particles: space.group.clone(),
            surface: surface.group.clone(),
            spots: self.pixels.read_write(),
            views: views.read(),
            marks: marks.read_write(),
            counts: counts.read_write(),
            subtriangle_marks: subtriangles.marks.texels(WORD),
            marked_before: subtriangles.starts.texels(WORD),
            push: MeshHomesPush { shift },
        };
        let pass =
            graph.pass("diffuse/particles/find/homes", pass).count("partly", counts, 0).count("homes", counts, 1);
        pass.pixels(surface.size);
        let lists = points.iter().flat_map(|points| &points.lists).zip(&self.mirrored).enumerate();
        for (number, (list, spots)) in lists {
            let pass = MeshMirroredHomes {
                scene_rays: space.rays.clone(),
                particles: space.group.clone(),
                mirrored: list.group(),
                spots: spots.read_write(),
                views: views.read(),
                marks: marks.read_write(),
                counts: counts.read_write(),
                subtriangle_marks: subtriangles.marks.texels(WORD),
                marked_before: subtriangles.starts.texels(WORD),
            };
            let pass = graph.pass(&format!("diffuse/particles/find/mirrored-homes.{number}"), pass);
            pass.threads_indirect(list.arguments, 0);
        }
    }
}
