#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "lib/hit_material.glsl"
#include "lightmaps/charts.glsl"

// Where one texel of the light maps lies: the point of its triangle with its weights, moved as the triangle is, and its normals, without normal maps.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer places;   // triangle and side, weights of corners 1 and 2, surface and side
layout(set = 0, binding = 1) uniform usamplerBuffer charts;   // lightmaps/charts.glsl
layout(set = 0, binding = 2) writeonly buffer Texels { uvec4 texels_out[]; };   // lightmaps/texels.glsl

layout(push_constant, scalar) uniform Push { uint texel_count; } push;

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.texel_count) {
        return;
    }
    uvec4 place = texelFetch(places, int(number));
    if (place.x == NO_TEXEL) {
        texels_out[2u * number] = uvec4(0u);
        texels_out[2u * number + 1u] = uvec4(0u, 0u, NO_TEXEL, place.w);
        return;
    }
    uint index = place.x & ~TEXEL_BACK;
    Triangle triangle = load_triangle(triangles, index);
    vec2 weights = uintBitsToFloat(place.yz);
    vec3 face = front_normal(triangle);
    vec3 position = point_of_triangle(triangle, weights, face);
    vec3 normal = face;
    if (!triangle.flat_normals) {
        vec3 mean = (1.0 - weights.x - weights.y) * unpack_direction(triangle.normals.x) + weights.x * unpack_direction(triangle.normals.y)
                    + weights.y * unpack_direction(triangle.normals.z);
        normal = normalize_or(mean, face);
        normal = dot(normal, face) < 0.0 ? -normal : normal;
    }
    float side = (place.x & TEXEL_BACK) != 0u ? -1.0 : 1.0;
    texels_out[2u * number] = uvec4(floatBitsToUint(position), pack_direction(side * normal));
    texels_out[2u * number + 1u] =
        uvec4(pack_direction(side * face), floatBitsToUint(load_chart(charts, index).texel), place.x, place.w);
}
