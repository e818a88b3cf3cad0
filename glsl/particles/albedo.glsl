// What a surface is made of at a point, textures included, and what its diffuse lobe reflects of light from anywhere.
#ifndef PARTICLES_ALBEDO
#define PARTICLES_ALBEDO

#include "groups/scene_rays.glsl"
#include "lib/brdf.glsl"
#include "lib/texels.glsl"
#include "lib/traced_scene.glsl"

vec4 texel_of(uint material, uint use_number, vec4 sets) {
    TextureUse use = load_texture_use(material_textures, material, use_number);
    vec3 uv = vec3(use.texcoord == 0u ? sets.xy : sets.zw, 1.0);
    return sample_texels(texels, texture_table, use.layer, vec2(dot(use.u_row, uv), dot(use.v_row, uv)), vec2(0.0), vec2(0.0));
}

MaterialPoint textured_point(Triangle triangle, Material material, vec2 place) {
    vec3 weights = vec3(1.0 - place.x - place.y, place);
    vec4 color = VERTEX_COLORS != 0u ? interpolated(corner_colors, triangle, weights) : vec4(1.0);
    MaterialPoint point = material_factors(material, color);
    uint kinds = MATERIAL_BASE_COLOR_TEXTURE | MATERIAL_METALLIC_ROUGHNESS_TEXTURE | MATERIAL_TRANSMISSION_TEXTURE;
    if ((material.flags & TEXTURES & kinds) != 0u) {
        vec4 sets = interpolated(corner_texcoords, triangle, weights);
        if ((material.flags & MATERIAL_BASE_COLOR_TEXTURE) != 0u) {
            point.base_color *= texel_of(triangle.material, USE_BASE_COLOR, sets);
        }
        if ((material.flags & MATERIAL_METALLIC_ROUGHNESS_TEXTURE) != 0u) {
            vec4 texel = texel_of(triangle.material, USE_METALLIC_ROUGHNESS, sets);
            point.roughness *= texel.g;
            point.metallic *= texel.b;
        }
        if ((material.flags & MATERIAL_TRANSMISSION_TEXTURE) != 0u) {
            point.transmission *= texel_of(triangle.material, USE_TRANSMISSION, sets).r;
        }
    }
    return point;
}

// Particles stand on such surfaces.
bool has_diffuse_lobe(Material material) {
    return max3(lobes_of_material(material, material_factors(material, vec4(1.0))).diffuse_albedo) > 0.0;
}

// Specular lobes from this roughness on are no targets of photons (is_glossy() of src/scene/facts.rs).
const float BROAD_ROUGHNESS = 0.5;

// What a broad specular lobe reflects of light from anywhere: of F = f0 + (f90 − f0)(1 − v·h)⁵ the means over both directions, cosine-weighted,
//
//   ⟨D V⟩ ≈ 1/(1 + α(0.232 + 1.213 α))        ⟨D V (1 − v·h)⁵⟩ ≈ 0.0028 α^−1.37        (fitted to sums over visible normals, within 0.003 for α >= 0.25)
vec3 broad_albedo_at(Triangle triangle, Material material, vec2 place) {
    if (material.roughness < BROAD_ROUGHNESS || (material.flags & MATERIAL_METALLIC_ROUGHNESS_TEXTURE) != 0u) {
        return vec3(0.0);
    }
    Lobes lobes = lobes_of_material(material, textured_point(triangle, material, place));
    float alpha = lobes.roughness * lobes.roughness;
    float even = 1.0 / (1.0 + alpha * (0.232 + 1.213 * alpha));
    float grazing = 0.0028 * pow(alpha, -1.37);
    return clamp(lobes.f0 * (even - grazing) + lobes.f90 * grazing, 0.0, 1.0);
}

vec3 diffuse_albedo_at(Triangle triangle, Material material, vec2 place) {
    Lobes lobes = lobes_of_material(material, textured_point(triangle, material, place));
    return clamp(indirect_diffuse_albedo(lobes.diffuse_albedo, lobes.f0, lobes.f90), 0.0, 1.0);
}

#endif
