#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/finite.glsl"
#include "hemicube/view.glsl"
#include "hemicube/weight.glsl"
#include "lightmaps/gathered.glsl"

// What one fragment of a view shows, L = (ρ/π)·E_AIM, W/(m²·sr): where the ray through its middle meets the triangle that was drawn there.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer received;  // the AIM
layout(set = 0, binding = 1) uniform usamplerBuffer list;     // texels to gather
layout(set = 0, binding = 2) uniform usamplerBuffer head;     // word 3: how many
layout(set = 0, binding = 3) uniform usampler2D seen;         // the atlas
layout(set = 0, binding = 4) writeonly buffer Light { vec4 light[]; };  // by view, row by row

layout(push_constant, scalar) uniform Push {
    uint first;       // place in the list of this batch's first view
    uint view_count;  // of the batch
    uint columns;     // tiles along the atlas
    uint side;        // fragments
    float plane;      // a
    uint first_of_map;  // element of the AIM
} push;

// Rasterisers move corners: a fragment's middle may lie beside the triangle that it shows, and stands for the point of it that is nearest then.
Hit hit_of(uint number, vec3 origin, vec3 direction) {
    Triangle triangle = load_triangle(triangles, number);
    vec3 across = cross(direction, triangle.edge2);
    vec3 way = origin - triangle.origin;
    vec2 weights = vec2(dot(way, across), dot(direction, cross(way, triangle.edge1))) / dot(triangle.edge1, across);
    weights = max(is_finite(weights) ? weights : vec2(1.0 / 3.0), vec2(0.0));
    weights /= max(weights.x + weights.y, 1.0);
    vec3 to_point = weights.x * triangle.edge1 + weights.y * triangle.edge2 - way;
    return Hit(dot(to_point, direction) / dot(direction, direction), weights, number);
}

void main() {
    uint fragments = push.side * push.side;
    uint number = gl_GlobalInvocationID.x / fragments;
    if (number >= push.view_count) {
        return;
    }
    vec3 radiance = vec3(0.0);
    uint fragment = gl_GlobalInvocationID.x % fragments;
    uvec2 place = uvec2(fragment % push.side, fragment / push.side);
    uvec2 tile = uvec2(number % push.columns, number / push.columns);
    uint triangle = texelFetch(seen, ivec2(tile * push.side + place), 0).x;
    if (triangle != NO_TRIANGLE && push.first + number < texelFetch(head, 3).x) {
        View view = view_of_texel(texelFetch(list, int(push.first + number)).x);
        vec3 direction = direction_through(view, middle_of_fragment(place, push.side, push.plane));
        if (dot(direction, view.face) > 0.0) {
            vec3 lobe;
            Cell cell;
            if (sends_light_back(hit_of(triangle, view.origin, direction), view.origin, direction, lobe, cell)) {
                radiance = lobe * light_of(cell, received, push.first_of_map);
            }
        }
    }
    light[gl_GlobalInvocationID.x] = vec4(radiance, 0.0);
}
