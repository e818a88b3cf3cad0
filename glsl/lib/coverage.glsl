// What alpha leaves of a surface (glTF 2.0, alphaMode MASK): whether there is anything at a point of a triangle.
#ifndef LIB_COVERAGE
#define LIB_COVERAGE

#include "groups/scene_rays.glsl"
#include "lib/texels.glsl"
#include "lib/traced_scene.glsl"

// Alpha comes from half floats: what equals the cutoff may have been rounded to less by so much of it.
const float ALPHA_ROUNDING = 1.0 - 1.0 / 2048.0;

// `place`: the weights of corners 1 and 2.
bool is_covered(Triangle triangle, Material material, vec2 place) {
    vec3 weights = vec3(1.0 - place.x - place.y, place);
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
    return alpha >= material.alpha_cutoff * ALPHA_ROUNDING;
}

#endif
