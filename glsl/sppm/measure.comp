#version 460
#include "lib/prelude.glsl"
#include "groups/paths.glsl"
#include "groups/scene_rays.glsl"
#include "lib/sobol.glsl"
#include "path/queue.glsl"
#include "path/state.glsl"
#include "path/vertex.glsl"
#include "sppm/photon.glsl"

// Leaves the measurement point of a camera's path: the first vertex at which the diffuse lobe is drawn. The choice is that of
// path/scatter.comp, which runs after this kernel on the same vertex with the same number.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) buffer PointBlock { uvec4 points[]; };
layout(set = 0, binding = 1) buffer QueueBlock { uint point_queue[]; };

layout(push_constant, scalar) uniform Push {
    uint depth;  // vertices before this one
    uint reserved;
} push;

bool measure(uint path) {
    if ((texelFetch(path_flags, int(path)).x & FLAG_ALL_SPECULAR) == 0u) {
        return false;
    }
    Vertex vertex = load_vertex(path_vertices, path);
    vec3 to_viewer = -texelFetch(path_rays, 2 * int(path) + 1).xyz;
    vec3 viewer = local_viewer(frame_around(vertex.normal), to_viewer);
    float share = lobe_shares(vertex.matter, viewer.z).x;
    uvec2 seed = texelFetch(path_seeds, int(path)).xy;
    float choice = sobol_sample(sobol, seed.y, seed_of(seed.x, STREAM_SCATTER + 2u * push.depth)).x;
    if (choice >= share) {
        return false;
    }
    vec3 throughput = texelFetch(path_states, int(path)).rgb / share;
    if (SPECULAR_LOBES != 0u) {
        uvec4 last = texelFetch(path_vertices, VERTEX_TEXELS * int(path) + 4);
        throughput *= vec3(unpackHalf2x16(last.z), unpackHalf2x16(last.w).x);
    }
    uint first = uint(POINT_TEXELS) * path;
    points[first] = uvec4(floatBitsToUint(vertex.position_rs), pack_direction(vertex.geometric_normal));
    points[first + 1u] = uvec4(floatBitsToUint(throughput * vertex.matter.diffuse_albedo), pack_direction(vertex.normal));
    points[first + 2u] = uvec4(
        packUnorm2x16(vec2(max3(vertex.matter.f0), vertex.matter.f90)), pack_direction(to_viewer), push.depth, 0u);
    return true;
}

void main() {
    uint path = queued_path(alive_paths);
    bool wanted = path != NO_PATH && measure(path);
    APPEND_TO_QUEUE(point_queue, path, wanted)
}
