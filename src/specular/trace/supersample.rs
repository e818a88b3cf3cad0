//! Samples all over marked pixels, and their means in place of what the pixels' centres show.

use ash::vk;

use super::marks::{MarkedPixels, ReflectedImages, mark};
use super::options::TraceOptions;
use super::walk::{band_rows, count, walking};
use crate::frame::mirrored::MirroredList;
use crate::frame::mirrored_light::Shining;
use crate::frame::rays::TracedScene;
use crate::graph::bindings::{BufferRef, ImageRef, TexelBuffer};
use crate::method::FrameCx;
use crate::shaders::groups::Lobes;
use crate::shaders::trace::{Replace, Supersample, SupersamplePush};
use crate::shaders::types::MirroredPoint;
use crate::slot::Slot;

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const WORDS: vk::Format = vk::Format::R32G32B32A32_UINT;
const WORD: vk::Format = vk::Format::R32_UINT;

/// Samples of the marked pixels of some rows.
#[derive(Clone, Copy)]
pub(super) struct Samples {
    marked: MarkedPixels,
    /// What shines by itself, three texels a pixel.
    sums: BufferRef<[u32; 4]>,
    pub(super) list: MirroredList,
    light: BufferRef<[f32; 4]>,
}

/// Declares the passes that mark pixels, sample them and light what the samples come to.
pub(super) fn sample(
    cx: &mut FrameCx<'_, '_>,
    scene: &TracedScene,
    reflected: Option<ReflectedImages>,
    options: &TraceOptions,
) -> Vec<Samples> {
    let [width, height] = cx.frame.surface.size;
    let rows = band_rows([width, height], options.supersamples);
    let mut bands = Vec::new();
    for (number, first_row) in (0..height).step_by(rows as usize).enumerate() {
        let marked = mark(cx, reflected, (number, first_row, rows.min(height - first_row)), options);
        let (sums, list) = follow(cx, scene, marked, number, options);
        let shining = Shining::new(cx.graph, scene, list, ("specular/trace/supersample/light", number), true);
        let found = shining.find_punctual(cx.graph);
        shining.find_others(cx.graph, found, options.light_samples);
        bands.push(Samples { marked, sums, list, light: shining.light });
    }
    bands
}

/// Follows the samples of marked pixels.
fn follow(
    cx: &mut FrameCx<'_, '_>,
    scene: &TracedScene,
    marked: MarkedPixels,
    number: usize,
    options: &TraceOptions,
) -> (BufferRef<[u32; 4]>, MirroredList) {
    let frame = cx.frame;
    let graph = &mut *cx.graph;
    let least = marked.pixels.count() * options.supersamples as usize;
    let points = graph.growing_buffer::<MirroredPoint>(&format!("trace.sample_points.{number}"), least);
    let sums = graph.buffer::<[u32; 4]>(&format!("trace.sample_sums.{number}"), 3 * marked.pixels.count());
    let counts = graph.buffer::<u32>(&format!("trace.sample_counts.{number}"), 2);
    graph.fill_buffer(&format!("specular/trace/supersample/clear.{number}"), counts, 0);
    let capacity = points.count() as u32;
    // Of wide lobes all samples of a pixel together send as many rays as its centre does, at least.
    let rays_of_lobe = options.samples.div_ceil(options.supersamples);
    let (specular_lobes, transmissive) = (u32::from(frame.facts.specular), u32::from(frame.facts.transmissive));
    let pass = Supersample {
        scene_rays: scene.rays(graph),
        lobes: Lobes { specular_lobes, transmissive },
        camera: frame.surface.group.camera.clone(),
        marked: marked.pixels.texels(WORD),
        marked_count: marked.arguments.texels(WORD),
        points: points.start(),
        counts: counts.read_write(),
        sums: sums.start(),
        push: SupersamplePush {
            shift: (frame.data.origin - scene.origin).as_vec3().to_array(),
            side: options.supersamples.isqrt(),
            walking: walking(scene, options, rays_of_lobe, capacity),
            size: frame.surface.size,
            lamps: u32::from(!frame.mirrored_lamps),
        },
    };
    let pass = graph.pass(&format!("specular/trace/supersample/rays.{number}"), pass);
    let pass = pass.count("points", counts, 0).count("rays", counts, 1).unordered();
    pass.threads_indirect(marked.arguments, 0);
    graph.grows(points, counts, 0);
    let arguments = graph.buffer::<u32>(&format!("trace.sample_arguments.{number}"), 4);
    count(graph, &format!("specular/trace/supersample/arguments.{number}"), counts, capacity, arguments);
    (sums, MirroredList { points, arguments })
}

/// Declares the passes that put the means into slots; `diffuse`: irradiance of each list's points.
pub(super) fn replace(
    cx: &mut FrameCx<'_, '_>,
    samples: &[Samples],
    [diffuse, caustics]: [Option<&[BufferRef<[f32; 4]>]>; 2],
    slots: &[(Slot, ImageRef)],
) {
    for &(slot, image) in slots {
        // As the kernel numbers them.
        let number = match slot {
            Slot::Emission => 0,
            Slot::Direct => 1,
            Slot::Specular => 2,
            Slot::Diffuse if diffuse.is_some() => 3,
            Slot::Diffuse | Slot::Caustics => continue,
        };
        for (band, samples) in samples.iter().enumerate() {
            let irradiance = diffuse.filter(|_| number >= 2).map(|diffuse| diffuse[band].texels(FLOATS));
            let caustics = caustics.filter(|_| slot == Slot::Specular).map(|caustics| caustics[band].texels(FLOATS));
            let pass = Replace {
                slot: number,
                has_field: u32::from(irradiance.is_some()),
                has_caustics: u32::from(caustics.is_some()),
                marked: samples.marked.pixels.texels(WORD),
                marked_count: samples.marked.arguments.texels(WORD),
                sums: samples.sums.texels(WORDS),
                points: samples.list.points.texels(WORDS),
                light: samples.light.texels(FLOATS),
                irradiance: irradiance.unwrap_or(TexelBuffer::absent()),
                caustics: caustics.unwrap_or(TexelBuffer::absent()),
                image: image.modify(),
            };
            let pass = cx.graph.pass(&format!("specular/trace/supersample/{slot}.{band}"), pass);
            pass.threads_indirect(samples.marked.arguments, 0);
        }
    }
}
