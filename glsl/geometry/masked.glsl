// Where a surface cut out by its alpha is there (glTF 2.0, alphaMode MASK).
#include "groups/geometry.glsl"
#include "geometry/interpolated.glsl"
#include "geometry/material_textures.glsl"

layout(location = 1) in vec4 vertex_color;
layout(location = 2) flat in uvec2 drawn;  // geometry/vertex.glsl
layout(location = 4) in vec4 texcoord_sets;
layout(location = 5) flat in vec4 corner_color;
layout(location = 6) flat in vec4 corner_texcoords;

bool is_there(Instance instance) {
    Texcoords texcoords = texcoords_of_fragment(texcoord_sets, corner_texcoords);
    Material material = load_material(drawn_materials, instance.material);
    MaterialPoint point = material_factors(material, color_of_fragment(instance, vertex_color, corner_color));
    apply_base_color_texture(point, material, instance.material, texcoords);
    return point.base_color.a >= material.alpha_cutoff;
}
