#version 460
#include "lib/prelude.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "lib/vpl.glsl"
#include "regions/planes.glsl"
#include "regions/regions.glsl"

// Irradiance E [W/m²] of two valid regions, neighbours on their list: the sum over all VPLs at the regions' receivers (vpl/gather.glsl). The
// alpha of what it writes is the receiver's normal, packed, which is above 0.

layout(local_size_x = 64) in;

layout(set = 0, binding = 2) uniform samplerBuffer vpls;
layout(set = 0, binding = 3) uniform usamplerBuffer list;
layout(set = 0, binding = 4, rgba32f) uniform image2D irradiance;

#include "vpl/gather.glsl"
#include "vpl/receivers.glsl"

layout(push_constant, scalar) uniform Push {
    ivec2 size;         // pixels
    int level_count;
    VplRange range;
} push;

// The number `index` of the list as a texel of the flattened image.
ivec2 listed_texel(uint index) {
    uint texel = texelFetch(list, int(4u + index)).x;
    return ivec2(texel & 0xFFFFu, texel >> 16);
}

void store_sum(ivec2 texel, vec3 sum, vec3 normal) {
    imageStore(irradiance, texel, vec4(imageLoad(irradiance, texel).rgb + sum, pack_direction_in_float(normal)));
}

void main() {
    uint count = texelFetch(list, 3).x;
    uint row = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uint index = 2u * (gl_GlobalInvocationID.y * row + gl_GlobalInvocationID.x);
    if (index >= count) {
        return;
    }
    bool has_second = index + 1u < count;
    ivec2 texel_a = listed_texel(index);
    ivec2 texel_b = listed_texel(has_second ? index + 1u : index);
    Receiver a = receiver_of_region(region_at(push.size, texel_a, push.level_count), push.size);
    Receiver b = receiver_of_region(region_at(push.size, texel_b, push.level_count), push.size);
    vec3 irradiance_a;
    vec3 irradiance_b;
    gather(push.range, a, b, irradiance_a, irradiance_b);
    store_sum(texel_a, irradiance_a, a.normal);
    if (has_second) {
        store_sum(texel_b, irradiance_b, b.normal);
    }
}
