#version 460
#include "lib/prelude.glsl"
#include "photons/choice.glsl"

// One group numbers the marked blocks: square_firsts[s] = Σ_{t<s} square_counts[t].

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform usamplerBuffer choice;
layout(set = 0, binding = 1) readonly buffer CountBlock { uint square_counts[]; };
layout(set = 0, binding = 2) writeonly buffer FirstBlock { uint square_firsts[]; };

#define SCAN_TYPE uint

uint scan_term(uint square) {
    return square_counts[square];
}

void scan_store(uint square, uint before) {
    square_firsts[square] = before;
}

#include "lib/prefix_scan.glsl"

void main() {
    scan(texelFetch(choice, 0).x * texelFetch(choice, 1).x);
}
