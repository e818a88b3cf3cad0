#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "groups/vpl_visibility.glsl"
#include "lib/brdf.glsl"
#include "lib/sobol.glsl"
#include "lib/texels.glsl"
#include "lib/traced_scene.glsl"
#include "lib/vpl.glsl"
#include "lib/disc.glsl"
#include "vpl/paths.glsl"

// One invocation makes a VPL where a path met a surface (Keller 1997). With Φ the flux of the VPL that it left, which n paths leave of N
// in its bounce, and ρ = indirect_diffuse_albedo() there,
//
//   Φ' = Φ · N/n · ρ       A' = 5/D, at most the scene's π r²       D = n/N · Σ_i F_i(y)/π
//
// in W and m², F_i of lib/disc.glsl. ΣΦ' over a bounce is on average what the scene reflects of the bounce before.
//
// A VPL i sends n/N paths on average, cosine-distributed: per path they meet cos θ_i/π · cos θ_y/d² of the surface at y [1/m²], for a disc, from
// all over it, F_i/π. D is the sum over all VPLs that send light, taken over every k-th where they are many, and leaves out what hides them from y. So
// 1/D is the area that a VPL of this bounce stands for, and discs of just that area have the radiosity ρ Σ_i Φ_i F_i/π that gathering the
// bounce before gives there, without visibility, if all Φ_i are equal. Those made here overlap five times (OVERLAP): each has a fifth of it.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer hits;
layout(set = 0, binding = 1) buffer Vpls { vec4 vpls[]; };

layout(push_constant, scalar) uniform Push { Bounce bounce; } push;

// Parents that the density is taken over, at most; of more, every k-th.
const uint DENSITY_PARENTS = 256u;

vec4 sample_use(uint material, uint use_number, vec4 sets) {
    TextureUse use = load_texture_use(material_textures, material, use_number);
    vec3 uv = vec3(use.texcoord == 0u ? sets.xy : sets.zw, 1.0);
    uvec4 entry = texelFetch(texture_table, int(use.layer));
    return sample_level(texels, entry, 0, vec2(dot(use.u_row, uv), dot(use.v_row, uv)));
}

// The textures that the diffuse lobe depends on, one after the other through one piece of code.
void apply_textures(inout MaterialPoint point, uint kinds, uint index, vec4 sets) {
    [[dont_unroll]] for (uint use = 0u; use < 7u; ++use) {
        if ((kinds & (MATERIAL_BASE_COLOR_TEXTURE << use)) == 0u) {
            continue;
        }
        vec4 texel = sample_use(index, use, sets);
        if (use == USE_BASE_COLOR) {
            point.base_color *= texel;
        } else if (use == USE_METALLIC_ROUGHNESS) {
            point.metallic *= texel.b;
        } else if (use == USE_SPECULAR) {
            point.specular *= texel.a;
        } else if (use == USE_SPECULAR_COLOR) {
            point.specular_color *= texel.rgb;
        } else if (use == USE_TRANSMISSION) {
            point.transmission *= texel.r;
        }
    }
}

vec3 albedo_at(Triangle triangle, vec3 weights) {
    Material material = load_material(materials, triangle.material);
    vec4 color = VERTEX_COLORS != 0u ? interpolated(corner_colors, triangle, weights) : vec4(1.0);
    MaterialPoint point = material_factors(material, color);
    uint kinds = material.flags & TEXTURES & ~(MATERIAL_NORMAL_TEXTURE | MATERIAL_EMISSIVE_TEXTURE);
    if (TEXTURES != 0u && kinds != 0u) {
        apply_textures(point, kinds, triangle.material, interpolated(corner_texcoords, triangle, weights));
    }
    Lobes lobes = lobes_of_material(material, point);
    return clamp(indirect_diffuse_albedo(lobes.diffuse_albedo, lobes.f0, lobes.f90), 0.0, 1.0);
}

// D, 1/m².
float density_of_paths(vec3 position_rs, vec3 normal) {
    uint step = (push.bounce.parent_count + DENSITY_PARENTS - 1u) / DENSITY_PARENTS;
    float sum = 0.0;
    uint seen = 0u;
    for (uint i = 0u; i < push.bounce.parent_count; i += step) {
        uint parent = push.bounce.parents + i;
        Vpl vpl = as_disc(unpack_vpl(vpls[2u * parent], vpls[2u * parent + 1u]));
        sum += max3(vpl.strength) > 0.0 ? disc_form_factor(vpl, position_rs, normal) : 0.0;
        ++seen;
    }
    return INVERSE_PI * sum * (float(push.bounce.child_count) / float(seen));
}

void main() {
    uint child = gl_GlobalInvocationID.x;
    if (child >= push.bounce.child_count) {
        return;
    }
    vec4 position = pack_vpl_position(vec3(0.0), 0.0);
    vec4 strength = pack_vpl_strength(vec3(0.0), vec3(0.0, 0.0, 1.0));
    vec4 hit = texelFetch(hits, int(child));
    uint index = floatBitsToUint(hit.w);
    if (index != 0xFFFFFFFFu) {
        uint parent = parent_of_path(push.bounce, child, sobol_sample(sobol, child, seed_of_bounce(push.bounce)).z);
        Vpl vpl = unpack_vpl(vpls[2u * parent], vpls[2u * parent + 1u]);
        vec3 flux = vpl.strength * (PI * length(vpl.normal) * float(push.bounce.parent_count) / float(push.bounce.child_count));
        Triangle triangle = load_triangle(triangles, index);
        vec3 face = front_normal(triangle);
        vec3 position_rs = point_of_triangle(triangle, hit.yz, face) - vpl_rays.shift;
        vec3 normal = dot(face, lifted_vpl(vpl) - position_rs) < 0.0 ? -face : face;
        float area = min(OVERLAP / max(density_of_paths(position_rs, normal), 1e-30), PI * vpl_rays.radius * vpl_rays.radius);
        position = pack_vpl_position(position_rs, area);
        strength = pack_vpl_strength(flux * albedo_at(triangle, vec3(1.0 - hit.y - hit.z, hit.yz)), normal);
    }
    uint first = 2u * (push.bounce.children + child);
    vpls[first] = position;
    vpls[first + 1u] = strength;
}
