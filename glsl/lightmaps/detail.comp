#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lightmaps/lookup.glsl"

// What light maps hold for one texel of finer maps of the same surfaces, W/m²: interpolated, and cut, as for a point that the eye sees.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer placed;  // the finer maps' texels (lightmaps/texels.glsl)
layout(set = 0, binding = 1) uniform usamplerBuffer places;  // on which triangle these lie, and where (lightmaps/place.comp)
layout(set = 0, binding = 2) uniform samplerBuffer light;    // of the maps' texels, element stride·number + offset
layout(set = 0, binding = 3) writeonly buffer Found { vec4 found[]; };

layout(push_constant, scalar) uniform Push {
    uint texel_count;
    uint stride;
    uint offset;
} push;

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.texel_count) {
        return;
    }
    uvec4 place = texelFetch(places, int(number));
    vec3 sum = vec3(0.0);
    if (place.x != NO_TEXEL) {
        vec3 position = uintBitsToFloat(texelFetch(placed, 2 * int(number)).xyz);
        vec3 face = unpack_direction(texelFetch(placed, 2 * int(number) + 1).x);
        bool back = (place.x & TEXEL_BACK) != 0u;
        Cell cell = texels_at(place.x & ~TEXEL_BACK, uintBitsToFloat(place.yz), back, position, face);
        for (int corner = 0; corner < 4; ++corner) {
            sum += cell.weights[corner] * texelFetch(light, int(push.stride * cell.texels[corner] + push.offset)).rgb;
        }
    }
    found[number] = vec4(sum, 1.0);
}
