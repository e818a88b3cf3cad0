#version 460
#include "lib/prelude.glsl"
#include "groups/light_views.glsl"
#include "caches/across_plane.glsl"
#include "caches/slots.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/lights.glsl"
#include "lib/sobol.glsl"
#include "lib/vpl.glsl"

// One invocation makes one virtual area light of a block of light-view texels (Reich 2015, section 4.3.1): flux Φ is summed over all of them, so that none is lost; position
// and normal are means by flux. The mean position is moved along the normal of the lit texel nearest to it onto that texel's plane, or onto the texel itself if it would end up
// farther away than that is large: on a flat surface it stays where it is, and where a block holds surfaces on both sides of an edge, it neither floats before the edge nor sinks
// behind it.
//
// Lights that are drawn anew in each frame lie in one of the block's texels, drawn by flux.
//
// Its area is what its lit texels see of their surfaces, m² (disc: the irradiance is Φ/π · cos cos / (d² + A/π), lib/vpl.glsl), or the same as the light sees it,
// A cosθ, which is A_near z²/(z_near² M) (4.5); the paper adds all of it to d² (4.4). Either way the second number that is stored is what is added to d².

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint PAPER = 0u;

layout(set = 0, binding = 0) readonly buffer SlotViewBlock { SlotView slot_views[]; };
layout(set = 0, binding = 1) writeonly buffer SlotBlock { vec4 slots[]; };
layout(set = 0, binding = 2) buffer DroppedBlock { uint dropped_texels[]; };

layout(push_constant, scalar) uniform Push {
    uint slot_count;
    uint view_count;
    int side;
    uint drawn;  // 0: mean positions; else places are drawn, by this number
} push;

// A texel that its surface lies askew to is longer than the root of its area.
const float TEXELS_AWAY = 2.0;

uint place_of_slot(uint slot) {
    uint low = 0u;
    uint high = push.view_count;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (slot_views[middle].first <= slot) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

vec3 position_at(LightView view, ivec2 texel) {
    float depth = texelFetch(light_depth, texel, 0).x;
    return position_of_texel(view, tangent_of_texel(view, vec2(texel) + 0.5), max(depth, 1e-30));
}

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= push.slot_count) {
        return;
    }
    SlotView place = slot_views[place_of_slot(slot)];
    LightView view = load_view(views, place.view);
    ivec2 first = push.side * block_of_slot(slot - place.first);
    ivec2 end = view.rect_origin + min(first + push.side, view.rect_size);
    first += view.rect_origin;

    vec3 flux = vec3(0.0);
    float weights = 0.0;
    float area = 0.0;
    vec3 base = vec3(0.0);  // of the positions: the first lit one
    vec3 way = vec3(0.0);
    vec3 normals = vec3(0.0);
    uint dropped = 0u;
    for (int y = first.y; y < end.y; ++y) {
        // Row by row: many equal numbers in one sum would all be rounded the same way.
        vec3 row = vec3(0.0);
        for (int x = first.x; x < end.x; ++x) {
            ivec2 texel = ivec2(x, y);
            vec3 texel_flux = texelFetch(light_flux, texel, 0).rgb;
            float depth = texelFetch(light_depth, texel, 0).x;
            bool sound = is_finite(texel_flux);
            dropped += sound ? 0u : 1u;
            float weight = sound && depth > 0.0 ? luminance(texel_flux) : 0.0;
            if (weight > 0.0) {
                vec2 tangent = tangent_of_texel(view, vec2(texel) + 0.5);
                vec3 position_rs = position_of_texel(view, tangent, depth);
                vec3 normal = unpack_direction(texelFetch(light_normal, texel, 0).x);
                float seen = area_of_texel(view, tangent, depth, normal);
                vec3 ray = ray_of_tangent(view, tangent);
                area += PAPER != 0u ? PI * seen * abs(dot(normal, ray)) : seen;
                base = weights == 0.0 ? position_rs : base;
                row += texel_flux;
                weights += weight;
                way += weight * (position_rs - base);
                normals += weight * normal;
            }
        }
        flux += row;
    }
    if (dropped > 0u) {
        atomicAdd(dropped_texels[0], dropped);
    }
    vec3 mean = base + way / max(weights, 1e-37);
    ivec2 nearest = first;
    // By flux, evenly over numbers that follow each other.
    float drawn = fract(float(mix_bits(slot) >> 8) / 16777216.0 + 0.6180339887 * float(push.drawn & 0xFFFFu)) * weights;
    float passed = 0.0;
    float least = 3e38;
    for (int y = first.y; y < end.y && weights > 0.0; ++y) {
        for (int x = first.x; x < end.x; ++x) {
            ivec2 texel = ivec2(x, y);
            vec3 texel_flux = texelFetch(light_flux, texel, 0).rgb;
            float weight = is_finite(texel_flux) ? luminance(texel_flux) : 0.0;
            vec3 off = position_at(view, texel) - mean;
            if (weight > 0.0 && push.drawn == 0u && dot(off, off) < least) {
                least = dot(off, off);
                nearest = texel;
            }
            if (weight > 0.0 && push.drawn != 0u && passed <= drawn) {
                nearest = texel;
            }
            passed += weight;
        }
    }
    vec3 normal = unpack_direction(texelFetch(light_normal, nearest, 0).x);
    vec3 at = position_at(view, nearest);
    vec2 tangent = tangent_of_texel(view, vec2(nearest) + 0.5);
    float size = area_of_texel(view, tangent, max(texelFetch(light_depth, nearest, 0).x, 1e-30), normal);
    vec3 position_rs = push.drawn != 0u ? at : at + across_plane(normal, mean - at, TEXELS_AWAY * sqrt(size));
    bool lit = weights > 0.0 && is_finite(position_rs) && is_finite(area);
    slots[2u * slot] = lit ? pack_vpl_position(position_rs, area) : vec4(0.0);
    slots[2u * slot + 1u] = lit ? pack_vpl_strength(flux * view.flux_scale, push.drawn != 0u ? normal : normalize_or(normals, normal)) : vec4(0.0);
}
