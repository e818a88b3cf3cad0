#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "lightmaps/charts.glsl"
#include "lightmaps/rounds.glsl"

// The box around each side of a surface, of the texel's part: it holds every line between two of its points, as far as these are lifted off it.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer Bounds { uint bounds[]; };  // six words a side, as in rounds.glsl

layout(push_constant, scalar) uniform Push { uint texel_count; } push;

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.texel_count) {
        return;
    }
    uvec4 place = texelFetch(lightmap_texels, 2 * int(number));
    uvec4 more = texelFetch(lightmap_texels, 2 * int(number) + 1);
    if (more.z == NO_TEXEL) {
        return;
    }
    vec3 position = uintBitsToFloat(place.xyz);
    float size = uintBitsToFloat(more.y);
    [[dont_unroll]] for (uint word = 0u; word < 6u; ++word) {
        float value = (word < 3u ? position[word] : -position[word - 3u]) + size;
        if (bounds[6u * more.w + word] < ordered(value)) {
            atomicMax(bounds[6u * more.w + word], ordered(value));
        }
    }
}
