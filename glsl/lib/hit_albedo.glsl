// What of diffuse irradiance the diffuse lobe of a surface that a ray met sends back, textures included. The including file has the hierarchy (lib/bvh.glsl).
#ifndef LIB_HIT_ALBEDO
#define LIB_HIT_ALBEDO

#include "lib/hit_material.glsl"

// `triangle`: that of the hit.
vec3 albedo_of_hit(Triangle triangle, Hit hit) {
    Material material = load_material(materials, triangle.material);
    vec3 weights = vec3(1.0 - hit.barycentric.x - hit.barycentric.y, hit.barycentric);
    MaterialPoint point = material_factors(material, VERTEX_COLORS != 0u ? interpolated(corner_colors, triangle, weights) : vec4(1.0));
    Material matter = material;
    matter.flags &= ~(MATERIAL_NORMAL_TEXTURE | MATERIAL_EMISSIVE_TEXTURE);
    if ((matter.flags & TEXTURES & MATERIAL_ALL_TEXTURES) != 0u) {
        vec3 no_normal;
        vec4 sets = interpolated(corner_texcoords, triangle, weights);
        apply_textures(point, no_normal, matter, triangle.material, sets, Footprint(vec4(0.0), vec4(0.0)));
    }
    Lobes lobes = lobes_of_material(material, point);
    return clamp(indirect_diffuse_albedo(lobes.diffuse_albedo, lobes.f0, lobes.f90), 0.0, 1.0);
}

#endif
