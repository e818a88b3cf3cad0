#version 460
#include "lib/prelude.glsl"
#include "groups/mirrored.glsl"
#include "groups/particles.glsl"
#include "lib/mirrored.glsl"

// The irradiance of diffuse light at one point that mirrors show, W/m², as pixels have it (mesh_interpolate.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer spots;
layout(set = 0, binding = 1) uniform usamplerBuffer tessellation;
layout(set = 0, binding = 2) uniform usamplerBuffer particle_marks;
layout(set = 0, binding = 3) uniform usamplerBuffer marked_before;
layout(set = 0, binding = 4) uniform samplerBuffer radiance_particles;
layout(set = 0, binding = 5) uniform usamplerBuffer list_lengths;
layout(set = 0, binding = 6) uniform usamplerBuffer lists;
layout(set = 0, binding = 7) uniform samplerBuffer irradiance;
layout(set = 0, binding = 8) writeonly buffer Received { vec4 received[]; };

#include "particles/mesh_interpolate.glsl"

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= texelFetch(mirrored_count, 3).x) {
        return;
    }
    Surface point = load_mirrored(mirrored_points, index).surface;
    received[index] = vec4(irradiance_at_spot(texelFetch(spots, int(index)), point.position_rs, point.normal), 0.0);
}
