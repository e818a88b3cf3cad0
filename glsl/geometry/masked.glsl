// Where a surface cut out by its alpha is there (glTF 2.0, alphaMode MASK).
#include "groups/geometry.glsl"
#include "geometry/material_textures.glsl"

layout(location = 1) in float vertex_alpha;
layout(location = 2) flat in uint instance_index;
layout(location = 4) in vec4 texcoord_sets;

bool is_there(uint material_index) {
    Texcoords texcoords = texcoords_of_fragment(texcoord_sets);
    Material material = load_material(drawn_materials, material_index);
    MaterialPoint point = material_factors(material, vec4(1.0, 1.0, 1.0, vertex_alpha));
    apply_base_color_texture(point, material, material_index, texcoords);
    return point.base_color.a >= material.alpha_cutoff;
}
