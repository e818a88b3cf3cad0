#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "bounces/samples.glsl"
#include "lib/hit_material.glsl"

// What one sample of the surfaces reflects of light from all around: indirect_diffuse_albedo(), textures averaged over about the square that the sample stands for; and its
// area, m².

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer samples;
layout(set = 0, binding = 1) writeonly buffer MatterBlock { vec4 matter[]; };

layout(push_constant, scalar) uniform Push { uint slot_count; } push;

// From the weights of corners 1 and 2, a square's side along their edges.
Footprint footprint_of(Triangle triangle, float side) {
    vec4 base = texelFetch(corner_texcoords, triangle.first_corner);
    vec4 along1 = texelFetch(corner_texcoords, triangle.first_corner + 1) - base;
    vec4 along2 = texelFetch(corner_texcoords, triangle.first_corner + 2) - base;
    return Footprint(
        along1 * (side / max(length(triangle.edge1), 1e-30)), along2 * (side / max(length(triangle.edge2), 1e-30)));
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.slot_count) {
        return;
    }
    SurfaceSample point = load_sample(samples, index);
    vec3 albedo = vec3(0.0);
    if (point.area > 0.0) {
        Triangle triangle = load_triangle(triangles, point.triangle);
        Material material = load_material(materials, triangle.material);
        vec3 weights = vec3(1.0 - point.place.x - point.place.y, point.place);
        vec4 color = VERTEX_COLORS != 0u ? interpolated(corner_colors, triangle, weights) : vec4(1.0);
        MaterialPoint made = material_factors(material, color);
        if (TEXTURES != 0u && (material.flags & TEXTURES) != 0u) {
            vec3 normal_texel;
            vec4 sets = interpolated(corner_texcoords, triangle, weights);
            apply_textures(made, normal_texel, material, triangle.material, sets, footprint_of(triangle, sqrt(point.area)));
        }
        Lobes lobes = lobes_of_material(material, made);
        albedo = clamp(indirect_diffuse_albedo(lobes.diffuse_albedo, lobes.f0, lobes.f90), 0.0, 1.0);
    }
    matter[index] = vec4(albedo, point.area);
}
