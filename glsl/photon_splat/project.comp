#version 460
#include "lib/prelude.glsl"
#include "groups/splat.glsl"
#include "groups/surface.glsl"
#include "lib/finite.glsl"
#include "photons/records.glsl"
#include "photon_splat/disc.glsl"
#include "photon_splat/extent.glsl"
#include "photon_splat/kernel.glsl"
#include "photon_splat/levels.glsl"
#include "photon_splat/state.glsl"

// One photon becomes the disc that is splatted, and is counted in its cell of the grid; one that no pixel can see is left out.
//
// A disc smaller than about a sample would slip between samples: its radius is at least LEAST_SAMPLES times a sample's extent on its
// surface. Where it covers few samples, Σ K(d/h)/h²·ΔA over them, ΔA the area of the surface that each stands for, is not yet
// its integral, 1; the flux is divided by that sum, so that each photon's whole flux arrives.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer photons;
layout(set = 0, binding = 1) uniform usamplerBuffer counts;
layout(set = 0, binding = 2) writeonly buffer DiscBlock { uvec4 discs[]; };
layout(set = 0, binding = 3) writeonly buffer PlaceBlock { uvec2 places[]; };  // cell, or NO_CELL · place among its photons
layout(set = 0, binding = 4) buffer CellCountBlock { uint cell_counts[]; };
layout(set = 0, binding = 5) buffer CellPeakBlock { uint cell_peaks[]; };  // the brightest of each cell's discs, W/m², as a float's bits
layout(set = 0, binding = 6) buffer StateBlock { uint state[]; };

layout(set = 0, binding = 7) uniform samplerBuffer ellipses;

layout(push_constant, scalar) uniform Push {
    ivec2 image_size;
    uint stage;
    int downscale;
    int level_count;
    float tolerance;  // metres that a photon may be off its surface
} push;

const float LEAST_SAMPLES = 1.0;
const float FEW_SAMPLES = 3.0;
const float MOST_SAMPLES = 150.0;

shared uint levels_of_group;

// Metres between samples on a plane at the photon across the view.
float sample_extent(float along) {
    vec2 extents = 2.0 * vec2(length(camera.right_scaled), length(camera.down_scaled)) / vec2(push.image_size);
    float scale = camera.depth_range > 0.0 ? 1.0 : max(along, camera.near);
    return max(extents.x, extents.y) * scale * float(push.downscale);
}

// How much shorter a unit vector looks from there.
float foreshortening(vec3 to_eye, vec3 direction) {
    float along = dot(to_eye, direction);
    return sqrt(max(1.0 - along * along, 0.01));
}

// Σ K(d/h)/h²·ΔA over the samples of the photon's plane n·x = c. Perspective: x = r·c/(n·r) on the ray r through a sample, and a sample
// of area a at distance 1 stands for the area a·z³/|c|, z being the depth of x.
float lattice_sum(Photon photon, float radius, float smaller, vec3 squeeze, Extent extent) {
    bool perspective = camera.depth_range <= 0.0;
    vec3 offset = photon.position_rs - camera.position_rs;
    float plane = dot(offset, photon.normal);
    float along_normal = dot(camera.forward, photon.normal);
    vec3 x_step = camera.right_scaled * (2.0 * float(push.downscale) / float(push.image_size.x));
    vec3 y_step = camera.down_scaled * (2.0 * float(push.downscale) / float(push.image_size.y));
    ivec2 first = ivec2(ceil(extent.center - extent.radius - 0.5));
    ivec2 last = ivec2(floor(extent.center + extent.radius - 0.5));
    vec2 corner = ndc_of_pixel(first * push.downscale + push.downscale / 2, push.image_size);
    vec3 row = corner.x * camera.right_scaled + corner.y * camera.down_scaled;
    float inverse_radius = 1.0 / radius;
    float area_factor = perspective ? 1.0 / abs(plane) : 1.0 / abs(along_normal);
    float sum = 0.0;
    for (int y = first.y; y <= last.y; ++y, row += y_step) {
        vec3 across = row;
        for (int x = first.x; x <= last.x; ++x, across += x_step) {
            vec3 ray = perspective ? camera.forward + across : camera.forward;
            vec3 start = perspective ? vec3(0.0) : across;
            float z = (plane - dot(start, photon.normal)) / dot(ray, photon.normal);
            float area = perspective ? z * z * z : 1.0;
            vec3 from_center = start + ray * z - offset;
            float squeezed = dot(from_center, squeeze);
            float squared = dot(from_center, from_center) * inverse_radius * inverse_radius + squeezed * squeezed;
            // A ray along the plane does not meet it.
            sum += area > 0.0 && is_finite(squared) ? kernel_shape(squared) * area : 0.0;
        }
    }
    return sum * area_factor * length(x_step) * length(y_step) * kernel_peak() * inverse_radius / smaller;
}

