// Shading normals from normal maps.
#ifndef GEOMETRY_NORMAL_MAP
#define GEOMETRY_NORMAL_MAP

#include "geometry/material_textures.glsl"
#include "geometry/normals.glsl"

// The normal map's vector n' = t.x·T + t.y·B + t.z·N with B = w·(N×T) (glTF 2.0; MikkTSpace). A mirroring transform turns the
// cross product round, which the tangent's sign makes good. Without tangents there is no frame to read the map in.
vec3 mapped_normal(Instance instance, Material material, Normals normals, vec4 vertex_tangent, Texcoords texcoords) {
    if (!has_texture(material, MATERIAL_NORMAL_TEXTURE) || (instance.flags & INSTANCE_HAS_TANGENTS) == 0u) {
        return normals.vertex;
    }
    vec3 texel = sample_texture(normal_texture, load_texture_use(drawn_textures, instance.material, USE_NORMAL), texcoords).xyz * 2.0 - 1.0;
    texel.xy *= material.normal_scale;
    float mirror = (instance.flags & INSTANCE_FLIPPED) != 0u ? -1.0 : 1.0;
    vec3 tangent = normalize_or(transform_direction(instance, vertex_tangent.xyz), vec3(0.0));
    vec3 bitangent = cross(normals.vertex, tangent) * (vertex_tangent.w * mirror);
    return normalize_or(texel.x * tangent + texel.y * bitangent + texel.z * normals.vertex, normals.vertex);
}

#endif
