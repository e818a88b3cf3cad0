// What a surface is made of where a ray meets it, textures included, and its normal of shading.
#ifndef LIB_HIT_MATERIAL
#define LIB_HIT_MATERIAL

#include "groups/scene_rays.glsl"
#include "lib/brdf.glsl"
#include "lib/octahedral.glsl"
#include "lib/texels.glsl"
#include "lib/traced_scene.glsl"

// How texture coordinates change to the next pixel; 0: textures are read at their finest.
struct Footprint {
    vec4 dx;
    vec4 dy;
};

vec2 set_of(uint texcoord, vec4 sets) {
    return texcoord == 0u ? sets.xy : sets.zw;
}

// Texture use.layer of the material at texture coordinates `sets`.
vec4 sample_use(uint material, uint use_number, vec4 sets, Footprint footprint) {
    TextureUse use = load_texture_use(material_textures, material, use_number);
    vec3 uv = vec3(set_of(use.texcoord, sets), 1.0);
    mat2 linear = transpose(mat2(use.u_row.xy, use.v_row.xy));
    vec2 dx = linear * set_of(use.texcoord, footprint.dx);
    vec2 dy = linear * set_of(use.texcoord, footprint.dy);
    return sample_texels(texels, texture_table, use.layer, vec2(dot(use.u_row, uv), dot(use.v_row, uv)), dx, dy);
}

bool has_texture(Material material, uint kind) {
    return (material.flags & TEXTURES & kind) != 0u;
}

// The textures of a material at a point, one after the other through one piece of code: kernels stay small.
void apply_textures(inout MaterialPoint point, inout vec3 normal_texel, Material material, uint index, vec4 sets, Footprint footprint) {
    [[dont_unroll]] for (uint use = 0u; use < 7u; ++use) {
        if (!has_texture(material, MATERIAL_BASE_COLOR_TEXTURE << use)) {
            continue;
        }
        vec4 texel = sample_use(index, use, sets, footprint);
        if (use == USE_BASE_COLOR) {
            point.base_color *= texel;
        } else if (use == USE_METALLIC_ROUGHNESS) {
            point.roughness *= texel.g;
            point.metallic *= texel.b;
        } else if (use == USE_NORMAL) {
            normal_texel = texel.xyz * 2.0 - 1.0;
        } else if (use == USE_EMISSIVE) {
            point.emissive *= texel.rgb;
        } else if (use == USE_SPECULAR) {
            point.specular *= texel.a;
        } else if (use == USE_SPECULAR_COLOR) {
            point.specular_color *= texel.rgb;
        } else {
            point.transmission *= texel.r;
        }
    }
}

// The normal of shading on the side of `geometric_normal`. `face`: front_normal().
vec3 mapped_normal(Triangle triangle, Material material, vec3 weights, vec3 face, vec3 geometric_normal, vec3 normal_texel) {
    vec3 normal = geometric_normal;
    if (!triangle.flat_normals) {
        vec3 vertex_normal = normalize_or(
            weights.x * unpack_direction(triangle.normals.x) + weights.y * unpack_direction(triangle.normals.y)
                + weights.z * unpack_direction(triangle.normals.z), face);
        vec3 mapped = vertex_normal;
        if (NORMAL_MAPS != 0u && has_texture(material, MATERIAL_NORMAL_TEXTURE)) {
            vec4 tangent = interpolated(corner_tangents, triangle, weights);
            vec3 unit_tangent = normalize_or(tangent.xyz, vec3(0.0));
            vec3 bitangent = cross(vertex_normal, unit_tangent) * tangent.w;
            vec2 slope = normal_texel.xy * material.normal_scale;
            mapped = normalize_or(slope.x * unit_tangent + slope.y * bitangent + normal_texel.z * vertex_normal, vertex_normal);
        }
        normal = dot(vertex_normal, geometric_normal) < 0.0 ? -mapped : mapped;
    }
    return normal;
}

#endif
