#version 460
#include "lib/prelude.glsl"
#include "groups/lobes.glsl"
#include "groups/scene_rays.glsl"
#include "lib/finite.glsl"
#include "lib/mirrored.glsl"
#include "lib/scene.glsl"
#include "trace/walking.glsl"

// Takes n×n samples of one marked pixel, spread over all of it: rays from the camera, followed as those that start at pixels' centres are (ways.glsl). With N = n²
// samples r of radiance L
//
//   L ≈ 1/N Σ_r L(r)
//
// is the mean over the pixel. Lists the surfaces that the rays come to, the first ones and those that mirrors show, and sums up what shines by itself, slot by slot.
// They are a square lattice, turned so far that row j is shifted by j/n of a stratum to the right and column i by i/n upwards: all N differ in both coordinates, so
// that an upright edge has N steps and not n.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform CameraBlock { Camera camera; };
layout(set = 0, binding = 1) uniform usamplerBuffer marked;        // marks.comp
layout(set = 0, binding = 2) uniform usamplerBuffer marked_count;  // word 3
layout(set = 0, binding = 3) writeonly buffer Points { MirroredPoint points[]; };
layout(set = 0, binding = 4) buffer Counts { uint counts[]; };     // word 0: points, word 1: rays
layout(set = 0, binding = 5) writeonly buffer Sums { uvec4 sums[]; };  // three a pixel: replace.comp

layout(push_constant, scalar) uniform Push {
    vec3 shift;    // from render space to that of rays
    uint side;     // n
    Walking walking;
    uvec2 size;    // of the image
    uint lamps;    // 1: the slot `specular` shows what shines behind the first event, else `direct` does
} push;

#include "trace/ways.glsl"

vec3 emission_sum = vec3(0.0);
vec3 direct_sum = vec3(0.0);
vec3 specular_sum = vec3(0.0);

void add_shining(uint slot, vec3 radiance) {
    emission_sum += slot == IN_EMISSION ? radiance : vec3(0.0);
    direct_sum += slot == IN_DIRECT ? radiance : vec3(0.0);
    specular_sum += slot == IN_SPECULAR ? radiance : vec3(0.0);
}

// All that shines: at the points themselves wide lobes look for emissive surfaces, none does for the sky.
uint shows_of_first_reflection(bool narrow) {
    if (narrow) {
        return SHOWS_LAMPS | SHOWS_SKY | (push.lamps != 0u ? IN_SPECULAR : IN_DIRECT);
    }
    return SHOWS_SKY | IN_DIRECT;
}

// The change of the texture coordinates to where a ray meets the triangle's plane that is moved by `ray_step`.
vec4 texcoord_step(Triangle triangle, vec3 position, vec3 origin, vec3 direction, vec3 ray_step) {
    vec3 normal = cross(triangle.edge1, triangle.edge2);
    bool orthographic = camera.depth_range > 0.0;
    vec3 ray = orthographic ? camera.forward : direction / max(dot(direction, camera.forward), 1e-20) + ray_step;
    vec3 start = orthographic ? origin + ray_step : camera.position_rs + push.shift;
    vec3 moved = start + dot(position - start, normal) / dot(ray, normal) * ray - position;
    float inverse = 1.0 / max(dot(normal, normal), 1e-37);
    float u = dot(cross(moved, triangle.edge2), normal) * inverse;
    float v = dot(cross(triangle.edge1, moved), normal) * inverse;
    return interpolated(corner_texcoords, triangle, vec3(-u - v, u, v));
}

// To the next sample where the camera sees the triangle; in mirrors at their finest.
Footprint footprint_of(uint event, Triangle triangle, Hit hit, vec3 origin, vec3 direction) {
    Footprint footprint = Footprint(vec4(0.0), vec4(0.0));
    if (event == 0u) {
        vec3 position = origin + hit.distance * direction;
        vec2 step_size = 2.0 / (vec2(push.size) * float(push.side));
        footprint.dx = texcoord_step(triangle, position, origin, direction, camera.right_scaled * step_size.x);
        footprint.dy = texcoord_step(triangle, position, origin, direction, camera.down_scaled * step_size.y);
    }
    return footprint;
}

// A ray through the pixel, from the near plane on.
void send_from_camera(uvec2 pixel, uint number) {
    float side = float(push.side);
    vec2 stratum = vec2(number % push.side, number / push.side);
    vec2 place = (stratum + (vec2(stratum.y, side - 1.0 - stratum.x) + 0.5) / side) / side;
    vec2 ndc = 2.0 * (vec2(pixel) + place) / vec2(push.size) - 1.0;
    vec3 across = ndc.x * camera.right_scaled + ndc.y * camera.down_scaled;
    bool orthographic = camera.depth_range > 0.0;
    vec3 ray = orthographic ? camera.forward : camera.forward + across;
    vec3 origin = camera.position_rs + push.shift + ray * camera.near + (orthographic ? across : vec3(0.0));
    uint shows = SHOWS_LAMPS | SHOWS_SKY | IN_EMISSION;
    uint seed = seed_of(seed_of_pixel(ivec2(pixel)), number + 1u);
    waiting[0] = Way(origin, normalize(ray), vec3(1.0 / (side * side)), 0u, shows, seed);
    waiting_count = 1u;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(marked_count, 3).x) {
        return;
    }
    uint packed = texelFetch(marked, int(index)).x;
    uvec2 pixel = uvec2(packed & 0xFFFFu, packed >> 16);
    uint taken = 0u;
    uint number = 0u;
    Vertex first;
    Vertex vertex;
    bool goes_on = false;
    sample_count = 0u;
    // One step is one ray.
    [[dont_unroll]] while (true) {
        if (goes_on) {
            send_on(vertex, number);
        }
        bool from_camera = false;
        if (waiting_count == 0u) {
            ++number;
            if (number < sample_count) {
                vertex = first;
                goes_on = true;
                continue;
            }
            if (taken == push.side * push.side) {
                break;
            }
            send_from_camera(pixel, taken);
            ++taken;
            number = 0u;
            sample_count = 1u;
            from_camera = true;
        }
        goes_on = follow(vertex) && SPECULAR_LOBES != 0u;
        if (from_camera) {
            first = vertex;
            sample_count = goes_on ? 1u : 0u;
        }
    }
    atomicAdd(counts[1], ray_count);
    sums[3u * index] = uvec4(is_finite(emission_sum) ? floatBitsToUint(emission_sum) : uvec3(0u), head);
    sums[3u * index + 1u] = uvec4(is_finite(direct_sum) ? floatBitsToUint(direct_sum) : uvec3(0u), 0u);
    sums[3u * index + 2u] = uvec4(is_finite(specular_sum) ? floatBitsToUint(specular_sum) : uvec3(0u), 0u);
}
