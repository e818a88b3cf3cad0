// The including shader defines NODES_ACCESS: `writeonly` for the pass that starts from no nodes, nothing for one that adds to them.
//
// Puts a node at the head of its texel's list (Quyen 2014, alg. 3.4). Nodes beyond the pool's capacity are counted, but not stored.
#include "lib/octahedral.glsl"
#include "photon_lists/draw.glsl"
#include "photon_lists/node.glsl"

layout(set = 0, binding = 0) buffer Pixels { uint pixels[]; };
layout(set = 0, binding = 1) buffer NodeCount { uint node_count[]; };
layout(set = 0, binding = 2) NODES_ACCESS buffer Nodes { uvec4 nodes[]; };

void append(float depth, vec3 normal, uint material) {
    uint index = atomicAdd(node_count[0], 1u);
    if (index < push.capacity) {
        uint bits = floatBitsToUint(depth);
        uint pixel = 4u * (uint(gl_FragCoord.y) * push.resolution + uint(gl_FragCoord.x));
        uint next = atomicExchange(pixels[pixel], index);
        atomicMin(pixels[pixel + 1u], bits);
        atomicMin(pixels[pixel + 2u], ~bits);
        nodes[index] = uvec4(bits, pack_direction(normal), next, material);
    }
}
