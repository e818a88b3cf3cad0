// The body of gather_regions*.comp: irradiance of two regions of the list. A file that defines `vpl_visibility` binds what it needs for it
// from 8 on.

layout(local_size_x = 64) in;

layout(set = 0, binding = 6) uniform usamplerBuffer list;
layout(set = 0, binding = 7, rgba32f) writeonly uniform image2D irradiance;

layout(push_constant, scalar) uniform Push {
    ivec2 size;         // pixels
    int level_count;
    uint vpl_count;
} push;

// The number `index` of the list as a texel of the flattened image.
ivec2 listed_texel(uint index) {
    uint texel = texelFetch(list, int(4u + index)).x;
    return ivec2(texel & 0xFFFFu, texel >> 16);
}

void main() {
    uint count = texelFetch(list, 3).x;
    uint index = 2u * gl_GlobalInvocationID.x;
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
    gather(int(push.vpl_count), a, b, irradiance_a, irradiance_b);
    imageStore(irradiance, texel_a, vec4(irradiance_a, pack_direction_in_float(a.normal)));
    if (has_second) {
        imageStore(irradiance, texel_b, vec4(irradiance_b, pack_direction_in_float(b.normal)));
    }
}
