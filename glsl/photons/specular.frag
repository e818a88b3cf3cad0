#version 460
#include "lib/prelude.glsl"
#include "groups/geometry.glsl"
#include "geometry/normals.glsl"
#include "light_views/view.glsl"

// One texel of a light view on a primitive without textures that has a specular lobe: the surface, and the flux that photons are drawn by
// (photons/specular_targets.glsl; the mask of Quyen 2014, section 3.3.1.1, in watts instead of ones).

#include "photons/specular_targets.glsl"

layout(location = 0) in vec3 vertex_normal;
layout(location = 1) in vec4 vertex_color;
layout(location = 2) flat in uvec2 drawn;  // geometry/vertex.glsl
layout(location = 5) flat in vec4 corner_color;

void main() {
    Instance instance = load_instance(instances, drawn.x);
    Material material = load_material(drawn_materials, instance.material);
    MaterialPoint point = material_factors(material, color_of_fragment(instance, vertex_color, corner_color));
    Normals normals = fragment_normals(instance, vertex_normal, drawn.y, gl_FrontFacing);
    bool front = gl_FrontFacing != ((instance.flags & INSTANCE_FLIPPED) != 0u);
    write_specular_texel(instance.material, material, point, towards_viewer(normals.vertex, normals), normals.geometric, front);
}
