#version 460
#include "lib/prelude.glsl"
#include "groups/light_views.glsl"
#include "lib/color.glsl"
#include "lib/lights.glsl"
#include "lib/vpl.glsl"
#include "vpl/blocks.glsl"
#include "lib/disc.glsl"

// One invocation makes one of N virtual point lights (Quyen 2014, section 3.2.1).
//
// The paper lays a grid over a light view, and a disc over a spot's, with a random point in every cell, fixed for the run. Here the cells are
// of equal flux rather than of equal size: a view with n VPLs is cut at the line that parts its flux as n/2 : n − n/2, across what is longer
// in metres on the surface, and so on until every part has one (the median cut of Debevec 2005). Cells follow the cone of a spot by
// themselves, none is empty, and each VPL carries the flux of its cell: ΣΦ_k is all that the views reflect, channel by channel.
// In its cell a VPL sits at the median of the flux, first of columns, then of rows of that column, on a texel that reflects: cells differ from
// each other as they are, and the paper's jitter inside them makes the error larger (rrmse 0.078 in place of 0.050, Cornell box, 256 VPLs).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler2D sums;
layout(set = 0, binding = 1) readonly buffer Shares { ViewShare shares[]; };
layout(set = 0, binding = 2) writeonly buffer Vpls { vec4 vpls[]; };

layout(push_constant, scalar) uniform Push {
    uint view_count;
    uint vpl_count;
} push;

// The sum over blocks [low, high) of a view whose first block is `origin`. [W, W, W, m²]
vec4 sum_of(ivec2 origin, ivec2 low, ivec2 high) {
    ivec2 a = origin + low - 1;
    ivec2 b = origin + high - 1;
    vec4 both = low.x > 0 && low.y > 0 ? texelFetch(sums, a, 0) : vec4(0.0);
    vec4 left = low.x > 0 ? texelFetch(sums, ivec2(a.x, b.y), 0) : vec4(0.0);
    vec4 upper = low.y > 0 ? texelFetch(sums, ivec2(b.x, a.y), 0) : vec4(0.0);
    return max(texelFetch(sums, b, 0) - upper - (left - both), vec4(0.0));
}

// The place along `axis` up to which the blocks from `low` hold at most `target`: whole blocks.
int place_of_flux(ivec2 origin, ivec2 low, ivec2 high, int axis, float target) {
    int begin = low[axis];
    int end = high[axis];
    while (end - begin > 1) {
        int middle = (begin + end) / 2;
        ivec2 corner = high;
        corner[axis] = middle;
        if (luminance(sum_of(origin, low, corner).rgb) <= target) {
            begin = middle;
        } else {
            end = middle;
        }
    }
    return begin;
}

vec3 position_at(LightView view, vec2 texel) {
    float depth = texelFetch(light_depth, ivec2(texel), 0).x;
    return position_of_texel(view, tangent_of_texel(view, texel), max(depth, 1e-30));
}

// 0 or 1: across which the cell is longer, on the surface that the view sees through the middles of its edges.
int longer_axis(LightView view, ivec2 low, ivec2 high) {
    vec2 first = vec2(view.rect_origin + BLOCK_SIDE * low) + 0.5;
    vec2 last = vec2(view.rect_origin + BLOCK_SIDE * high) - 0.5;
    vec2 middle = floor(0.5 * (first + last)) + 0.5;
    float width = distance(position_at(view, vec2(first.x, middle.y)), position_at(view, vec2(last.x, middle.y)));
    float height = distance(position_at(view, vec2(middle.x, first.y)), position_at(view, vec2(middle.x, last.y)));
    ivec2 size = high - low;
    if (min(size.x, size.y) <= 1) {
        return size.x >= size.y ? 0 : 1;
    }
    return width >= height ? 0 : 1;
}

// The reflecting texel of a block that is nearest to `wanted` (atlas).
ivec2 reflecting_texel(ivec2 block, ivec2 wanted) {
    ivec2 nearest = wanted;
    int least = 1 << 20;
    [[dont_unroll]] for (int index = 0; index < BLOCK_SIDE * BLOCK_SIDE; ++index) {
        ivec2 texel = block * BLOCK_SIDE + ivec2(index % BLOCK_SIDE, index / BLOCK_SIDE);
        ivec2 way = texel - wanted;
        int squared = way.x * way.x + way.y * way.y;
        if (squared < least && max3(texelFetch(light_flux, texel, 0).rgb) > 0.0) {
            nearest = texel;
            least = squared;
        }
    }
    return nearest;
}

