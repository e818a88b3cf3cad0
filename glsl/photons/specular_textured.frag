#version 460
#include "lib/prelude.glsl"
#include "groups/geometry.glsl"
#include "geometry/normal_map.glsl"
#include "light_views/view.glsl"

// One texel of a light view on a textured primitive that has a specular lobe: the surface, and the flux that photons are drawn by
// (photons/specular_targets.glsl). Where a cut-out is a hole the view holds another depth, so that nothing of it comes here.

#include "photons/specular_targets.glsl"

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
    apply_lobe_textures(point, material, instance.material, texcoords);
    Normals normals = fragment_normals(instance, vertex_normal, drawn.y, gl_FrontFacing);
    vec3 normal = towards_viewer(mapped_normal(instance, material, normals, vertex_tangent, texcoords), normals);
    bool front = gl_FrontFacing != ((instance.flags & INSTANCE_FLIPPED) != 0u);
    write_specular_texel(instance.material, material, point, normal, normals.geometric, front);
}
