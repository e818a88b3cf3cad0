#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "particles/grid.glsl"
#include "particles/surface_points.glsl"

// Puts one area particle onto the surfaces (places.glsl) and counts it in its bucket of the grid.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer sums;
layout(set = 0, binding = 1) uniform samplerBuffer spacing;
layout(set = 0, binding = 2) writeonly buffer Places { uvec4 places[]; };
layout(set = 0, binding = 3) writeonly buffer Buckets { uint buckets[]; };
layout(set = 0, binding = 4) buffer Counts { uint counts[]; };
layout(set = 0, binding = 5) uniform usamplerBuffer cells;
layout(set = 0, binding = 6) uniform usamplerBuffer weights;

layout(push_constant, scalar) uniform Push {
    uint triangle_count;
    uint particle_count;
    uint bucket_count;
} push;

void main() {
    uint particle = gl_GlobalInvocationID.x;
    if (particle >= push.particle_count) {
        return;
    }
    SurfacePoint point = surface_point(sums, cells, weights, push.triangle_count, particle, push.particle_count);
    float closest = texelFetch(spacing, 0).x;
    uint level = level_of_width(point.width);
    uint bucket = bucket_of(cell_of(point.position, widest_of_level(level, closest)), level, push.bucket_count);
    float own = closest * spacing_of_width(point.width);
    places[particle] = uvec4(floatBitsToUint(point.position), pack_direction(point.normal));
    places[push.particle_count + particle] = uvec4(pack_direction(point.face), point.index, floatBitsToUint(own), point.width);
    buckets[particle] = bucket;
    atomicAdd(counts[bucket], 1u);
}
