// Surfaces cut out by their alpha, for kernels that trace rays: whether a hit is on what is left of the surface (glTF 2.0, alphaMode
// MASK).
#ifndef PATH_CUTOUTS
#define PATH_CUTOUTS

#include "groups/scene_rays.glsl"
#include "lib/texels.glsl"
#include "lib/traced_scene.glsl"

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