// Whether a disc of this radius ends before the surface does: in eight directions the view sees, behind the disc's rim, something on the disc's
// plane or in front of it. A wall that meets another one goes on in this sense (lib/disc.glsl folds the disc there), a box's edge does not.
bool surface_goes_on(LightView view, vec3 position_rs, vec3 normal, float radius) {
    vec3 along = normalize(cross(normal, abs(normal.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
    vec3 across = cross(normal, along);
    bool goes_on = true;
    [[dont_unroll]] for (int i = 0; i < 8 && goes_on; ++i) {
        float angle = 0.25 * PI * float(i);
        vec3 way = position_rs + radius * (cos(angle) * along + sin(angle) * across) - view.origin_rs;
        float z = dot(way, view.forward);
        vec2 tangent = vec2(dot(way, view.right), dot(way, view.down)) / (is_orthographic(view) ? 1.0 : max(z, 1e-20));
        ivec2 texel = ivec2(clamp((tangent - view.tangent_origin) / view.tangent_step, vec2(-1.0), vec2(view.rect_size)));
        if ((is_orthographic(view) || z > view.near) && all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, view.rect_size))) {
            texel += view.rect_origin;
            float depth = texelFetch(light_depth, texel, 0).x;
            vec3 seen = position_of_texel(view, tangent_of_texel(view, vec2(texel) + 0.5), max(depth, 1e-30));
            goes_on = depth > 0.0 && dot(normal, seen - position_rs) > -0.1 * radius;
        }
    }
    return goes_on;
}

// The view that holds VPL k.
uint find_view(uint k) {
    uint view = 0u;
    while (view + 1u < push.view_count && k >= shares[view].first + shares[view].count) {
        ++view;
    }
    return view;
}

void main() {
    uint k = gl_GlobalInvocationID.x;
    if (k >= push.vpl_count) {
        return;
    }
    uint view_index = find_view(k);
    ViewShare share = shares[view_index];
    if (k - share.first >= share.count) {
        vpls[2u * k] = pack_vpl_position(vec3(0.0), 0.0);
        vpls[2u * k + 1u] = pack_vpl_strength(vec3(0.0), vec3(0.0, 0.0, 1.0));
        return;
    }
    LightView view = load_view(views, view_index);
    ivec2 origin = view.rect_origin / BLOCK_SIDE;
    ivec2 low = ivec2(0);
    ivec2 high = view.rect_size / BLOCK_SIDE;
    uint index = k - share.first;
    uint count = share.count;
    while (count > 1u && any(greaterThan(high - low, ivec2(1)))) {
        int axis = longer_axis(view, low, high);
        float whole = luminance(sum_of(origin, low, high).rgb);
        float target = whole * float(count / 2u) / float(count);
        int cut = place_of_flux(origin, low, high, axis, target);
        // Whichever edge of the block that holds the target is nearer to it.
        ivec2 corner = high;
        corner[axis] = cut;
        float below = cut > low[axis] ? luminance(sum_of(origin, low, corner).rgb) : 0.0;
        corner[axis] = cut + 1;
        float above = luminance(sum_of(origin, low, corner).rgb);
        cut = clamp(target - below > above - target ? cut + 1 : cut, low[axis] + 1, high[axis] - 1);
        corner[axis] = cut;
        float lower = luminance(sum_of(origin, low, corner).rgb);
        ivec2 second = low;
        second[axis] = cut;
        float upper = luminance(sum_of(origin, second, high).rgb);
        float fraction = lower / max(lower + upper, 1e-37);
        uint of_lower = clamp(uint(float(count) * fraction + 0.5), lower > 0.0 ? 1u : 0u, upper > 0.0 ? count - 1u : count);
        if (index < of_lower) {
            high = corner;
            count = of_lower;
        } else {
            low = second;
            index -= of_lower;
            count -= of_lower;
        }
    }
    vec4 cell = sum_of(origin, low, high) / float(count);
    vec3 flux = cell.rgb + share.extra / float(share.count);

    // VPLs that share a block take points of the plastic number's sequence (Roberts 2018), the k-th for VPL k.
    vec2 point = count > 1u ? fract(0.5 + vec2(0.7548776662466927, 0.5698402909980532) * float(k)) : vec2(0.5);
    ivec2 block = low;
    ivec2 end = high;
    vec2 inside;
    for (int axis = 0; axis < 2; ++axis) {
        float whole = luminance(sum_of(origin, block, end).rgb);
        float target = whole * point[axis];
        int place = place_of_flux(origin, block, end, axis, target);
        ivec2 corner = end;
        corner[axis] = place;
        float below = place > block[axis] ? luminance(sum_of(origin, block, corner).rgb) : 0.0;
        corner[axis] = place + 1;
        float above = luminance(sum_of(origin, block, corner).rgb);
        inside[axis] = clamp((target - below) / max(above - below, 1e-37), 0.0, 1.0);
        block[axis] = place;
        end[axis] = place + 1;
    }
    block += origin;
    ivec2 texel = reflecting_texel(block, block * BLOCK_SIDE + ivec2(min(inside * float(BLOCK_SIDE), float(BLOCK_SIDE) - 0.5)));
    float depth = texelFetch(light_depth, texel, 0).x;
    vec3 normal = unpack_direction(texelFetch(light_normal, texel, 0).x);
    vec2 tangent = tangent_of_texel(view, vec2(texel) + 0.5);
    if (depth <= 0.0) {
        flux = vec3(0.0);
        depth = 1.0;
    }
    float area = max(cell.a, area_of_texel(view, tangent, depth, normal));
    vec3 position_rs = position_of_texel(view, tangent, depth);
    float overlap = OVERLAP;
    while (overlap > 1.0 && !surface_goes_on(view, position_rs, normal, sqrt(overlap * area * INVERSE_PI))) {
        overlap *= 0.6;
    }
    vpls[2u * k] = pack_vpl_position(position_rs, max(overlap, 1.0) * area);
    vpls[2u * k + 1u] = pack_vpl_strength(flux, normal);
}