bool is_number(Photon photon) {
    return is_finite(photon.position_rs) && is_finite(photon.radius) && is_finite(photon.flux);
}

// Whether it stays a number where it is squared and summed.
bool is_sound(Photon photon) {
    return all(lessThan(abs(photon.position_rs), vec3(1e15))) && photon.radius < 1e15
        && all(greaterThanEqual(photon.flux, vec3(0.0))) && all(lessThan(photon.flux, vec3(1e30)));
}

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        levels_of_group = 0u;
    }
    barrier();
    uint index = gl_GlobalInvocationID.x;
    if (index < texelFetch(counts, int(STAGE_WORDS * push.stage + COUNT_WORD)).x) {
        Photon photon = load_photon(photons, index);
        vec3 offset = photon.position_rs - camera.position_rs;
        vec3 to_eye = camera.depth_range > 0.0 ? -camera.forward : -normalize_or(offset, camera.forward);
        float cosine = max(abs(dot(to_eye, photon.normal)), 0.1);
        float sample_across = sample_extent(dot(offset, camera.forward));
        float radius = max(photon.radius, LEAST_SAMPLES * sample_across / cosine);
        float smaller = radius;
        vec3 squeeze = vec3(0.0);
        if (ELLIPTIC != 0u) {
            vec4 axis = texelFetch(ellipses, int(index));
            float least = LEAST_SAMPLES * sample_across;
            radius = max(photon.radius, least / foreshortening(to_eye, cross(photon.normal, axis.xyz)));
            smaller = min(max(axis.w, least / foreshortening(to_eye, axis.xyz)), radius);
            squeeze = axis.xyz * sqrt(max(1.0 / (smaller * smaller) - 1.0 / (radius * radius), 0.0));
        }
        bool is_dropped = !is_number(photon);
        bool sound = !is_dropped && is_sound(photon);
        float height = allowed_height(radius, push.tolerance);
        Extent extent =
            disc_extent(camera, photon.position_rs, photon.normal, radius, height, push.image_size, push.downscale);
        vec3 irradiance = photon.flux * (kernel_peak() / (radius * smaller));
        vec2 covered = 2.0 * extent.radius + 1.0;
        if (sound && smaller * cosine < FEW_SAMPLES * sample_across && covered.x * covered.y < MOST_SAMPLES) {
            irradiance /= clamp(lattice_sum(photon, radius, smaller, squeeze, extent), 0.5, 2.0);
        }
        irradiance = min(irradiance, vec3(1e30));
        float peak = max3(irradiance);
        uvec2 place = uvec2(NO_CELL, 0u);
        if (is_dropped) {
            atomicAdd(state[STATE_DROPPED], 1u);
        }
        if (sound && peak > 0.0 && extent.radius.x > 0.0) {
            float reach = max(extent.radius.x, extent.radius.y);
            int level = 0;
            while (level < push.level_count - 1 && reach > reach_of_level(level)) {
                ++level;
            }
            uvec4 cells = texelFetch(splat_levels, level);
            vec2 size = vec2(lattice_size(push.image_size, push.downscale));
            ivec2 cell = ivec2(clamp(extent.center, vec2(0.0), size - 0.5)) >> cell_log2(level);
            place.x = uint(cell_index(cell, cells));
            place.y = atomicAdd(cell_counts[place.x], 1u);
            atomicMax(cell_peaks[place.x], floatBitsToUint(peak));
            atomicOr(levels_of_group, 1u << level);
        }
        places[index] = place;
        discs[3u * index + 2u] = uvec4(floatBitsToUint(squeeze), 0u);
        discs[3u * index] = uvec4(floatBitsToUint(photon.position_rs), floatBitsToUint(radius));
        discs[3u * index + 1u] = uvec4(floatBitsToUint(irradiance), pack_direction(photon.normal));
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u && levels_of_group != 0u) {
        atomicOr(state[STATE_LEVELS], levels_of_group);
    }
}
