// The light caches of a frame (src/frame/caches/): how many there are, where they lie, and where pixels find them.
// group: bindings 152 to 159
#ifndef GROUPS_LIGHT_CACHES
#define GROUPS_LIGHT_CACHES

#include "caches/cascades.glsl"

layout(set = 0, binding = 152) uniform CascadeBlock { Cascades cascades; };
layout(set = 0, binding = 153) uniform usamplerBuffer cache_head;       // word 3: how many
layout(set = 0, binding = 154) uniform samplerBuffer cache_positions;   // render space
layout(set = 0, binding = 155) uniform usamplerBuffer cache_addresses;  // caches/cascades.glsl

vec3 position_of_cache(uint index) {
    return texelFetch(cache_positions, int(index)).xyz;
}

#endif
