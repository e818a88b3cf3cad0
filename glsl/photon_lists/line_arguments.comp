#version 460
#include "lib/prelude.glsl"
#include "photons/records.glsl"

// The arguments of a draw of one line for each ray of a stage.

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) readonly buffer Counts { uint counts[]; };
layout(set = 0, binding = 1) writeonly buffer Arguments { uint arguments[]; };

layout(push_constant, scalar) uniform Push {
    uint stage;
    uint capacity;
} push;

void main() {
    arguments[0] = 2u;
    arguments[1] = min(counts[STAGE_WORDS * push.stage + COUNT_WORD], push.capacity);
    arguments[2] = 0u;
    arguments[3] = 0u;
}
