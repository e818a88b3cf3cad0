// The points of a photon map at which irradiance is known, in a grid of cells of r (final_gather/records.glsl).
// group: bindings 148 to 151
#ifndef GROUPS_PHOTON_MAP
#define GROUPS_PHOTON_MAP

// Which of a point's rays a pass sends, and what it looks them up by.
struct GatherRays {
    uint first;
    uint end;
    uint count;    // of all passes
    uint bits;     // of the grid
    float radius;  // r, m
};

layout(set = 0, binding = 148) uniform usamplerBuffer map_points;
layout(set = 0, binding = 149) uniform usamplerBuffer map_starts;   // of each bucket's list
layout(set = 0, binding = 150) uniform usamplerBuffer map_lengths;

#endif
