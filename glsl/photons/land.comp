#version 460
#include "lib/prelude.glsl"
#include "photons/landing.glsl"

// What one photon met, where the scene was lists of pixels: the material's factors, and the surface's own normal (photons/landing.glsl).

layout(local_size_x = 64) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    uvec4 hit = uvec4(HIT_NONE);
    if (index < counts[push.stage * STAGE_WORDS + COUNT_WORD]) {
        hit = texelFetch(hits, int(index));
    }
    bool met = hit.x != HIT_NONE;
    hit = met ? hit : uvec4(0u);
    Landing landing = arrive(met ? index : 0u, hit);
    land(met, landing, material_factors(landing.material, vec4(1.0)));
}
