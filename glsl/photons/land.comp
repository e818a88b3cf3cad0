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
    // What the factor calls metal may be none where the texture says so; the pixel that the photon lands on knows.
    landing.may_diffuse = (landing.material.flags & MATERIAL_METALLIC_ROUGHNESS_TEXTURE) != 0u;
    land(met, landing, material_factors(landing.material, vec4(1.0)));
}
