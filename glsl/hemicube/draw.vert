#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "groups/scene_rays.glsl"
#include "hemicube/view.glsl"

// One corner of a triangle as one view sees it, in that view's tile of the atlas. What would leave the tile is clipped.

layout(set = 0, binding = 0) uniform usamplerBuffer list;
layout(set = 0, binding = 1) uniform usamplerBuffer pairs;  // of each instance its view and its run of triangles

layout(push_constant, scalar) uniform Push {
    uint first;  // place in the list of this batch's first view
    uint run;    // triangles
    uint triangle_count;
    uvec2 tiles; // along the atlas' sides
    float plane; // a
} push;

layout(location = 0) flat out uint number;  // of the triangle
layout(location = 1) out vec2 place;        // weights of its corners 1 and 2

out float gl_ClipDistance[4];

void main() {
    uint pair = texelFetch(pairs, gl_InstanceIndex).x;
    uint view_number = pair >> 16;
    uint corner = uint(gl_VertexIndex) % 3u;
    uint leaf = (pair & 0xFFFFu) * push.run + uint(gl_VertexIndex) / 3u;
    bool is_there = leaf < push.triangle_count;
    View view = view_of_texel(texelFetch(list, int(push.first + view_number)).x);
    int texel = 3 * int(is_there ? leaf : 0u);
    vec3 way = texelFetch(bvh_triangles, texel + int(corner)).xyz - view.origin;
    vec3 local = to_local(view.axes, way);
    vec2 across = local.xy / push.plane;
    // The tile's middle, and half its size, in the atlas.
    vec2 half_size = 1.0 / vec2(push.tiles);
    vec2 middle = (2.0 * vec2(view_number % push.tiles.x, view_number / push.tiles.x) + 1.0) * half_size - 1.0;
    gl_Position = vec4(middle * local.z + half_size * across, view.near, local.z);
    gl_ClipDistance[0] = is_there ? local.z - across.x : -1.0;
    gl_ClipDistance[1] = is_there ? local.z + across.x : -1.0;
    gl_ClipDistance[2] = is_there ? local.z - across.y : -1.0;
    gl_ClipDistance[3] = is_there ? local.z + across.y : -1.0;
    number = floatBitsToUint(texelFetch(bvh_triangles, texel).w);
    place = vec2(corner == 1u ? 1.0 : 0.0, corner == 2u ? 1.0 : 0.0);
}
