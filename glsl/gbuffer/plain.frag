#version 460
#include "lib/prelude.glsl"
#include "groups/geometry.glsl"
#include "geometry/normals.glsl"
#include "gbuffer/targets.glsl"

// One fragment of a primitive without textures: its normals, and its scattering lobes from the material's factors
// (glTF 2.0 appendix B, see lib/brdf.glsl).

layout(location = 0) in vec3 vertex_normal;
layout(location = 1) in vec4 vertex_color;
layout(location = 2) flat in uvec2 drawn;  // geometry/vertex.glsl
layout(location = 5) flat in vec4 corner_color;

void main() {
    Instance instance = load_instance(instances, drawn.x);
    Material material = load_material(drawn_materials, instance.material);
    MaterialPoint point = material_factors(material, color_of_fragment(instance, vertex_color, corner_color));
    Lobes lobes = lobes_of_material(material, point);

    Normals normals = fragment_normals(instance, vertex_normal, drawn.y, gl_FrontFacing);
    bool front = gl_FrontFacing != ((instance.flags & INSTANCE_FLIPPED) != 0u);

    surface = pack_surface(towards_viewer(normals.vertex, normals), normals.geometric, lobes);
    specular = pack_specular(lobes);
    emission = vec4(emitted_radiance(material, point, front), 1.0);
}
