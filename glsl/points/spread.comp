#version 460
#include "lib/prelude.glsl"
#include "points/fixed_point.glsl"
#include "points/listed_tile.glsl"
#include "points/source.glsl"

// Readies the flux Φ of one pixel of a tile for the filter: over the area that it will be spread on, by the filter's weights w (points/filter.glsl),
//
//   Φ / Σ w·A     [W/m²]     A = Δω·d²/cosθ, the area of the surface that each pixel shows
//
// so that filtered flux is landed flux. Where all areas are equal that is equation 4 on Φ/A, divided by the sum of its weights. Wide Gaussians are summed over every
// second pixel of every second row. Leaves a record of the pixel in a list (points/source.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 3) uniform usamplerBuffer fluxes;
layout(set = 0, binding = 4) uniform usampler2D red;
layout(set = 0, binding = 5) uniform usampler2D green;
layout(set = 0, binding = 6) uniform usampler2D blue;
// Of the filter in the world: widths.comp, shifts.comp.
layout(set = 0, binding = 7) uniform usampler2D width_xx;
layout(set = 0, binding = 8) uniform usampler2D width_yy;
layout(set = 0, binding = 9) uniform usampler2D width_xy;
layout(set = 0, binding = 10) uniform usampler2D shift_x;
layout(set = 0, binding = 11) uniform usampler2D shift_y;
layout(set = 0, binding = 12, r32ui) writeonly uniform uimage2D slots;  // 1 more than the number of the pixel's record
layout(set = 0, binding = 13) writeonly buffer SourceBlock { uvec4 sources[]; };
layout(set = 0, binding = 14) buffer CountBlock { uint source_count[]; };

layout(push_constant, scalar) uniform Push {
    ivec2 size;
    uint count_log2;
} push;

float whole_at(usampler2D image, ivec2 pixel) {
    return float(texelFetch(image, pixel, 0).x);
}

// The mean over the photons, `flux` being the sum of theirs in the mean channel.
vec3 width_at(ivec2 pixel, float flux, float extent) {
    float most = float(MOST_REACH) * extent;
    vec3 found = vec3(whole_at(width_xx, pixel), whole_at(width_yy, pixel), whole_at(width_xy, pixel));
    vec3 width = (found / flux - vec3(0.0, 0.0, 0.5)) * (most * most);
    // Faint photons are rounded to whole numbers: no ellipse is narrower than a pixel for that.
    float least = LEAST_RADIUS * extent * LEAST_RADIUS * extent;
    width.xy = clamp(width.xy, vec2(least), vec2(most * most));
    float limit = sqrt(max((width.x - 0.5 * least) * (width.y - 0.5 * least), 0.0));
    return vec3(width.xy, clamp(width.z, -limit, limit));
}

// Radii of a Gaussian, over a pixel's extent on the surface, from which on every second pixel gives its sum.
const float WIDE = 4.0;

void main() {
    int tile = tile_of_group(push.size);
    ivec2 pixel = pixel_of_tile(max(tile, 0), push.size);
    if (tile == NO_TILE || !is_inside(pixel, push.size)) {
        return;
    }
    uvec3 sums = uvec3(texelFetch(red, pixel, 0).x, texelFetch(green, pixel, 0).x, texelFetch(blue, pixel, 0).x);
    if (sums == uvec3(0u)) {
        return;
    }
    Place source = place_of_pixel(pixel, push.size);
    float radius = 0.0;
    Spreading spreading = Spreading(vec3(0.0), vec3(0.0));
    if (WORLD != 0u) {
        float mean = max((float(sums.x) + float(sums.y) + float(sums.z)) * (1.0 / 3.0), 1.0);
        vec3 width = width_at(pixel, mean, source.extent);
        radius = min(largest_radius(width), float(MOST_REACH) * source.extent);
        axes_over_radii(width, source.normal, spreading.first, spreading.second);
        move_within_pixel(source, pixel, vec2(whole_at(shift_x, pixel), whole_at(shift_y, pixel)) / mean, push.size);
    }
    int reach = reach_of(radius, source.extent);
    // The smaller radius decides, and a pixel on a slanted surface is longer. At the screen's edges, where the sum ends at once, every pixel counts.
    float cosine = abs(dot(source.normal, direction_to_eye(camera, source.position_rs)));
    bool wide = WORLD != 0u && cosine > WIDE * source.extent * length(spreading.second);
    bool within = all(greaterThanEqual(pixel - reach, ivec2(0))) && all(lessThan(pixel + reach, push.size));
    int apart = wide && within ? 2 : 1;
    int steps = (reach + apart - 1) / apart;
    float whole = 0.0;
    [[dont_unroll]] for (int j = -steps; j <= steps; ++j) {
        [[dont_unroll]] for (int i = -steps; i <= steps; ++i) {
            ivec2 step = apart * ivec2(i, j);
            Place receiver = place_of_pixel(pixel + step, push.size);
            if (receiver.valid) {
                whole += weight_of(source, spreading, receiver, step) * receiver.area;
            }
        }
    }
    whole *= float(apart * apart);
    vec3 flux = vec3(sums) / fixed_point_scale(fluxes, push.count_log2);
    vec3 light = whole > 0.0 ? flux / whole : vec3(0.0);
    uint number = atomicAdd(source_count[0], 1u);
    imageStore(slots, pixel, uvec4(number + 1u));
    uint first = SOURCE_TEXELS * number;
    sources[first] = uvec4(floatBitsToUint(light), uint(reach));
    sources[first + 1u] = uvec4(floatBitsToUint(source.position_rs), texelFetch(surface, pixel, 0).y);
    sources[first + 2u] = uvec4(floatBitsToUint(spreading.first), floatBitsToUint(source.extent));
    sources[first + 3u] = uvec4(floatBitsToUint(spreading.second), 0u);
}
