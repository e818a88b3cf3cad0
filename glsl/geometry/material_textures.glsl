// Set 1: the textures of a material, each a layer of the array bound for it. Programs that read but some of them still use
// this whole set, so that one descriptor set per material fits all.
#ifndef GEOMETRY_MATERIAL_TEXTURES
#define GEOMETRY_MATERIAL_TEXTURES

#include "groups/geometry.glsl"
#include "lib/brdf.glsl"

layout(set = 1, binding = 0) uniform sampler2DArray base_color_texture;
layout(set = 1, binding = 1) uniform sampler2DArray metallic_roughness_texture;
layout(set = 1, binding = 2) uniform sampler2DArray normal_texture;
layout(set = 1, binding = 3) uniform sampler2DArray emissive_texture;
layout(set = 1, binding = 4) uniform sampler2DArray specular_texture;
layout(set = 1, binding = 5) uniform sampler2DArray specular_color_texture;
layout(set = 1, binding = 6) uniform sampler2DArray transmission_texture;

// The bits of the texture kinds that any material drawn with this pipeline has: the kernel holds code for no others.
layout(constant_id = 0) const uint TEXTURES = MATERIAL_ALL_TEXTURES;

bool has_texture(Material material, uint kind) {
    return (material.flags & TEXTURES & kind) != 0u;
}

// Texture coordinates of a fragment, set 0 in xy, set 1 in zw, and their screen-space derivatives. These are taken from the
// interpolated vertex outputs, in uniform control flow: behind a load that depends on the material a helper invocation at a
// triangle's edge may see zeros (it does on lavapipe), and the fragment would sample the coarsest mip level. Coordinates that are no
// numbers (geometry/interpolated.glsl) become those of one corner.
struct Texcoords {
    vec4 sets;
    vec4 dx;
    vec4 dy;
};

Texcoords texcoords_of_fragment(vec4 interpolated, vec4 at_corner) {
    vec4 sets = is_finite(interpolated) ? interpolated : at_corner;
    return Texcoords(sets, dFdx(sets), dFdy(sets));
}

vec2 set_of(TextureUse use, vec4 sets) {
    return use.texcoord == 0u ? sets.xy : sets.zw;
}

vec4 sample_texture(sampler2DArray array, TextureUse use, Texcoords texcoords) {
    vec3 uv = vec3(set_of(use, texcoords.sets), 1.0);
    mat2 linear = transpose(mat2(use.u_row.xy, use.v_row.xy));
    vec2 dx = linear * set_of(use, texcoords.dx);
    vec2 dy = linear * set_of(use, texcoords.dy);
    return textureGrad(array, vec3(dot(use.u_row, uv), dot(use.v_row, uv), float(use.layer)), dx, dy);
}

// glTF 2.0: which channel of which texture scales which factor.
void apply_base_color_texture(inout MaterialPoint point, Material material, uint index, Texcoords texcoords) {
    if (has_texture(material, MATERIAL_BASE_COLOR_TEXTURE)) {
        point.base_color *= sample_texture(base_color_texture, load_texture_use(drawn_textures, index, USE_BASE_COLOR), texcoords);
    }
}

void apply_lobe_textures(inout MaterialPoint point, Material material, uint index, Texcoords texcoords) {
    if (has_texture(material, MATERIAL_METALLIC_ROUGHNESS_TEXTURE)) {
        vec4 texel = sample_texture(metallic_roughness_texture, load_texture_use(drawn_textures, index, USE_METALLIC_ROUGHNESS), texcoords);
        point.roughness *= texel.g;
        point.metallic *= texel.b;
    }
    if (has_texture(material, MATERIAL_SPECULAR_TEXTURE)) {
        point.specular *= sample_texture(specular_texture, load_texture_use(drawn_textures, index, USE_SPECULAR), texcoords).a;
    }
    if (has_texture(material, MATERIAL_SPECULAR_COLOR_TEXTURE)) {
        point.specular_color *= sample_texture(specular_color_texture, load_texture_use(drawn_textures, index, USE_SPECULAR_COLOR), texcoords).rgb;
    }
    if (has_texture(material, MATERIAL_TRANSMISSION_TEXTURE)) {
        point.transmission *= sample_texture(transmission_texture, load_texture_use(drawn_textures, index, USE_TRANSMISSION), texcoords).r;
    }
}

void apply_emissive_texture(inout MaterialPoint point, Material material, uint index, Texcoords texcoords) {
    if (has_texture(material, MATERIAL_EMISSIVE_TEXTURE)) {
        point.emissive *= sample_texture(emissive_texture, load_texture_use(drawn_textures, index, USE_EMISSIVE), texcoords).rgb;
    }
}

#endif
