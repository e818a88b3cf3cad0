//! The lighting stage: lights give flux to particles, particles scatter it along their links. It stands while lights, geometry and materials do.

use super::formats::{FLOATS4, WORD};
use super::geometry::{ParticleSpace, why_even};
use super::links::lobes_of;
use super::options::{ParticleTransport, ParticlesOptions};
use crate::frame::rays::TracedScene;
use crate::graph::Graph;
use crate::graph::bindings::{BufferRef, ReadWriteBuffer, TexelBuffer};
use crate::shaders::particles::{
    Bounce, BouncePush, Emit, EmitPush, FluxScale, FluxScalePush, Glints, GlintsPush, Radiance, RadiancePush, Scatter,
    ScatterPush, ScatterWide, ScatterWidePush,
};

/// What the stage leaves.
pub(super) struct Lighting {
    /// What lights gave each particle, W; behind these what they gave by way of specular events, where those are counted.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests add it up"))]
    pub(super) emitted: BufferRef<[f32; 4]>,
    /// Steps of fixed-point numbers a watt.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests read it"))]
    pub(super) scale: BufferRef<[f32; 4]>,
    /// What each received in every scattering step, where light is scattered and specular events are not counted.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests add it up"))]
    pub(super) received: Vec<BufferRef<u32>>,
    /// What each sends out, W/(m² sr).
    pub(super) radiance: BufferRef<[f32; 4]>,
}

/// Declares the stage, with so many scattering steps.
pub(super) fn light(
    graph: &mut Graph<'_>,
    scene: &TracedScene,
    space: &ParticleSpace,
    options: &ParticlesOptions,
    steps: u32,
) -> Lighting {
    let particle_count = space.count;
    let threads = [particle_count, 1, 1];
    let levels = space.levels;
    let emitted = graph.buffer::<[f32; 4]>("particles.emitted", (levels.count() * particle_count) as usize);
    let sample_count = if scene.emissive_count > 0 { options.emitter_samples } else { 0 };
    let (glints, steps_a_watt) = glints(graph, scene, space, options);
    let pass = Emit {
        scene_rays: space.rays.clone(),
        scene_lights: scene.lights(graph),
        particles: space.group.clone(),
        matter: space.matter.texels(FLOATS4),
        arrivals: space.arrivals.texels(WORD),
        glints: glints.unwrap_or(space.arrivals).read(),
        has_glints: u32::from(glints.is_some()),
        has_emitters: u32::from(scene.emissive_count > 0),
        event_levels: levels.told_apart,
        flux: emitted.write(),
        push: EmitPush {
            particle_count,
            light_count: scene.punctual_count,
            emitter_count: scene.emissive_count,
            sample_count,
            density_scale: scene.emissive_density_scale,
            links: (options.gather * options.gather) as f32,
            greatest_radiance: scene.greatest_radiance,
            watts_a_step: (1.0 / steps_a_watt) as f32,
            sky: scene.sky,
        },
    };
    let rays = u64::from(particle_count) * u64::from(scene.punctual_count + sample_count);
    graph.pass("diffuse/particles/light/emit", pass).note("rays", rays).threads(threads);
    let scale = graph.buffer::<[f32; 4]>("particles.scale", 1);
    let push = FluxScalePush { flux_count: levels.count() * particle_count };
    let pass = FluxScale { flux: emitted.texels(FLOATS4), scale: scale.write(), push };
    graph.pass("diffuse/particles/light/scale", pass).groups([1, 1, 1]);

    let emission = Emission { emitted, scale };
    match options.transport {
        ParticleTransport::TwoWay => scatter(graph, scene, space, options, (emission, steps)),
        ParticleTransport::GatherOnly => gather(graph, scene, space, options, (emission, steps)),
    }
}

/// What lights gave, and in which steps it is added up further on.
#[derive(Clone, Copy)]
struct Emission {
    emitted: BufferRef<[f32; 4]>,
    scale: BufferRef<[f32; 4]>,
}

