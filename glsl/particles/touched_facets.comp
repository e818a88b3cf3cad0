#version 460
#include "lib/prelude.glsl"
#include "lib/append.glsl"
#include "particles/again.glsl"
#include "particles/home_words.glsl"
#include "particles/moved.glsl"

// Lists the facets (catch.comp) whose particle may be another one since something moved.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer homes;
layout(set = 0, binding = 1) uniform usamplerBuffer touched;
layout(set = 0, binding = 2) buffer Head { uint head[]; };
layout(set = 0, binding = 3) writeonly buffer Again { uint again[]; };
layout(set = 0, binding = 4) uniform usamplerBuffer facets;

layout(push_constant, scalar) uniform Push {
    uint triangle_count;
    uint capacity;
} push;

void main() {
    uint facet = invocation_of_list();
    bool wanted = false;
    if (facet < texelFetch(facets, int(push.triangle_count)).x) {
        uint home = home_of_word(texelFetch(homes, int(facet)).x);
        wanted = home == LOST_FACET || (touched_bits(touched, home) & TOUCHED) != 0u;
    }
    uint place;
    APPEND(head[AGAIN_COUNT], wanted, place, {})
    if (wanted && place < push.capacity) {
        again[place] = facet;
    }
}
