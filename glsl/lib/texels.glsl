// Textures as one buffer of linear texels (samplerBuffer, rgba16f), mip levels included, so that a ray can read any of them
// without descriptors of its own. What a sampler would do, in arithmetic.
//
// texture_table, one texel (rgba32ui) a texture: first texel · width and height (16 bits each) · flags · number of levels
#ifndef LIB_TEXELS
#define LIB_TEXELS

#include "lib/scene.glsl"

const uint TEXTURE_MIRROR_U = 1u;
const uint TEXTURE_CLAMP_U = 2u;
const uint TEXTURE_MIRROR_V = 4u;
const uint TEXTURE_CLAMP_V = 8u;
const uint TEXTURE_NEAREST = 16u;

int wrapped(int coordinate, int size, bool mirror, bool clamped) {
    if (clamped) {
        return clamp(coordinate, 0, size - 1);
    }
    int period = mirror ? 2 * size : size;
    int inside = coordinate - period * int(floor((float(coordinate) + 0.5) / float(period)));
    return mirror && inside >= size ? 2 * size - 1 - inside : inside;
}

vec4 sample_level(samplerBuffer texels, uvec4 entry, int level, vec2 uv) {
    ivec2 size = ivec2(entry.y & 0xFFFFu, entry.y >> 16);
    int first = int(entry.x);
    for (int skipped = 0; skipped < level; ++skipped) {
        first += size.x * size.y;
        size = max(size / 2, ivec2(1));
    }
    bool nearest = (entry.z & TEXTURE_NEAREST) != 0u;
    // Far from the origin a float cannot tell texels apart anyway; the bound keeps the conversion to int defined.
    vec2 place = clamp(uv * vec2(size) - (nearest ? 0.0 : 0.5), vec2(-1e9), vec2(1e9));
    ivec2 low = ivec2(floor(place));
    vec2 part = nearest ? vec2(0.0) : place - vec2(low);
    ivec4 corner;
    for (int i = 0; i < 2; ++i) {
        corner[i] = wrapped(low.x + i, size.x, (entry.z & TEXTURE_MIRROR_U) != 0u, (entry.z & TEXTURE_CLAMP_U) != 0u);
        corner[2 + i] = wrapped(low.y + i, size.y, (entry.z & TEXTURE_MIRROR_V) != 0u, (entry.z & TEXTURE_CLAMP_V) != 0u);
    }
    vec4 sum = vec4(0.0);
    [[dont_unroll]] for (int i = 0; i < 4; ++i) {
        int column = i & 1;
        int row = i >> 1;
        float weight = (column == 0 ? 1.0 - part.x : part.x) * (row == 0 ? 1.0 - part.y : part.y);
        int x = column == 0 ? corner.x : corner.y;
        int y = row == 0 ? corner.z : corner.w;
        sum += weight * texelFetch(texels, first + y * size.x + x);
    }
    return sum;
}

// Trilinear: `dx` and `dy` are the steps of the texture coordinates from pixel to pixel, the longer of which chooses the levels; with
// 0 it is the finest.
vec4 sample_texels(samplerBuffer texels, usamplerBuffer texture_table, uint index, vec2 uv, vec2 dx, vec2 dy) {
    uvec4 entry = texelFetch(texture_table, int(index));
    vec2 size = vec2(entry.y & 0xFFFFu, entry.y >> 16);
    float covered = max(dot(dx * size, dx * size), dot(dy * size, dy * size));
    float lod = clamp(0.5 * log2(max(covered, 1e-20)), 0.0, float(entry.w - 1u));
    float level = floor(lod);
    vec4 texel = sample_level(texels, entry, int(level), uv);
    if (lod > level) {
        texel = mix(texel, sample_level(texels, entry, int(level) + 1, uv), lod - level);
    }
    return texel;
}

#endif
