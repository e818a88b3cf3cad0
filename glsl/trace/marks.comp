#version 460
#include "lib/prelude.glsl"
#include "groups/surface.glsl"
#include "lib/append.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"

// Lists one pixel if its centre may not stand for all of it: if it differs from one of its four neighbours (Jin et al. 2009) in
//
//   surface     one of the two shows none, or each is off the other's plane (neighbours of one plane or of one bent surface are not)
//   normal      of shading
//   colour      albedo and reflectance, with what a smooth surface shows of them (reflected.comp)
//   light       what shines by itself, direct light that has sharp shadows and no noise, and what a smooth surface shows of these
//   reflection  normals of what a smooth surface shows
//
// Colour and light differ by their contrast, |a − b|/(a + b) in the channel that is brightest (Mitchell 1987).

layout(local_size_x = 64) in;

// 1: something shines by itself; there is direct light; smooth surfaces show something.
layout(constant_id = 0) const uint HAS_EMISSION = 0u;
layout(constant_id = 1) const uint HAS_DIRECT = 0u;
layout(constant_id = 2) const uint HAS_REFLECTED = 0u;

layout(set = 0, binding = 0) uniform sampler2D emission;
layout(set = 0, binding = 1) uniform sampler2D direct;
layout(set = 0, binding = 2) uniform sampler2D reflected_light;
layout(set = 0, binding = 3) uniform usampler2D reflected_surface;
layout(set = 0, binding = 4) writeonly buffer Marked { uint marked[]; };  // x and y of pixels, 16 bits each
layout(set = 0, binding = 5) buffer Counts { uint counts[]; };  // word 0: marked pixels

layout(push_constant, scalar) uniform Push {
    uint first_row;
    uint row_count;
    uint capacity;
    float contrast;
} push;

// Sine and cosine of angles between surfaces, and between what normals of shading make of light.
const float BEND = 0.35;
const float NORMAL = 0.94;

struct Seen {
    bool something;
    Surface surface;
    vec3 light;
    vec3 color;
    vec3 reflected_normal;
};

Seen seen_at(ivec2 pixel, ivec2 size) {
    Seen seen;
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
    vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
    seen.something = pixel_depth > 0.0;
    seen.surface = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
    seen.light = HAS_EMISSION != 0u ? texelFetch(emission, pixel, 0).rgb : vec3(0.0);
    seen.light += HAS_DIRECT != 0u ? texelFetch(direct, pixel, 0).rgb : vec3(0.0);
    seen.color = seen.surface.diffuse_albedo + seen.surface.f0;
    seen.reflected_normal = vec3(0.0);
    if (HAS_REFLECTED != 0u) {
        seen.light += texelFetch(reflected_light, pixel, 0).rgb;
        uvec4 shown = texelFetch(reflected_surface, pixel, 0);
        vec2 middle = unpackHalf2x16(shown.y);
        seen.color += vec3(unpackHalf2x16(shown.x), middle.x);
        seen.reflected_normal = vec3(middle.y, unpackHalf2x16(shown.z));
    }
    return seen;
}

float contrast_of(vec3 a, vec3 b) {
    return max3(abs(a - b)) / max(max3(a + b), 1e-30);
}

bool differ(Seen a, Seen b) {
    if (!a.something || !b.something) {
        return a.something != b.something;
    }
    vec3 way = b.surface.position_rs - a.surface.position_rs;
    float off = min(abs(dot(a.surface.geometric_normal, way)), abs(dot(b.surface.geometric_normal, way)));
    return off > BEND * length(way) || dot(a.surface.normal, b.surface.normal) < NORMAL
        || contrast_of(a.color, b.color) > push.contrast || contrast_of(a.light, b.light) > push.contrast
        || distance(a.reflected_normal, b.reflected_normal) > BEND * max(max3(a.color), max3(b.color));
}

void main() {
    ivec2 pixel = pixel_of_invocation() + ivec2(0, push.first_row);
    ivec2 size = textureSize(depth, 0);
    bool mark = false;
    if (is_inside(pixel, ivec2(size.x, min(uint(size.y), push.first_row + push.row_count)))) {
        Seen here = seen_at(pixel, size);
        [[dont_unroll]] for (uint side = 0u; side < 4u && !mark; ++side) {
            int step_size = (side & 1u) != 0u ? 1 : -1;
            ivec2 other = pixel + ((side & 2u) != 0u ? ivec2(0, step_size) : ivec2(step_size, 0));
            other = clamp(other, ivec2(0), size - 1);
            mark = differ(here, seen_at(other, size));
        }
    }
    uint place;
    APPEND(counts[0], mark, place, {})
    if (mark && place < push.capacity) {
        marked[place] = uint(pixel.x) | uint(pixel.y) << 16;
    }
}