/// Passes it on along links, step by step.
fn scatter(
    graph: &mut Graph<'_>,
    scene: &TracedScene,
    space: &ParticleSpace,
    options: &ParticlesOptions,
    (Emission { emitted, scale }, steps): (Emission, u32),
) -> Lighting {
    let particle_count = space.count;
    let threads = [particle_count, 1, 1];
    let link_count = options.scatter * options.scatter;
    let levels = space.levels;
    let ring_size = levels.ring(steps);
    let sums = |graph: &mut Graph<'_>, name: &str, count: u32| {
        let sums = graph.buffer::<u32>(&format!("particles.received.{name}"), (3 * count * particle_count) as usize);
        graph.fill_buffer(&format!("diffuse/particles/light/clear.{name}"), sums, 0);
        sums
    };
    let ring = (levels.late() > 0).then(|| sums(graph, "ring", ring_size));
    // Links for gathering do not follow mirrors.
    let wide_apart = why_even(scene, options).is_none() && !scene.facts.specular;
    let mut total = emitted;
    let mut received: Vec<BufferRef<u32>> = Vec::new();
    for number in 0..steps {
        let next = ring.unwrap_or_else(|| sums(graph, &number.to_string(), 1));
        if number == 0 {
            total = graph.buffer::<[f32; 4]>("particles.total", particle_count as usize);
        }
        let before = received.last().map_or(TexelBuffer::absent(), |received| received.texels(WORD));
        let pass = Scatter {
            particles: space.group.clone(),
            wide_apart: u32::from(wide_apart),
            from_lights: u32::from(number < levels.count()),
            from_steps: u32::from(number > 0),
            second_ends: u32::from(scene.facts.specular),
            broad_lobes: u32::from(number < levels.count() && scene.facts.broad),
            event_levels: levels.told_apart,
            matter: space.matter.texels(FLOATS4),
            emitted: emitted.texels(FLOATS4),
            scatter_links: space.scatter_links.texels(WORD),
            scale: scale.texels(FLOATS4),
            received: before.clone(),
            next: next.read_write(),
            total: if number == 0 { total.start_then_read() } else { total.read_write() },
            push: ScatterPush { particle_count, link_count, number, step_count: steps, ring: ring_size },
        };
        graph.pass(&format!("diffuse/particles/light/scatter.{number}"), pass).threads(threads);
        for (place, chunk) in space.chunks.iter().enumerate().filter(|_| wide_apart) {
            let pass = ScatterWide {
                particles: space.group.clone(),
                from_lights: u32::from(number == 0),
                matter: space.matter.texels(FLOATS4),
                emitted: emitted.texels(FLOATS4),
                links: chunk.links.texels(WORD),
                scale: scale.texels(FLOATS4),
                received: before.clone(),
                next: next.read_write(),
                push: ScatterWidePush {
                    first: chunk.first,
                    count: chunk.count,
                    link_count: options.gather * options.gather,
                    scatter_count: link_count,
                    number,
                },
            };
            let pass = graph.pass(&format!("diffuse/particles/light/scatter-wide.{number}.{place}"), pass);
            pass.threads([chunk.count, 1, 1]);
        }
        if ring.is_none() {
            received.push(next);
        }
    }
    let last = match ring {
        Some(ring) => Some((ring, steps % ring_size * particle_count)),
        None => received.last().map(|last| (*last, 0)),
    };
    let late = (steps > 0 && steps < levels.count()).then_some((emitted, steps * particle_count));
    let scattered = last.map(|(last, first)| Scattered { total, last, first });
    let radiance = radiance_of(graph, space, Emission { emitted, scale }, scattered, late);
    Lighting { emitted, scale, received, radiance }
}

/// What particles were scattered: all with what lights gave before the last step, and the last step's from the particle `first` on.
#[derive(Clone, Copy)]
struct Scattered {
    total: BufferRef<[f32; 4]>,
    last: BufferRef<u32>,
    first: u32,
}

/// What all particles send out, of what lights gave them, what they were scattered, and what lights gave `late`, from a particle on.
fn radiance_of(
    graph: &mut Graph<'_>,
    space: &ParticleSpace,
    Emission { emitted, scale }: Emission,
    scattered: Option<Scattered>,
    late: Option<(BufferRef<[f32; 4]>, u32)>,
) -> BufferRef<[f32; 4]> {
    let radiance = graph.buffer::<[f32; 4]>("particles.radiance", space.count as usize);
    let pass = Radiance {
        scattered: u32::from(scattered.is_some()),
        has_late: u32::from(late.is_some()),
        late: late.map_or(TexelBuffer::absent(), |(late, _)| late.texels(FLOATS4)),
        particles: space.group.clone(),
        matter: space.matter.texels(FLOATS4),
        emitted: emitted.texels(FLOATS4),
        total: scattered.map_or(TexelBuffer::absent(), |scattered| scattered.total.texels(FLOATS4)),
        scale: scale.texels(FLOATS4),
        received: scattered.map_or(TexelBuffer::absent(), |scattered| scattered.last.texels(WORD)),
        list_lengths: space.list_lengths.texels(WORD),
        lists: space.lists.texels(WORD),
        radiance: radiance.write(),
        push: RadiancePush {
            particle_count: space.count,
            received_first: scattered.map_or(0, |scattered| scattered.first),
            late_first: late.map_or(0, |(_, first)| first),
        },
    };
    graph.pass("diffuse/particles/light/radiance", pass).threads([space.count, 1, 1]);
    radiance
}

