// Specular environment maps (Reich 2015, section 4.3.3). A map belongs to a cache that sees the eye along v. Its directions h are half vectors between v and where light
// comes from, ω = 2(v·h)h − v: the hemisphere around v holds all light of the sphere. In the frame around v, h goes to a disc by r = √(1 − z) and from there to the square by
// Shirley & Chiu's concentric map (1997): texels have equal solid angles, 2π/R² of level 0.
//
// Of a map of side R, level l has (R/2^l)² texels, row by row; levels follow each other. Each texel holds what light sends across the beam, E = Σ Φ/π · cos/(d² + a) in
// W/m², summed over it: a texel of a coarser level holds the sum of its four. The solid angle of the directions ω of a texel,
//
//   W = ∫ 4(v·h) dω_h                                                                              sr
//
// is what E is divided by to give a mean radiance: a uniform one is the same at every level.
#ifndef RADIANCE_MAPS_MAP
#define RADIANCE_MAPS_MAP

#include "lib/microfacet.glsl"

// R.
layout(constant_id = 3) const int MAP_SIDE = 16;

const int MAP_TEXELS = (4 * MAP_SIDE * MAP_SIDE - 1) / 3;
const int MAP_LEVELS = MAP_SIDE == 4 ? 3 : MAP_SIDE == 8 ? 4 : MAP_SIDE == 16 ? 5 : MAP_SIDE == 32 ? 6 : 7;

int side_of_level(int level) {
    return MAP_SIDE >> level;
}

// Texels of the levels before.
int first_of_level(int level) {
    int side = side_of_level(level);
    return 4 * (MAP_SIDE * MAP_SIDE - side * side) / 3;
}

// Of one texel in half vectors, sr.
float texel_angle(int level) {
    float side = float(side_of_level(level));
    return 2.0 * PI / (side * side);
}

// Where the direction lies in the unit square; z is not negative.
vec2 square_of_direction(vec3 local) {
    // √(1 − z) without the difference that cancels around the middle.
    vec2 disc = local.xy * inversesqrt(1.0 + max(local.z, 0.0));
    vec2 size = abs(disc);
    float radius = length(disc);
    bool wide = size.x >= size.y;
    float across = wide ? disc.x : disc.y;
    float along = wide ? disc.y : disc.x;
    float first = across < 0.0 ? -radius : radius;
    float second = size.x + size.y > 0.0 ? first * (4.0 * INVERSE_PI) * atan(along / across) : 0.0;
    return 0.5 + 0.5 * (wide ? vec2(first, second) : vec2(second, first));
}

// The half vector between two directions, in the frame around the second one. Opposite ones have none: any across them.
vec3 half_direction(Frame frame, vec3 toward) {
    vec3 local = to_local(frame, toward) + vec3(0.0, 0.0, 1.0);
    float squared = dot(local, local);
    return squared > 1e-12 ? local * inversesqrt(squared) : vec3(1.0, 0.0, 0.0);
}

// Four texels around a place in the unit square and their weights; beyond the edge the nearest counts.
struct Corners {
    ivec4 texels;
    vec4 weights;
};

Corners corners_of(vec2 square, int level) {
    int side = side_of_level(level);
    vec2 place = square * float(side) - 0.5;
    vec2 lowest = floor(place);
    vec2 along = place - lowest;
    ivec2 low = clamp(ivec2(lowest), ivec2(0), ivec2(side - 1));
    ivec2 high = clamp(ivec2(lowest) + 1, ivec2(0), ivec2(side - 1));
    int first = first_of_level(level);
    ivec4 texels = first + ivec4(low.y * side + low.x, low.y * side + high.x, high.y * side + low.x, high.y * side + high.x);
    vec2 less = 1.0 - along;
    return Corners(texels, vec4(less.x * less.y, along.x * less.y, less.x * along.y, along.x * along.y));
}

#endif
