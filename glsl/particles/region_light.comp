#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "particles/region_point.glsl"

// The irradiance of indirect light at one region of the picture, W/m² (irradiance.glsl), with the packed normal, which is above 0.

layout(local_size_x = 64) in;

layout(set = 0, binding = 2) uniform usamplerBuffer homes;
layout(set = 0, binding = 3) uniform usamplerBuffer list_lengths;
layout(set = 0, binding = 4) uniform usamplerBuffer lists;
layout(set = 0, binding = 5) uniform samplerBuffer irradiance;  // and the area of each
layout(set = 0, binding = 6, rgba32f) uniform image2D regions_irradiance;

layout(push_constant, scalar) uniform Push {
    vec3 shift;
    ivec2 size;       // pixels
    int level_count;
} push;

#include "particles/irradiance.glsl"

const uint NO_PARTICLE = 0xFFFFFFFFu;

void main() {
    uint index = region_of_invocation();
    RegionPoint point = region_point(index, push.size, push.level_count);
    if (point.texel.x < 0) {
        return;
    }
    uint home = texelFetch(homes, int(index)).x;
    vec3 received = home != NO_PARTICLE ? irradiance_at(point.position_rs + push.shift, point.normal, home) : vec3(0.0);
    imageStore(regions_irradiance, point.texel, vec4(received, pack_direction_in_float(point.normal)));
}
