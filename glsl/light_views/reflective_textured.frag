#version 460
#include "lib/prelude.glsl"
#include "groups/geometry.glsl"
#include "geometry/material_textures.glsl"
#include "geometry/normals.glsl"
#include "light_views/view.glsl"
#include "light_views/targets.glsl"

// One texel of a reflective light view, on a textured primitive: its normal and reflected flux in W (light_views/targets.glsl).

// 1: a fragment whose alpha is below the material's cutoff is a hole.
layout(constant_id = 1) const uint ALPHA_MASK = 0u;

layout(location = 0) in vec3 vertex_normal;
layout(location = 1) in vec4 vertex_color;
layout(location = 2) flat in uvec2 drawn;  // geometry/vertex.glsl
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
    Lobes lobes = lobes_of_material(material, point);
    vec3 normal = fragment_normals(instance, vertex_normal, drawn.y, gl_FrontFacing).geometric;

    LightView view = load_view(views, push.view_index);
    normal_target = pack_direction(normal);
    flux_target = reflected_flux(load_light(lights, view.light), view, gl_FragCoord, normal, lobes, point.transmission);
}
