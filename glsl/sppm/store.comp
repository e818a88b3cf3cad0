#version 460
#include "lib/prelude.glsl"
#include "groups/paths.glsl"
#include "path/queue.glsl"
#include "path/state.glsl"
#include "path/vertex.glsl"
#include "sppm/photon.glsl"

// Leaves a photon where a light's path meets a surface that scatters diffusely, and counts it to its bucket of the grid.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer PhotonBlock { uvec4 photons[]; };
layout(set = 0, binding = 1) buffer QueueBlock { uint photon_queue[]; };
layout(set = 0, binding = 2) buffer CountBlock { uint bucket_counts[]; };

layout(push_constant, scalar) uniform Push {
    uint depth;          // vertices before this one
    uint bits;           // of the grid
    float inverse_cell;  // 1/m
    uint reserved;
} push;

void main() {
    uint path = queued_path(alive_paths);
    bool wanted = false;
    Vertex vertex;
    if (path != NO_PATH) {
        vertex = load_vertex(path_vertices, path);
        wanted = max3(vertex.matter.diffuse_albedo) > 0.0;
    }
    uint place;
    QUEUE_PLACE(photon_queue, wanted, place)
    if (wanted) {
        vec3 to_light = -texelFetch(path_rays, 2 * int(path) + 1).xyz;
        vec3 flux = texelFetch(path_states, int(path)).rgb;
        if (SPECULAR_LOBES != 0u) {
            uvec4 last = texelFetch(path_vertices, VERTEX_TEXELS * int(path) + 4);
            flux *= vec3(unpackHalf2x16(last.z), unpackHalf2x16(last.w).x);
        }
        uint bucket = bucket_of(ivec3(floor(vertex.position_rs * push.inverse_cell)), push.bits);
        uint specular = (texelFetch(path_flags, int(path)).x & FLAG_LAST_SPECULAR) != 0u ? 1u : 0u;
        float cosine = max(abs(dot(vertex.geometric_normal, to_light)), 1e-6);
        uint texel = uint(PHOTON_TEXELS) * place;
        photons[texel] = uvec4(floatBitsToUint(vertex.position_rs), bucket);
        photons[texel + 1u] = uvec4(floatBitsToUint(flux), pack_direction(to_light));
        photons[texel + 2u] = uvec4(pack_direction(vertex.geometric_normal), push.depth, specular, floatBitsToUint(cosine));
        atomicAdd(bucket_counts[bucket], 1u);
    }
}
