// The surface of a texel that follows those already taken: what the depth test leaves of the fragments behind `previous`.
#include "lib/octahedral.glsl"
#include "photon_lists/draw.glsl"

layout(set = 0, binding = 0) uniform usampler2D previous;

layout(location = 0) out uvec4 layer;  // rgba32ui: depth | normal | material | 1, or infinitely far | 0 | 0 | 0

bool is_next(float depth) {
    return depth > uintBitsToFloat(texelFetch(previous, ivec2(gl_FragCoord.xy), 0).x);
}

void write_layer(float depth, vec3 normal, uint material) {
    layer = uvec4(floatBitsToUint(depth), pack_direction(normal), material, 1u);
}
