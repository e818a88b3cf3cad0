#version 460
#include "lib/prelude.glsl"
#include "path/queue.glsl"
#include "path/state.glsl"
#include "path/vertex.glsl"
#include "sppm/photon.glsl"

// Adds the photons around one measurement point (Hachisuka & Jensen 2009, eq. 3; the adjoint of the shading normal as in particle/camera.comp),
//
//   L = β/P(D) Σ f_D(l, v) |l·n_s|/|l·n_p| Φ / (p π r² N)        W/(m²·sr)
//
// with the share p of the disc that is surface (sppm/probe.comp), over those within r of it, on the same surface: whose normal is at most 60° off, so that no light comes around corners, and which are
// within r/4 of the tangent plane, so that none comes from a surface before or behind, while one that curves with a radius above 2r
// loses nothing. Sums are 64-bit integers in units of 1/scale: whatever the order of the photons, the same sum.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer point_queue;
layout(set = 0, binding = 1) uniform usamplerBuffer points;
layout(set = 0, binding = 2) uniform usamplerBuffer photons;
layout(set = 0, binding = 3) uniform usamplerBuffer bucket_starts;
layout(set = 0, binding = 4) uniform usamplerBuffer photon_order;
layout(set = 0, binding = 5) buffer RadianceBlock { vec4 path_radiance[]; };

layout(push_constant, scalar) uniform Push {
    float radius;        // r, m
    float inverse_cell;  // 1/m
    float density;       // 1/(π r² N), 1/m²
    float scale;         // units of a sum in 1 W/(m²·sr)
    uint bits;           // of the grid
    uint bounces;        // scatterings between light and x at most
    uint path_count;
    uint reserved;
} push;

struct Sum {
    uvec3 low;
    uvec3 high;
};

void add(inout Sum sum, vec3 light) {
    vec3 units = min(light * push.scale, vec3(1e18));
    uvec3 high = uvec3(units * (1.0 / 4294967296.0));
    uvec3 low = uvec3(units - vec3(high) * 4294967296.0);
    uvec3 carry;
    sum.low = uaddCarry(sum.low, low, carry);
    sum.high += high + carry;
}

void add_radiance(uint path, uint slot, Sum sum) {
    uint place = slot * push.path_count + path;
    vec3 radiance = (vec3(sum.high) * 4294967296.0 + vec3(sum.low)) / push.scale;
    path_radiance[place] = vec4(path_radiance[place].rgb + radiance, 0.0);
}

struct Receiver {
    vec3 position;
    vec3 geometric_normal;
    Frame frame;
    vec3 viewer;
    Matter matter;
    uint depth;
    float inverse_share;  // 1/p
};

Receiver load_receiver(uint path) {
    uvec4 a = texelFetch(points, POINT_TEXELS * int(path));
    uvec4 b = texelFetch(points, POINT_TEXELS * int(path) + 1);
    uvec4 c = texelFetch(points, POINT_TEXELS * int(path) + 2);
    vec2 layer = unpackUnorm2x16(c.x);
    Frame frame = frame_around(unpack_direction(b.w));
    return Receiver(
        uintBitsToFloat(a.xyz), unpack_direction(a.w), frame, local_viewer(frame, unpack_direction(c.y)),
        Matter(uintBitsToFloat(b.xyz), vec3(layer.x), layer.y, 1.0, vec3(0.0), 1.0), c.z, float(c.w));
}

// What one photon adds; null if it is none of the receiver's.
vec3 light_of_photon(Receiver receiver, int photon, out bool specular) {
    vec3 offset = uintBitsToFloat(texelFetch(photons, PHOTON_TEXELS * photon).xyz) - receiver.position;
    specular = false;
    if (dot(offset, offset) >= push.radius * push.radius
        || abs(dot(offset, receiver.geometric_normal)) >= 0.25 * push.radius) {
        return vec3(0.0);
    }
    uvec4 b = texelFetch(photons, PHOTON_TEXELS * photon + 1);
    uvec4 c = texelFetch(photons, PHOTON_TEXELS * photon + 2);
    specular = c.z != 0u;
    if (dot(unpack_direction(c.x), receiver.geometric_normal) <= 0.5 || c.y + receiver.depth > push.bounces) {
        return vec3(0.0);
    }
    vec3 direction = to_local(receiver.frame, unpack_direction(b.w));
    vec3 scattered = diffuse_lobe(receiver.matter, receiver.viewer, direction, 1.0).value;
    return scattered * uintBitsToFloat(b.xyz) * (push.density * receiver.inverse_share / uintBitsToFloat(c.w));
}

void gather(uint path) {
    Receiver receiver = load_receiver(path);
    ivec3 low = ivec3(floor((receiver.position - push.radius) * push.inverse_cell));
    Sum diffuse = Sum(uvec3(0u), uvec3(0u));
    Sum caustics = diffuse;
    [[dont_unroll]] for (uint corner = 0u; corner < 8u; ++corner) {
        uint bucket = bucket_of(low + ivec3(corner & 1u, corner >> 1 & 1u, corner >> 2), push.bits);
        int end = int(texelFetch(bucket_starts, int(bucket) + 1).x);
        for (int place = int(texelFetch(bucket_starts, int(bucket)).x); place < end; ++place) {
            bool specular;
            vec3 light = light_of_photon(receiver, int(texelFetch(photon_order, place).x), specular);
            if (max3(light) > 0.0) {
                if (specular && receiver.depth == 0u) {
                    add(caustics, light);
                } else {
                    add(diffuse, light);
                }
            }
        }
    }
    add_radiance(path, receiver.depth == 0u ? SLOT_DIFFUSE : SLOT_SPECULAR, diffuse);
    if (SPECULAR_LOBES != 0u && receiver.depth == 0u) {
        add_radiance(path, SLOT_CAUSTICS, caustics);
    }
}

void main() {
    uint path = queued_path(point_queue);
    if (path != NO_PATH) {
        gather(path);
    }
}
