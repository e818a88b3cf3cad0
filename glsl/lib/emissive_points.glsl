// The radiance of points of emissive triangles, before the cosine decides which side shows.
#ifndef LIB_EMISSIVE_POINTS
#define LIB_EMISSIVE_POINTS

#include "groups/scene_lights.glsl"
#include "groups/scene_rays.glsl"
#include "lib/coverage.glsl"
#include "lib/texels.glsl"
#include "lib/traced_scene.glsl"

// At a point that is there, as a hit is. `place`: the weights of corners 1 and 2.
vec3 emissive_radiance(Triangle triangle, Material material, vec2 place) {
    if (EMISSIVE_TEXTURES == 0u || (material.flags & MATERIAL_EMISSIVE_TEXTURE) == 0u) {
        return material.emissive;
    }
    vec4 sets = interpolated(corner_texcoords, triangle, vec3(1.0 - place.x - place.y, place));
    TextureUse use = load_texture_use(material_textures, triangle.material, USE_EMISSIVE);
    vec3 uv = vec3(use.texcoord == 0u ? sets.xy : sets.zw, 1.0);
    vec2 texcoord = vec2(dot(use.u_row, uv), dot(use.v_row, uv));
    return material.emissive * sample_texels(texels, texture_table, use.layer, texcoord, vec2(0.0), vec2(0.0)).rgb;
}

// At any point: what alpha cuts away emits nothing.
vec3 covered_radiance(Triangle triangle, Material material, vec2 place) {
    if (EMISSIVE_CUTOUTS != 0u && ALPHA_MASKS != 0u && material.alpha_cutoff >= 0.0 && !is_covered(triangle, material, place)) {
        return vec3(0.0);
    }
    return emissive_radiance(triangle, material, place);
}

#endif
