#version 460
#include "lib/prelude.glsl"

// One invocation writes the four words of an indirect command, as passes that count their successors' work do.

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) buffer Arguments { uint arguments[]; };

layout(push_constant, scalar) uniform Push {
    uvec4 words;
    uint first;
} push;

void main() {
    for (uint i = 0u; i < 4u; ++i) {
        arguments[push.first + i] = push.words[i];
    }
}