/// Has all particles gather it, bounce by bounce.
fn gather(
    graph: &mut Graph<'_>,
    scene: &TracedScene,
    space: &ParticleSpace,
    options: &ParticlesOptions,
    (Emission { emitted, scale }, bounces): (Emission, u32),
) -> Lighting {
    let scatter_count = options.scatter * options.scatter;
    let levels = space.levels;
    let counted = levels.late() > 0;
    let ring_size = levels.ring(bounces);
    let ring = counted.then(|| graph.buffer::<[f32; 4]>("particles.radiance.ring", (ring_size * space.count) as usize));
    let mut radiance = (!counted).then(|| radiance_of(graph, space, Emission { emitted, scale }, None, None));
    let mut other = graph.buffer::<[f32; 4]>("particles.radiance.other", space.count as usize);
    // Where events are counted, the first is what lights gave.
    let passes = bounces + u32::from(counted);
    for bounce in 0..passes {
        let last = bounce + 1 == passes;
        for (number, chunk) in space.chunks.iter().enumerate() {
            let into = |whole: BufferRef<[f32; 4]>, first: bool| {
                if first && number == 0 { whole.start_then_read() } else { whole.read_write() }
            };
            let pass = Bounce {
                last: u32::from(counted && last),
                event_levels: levels.told_apart,
                second_ends: u32::from(scene.facts.specular),
                broad_lobes: u32::from(scene.facts.broad),
                links: chunk.links.texels(WORD),
                scatter_links: space.scatter_links.texels(WORD),
                radiance: radiance.map_or(TexelBuffer::absent(), |radiance| radiance.texels(FLOATS4)),
                matter: space.matter.texels(FLOATS4),
                emitted: emitted.texels(FLOATS4),
                next: if counted && !last { ReadWriteBuffer::absent() } else { into(other, true) },
                earlier: ring.map_or(ReadWriteBuffer::absent(), |ring| into(ring, bounce == 0)),
                push: BouncePush {
                    first: chunk.first,
                    count: chunk.count,
                    link_count: options.gather * options.gather,
                    scatter_count,
                    second_ends: scatter_count * space.count,
                    number: bounce + 1,
                    ring: ring_size,
                    particle_count: space.count,
                },
            };
            let pass = graph.pass(&format!("diffuse/particles/light/gather.{bounce}.{number}"), pass);
            pass.threads([chunk.count, 1, 1]);
        }
        if let Some(radiance) = radiance.as_mut() {
            std::mem::swap(radiance, &mut other);
        }
    }
    let radiance = radiance.unwrap_or(other);
    Lighting { emitted, scale, received: Vec::new(), radiance }
}

/// What photons bring off mirrors and through glass, in steps, and steps a watt; none where nothing is glossy or the sky alone shines.
fn glints(
    graph: &mut Graph<'_>,
    scene: &TracedScene,
    space: &ParticleSpace,
    options: &ParticlesOptions,
) -> (Option<BufferRef<u32>>, f64) {
    // A channel may carry several times the luminance, and all of it may land on one particle.
    let steps_a_watt = f64::from(1_u32 << 31) / (16.0 * scene.power.max(1e-30));
    let target_count = scene.target_shares.count;
    let levels = space.levels;
    let reason = match (target_count, scene.emitter_count, options.photons, levels.told_apart) {
        (0, ..) => Some("nothing glossy that lights reach"),
        (_, 0, ..) => Some("no light but the sky"),
        (_, _, 0, _) => Some("no photons asked for"),
        (.., 1) => Some("reflections are more bounces than asked for"),
        _ => None,
    };
    if let Some(reason) = reason {
        graph.skip("diffuse/particles/light/glints", reason);
        return (None, steps_a_watt);
    }
    let glints = graph.buffer::<u32>("particles.glints", (3 * levels.late().max(1) * space.count) as usize);
    graph.fill_buffer("diffuse/particles/light/clear-glints", glints, 0);
    let photon_count = options.photons;
    let pass = Glints {
        scene_rays: space.rays.clone(),
        scene_lights: scene.lights(graph),
        light_targets: scene.targets(graph),
        particles: space.group.clone(),
        lobes: lobes_of(scene),
        event_levels: levels.told_apart,
        glints: glints.read_write(),
        facets: space.facets.read(),
        homes: space.homes.read(),
        push: GlintsPush {
            photon_count,
            emitter_count: scene.emitter_count,
            target_count,
            steps_a_watt: steps_a_watt as f32,
            particle_count: space.count,
        },
    };
    let pass = graph.pass("diffuse/particles/light/glints", pass).note("photons", u64::from(photon_count));
    pass.threads([photon_count, 1, 1]);
    (Some(glints), steps_a_watt)
}
