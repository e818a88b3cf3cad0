#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_lights.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/color.glsl"
#include "lib/emissive_points.glsl"
#include "lib/emitters.glsl"
#include "lib/lights.glsl"
#include "lib/octahedral.glsl"
#include "lib/ray_offset.glsl"
#include "lib/sobol.glsl"
#include "particles/arrivals.glsl"
#include "particles/events.glsl"
#include "particles/places.glsl"

// The flux that one particle receives from the lights, W (Chang et al. 4.2.1, for every kind of light):
//
//   φ = ΔA·( Σ_punctual I(ω)·cosθ/(d² + ΔA/π)·V + Σ_k L_e(y_k)·cosθ·V/(K·p_k + M·cosθ/π) + π/M Σ_links w·L_e + π·L_sky·s )
//
// d² + ΔA/π in place of d²: the particle is a disc, which takes no more than a half space of light. y_k: K points of emissive surfaces drawn by power with
// density p_k (1/sr, seen from the particle), combined by the balance heuristic with those that the particle's M links end on, with the density cosθ/π and
// weight w = M·cosθ/π/(K·p + M·cosθ/π) (links.comp): bounded however near the emitter is. s: what share of the sky's light the links see, in mirrors and
// through glass too.
// To this comes what photons bring off mirrors and through glass (glints.comp). Where specular events are counted (events.glsl), the sky and photons that met some
// stand behind the flux of all particles by how many they met.

layout(local_size_x = 64) in;

// 1: photons bring flux off mirrors and through glass.
layout(constant_id = 0) const uint HAS_GLINTS = 0u;

layout(set = 0, binding = 1) uniform samplerBuffer matter;
layout(set = 0, binding = 2) uniform usamplerBuffer arrivals;
layout(set = 0, binding = 3) readonly buffer Glints { uint glints[]; };  // steps: red, green, blue one by one
layout(set = 0, binding = 4) writeonly buffer Flux { vec4 flux[]; };     // W; what share of it is not the sky's

layout(push_constant, scalar) uniform Push {
    uint particle_count;
    uint light_count;
    uint emitter_count;
    uint sample_count;
    float density_scale;
    float links;              // of a particle
    float watts_a_step;
    float greatest_radiance;  // of any emissive surface, W/(m²·sr)
    vec3 sky;                 // W/(m²·sr)
} push;

// The irradiance that links bring of the sky's light, W/m², by so many specular events where these are counted.
vec3 sky_by_links(uint particle, uint events) {
    int first = int(events == 0u ? particle * arrival_words() : late_sky(push.particle_count, particle, events));
    uvec3 steps = uvec3(texelFetch(arrivals, first).x, texelFetch(arrivals, first + 1).x, texelFetch(arrivals, first + 2).x);
    return push.sky * vec3(steps) * (PI / (push.links * float(SKY_STEPS)));
}

// And of emissive surfaces'.
vec3 emission_by_links(uint particle) {
    vec3 radiance = vec3(0.0);
    if (HAS_EMITTERS != 0u) {
        int first = int(particle * arrival_words() + EMISSION_WORD);
        for (int channel = 0; channel < 3; ++channel) {
            float whole = float(texelFetch(arrivals, first + 2 * channel).x);
            float parts = float(texelFetch(arrivals, first + 2 * channel + 1).x);
            radiance[channel] += push.greatest_radiance * (whole + parts / EMISSION_STEPS) / EMISSION_STEPS;
        }
    }
    return radiance * (PI / push.links);
}

vec4 with_share(vec3 received, vec3 from_sky) {
    received = is_finite(received) ? received : vec3(0.0);
    return vec4(received, 1.0 - clamp(luminance(from_sky) / max(luminance(received), 1e-30), 0.0, 1.0));
}

vec3 by_photons(uint number) {
    uint first = 3u * number;
    return HAS_GLINTS != 0u ? vec3(glints[first], glints[first + 1], glints[first + 2]) * push.watts_a_step : vec3(0.0);
}

void main() {
    uint particle = gl_GlobalInvocationID.x;
    if (particle >= push.particle_count) {
        return;
    }
    float area = texelFetch(matter, int(particle)).w;
    if (area <= 0.0) {
        [[dont_unroll]] for (uint level = 0u; level < max(EVENT_LEVELS, 1u); ++level) {
            flux[level * push.particle_count + particle] = vec4(0.0);
        }
        return;
    }
    uvec4 place = texelFetch(particle_places, int(particle));
    vec3 position = uintBitsToFloat(place.xyz);
    vec3 normal = unpack_direction(place.w);
    vec3 face = face_of_particle(particle_places, particle);
    vec3 origin = offset_ray_origin(position, face);
    float disc = area * INVERSE_PI;

    vec3 irradiance = sky_by_links(particle, 0u) + emission_by_links(particle);
    [[dont_unroll]] for (uint i = 0u; i < push.light_count + push.sample_count; ++i) {
        vec3 light = vec3(0.0);
        vec3 way = vec3(0.0);
        float end = 1.0;
        if (i < push.light_count) {
            Light source = load_light(punctual_lights, i);
            Illumination illumination = illuminate(source, position);
            bool directional = source.kind == LIGHT_DIRECTIONAL;
            way = directional ? illumination.to_light : source.position_rs - origin;
            end = directional ? 3e38 : 1.0;
            vec3 beyond = source.position_rs - position;
            float distance2 = dot(beyond, beyond);
            float spread = directional ? 1.0 : distance2 / (distance2 + disc);
            light = illumination.irradiance * (spread * max(dot(normal, illumination.to_light), 0.0));
        } else {
            vec4 random = sobol_sample(sobol, i - push.light_count, seed_of(particle, 0xE31771u));
            Emitter emitter = pick_emitter(emissive_triangles, push.emitter_count, random.x);
            Triangle triangle = load_triangle(triangles, emitter.number);
            Material material = load_material(materials, triangle.material);
            EmissivePoint point = draw_emissive_point(triangle, random.yz);
            vec3 front = front_normal(triangle);
            way = point_of_triangle(triangle, point.place, front) - origin;
            float distance2 = max(dot(way, way), 1e-30);
            vec3 to_light = way * inversesqrt(distance2);
            float cosine = -dot(front, to_light);
            cosine = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u ? abs(cosine) : max(cosine, 0.0);
            float received = max(dot(normal, to_light), 0.0);
            float density = point.density * push.density_scale * float(push.sample_count) * distance2;
            float both = density + push.links * received * cosine * INVERSE_PI;
            light = covered_radiance(triangle, material, point.place) * (cosine * received / max(both, 1e-30));
        }
        if (max3(light) > 0.0 && dot(face, way) > 0.0 && !is_occluded(origin, way, end)) {
            irradiance += light;
        }
    }
    vec3 received = irradiance * area;
    if (EVENT_LEVELS == 0u) {
        received += by_photons(particle);
    }
    flux[particle] = with_share(received, sky_by_links(particle, 0u) * area);
    [[dont_unroll]] for (uint events = 1u; events < EVENT_LEVELS; ++events) {
        vec3 from_sky = max3(push.sky) > 0.0 ? sky_by_links(particle, events) * area : vec3(0.0);
        vec3 from_lamps = by_photons((events - 1u) * push.particle_count + particle);
        flux[events * push.particle_count + particle] = with_share(from_sky + from_lamps, from_sky);
    }
}
