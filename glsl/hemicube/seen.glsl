// Which runs of triangles a view may see. The including file has the hierarchy (lib/bvh.glsl).
#ifndef HEMICUBE_SEEN
#define HEMICUBE_SEEN

#include "hemicube/view.glsl"
#include "lightmaps/lookup.glsl"

layout(set = 0, binding = 0) uniform samplerBuffer boxes;   // hemicube/boxes.comp
layout(set = 0, binding = 1) uniform usamplerBuffer list;   // texels to gather
layout(set = 0, binding = 2) uniform usamplerBuffer head;   // word 3: how many

layout(push_constant, scalar) uniform Push {
    uint first;       // place in the list of this batch's first view
    uint view_count;  // of the batch
    uint run_count;
    uint run;         // triangles of each
    float plane;      // a
} push;

// Whether view `number` of the batch is one: of a texel that is to be gathered, and that lies in the open.
bool is_view(uint number) {
    uint place = push.first + number;
    return number < push.view_count && place < texelFetch(head, 3).x && is_valid(texelFetch(list, int(place)).x);
}

// How far the box reaches along a direction, m.
float reach(vec3 direction, vec3 way, vec3 half_size) {
    return dot(direction, way) + dot(abs(direction), half_size);
}

// Whether any of a run's box lies before the texel, and within the four sides of what it sees.
bool sees_run(View view, uint run) {
    vec3 way = texelFetch(boxes, 2 * int(run)).xyz - view.origin;
    vec3 half_size = texelFetch(boxes, 2 * int(run) + 1).xyz;
    vec3 normal = push.plane * view.axes.normal;
    return reach(view.axes.normal, way, half_size) >= view.near && reach(view.face, way, half_size) >= 0.0
           && reach(normal + view.axes.tangent, way, half_size) >= 0.0 && reach(normal - view.axes.tangent, way, half_size) >= 0.0
           && reach(normal + view.axes.bitangent, way, half_size) >= 0.0
           && reach(normal - view.axes.bitangent, way, half_size) >= 0.0;
}

#endif
