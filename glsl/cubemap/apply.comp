#version 460
#include "lib/prelude.glsl"
#include "groups/surface.glsl"
#include "cubemap/cube.glsl"
#include "cubemap/objects.glsl"
#include "lib/directional_albedo.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"

// The slot `specular` of one pixel from the map of its object, W/(m²·sr):
//
//   L(x, v) = (f0·A + f90·B) · L_α'(p − c)
//
// A and B are the lobe's directional albedo for Fresnel terms of 1 and 0, and 0 and 1; L_α the map around the object's middle c as a lobe of α shows it (prefilter.comp). p
// is where the ray from x along the lobe's main direction leaves what the map shows: of its points x + t·r the first that lies behind the depth that the map holds
// for its direction (distance impostors: Szirmay-Kalos et al. 2005). As seen from c the lobe has the width α' = α·|p − x|/|p − c|. What comes through glass is looked up
// likewise, from where the line of sight leaves it. Where p is hidden from the middle of its object, the first map of another object counts that shows the ray's end.

layout(local_size_x = 64) in;

// 1: no earlier pass has written the image.
layout(constant_id = 1) const uint IS_FIRST = 0u;
// 1: some surface transmits.
layout(constant_id = 2) const uint HAS_GLASS = 0u;
// 1: pixels of other objects whose own maps know no answer.
layout(constant_id = 3) const uint TAKES_OTHERS = 0u;

layout(set = 0, binding = 0) uniform usampler2D owners;      // find.comp
layout(set = 0, binding = 1) uniform samplerBuffer boxes;
layout(set = 0, binding = 2) uniform samplerBuffer lobes;
layout(set = 0, binding = 3) uniform samplerBuffer albedos;
layout(set = 0, binding = 4, rgba32f) writeonly uniform image2D reflected;
layout(set = 0, binding = 5) uniform usampler2D exits;       // through.comp
layout(set = 0, binding = 6) uniform sampler2D transmitted;
layout(set = 0, binding = 7) uniform usamplerBuffer objects;
layout(set = 0, binding = 8, r32ui) uniform uimage2D unanswered;  // 1: no map so far shows where the reflection ends

layout(push_constant, scalar) uniform Push {
    vec3 middle_rs;
    uint owner;
    uint object;  // its place in the list
} push;

const uint STEPS = 24u;
const uint REFINEMENTS = 5u;
// What interpolation between texels may be off by.
const float SLACK = 1e-3;
// Beyond what a slope makes of it from one texel to the next.
const float FAR_BEHIND = 0.25;

struct Found {
    vec3 direction;  // from the map's middle
    float ratio;     // |p − x|/|p − c|
    float way;       // |p − x|, m
    bool sure;       // the map shows p, or that there is nothing
};

// How far behind what the map shows there a point u/(1 − s) is; below 0: before it. The point at s = 1 is infinitely far.
float behind(vec3 u, float s, float inverse_depth) {
    return max3(abs(u)) * inverse_depth - (1.0 - s);
}

// Along x + t·way, with t = |x|·s/(1 − s): steps of s turn the direction evenly.
Found surroundings(vec3 from, vec3 way) {
    float reach = max(length(from), 1e-20);
    float before = 0.0;
    float at_before = behind(from, 0.0, bilinear(boxes, 0u, CUBE_SIDE, from).w);
    // At a silhouette interpolation puts x in front of what hides it.
    bool in_front = at_before < -SLACK && behind(from, 0.0, greatest_around(boxes, CUBE_SIDE, from)) < FAR_BEHIND;
    [[dont_unroll]] for (uint i = 1u; i <= STEPS; ++i) {
        float s = float(i) / float(STEPS);
        vec3 u = mix(from, reach * way, s);
        float at = behind(u, s, bilinear(boxes, 0u, CUBE_SIDE, u).w);
        if (in_front && at > 0.0) {
            float low = before;
            float high = s;
            [[dont_unroll]] for (uint refinement = 0u; refinement < REFINEMENTS; ++refinement) {
                float share = clamp(at_before / (at_before - at), 0.1, 0.9);
                float between = mix(low, high, share);
                vec3 there = mix(from, reach * way, between);
                float value = behind(there, between, bilinear(boxes, 0u, CUBE_SIDE, there).w);
                if (value > 0.0) {
                    high = between;
                    at = value;
                } else {
                    low = between;
                    at_before = value;
                }
            }
            s = mix(low, high, clamp(at_before / min(at_before - at, -1e-20), 0.0, 1.0));
            u = mix(from, reach * way, s);
            return Found(u, reach * s / max(length(u), 1e-20), reach * s / max(1.0 - s, 1e-6), true);
        }
        in_front = at <= 0.0;
        before = s;
        at_before = at;
    }
    return Found(way, 1.0, 3e38, in_front);
}

