#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "lib/texels.glsl"
#include "lib/traced_scene.glsl"
#include "photons/landing.glsl"

// What one photon met, where the scene was its triangles: the material with its textures at the finest level, and the interpolated or
// mapped normal (photons/landing.glsl).

layout(local_size_x = 64) in;

// Texture `kind` of the material at the texture coordinates of both sets; white where it has none.
vec4 texture_of(Material material, uint index, uint kind, vec4 sets) {
    if ((material.flags & TEXTURES & (MATERIAL_BASE_COLOR_TEXTURE << kind)) == 0u) {
        return vec4(1.0);
    }
    TextureUse use = load_texture_use(material_textures, index, kind);
    vec3 uv = vec3(use.texcoord == 0u ? sets.xy : sets.zw, 1.0);
    uvec4 entry = texelFetch(texture_table, int(use.layer));
    return sample_level(texels, entry, 0, vec2(dot(use.u_row, uv), dot(use.v_row, uv)));
}

// All textures but the emissive one, one after the other through one piece of code: kernels stay small.
void apply_textures(inout MaterialPoint point, inout vec3 normal_texel, Material material, uint index, vec4 sets) {
    [[dont_unroll]] for (uint use = 0u; use < 7u; ++use) {
        vec4 texel = texture_of(material, index, use, sets);
        if (use == USE_BASE_COLOR) {
            point.base_color *= texel;
        } else if (use == USE_METALLIC_ROUGHNESS) {
            point.roughness *= texel.g;
            point.metallic *= texel.b;
        } else if (use == USE_NORMAL) {
            bool mapped = (material.flags & TEXTURES & MATERIAL_NORMAL_TEXTURE) != 0u;
            normal_texel = mapped ? texel.xyz * 2.0 - 1.0 : normal_texel;
        } else if (use == USE_SPECULAR) {
            point.specular *= texel.a;
        } else if (use == USE_SPECULAR_COLOR) {
            point.specular_color *= texel.rgb;
        } else if (use == USE_TRANSMISSION) {
            point.transmission *= texel.r;
        }
    }
}

// The weights of corners 0, 1 and 2 at a point of the triangle's plane.
vec3 weights_at(Triangle triangle, vec3 position) {
    vec3 normal = cross(triangle.edge1, triangle.edge2);
    vec3 from_corner = position - triangle.origin;
    float inverse = 1.0 / max(dot(normal, normal), 1e-37);
    vec2 weights = vec2(dot(cross(from_corner, triangle.edge2), normal), dot(cross(triangle.edge1, from_corner), normal)) * inverse;
    weights = clamp(weights, 0.0, 1.0);
    return vec3(max(1.0 - weights.x - weights.y, 0.0), weights);
}

vec3 shading_normal_at(Triangle triangle, Material material, vec3 weights, vec3 normal_texel, vec3 geometric) {
    vec3 vertex_normal = normalize_or(
        weights.x * unpack_direction(triangle.normals.x) + weights.y * unpack_direction(triangle.normals.y)
            + weights.z * unpack_direction(triangle.normals.z), front_normal(triangle));
    vec3 mapped = vertex_normal;
    if (NORMAL_MAPS != 0u && (material.flags & TEXTURES & MATERIAL_NORMAL_TEXTURE) != 0u) {
        vec4 tangent = interpolated(corner_tangents, triangle, weights);
        vec3 unit_tangent = normalize_or(tangent.xyz, vec3(0.0));
        vec3 bitangent = cross(vertex_normal, unit_tangent) * tangent.w;
        vec2 slope = normal_texel.xy * material.normal_scale;
        mapped = normalize_or(slope.x * unit_tangent + slope.y * bitangent + normal_texel.z * vertex_normal, vertex_normal);
    }
    return dot(vertex_normal, geometric) < 0.0 ? -mapped : mapped;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    uvec4 hit = uvec4(HIT_NONE);
    if (index < counts[push.stage * STAGE_WORDS + COUNT_WORD]) {
        hit = texelFetch(hits, int(index));
    }
    bool met = hit.x != HIT_NONE;
    hit = met ? hit : uvec4(0u);
    Landing landing = arrive(met ? index : 0u, hit);
    Material material = landing.material;
    Triangle triangle = load_triangle(triangles, hit.w);
    vec3 weights = weights_at(triangle, landing.photon.origin_rs + push.shift);
    vec4 color = VERTEX_COLORS != 0u ? interpolated(corner_colors, triangle, weights) : vec4(1.0);
    MaterialPoint point = material_factors(material, color);
    vec3 normal_texel = vec3(0.0, 0.0, 1.0);
    if ((material.flags & TEXTURES & ~MATERIAL_EMISSIVE_TEXTURE) != 0u && (TEXTURES & MATERIAL_ALL_TEXTURES) != 0u) {
        vec4 sets = interpolated(corner_texcoords, triangle, weights);
        apply_textures(point, normal_texel, material, hit.z, sets);
    }
    if (push.goes_on != 0u && !triangle.flat_normals) {
        landing.shading_normal = shading_normal_at(triangle, material, weights, normal_texel, landing.normal);
    }
    land(met, landing, point);
}
