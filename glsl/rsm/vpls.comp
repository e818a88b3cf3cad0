#version 460
#include "lib/prelude.glsl"
#include "lib/vpl.glsl"
#include "rsm/texels.glsl"

// One invocation makes one of N virtual point lights (Keller 1997) out of the light views' texels, in place of the fixed
// pattern of Dachsbacher & Stamminger 2005: stratified sampling of the reflected flux.
//
// P(c) is the cumulative (flux rgb [W], lit surface [m²]) of all texels in the tiles' order, as a piecewise linear function of
// its own luminance c = 0 … C. Light k stands for the interval a = kC/N … b = (k+1)C/N and carries
//
//   Φ_k = P(b).rgb − P(a).rgb        A_k = P(b).a − P(a).a
//
// so that ΣΦ_k = P(C) is the whole reflected flux, channel by channel, and every light has the same luminance. It sits on
// the texel in the interval's middle. Lights share N by flux, since their texels share the one distribution.

layout(local_size_x = 64) in;

layout(set = 0, binding = 5) readonly buffer FluxPrefix { vec4 flux_prefix[]; };
layout(set = 0, binding = 6) writeonly buffer Vpls { vec4 vpls[]; };

layout(push_constant, scalar) uniform Push {
    uint tile_count;
    uint vpl_count;
} push;

// A point of the cumulative distribution: flux_prefix[tile] + partial. Kept apart, differences inside a tile do not cancel.
struct Quantile {
    uint tile;
    vec4 partial;
    ivec2 texel;     // the texel that holds the point, when tile < tile_count
    vec4 of_texel;   // its flux and surface
};

// The last tile whose prefix is at most `target`.
uint find_tile(float target) {
    uint low = 0u;
    uint high = push.tile_count;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (luminance(flux_prefix[middle].rgb) <= target) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

Quantile find_quantile(float target) {
    Quantile found;
    found.tile = find_tile(target);
    found.partial = vec4(0.0);
    found.texel = ivec2(0);
    found.of_texel = vec4(0.0);
    LightTile tile = tiles[found.tile];
    LightView view = load_view(views, tile.view);
    float remaining = target - luminance(flux_prefix[found.tile].rgb);
    bool reached = false;
    [[dont_unroll]] for (uint index = 0u; index < TILE_TEXELS && !reached; ++index) {
        ivec2 texel = texel_of_tile(tile, index);
        vec4 of_texel = flux_and_area(view, texel);
        float weight = luminance(of_texel.rgb);
        if (weight > 0.0) {
            float share = clamp(remaining / weight, 0.0, 1.0);
            reached = remaining < weight;
            remaining -= weight;
            found.partial += share * of_texel;
            found.texel = texel;
            found.of_texel = of_texel;
        }
    }
    return found;
}

void main() {
    uint k = gl_GlobalInvocationID.x;
    if (k >= push.vpl_count) {
        return;
    }
    vec4 whole = flux_prefix[push.tile_count];
    float total = luminance(whole.rgb);
    if (total <= 0.0) {
        vpls[2u * k] = pack_vpl_position(vec3(0.0), 0.0);
        vpls[2u * k + 1u] = pack_vpl_strength(vec3(0.0), vec3(0.0, 0.0, 1.0));
        return;
    }

    // One loop, so that the search is compiled once. The interval's ends come out of the same expression for both neighbours.
    Quantile begin;
    Quantile middle;
    Quantile end;
    [[dont_unroll]] for (uint step = 0u; step < 3u; ++step) {
        precise float target = total * (float(2u * k + step) / float(2u * push.vpl_count));
        Quantile quantile = find_quantile(target);
        if (step == 0u) {
            begin = quantile;
        } else if (step == 1u) {
            middle = quantile;
        } else {
            end = quantile;
        }
    }
    if (k == 0u) {
        begin.tile = 0u;
        begin.partial = vec4(0.0);
    }
    if (k + 1u == push.vpl_count) {
        end.tile = push.tile_count;
        end.partial = vec4(0.0);
    }
    vec4 share = (flux_prefix[end.tile] - flux_prefix[begin.tile]) + (end.partial - begin.partial);
    vec3 flux = max(share.rgb, vec3(0.0));

    // The surface's difference may cancel beside much larger ones. What the light stands for is at least its own part of its texel.
    float own = min(total / (float(push.vpl_count) * max(luminance(middle.of_texel.rgb), 1e-37)), 1.0);
    float area = max(share.a, own * middle.of_texel.a);

    LightView view = load_view(views, tiles[middle.tile].view);
    float depth = texelFetch(light_depth, middle.texel, 0).x;
    vec2 tangent = tangent_of_texel(view, vec2(middle.texel) + 0.5);
    vpls[2u * k] = pack_vpl_position(position_of_texel(view, tangent, depth), area);
    vpls[2u * k + 1u] = pack_vpl_strength(flux, unpack_direction(texelFetch(light_normal, middle.texel, 0).x));
}