vec3 light_of_lobe(vec3 direction, float alpha) {
    float level = log2(alpha * (0.5 * float(CUBE_SIDE)));
    uint low = uint(clamp(floor(level), 0.0, float(LOBE_LEVELS - 1u)));
    vec3 coarser = bilinear(lobes, first_of_lobes(low), side_of_lobes(low), direction).rgb;
    if (level < 0.0) {
        return mix(bilinear(boxes, 0u, CUBE_SIDE, direction).rgb, coarser, exp2(level));
    }
    if (low + 1u < LOBE_LEVELS) {
        coarser = mix(coarser, bilinear(lobes, first_of_lobes(low + 1u), side_of_lobes(low + 1u), direction).rgb, level - float(low));
    }
    return coarser;
}

Found reflection_of(Surface point) {
    vec3 to_eye = direction_to_eye(camera, point.position_rs);
    vec3 mirrored = normalize(2.0 * dot(point.normal, to_eye) * point.normal - to_eye);
    float alpha = max(point.roughness * point.roughness, MINIMUM_ALPHA);
    // Wide lobes lean to the normal (Lagarde & de Rousiers 2014, listing 22).
    float smooth_share = (1.0 - alpha) * (sqrt(1.0 - alpha) + alpha);
    vec3 way = normalize(mix(point.normal, mirrored, smooth_share));
    vec3 from = point.position_rs - push.middle_rs;
    Found found = surroundings(from, way);
    // The map does not show its own object.
    if (TAKES_OTHERS != 0u && found.sure) {
        found.sure = !leads_into_box(objects, push.object, from, min(found.way, 1e18) * way);
    }
    return found;
}

vec3 reflected_light(Surface point, Found found) {
    float cosine = max(dot(point.normal, direction_to_eye(camera, point.position_rs)), 1e-3);
    float alpha = max(point.roughness * point.roughness, MINIMUM_ALPHA);
    vec2 albedo = directional_albedo(albedos, 0, cosine, point.roughness);
    return (point.f0 * albedo.x + point.f90 * albedo.y) * light_of_lobe(found.direction, clamp(alpha * found.ratio, 1e-6, 1.0));
}

// Through glass, as if its surfaces were smooth and their lobe that of the first one.
vec3 transmitted_light(ivec2 pixel, float roughness) {
    vec3 weight = HAS_GLASS != 0u ? texelFetch(transmitted, pixel, 0).rgb : vec3(0.0);
    if (max3(weight) <= 0.0) {
        return vec3(0.0);
    }
    uvec4 leaves = texelFetch(exits, pixel, 0);
    Found found = surroundings(uintBitsToFloat(leaves.xyz) - push.middle_rs, unpack_direction(leaves.w));
    return weight * light_of_lobe(found.direction, clamp(roughness * roughness * found.ratio, 1e-6, 1.0));
}

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(reflected);
    if (!is_inside(pixel, size)) {
        return;
    }
    uint owner = texelFetch(owners, pixel, 0).x;
    bool takes = owner == push.owner;
    if (TAKES_OTHERS != 0u) {
        takes = owner != push.owner && imageLoad(unanswered, pixel).x != 0u;
    }
    uint open = 0u;
    if (takes) {
        vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), texelFetch(depth, pixel, 0).x);
        Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), texelFetch(specular, pixel, 0));
        Found found = reflection_of(point);
        if (TAKES_OTHERS == 0u || found.sure) {
            vec3 behind_glass = TAKES_OTHERS == 0u ? transmitted_light(pixel, point.roughness) : vec3(0.0);
            imageStore(reflected, pixel, vec4(reflected_light(point, found) + behind_glass, 1.0));
            open = found.sure || max3(behind_glass) > 0.0 ? 0u : 1u;
            imageStore(unanswered, pixel, uvec4(open));
        }
    } else if (IS_FIRST != 0u) {
        imageStore(reflected, pixel, vec4(0.0, 0.0, 0.0, 1.0));
        imageStore(unanswered, pixel, uvec4(0u));
    }
}
