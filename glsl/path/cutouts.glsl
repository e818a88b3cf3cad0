// Surfaces cut out by their alpha, for kernels that trace rays: whether a hit is on what is left of the surface (glTF 2.0, alphaMode
// MASK). Bindings 16 to 22 of set 0.
#ifndef PATH_CUTOUTS
#define PATH_CUTOUTS

#include "lib/texels.glsl"
#include "lib/traced_scene.glsl"

// 1: some surface is cut out.
layout(constant_id = 15) const uint ALPHA_MASKS = 0u;
layout(constant_id = 16) const uint VERTEX_COLORS = 0u;

layout(set = 0, binding = 16) uniform usamplerBuffer triangles;
layout(set = 0, binding = 17) uniform samplerBuffer corner_colors;
layout(set = 0, binding = 18) uniform samplerBuffer corner_texcoords;
layout(set = 0, binding = 19) uniform usamplerBuffer materials;
layout(set = 0, binding = 20) uniform usamplerBuffer material_textures;
layout(set = 0, binding = 21) uniform usamplerBuffer texture_table;
layout(set = 0, binding = 22) uniform samplerBuffer texels;

#define BVH_ACCEPTS_HITS

bool accepts_hit(uint index, vec2 barycentric) {
    if (ALPHA_MASKS == 0u) {
        return true;
    }
    Triangle triangle = load_triangle(triangles, index);
    Material material = load_material(materials, triangle.material);
    vec3 weights = vec3(1.0 - barycentric.x - barycentric.y, barycentric);
    float alpha = material.base_color.a;
    if (VERTEX_COLORS != 0u) {
        alpha *= interpolated(corner_colors, triangle, weights).a;
    }
    if ((material.flags & MATERIAL_BASE_COLOR_TEXTURE) != 0u) {
        vec4 sets = interpolated(corner_texcoords, triangle, weights);
        TextureUse use = load_texture_use(material_textures, triangle.material, USE_BASE_COLOR);
        vec3 uv = vec3(use.texcoord == 0u ? sets.xy : sets.zw, 1.0);
        uvec4 entry = texelFetch(texture_table, int(use.layer));
        alpha *= sample_level(texels, entry, 0, vec2(dot(use.u_row, uv), dot(use.v_row, uv))).a;
    }
    return alpha >= material.alpha_cutoff;
}

#endif
