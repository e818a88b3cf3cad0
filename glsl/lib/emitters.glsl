// All that next-event estimation and light paths start from: punctual lights and emissive triangles, drawn by power from one alias
// table (Vose 1991). The sky is not among them: paths that leave the scene find it, and its light is the same everywhere.
//
// emitters, one texel (rgba32ui) an entry: threshold · alias · what (EMITTER_TRIANGLE or light, and its number) · probability
#ifndef LIB_EMITTERS
#define LIB_EMITTERS

#include "lib/lights.glsl"
#include "lib/traced_scene.glsl"

const uint EMITTER_TRIANGLE = 0x80000000u;

struct Emitter {
    bool is_triangle;
    uint number;        // of the triangle or light
    float probability;
};

Emitter pick_emitter(usamplerBuffer emitters, uint count, float random) {
    float scaled = random * float(count);
    uint place = min(uint(scaled), count - 1u);
    uvec4 entry = texelFetch(emitters, int(place));
    if (scaled - float(place) >= uintBitsToFloat(entry.x)) {
        entry = texelFetch(emitters, int(entry.y));
    }
    return Emitter((entry.z & EMITTER_TRIANGLE) != 0u, entry.z & ~EMITTER_TRIANGLE, uintBitsToFloat(entry.w));
}

// Uniform in area (Osada et al. 2002): barycentric coordinates of corners 1 and 2.
vec2 place_in_triangle(vec2 random) {
    float root = sqrt(random.x);
    return vec2(root * (1.0 - random.y), root * random.y);
}

#endif
