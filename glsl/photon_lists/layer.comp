#version 460
#include "lib/prelude.glsl"
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "photon_lists/node.glsl"

// One texel of a layer becomes a node at the head of the texel's list. The node's place is its layer and texel: no order to decide about.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usampler2D layer;
layout(set = 0, binding = 1) buffer Pixels { uint pixels[]; };
layout(set = 0, binding = 2) buffer NodeCount { uint node_count[]; };
layout(set = 0, binding = 3) buffer Nodes { uvec4 nodes[]; };

layout(push_constant, scalar) uniform Push {
    uint number;       // of the layer
    uint pixel_count;
} push;

void main() {
    uint pixel = gl_GlobalInvocationID.x;
    uint found = 0u;
    if (pixel < push.pixel_count) {
        int width = textureSize(layer, 0).x;
        uvec4 texel = texelFetch(layer, ivec2(int(pixel) % width, int(pixel) / width), 0);
        found = texel.w;
        if (found != 0u) {
            uint index = push.number * push.pixel_count + pixel;
            nodes[index] = uvec4(texel.xy, pixels[4u * pixel], texel.z);
            pixels[4u * pixel] = index;
            pixels[4u * pixel + 1u] = min(pixels[4u * pixel + 1u], texel.x);
            pixels[4u * pixel + 2u] = ~texel.x;
        }
    }
    uint all = subgroupAdd(found);
    if (subgroupElect()) {
        atomicAdd(node_count[0], all);
    }
}
