#version 460
#include "lib/prelude.glsl"
#include "groups/mirrored.glsl"
#include "groups/particles.glsl"
#include "lib/mirrored.glsl"

// The irradiance of diffuse light at one point that mirrors show, W/m², as pixels have it (irradiance.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer homes;
layout(set = 0, binding = 1) uniform usamplerBuffer list_lengths;
layout(set = 0, binding = 2) uniform usamplerBuffer lists;
layout(set = 0, binding = 3) uniform samplerBuffer irradiance;
layout(set = 0, binding = 4) writeonly buffer Received { vec4 received[]; };

#include "particles/irradiance.glsl"

const uint NO_PARTICLE = 0xFFFFFFFFu;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(mirrored_count, 3).x) {
        return;
    }
    uint home = texelFetch(homes, int(index)).x;
    vec3 found = vec3(0.0);
    if (home != NO_PARTICLE) {
        Surface point = load_mirrored(mirrored_points, index).surface;
        found = irradiance_at(point.position_rs, point.normal, home);
    }
    received[index] = vec4(found, 0.0);
}
