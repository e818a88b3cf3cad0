// How much a specular lobe takes of each level of a map.
#ifndef RADIANCE_MAPS_LOBES
#define RADIANCE_MAPS_LOBES

#include "lib/brdf.glsl"
#include "radiance_maps/map.glsl"

const uint LOBE_BLINN_PHONG = 0u;
const uint LOBE_GGX = 1u;

layout(constant_id = 6) const uint LOBE = LOBE_GGX;

// A lobe as a sum over levels: from which one on, and what it takes up to there.
struct LevelShares {
    float alpha2;    // GGX
    float level;     // Blinn-Phong
    float exponent;
};

// (4.23), and (4.22) without its factor 2: half vectors have R² texels (NOTES). Narrower lobes than the map's finest texels are as wide as these (4.8).
LevelShares shares_of(Surface point) {
    float alpha = max(point.roughness * point.roughness, MINIMUM_ALPHA);
    float texels = float(MAP_SIDE * MAP_SIDE);
    float exponent = min(2.0 / (alpha * alpha + 0.0005), texels - 1.0);
    float level = clamp(0.5 * log2(texels / (exponent + 1.0)), 0.0, float(MAP_LEVELS - 1));
    return LevelShares(alpha * alpha, level, exponent);
}

// D of GGX falls with the angle: it is a sum of even discs of all sizes around the normal. Of its unit ∫ D cos, the share
//
//   C(q) = q² (1 − α²) / (α² + q(1 − α²))²          q = sin² of a disc's half angle
//
// lies in discs up to that size; α² is the whole hemisphere's. A bilinear look-up spreads like a disc of π texels; one takes the sizes up to twice that, in area, where
// the next level takes over. Discs that are wider than texels of the level with 4² of them are left to the lobe's value at each of these (radiance_maps/apply.comp).
float share_up_to(LevelShares shares, int level) {
    if (level + 1 >= MAP_LEVELS) {
        return 1.0;
    }
    float side = float(side_of_level(level));
    float solid_angle = min(2.0 * PI / (side * side), 1.0);  // over 2π
    float q = solid_angle * (2.0 - solid_angle);
    float spread = shares.alpha2 + q * (1.0 - shares.alpha2);
    return q * q * (1.0 - shares.alpha2) / (spread * spread);
}

const int WIDE_LEVEL = MAP_LEVELS - 3;

float share_of_level(LevelShares shares, int level) {
    if (LOBE == LOBE_BLINN_PHONG) {
        return max(1.0 - abs(shares.level - float(level)), 0.0);
    }
    return share_up_to(shares, level) - (level > 0 ? share_up_to(shares, level - 1) : 0.0);
}

#endif
