#version 460
#include "lib/prelude.glsl"
#include "particles/cells.glsl"

// Into how many cells one triangle is cut, whose particles lie equally dense: n² parts, each of about CELL_PARTICLES particles if these were spread evenly.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer areas;
layout(set = 0, binding = 1) writeonly buffer Counts { uint counts[]; };

layout(push_constant, scalar) uniform Push {
    uint triangle_count;
    float particles_an_area;  // of all particles over all area, 1/m²
} push;

// As in src/diffuse/particles/place.rs, which makes room for as many.
const float CELL_PARTICLES = 16.0;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= push.triangle_count) {
        return;
    }
    float cells = texelFetch(areas, int(index)).x * push.particles_an_area / CELL_PARTICLES;
    uint parts = uint(clamp(ceil(sqrt(cells)), 1.0, float(MOST_PARTS)));
    counts[index] = parts * parts;
}
