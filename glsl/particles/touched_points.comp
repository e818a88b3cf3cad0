#version 460
#include "lib/prelude.glsl"
#include "lib/append.glsl"
#include "particles/again.glsl"
#include "particles/home_words.glsl"
#include "particles/moved.glsl"

// Lists the points by which particles are measured (catch.comp) whose particle may be another one since something moved.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer homes;
layout(set = 0, binding = 1) uniform usamplerBuffer touched;
layout(set = 0, binding = 2) buffer Head { uint head[]; };
layout(set = 0, binding = 3) writeonly buffer Again { uint again[]; };

layout(push_constant, scalar) uniform Push {
    uint point_count;
    uint capacity;
} push;

void main() {
    uint point = invocation_of_list();
    bool wanted = false;
    if (point < push.point_count) {
        uint home = texelFetch(homes, int(point)).x;
        wanted = home == LOST_POINT || (home < NO_POINT && (touched_bits(touched, home) & TOUCHED) != 0u);
    }
    uint place;
    APPEND(head[AGAIN_COUNT], wanted, place, {})
    if (wanted && place < push.capacity) {
        again[place] = point;
    }
}
