#version 460
#include "lib/prelude.glsl"

// Lists the numbers of the bits that are set in one word, in their order.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer marks;
layout(set = 0, binding = 1) uniform usamplerBuffer starts;
layout(set = 0, binding = 2) writeonly buffer Numbers { uint numbers[]; };

layout(push_constant, scalar) uniform Push { uint word_count; } push;

void main() {
    uint word = gl_GlobalInvocationID.x;
    if (word >= push.word_count) {
        return;
    }
    uint bits = texelFetch(marks, int(word)).x;
    uint place = texelFetch(starts, int(word)).x;
    [[dont_unroll]] for (; bits != 0u; bits &= bits - 1u) {
        numbers[place] = 32u * word + uint(findLSB(bits));
        ++place;
    }
}
