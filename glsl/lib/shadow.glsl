// Filtered shadow lookup in the atlas of light views.
#ifndef LIB_SHADOW
#define LIB_SHADOW

#include "lib/lights.glsl"

struct ShadowFilter {
    float normal_offset;  // in widths of a shadow texel at the receiver
    int radius;           // taps: (2·radius + 1)²
};

// How far, in texel widths, a texel's surface may lie behind the receiver's plane and still be taken for the receiver's.
const float SURFACE_DEPTH_TEXELS = 4.0;

// The share of the light that arrives, 0 … 1: percentage-closer filtering (Reeves et al. 1987) with (2r+1)² bilinear taps one texel
// apart. Neighbouring taps share texels, so their sum is one comparison for each of (2r+2)² texels, weighted 1−f, 1, …, 1, f in x and y.
//
// Every texel is compared with the depth that the receiver's own plane has at that texel. Reversed depth is linear over
// the plane of the view for any planar receiver: with v the receiver seen from the view and n its normal,
//   perspective   depth(t) = near·n·(forward + t.x·right + t.y·down)/(n·v)    ∂depth/∂t = near·(n·right, n·down)/(n·v)
//   orthographic  depth(t) = −z(t)/range                                      ∂depth/∂t = (n·right, n·down)/(n·forward)/range
// A flat receiver is then free of acne at every slope without a bias, and nothing detaches from its shadow.
// What remains, rounding and dents between facets, is met by moving the receiver along its normal by a share of the texel
// that grows with the slope (Holbert 2011). Slopes are capped at a cosine of 0.02.
//
// A texel through which the light passes far behind that plane does not show the receiver's surface at all: the surface ends before
// it. Such texels say nothing about the receiver and are left out of the average; counted as lit, they would let light in along
// the edges of closed rooms. If no texel is left, nothing stands in the light's way.
float light_visibility(sampler2D light_depth, LightView view, vec3 position_rs, vec3 normal, ShadowFilter shadow_filter) {
    vec3 receiver = position_rs - view.origin_rs;
    bool orthographic = is_orthographic(view);
    vec3 away = orthographic ? view.forward : normalize_or(receiver, view.forward);
    float cosine = dot(normal, away);
    float texel_width = view.tangent_step * (orthographic ? 1.0 : dot(receiver, view.forward));
    float slope = max(sqrt(max(1.0 - cosine * cosine, 0.0)), 0.1);
    receiver += normal * (shadow_filter.normal_offset * texel_width * slope);

    vec2 tangent = vec2(dot(receiver, view.right), dot(receiver, view.down));
    vec2 gradient = vec2(dot(normal, view.right), dot(normal, view.down)) * view.tangent_step;
    float z = dot(receiver, view.forward);
    float depth;
    if (orthographic) {
        depth = depth_of_linear(view, z);
        gradient /= min(dot(normal, view.forward), -0.02) * view.depth_range;
    } else {
        // Nothing nearer than the near plane is in the map, so nothing there is in shadow.
        z = max(z, view.near);
        depth = view.near / z;
        tangent /= z;
        gradient *= view.near / min(dot(normal, receiver), -0.02 * length(receiver));
    }

    vec2 texel = (tangent - view.tangent_origin) / view.tangent_step - 0.5;
    vec2 whole = floor(texel);
    vec2 fraction = texel - whole;
    int radius = shadow_filter.radius;
    // The guard band holds all taps of what the view is asked for; anything beyond is read at its rim.
    vec2 rim = vec2(view.rect_size) - float(radius + 2);
    vec2 first = vec2(view.rect_origin) + clamp(whole, vec2(float(radius)), rim) - float(radius);
    vec2 to_uv = 1.0 / vec2(textureSize(light_depth, 0));
    float behind = SURFACE_DEPTH_TEXELS * texel_width * (orthographic ? 1.0 / view.depth_range : view.near / (z * z));
    float lit = 0.0;
    float seen = 0.0;
    // Four texels a fetch: [(0,1), (1,1), (1,0), (0,0)].
    for (int y = 0; y <= radius; ++y) {
        for (int x = 0; x <= radius; ++x) {
            vec2 corner = 2.0 * vec2(x, y);
            vec4 occluders = textureGather(light_depth, (first + corner + 1.0) * to_uv);
            vec2 offset = corner - float(radius) - fraction;
            vec4 planes = depth + gradient.x * (offset.x + vec4(0.0, 1.0, 1.0, 0.0)) + gradient.y * (offset.y + vec4(1.0, 1.0, 0.0, 0.0));
            vec2 weight_x = vec2(x == 0 ? 1.0 - fraction.x : 1.0, x == radius ? fraction.x : 1.0);
            vec2 weight_y = vec2(y == 0 ? 1.0 - fraction.y : 1.0, y == radius ? fraction.y : 1.0);
            vec4 weights = weight_x.xyyx * weight_y.yyxx * vec4(lessThanEqual(planes - occluders, vec4(behind)));
            seen += dot(weights, vec4(1.0));
            lit += dot(weights, vec4(lessThanEqual(occluders, max(planes, 0.0))));
        }
    }
    return seen > 0.0 ? lit / seen : 1.0;
}

#endif
