#version 460
#include "lib/prelude.glsl"
#include "groups/geometry.glsl"
#include "geometry/material_textures.glsl"

// One fragment of an alpha-masked primitive in a light view that holds depth alone: below the material's cutoff it is a hole.

layout(location = 0) in float vertex_alpha;
layout(location = 1) in vec4 texcoord_sets;
layout(location = 2) flat in uint material_index;

void main() {
    Texcoords texcoords = texcoords_of_fragment(texcoord_sets);
    Material material = load_material(drawn_materials, material_index);
    MaterialPoint point = material_factors(material, vec4(1.0, 1.0, 1.0, vertex_alpha));
    apply_base_color_texture(point, material, material_index, texcoords);
    if (point.base_color.a < material.alpha_cutoff) {
        discard;
    }
}
