#version 460
#include "lib/prelude.glsl"
#include "lib/vectors.glsl"

// The irradiance of indirect light at one particle that is used, W/m² (Chang et al. 4.3.1): its links are spread by the cosine, so
//
//   E = ∫ L cosθ dω ≈ π/N Σ_k L(end of link k)

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer used;
layout(set = 0, binding = 1) uniform usamplerBuffer links;
layout(set = 0, binding = 2) uniform samplerBuffer radiance;
layout(set = 0, binding = 3) uniform samplerBuffer matter;
layout(set = 0, binding = 4) buffer Irradiance { vec4 irradiance[]; };  // and the area of each, m²

layout(push_constant, scalar) uniform Push {
    uint first;       // particle of the chunk
    uint count;
    uint link_count;
} push;

#include "particles/gathered.glsl"

void main() {
    uint own = gl_GlobalInvocationID.x;
    if (own >= push.count || texelFetch(used, int(push.first + own)).x == 0u) {
        return;
    }
    irradiance[push.first + own] = vec4(gathered(own, push.link_count), texelFetch(matter, int(push.first + own)).w);
}
