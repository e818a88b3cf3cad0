#version 460
#include "lib/prelude.glsl"
#include "groups/geometry.glsl"
#include "geometry/material_textures.glsl"
#include "geometry/normal_map.glsl"
#include "gbuffer/targets.glsl"

// One fragment of a textured primitive: its normals with the normal map's on top, and its scattering lobes from the material's factors
// times its textures (glTF 2.0 appendix B, see lib/brdf.glsl).

// 1: a fragment whose alpha is below the material's cutoff is a hole.
layout(constant_id = 1) const uint ALPHA_MASK = 0u;

layout(location = 0) in vec3 vertex_normal;
layout(location = 1) in vec4 vertex_color;
layout(location = 2) flat in uvec2 drawn;  // geometry/vertex.glsl
layout(location = 3) in vec4 vertex_tangent;
layout(location = 4) in vec4 texcoord_sets;
layout(location = 5) flat in vec4 corner_color;
layout(location = 6) flat in vec4 corner_texcoords;

void main() {
    Texcoords texcoords = texcoords_of_fragment(texcoord_sets, corner_texcoords);
    Instance instance = load_instance(instances, drawn.x);
    Material material = load_material(drawn_materials, instance.material);
    MaterialPoint point = material_factors(material, color_of_fragment(instance, vertex_color, corner_color));
    apply_base_color_texture(point, material, instance.material, texcoords);
    if (ALPHA_MASK != 0u && point.base_color.a < material.alpha_cutoff) {
        discard;
    }
    apply_lobe_textures(point, material, instance.material, texcoords);
    apply_emissive_texture(point, material, instance.material, texcoords);
    Lobes lobes = lobes_of_material(material, point);

    Normals normals = fragment_normals(instance, vertex_normal, drawn.y, gl_FrontFacing);
    vec3 shading_normal = towards_viewer(mapped_normal(instance, material, normals, vertex_tangent, texcoords), normals);
    bool front = gl_FrontFacing != ((instance.flags & INSTANCE_FLIPPED) != 0u);

    surface = pack_surface(shading_normal, normals.geometric, lobes);
    specular = pack_specular(lobes);
    emission = vec4(emitted_radiance(material, point, front), 1.0);
}
