#version 460
#include "lib/prelude.glsl"
#include "lib/color.glsl"
#include "lib/vectors.glsl"
#include "lib/vpl.glsl"

// One invocation for each slot with which a group of lights begins makes these lights of their slots, as caches/reduce.comp makes slots of texels: flux and areas are sums, position
// and the normal a mean by flux; the position too where all slots lie in a plane, else that of the slot nearest to the mean, so that no light gets through a wall; and finds the sphere around them (caches/gather_groups.comp).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer slots;
layout(set = 0, binding = 1) uniform usamplerBuffer cuts;
layout(set = 0, binding = 2) uniform usamplerBuffer offsets;
layout(set = 0, binding = 3) writeonly buffer LightBlock { vec4 lights[]; };
layout(set = 0, binding = 4) writeonly buffer GroupBlock { uvec4 groups[]; };

layout(push_constant, scalar) uniform Push {
    uint slot_count;
    uint group_count;  // that there is room for
} push;

Vpl slot_light(uint slot) {
    return unpack_vpl(texelFetch(slots, int(2u * slot)), texelFetch(slots, int(2u * slot + 1u)));
}

// Slots lie in a plane if they are less high over it than this share of the root of their area.
const float FLAT = 0.02;

// The light of the slots from `first` to before `end`.
void merge(uint first, uint end, out vec4 texel, out vec4 strength) {
    vec3 flux = vec3(0.0);
    float weights = 0.0;
    float area = 0.0;
    vec3 base = vec3(0.0);
    vec3 way = vec3(0.0);
    vec3 normals = vec3(0.0);
    for (uint slot = first; slot < end; ++slot) {
        Vpl light = slot_light(slot);
        float size = length(light.normal);
        float weight = size * luminance(light.strength);
        if (weight > 0.0) {
            base = weights == 0.0 ? light.position_rs : base;
            flux += PI * size * light.strength;
            area += PI * light.area_over_pi;
            weights += weight;
            way += weight * (light.position_rs - base);
            normals += (weight / size) * light.normal;
        }
    }
    vec3 mean = base + way / max(weights, 1e-37);
    vec3 place = mean;
    vec3 plane = vec3(0.0, 0.0, 1.0);
    float least = 3e38;
    for (uint slot = first; slot < end; ++slot) {
        Vpl light = slot_light(slot);
        vec3 off = light.position_rs - mean;
        if (luminance(light.strength) > 0.0 && dot(off, off) < least) {
            least = dot(off, off);
            plane = normalize(light.normal);
            place = light.position_rs;
        }
    }
    float highest = 0.0;
    for (uint slot = first; slot < end; ++slot) {
        Vpl light = slot_light(slot);
        highest = luminance(light.strength) > 0.0 ? max(highest, abs(dot(plane, light.position_rs - place))) : highest;
    }
    bool flat_block = highest < FLAT * sqrt(area);
    texel = pack_vpl_position(flat_block ? mean + dot(plane, place - mean) * plane : place, area);
    strength = pack_vpl_strength(flux, normalize_or(normals, plane));
}

void main() {
    uint slot = gl_GlobalInvocationID.x;
    uint cut = slot < push.slot_count ? texelFetch(cuts, int(slot)).x : 0u;
    if ((cut & 2u) == 0u) {
        return;
    }
    uvec2 before = texelFetch(offsets, int(slot)).xy;
    if (before.y >= push.group_count) {
        return;
    }
    uint next = before.x;
    float weights = 0.0;
    vec3 base = vec3(0.0);
    vec3 way = vec3(0.0);
    float squares = 0.0;
    float farthest = 0.0;
    uint end = slot + (1u << (2u * (cut >> 8 & 15u)));
    [[dont_unroll]] for (uint at = slot; at < end;) {
        uint own = texelFetch(cuts, int(at)).x;
        uint size = 1u << (2u * (own >> 4 & 15u));
        if ((own & 1u) != 0u) {
            vec4 first = texelFetch(slots, int(2u * at));
            vec4 second = texelFetch(slots, int(2u * at + 1u));
            if (size > 1u) {
                merge(at, at + size, first, second);
            }
            lights[2u * next] = first;
            lights[2u * next + 1u] = second;
            ++next;
            float weight = luminance(second.rgb);
            base = weights == 0.0 ? first.xyz : base;
            vec3 off = first.xyz - base;
            weights += weight;
            way += weight * off;
            squares += weight * (dot(off, off) + 0.5 * first.w);
            farthest = max(farthest, length(off));
        }
        at += size;
    }
    vec3 mean = way / max(weights, 1e-37);
    float radius = 2.0 * sqrt(max(squares / max(weights, 1e-37) - dot(mean, mean), 0.0));
    uint count = next - before.x;
    groups[2u * before.y] = floatBitsToUint(vec4(base + mean, radius));
    groups[2u * before.y + 1u] = uvec4(before.x, count, floatBitsToUint(vec2(weights, farthest + length(mean))));
}
