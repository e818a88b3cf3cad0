#version 460
#include "lib/prelude.glsl"
#include "photons/records.glsl"
#include "photon_splat/disc.glsl"

// Copies one photon's disc (photon_splat/disc.glsl) to its place among those of its cell, in four lists that gather.comp reads without
// unpacking: centre, and radius of a sphere around all that the disc may light; normal, and 1/h²; irradiance, and allowed height;
// squeeze.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer counts;
layout(set = 0, binding = 1) uniform usamplerBuffer discs;
layout(set = 0, binding = 2) uniform usamplerBuffer places;
layout(set = 0, binding = 3) uniform usamplerBuffer cell_starts;
layout(set = 0, binding = 4) writeonly buffer CenterBlock { vec4 sorted_centers[]; };
layout(set = 0, binding = 5) writeonly buffer NormalBlock { vec4 sorted_normals[]; };
layout(set = 0, binding = 6) writeonly buffer IrradianceBlock { vec4 sorted_irradiances[]; };
layout(set = 0, binding = 7) writeonly buffer SqueezeBlock { vec4 sorted_squeezes[]; };

layout(push_constant, scalar) uniform Push {
    uint stage;
    float tolerance;
} push;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(counts, int(STAGE_WORDS * push.stage + COUNT_WORD)).x) {
        return;
    }
    uvec2 place = texelFetch(places, int(index)).xy;
    if (place.x == NO_CELL) {
        return;
    }
    uint target = texelFetch(cell_starts, int(place.x)).x + place.y;
    vec4 center = uintBitsToFloat(texelFetch(discs, 3 * int(index)));
    uvec4 disc = texelFetch(discs, 3 * int(index) + 1);
    float height = allowed_height(center.w, push.tolerance);
    sorted_centers[target] = vec4(center.xyz, length(vec2(center.w, height)));
    sorted_normals[target] = vec4(unpack_direction(disc.w), 1.0 / (center.w * center.w));
    sorted_squeezes[target] = uintBitsToFloat(texelFetch(discs, 3 * int(index) + 2));
    sorted_irradiances[target] = vec4(uintBitsToFloat(disc.xyz), height);
}
