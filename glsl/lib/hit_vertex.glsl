// The surface that a ray met and what it is made of there, textures, normal maps and media included. The including file has the hierarchy (lib/bvh.glsl).
#ifndef LIB_HIT_VERTEX
#define LIB_HIT_VERTEX

#include "lib/hit_material.glsl"
#include "lib/lobes.glsl"

struct HitVertex {
    vec3 position;
    vec3 face;           // normals on the side that the ray came from
    vec3 normal;
    Matter matter;
    float roughness;
    vec3 emitted;        // towards where the ray came from, W/(m²·sr)
    vec3 transmittance;  // of what the ray crossed
    bool unlit;
};

// `triangle`: that of the hit.
HitVertex vertex_of_hit(Triangle triangle, Hit hit, vec3 origin, vec3 direction, Footprint footprint) {
    Material material = load_material(materials, triangle.material);
    vec3 weights = vec3(1.0 - hit.barycentric.x - hit.barycentric.y, hit.barycentric);
    vec3 face = front_normal(triangle);
    bool front = dot(face, direction) < 0.0;
    MaterialPoint point = material_factors(material, VERTEX_COLORS != 0u ? interpolated(corner_colors, triangle, weights) : vec4(1.0));
    vec3 normal_texel = vec3(0.0, 0.0, 1.0);
    if ((material.flags & TEXTURES & MATERIAL_ALL_TEXTURES) != 0u) {
        vec4 sets = interpolated(corner_texcoords, triangle, weights);
        apply_textures(point, normal_texel, material, triangle.material, sets, footprint);
    }
    HitVertex vertex;
    vertex.transmittance = vec3(1.0);
    if (TRANSMISSIVE != 0u && !front) {
        vec4 medium = texelFetch(media, int(triangle.material));
        vertex.transmittance = exp(-medium.xyz * (medium.w * hit.distance));
    }
    vertex.unlit = (material.flags & MATERIAL_UNLIT) != 0u;
    vertex.emitted = emitted_radiance(material, point, front);
    Lobes lobes = lobes_of_material(material, point);
    vec3 transmission = clamp(point.base_color.rgb * ((1.0 - point.metallic) * point.transmission), 0.0, 1.0);
    float relative_ior = 1.0;
    if (TRANSMISSIVE != 0u && max3(transmission) > 0.0 && texelFetch(media, int(triangle.material)).w > 0.0) {
        relative_ior = front ? material.ior : 1.0 / material.ior;
    }
    vertex.matter = Matter(
        clamp(lobes.diffuse_albedo, 0.0, 1.0), clamp(lobes.f0, 0.0, 1.0), lobes.f90, max(lobes.roughness * lobes.roughness, MINIMUM_ALPHA),
        transmission, relative_ior);
    vertex.roughness = lobes.roughness;
    vertex.face = front ? face : -face;
    vertex.position = point_of_hit(triangle, hit.barycentric, face, origin, hit.distance * direction);
    vertex.normal = mapped_normal(triangle, material, weights, face, vertex.face, normal_texel);
    return vertex;
}

#endif
