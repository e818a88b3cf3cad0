#version 460
#include "lib/prelude.glsl"

// One group counts the bits of a row of words before each word, and all of them; says how many groups take one each.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform usamplerBuffer marks;
layout(set = 0, binding = 1) writeonly buffer Starts { uint starts[]; };
layout(set = 0, binding = 2) writeonly buffer Found { uint found[]; };  // groups of 64, three words; bits

layout(push_constant, scalar) uniform Push { uint word_count; } push;

// Groups along x: no device need dispatch more than 65,535.
const uint MOST_GROUPS = 32768u;

#define SCAN_TYPE uint

uint scan_term(uint index) {
    return uint(bitCount(texelFetch(marks, int(index)).x));
}

void scan_store(uint index, uint before) {
    starts[index] = before;
}

#include "lib/prefix_scan.glsl"

void main() {
    scan(push.word_count);
    if (gl_LocalInvocationIndex == 0u) {
        uint groups = (scan_total() + 63u) / 64u;
        found[0] = min(groups, MOST_GROUPS);
        found[1] = (groups + MOST_GROUPS - 1u) / MOST_GROUPS;
        found[2] = 1u;
        found[3] = scan_total();
    }
}
