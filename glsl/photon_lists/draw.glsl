// Set 0 and push constants of the programs that draw the scene into the square of one view; the views' squares lie below one another.
#ifndef PHOTON_LISTS_DRAW
#define PHOTON_LISTS_DRAW

#include "groups/photon_lists.glsl"
#include "geometry/normals.glsl"
#include "photon_lists/view.glsl"

layout(push_constant, scalar) uniform DrawnListView {
    uint view_index;
    uint view_count;
    uint resolution;
    uint capacity;  // nodes
} push;

float linear_depth(vec3 position_rs) {
    return dot(texelFetch(list_views, 8 * int(push.view_index) + 3), vec4(position_rs, 1.0));
}

vec4 clip_position(vec3 position_rs) {
    ListView view = load_list_view(list_views, push.view_index);
    vec4 position = vec4(position_rs, 1.0);
    float w = dot(view.row_w, position);
    float scale = 2.0 / float(push.resolution);
    float reversed = view.near > 0.0 ? view.near : 1.0 - dot(view.row_depth, position) / view.far;
    return vec4(scale * dot(view.row_x, position) - w, scale * dot(view.row_y, position) - w, reversed, w);
}

// The triangle's own normal, which points out of the front as its winding has it.
vec3 front_normal(Instance instance, uint first_vertex) {
    float outside = (instance.flags & INSTANCE_FLIPPED) != 0u ? -1.0 : 1.0;
    return outside * normalize_or(face_normal(instance, first_vertex), vec3(0.0, 0.0, 1.0));
}

// Whether this view sees a surface at least half as well as the best does. Seen edge-on, it covers texels by chance and has no plane there.
bool is_kept(vec3 normal) {
    float best = 0.0;
    for (uint view = 0u; view < push.view_count; ++view) {
        best = max(best, abs(dot(normal, texelFetch(list_views, 8 * int(view) + 5).xyz)));
    }
    return abs(dot(normal, texelFetch(list_views, 8 * int(push.view_index) + 5).xyz)) >= 0.5 * best;
}

#endif
