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
// so that ΣΦ_k = P(C) is the whole reflected flux, channel by channel, and every light has the same luminance. It sits on the
// surface in the interval's middle: on the texel that holds it, as far along the way from the curve's previous texel to its next as
// the middle lies through the texel's flux. Where rounding decides between two neighbouring texels, the place is their shared edge
// either way. Lights share N by flux, since their texels share the one distribution.

layout(local_size_x = 64) in;

layout(set = 0, binding = 1) readonly buffer FluxPrefix { vec4 flux_prefix[]; };
layout(set = 0, binding = 2) writeonly buffer Vpls { vec4 vpls[]; };

layout(push_constant, scalar) uniform Push {
    uint tile_count;
    uint vpl_count;
} push;

// A point of the cumulative distribution: flux_prefix[tile] + partial. Kept apart, differences inside a tile do not cancel.
struct Quantile {
    uint tile;
    vec4 partial;
    uint index;      // the texel of the tile that holds the point, when tile < tile_count
    float along;     // how far through that texel's flux the point lies, 0 … 1
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
    found.index = 0u;
    found.along = 0.5;
    found.of_texel = vec4(0.0);
    LightTile tile = tiles[found.tile];
    LightView view = load_view(views, tile.view);
    float remaining = target - luminance(flux_prefix[found.tile].rgb);
    bool reached = false;
    [[dont_unroll]] for (uint index = 0u; index < TILE_TEXELS && !reached; ++index) {
        ivec2 texel = texel_of_tile(tile, index);
        bool dropped = false;
        vec4 of_texel = flux_and_area(view, texel, dropped);
        float weight = luminance(of_texel.rgb);
        if (weight > 0.0) {
            float share = clamp(remaining / weight, 0.0, 1.0);
            reached = remaining < weight;
            remaining -= weight;
            found.partial += share * of_texel;
            found.index = index;
            found.along = share;
            found.of_texel = of_texel;
        }
    }
    return found;
}

// From the middle of a texel to the edge that it shares with the one `steps` (±1) further along the curve, in texels; 0 where
// the curve jumps.
vec2 towards_neighbor(uint tile, uint index, int steps) {
    int place = int(tile * TILE_TEXELS + index) + steps;
    uint neighbor = uint(clamp(place, 0, int(push.tile_count * TILE_TEXELS) - 1));
    ivec2 step = texel_of_tile(tiles[neighbor / TILE_TEXELS], neighbor % TILE_TEXELS) - texel_of_tile(tiles[tile], index);
    return abs(step.x) + abs(step.y) == 1 ? 0.5 * vec2(step) : vec2(0.0);
}

// The point of the texel's surface at a tangent coordinate inside the texel: on the plane through what the texel's middle sees.
vec3 position_on_texel(LightView view, vec2 middle, vec2 tangent, float depth, vec3 normal) {
    vec3 seen = position_of_texel(view, middle, depth);
    vec3 origin = view.origin_rs;
    if (is_orthographic(view)) {
        origin += tangent.x * view.right + tangent.y * view.down;
    }
    vec3 ray = ray_of_tangent(view, tangent);
    float slope = dot(normal, ray);
    float z = dot(normal, seen - origin) / (abs(slope) > 1e-6 ? slope : 1e-6);
    float middle_z = linear_depth(view, depth);
    float reach = 4.0 * view.tangent_step * (is_orthographic(view) ? 1.0 : middle_z);
    return origin + ray * clamp(z, middle_z - reach, middle_z + reach);
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
    ivec2 texel = texel_of_tile(tiles[middle.tile], middle.index);
    float depth = texelFetch(light_depth, texel, 0).x;
    vec3 normal = unpack_direction(texelFetch(light_normal, texel, 0).x);
    vec2 offset = middle.along < 0.5
        ? (1.0 - 2.0 * middle.along) * towards_neighbor(middle.tile, middle.index, -1)
        : (2.0 * middle.along - 1.0) * towards_neighbor(middle.tile, middle.index, 1);
    vec2 center = tangent_of_texel(view, vec2(texel) + 0.5);
    vpls[2u * k] = pack_vpl_position(position_on_texel(view, center, center + offset * view.tangent_step, depth, normal), area);
    vpls[2u * k + 1u] = pack_vpl_strength(flux, normal);
}
