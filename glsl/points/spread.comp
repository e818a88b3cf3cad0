#version 460
#include "lib/prelude.glsl"
#include "points/fixed_point.glsl"
#include "points/listed_tile.glsl"
#include "points/filter.glsl"

// Readies the flux Φ of one pixel of a tile for the filter: over the area that it will be spread on, by the filter's weights w (points/filter.glsl),
//
//   Φ / Σ w·A     [W/m²]     A = Δω·d²/cosθ, the area of the surface that each pixel shows
//
// so that filtered flux is landed flux. Where all areas are equal that is equation 4 on Φ/A, divided by the sum of its weights.

layout(local_size_x = 64) in;

layout(set = 0, binding = 3) uniform usamplerBuffer peak;
layout(set = 0, binding = 4) uniform usampler2D red;
layout(set = 0, binding = 5) uniform usampler2D green;
layout(set = 0, binding = 6) uniform usampler2D blue;
// Of the filter in the world: widths.comp, shifts.comp.
layout(set = 0, binding = 7) uniform usampler2D width_xx;
layout(set = 0, binding = 8) uniform usampler2D width_yy;
layout(set = 0, binding = 9) uniform usampler2D width_xy;
layout(set = 0, binding = 10) uniform usampler2D shift_x;
layout(set = 0, binding = 11) uniform usampler2D shift_y;
layout(set = 0, binding = 12, rgba32f) writeonly uniform image2D spread;  // W/m² · larger radius, m
layout(set = 0, binding = 13, rgba32ui) writeonly uniform uimage2D shapes;  // C⁻¹ as floats, 1/m²: xx, yy, xy · where in the pixel, unorm16 each

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
    vec3 inverse = vec3(0.0);
    uint inside = 0u;
    if (WORLD != 0u) {
        float mean = max((float(sums.x) + float(sums.y) + float(sums.z)) * (1.0 / 3.0), 1.0);
        vec3 width = width_at(pixel, mean, source.extent);
        radius = min(largest_radius(width), float(MOST_REACH) * source.extent);
        inverse = inverse_width(width);
        inside = packUnorm2x16(vec2(whole_at(shift_x, pixel), whole_at(shift_y, pixel)) / mean);
        move_within_pixel(source, pixel, unpackUnorm2x16(inside), push.size);
    }
    int reach = reach_of(radius, source.extent);
    float whole = 0.0;
    [[dont_unroll]] for (int j = -reach; j <= reach; ++j) {
        [[dont_unroll]] for (int i = -reach; i <= reach; ++i) {
            Place receiver = place_of_pixel(pixel + ivec2(i, j), push.size);
            if (receiver.valid) {
                whole += weight_of(source, inverse, receiver, ivec2(i, j)) * receiver.area;
            }
        }
    }
    vec3 flux = vec3(sums) / fixed_point_scale(texelFetch(peak, 0).x, push.count_log2);
    imageStore(spread, pixel, vec4(flux / max(whole, 1e-37), radius));
    imageStore(shapes, pixel, uvec4(floatBitsToUint(inverse), inside));
}
