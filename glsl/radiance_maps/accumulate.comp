#version 460
#include "lib/prelude.glsl"
#include "groups/light_caches.glsl"
#include "groups/surface.glsl"
#include "radiance_maps/of_map.glsl"
#include "radiance_maps/map.glsl"

// One group a map: the mean of its light and of what frames before found at the same node (Reich 2015, section 6.3, names it), each of which drew its lights anew from what the
// light views see. After n frames the next one counts by 1/(n + 1), from the last of `most_frames` on by one over these.
//
// Where a map was kept, nodes know by their place in the whole grid, wrapped around into a volume: a cache that comes into view begins at n = 0, one that leaves is forgotten. A
// map turns with the way to the eye: what the last one had in a direction of light is looked up where it was, as radiance, E/W.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer map_head;
layout(set = 0, binding = 1) uniform usamplerBuffer map_caches;
layout(set = 0, binding = 2) uniform usamplerBuffer nodes;  // of each cache its address
layout(set = 0, binding = 3) uniform samplerBuffer tables;  // of each texel the middle h and W
// Of the last frame: of each place of the wrapped volumes its map's number plus one; of each map the way to the eye and how many frames it is of, its node and cascade; the finest levels.
layout(set = 0, binding = 4) uniform usamplerBuffer last_slots;
layout(set = 0, binding = 5) uniform samplerBuffer last_places;
layout(set = 0, binding = 6) uniform samplerBuffer last_maps;
layout(set = 0, binding = 7) coherent buffer MapBlock { vec4 maps[]; };
layout(set = 0, binding = 8) writeonly buffer SlotBlock { uint next_slots[]; };
layout(set = 0, binding = 9) writeonly buffer PlaceBlock { vec4 next_places[]; };
layout(set = 0, binding = 10) writeonly buffer NextBlock { vec4 next_maps[]; };

layout(push_constant, scalar) uniform Push {
    uint capacity;
    float most_frames;
} push;

#include "radiance_maps/levels.glsl"

const int FINEST = MAP_SIDE * MAP_SIDE;

// Where a node of the whole grid is kept.
int wrapped_address(int cascade, ivec3 node) {
    int side = cascades.resolution;
    ivec3 place = (node % side + side) % side;
    return ((cascade * side + place.z) * side + place.y) * side + place.x;
}

// The node of an address and its cascade.
ivec4 node_of_address(uint address) {
    int side = cascades.resolution;
    int index = int(address);
    int cascade = cascade_of_address(cascades, address);
    ivec3 in_volume = ivec3(index % side, index / side % side, index / (side * side) % side);
    return ivec4(in_volume + ivec3(first_node(cascades, cascade)), cascade);
}

// What the last map, seen in its own frame, had in the directions of a texel.
vec3 light_before(Frame now, Frame then, int map, int texel) {
    vec4 known = texelFetch(tables, texel);
    vec3 toward = to_world(now, 2.0 * known.z * known.xyz - vec3(0.0, 0.0, 1.0));
    Corners corners = corners_of(square_of_direction(half_direction(then, toward)), 0);
    vec3 light = vec3(0.0);
    float angle = 0.0;
    [[dont_unroll]] for (int corner = 0; corner < 4; ++corner) {
        light += corners.weights[corner] * texelFetch(last_maps, map * FINEST + corners.texels[corner]).rgb;
        angle += corners.weights[corner] * texelFetch(tables, corners.texels[corner]).w;
    }
    return light * (known.w / max(angle, 1e-9));
}

void main() {
    uint map = map_of_group();
    if (map >= min(texelFetch(map_head, 3).x, push.capacity)) {
        return;
    }
    first_texel = map * uint(MAP_TEXELS);
    uint cache = texelFetch(map_caches, int(map)).x;
    ivec4 node = node_of_address(texelFetch(nodes, int(cache)).x);
    int slot = wrapped_address(node.w, node.xyz);
    uint last = texelFetch(last_slots, slot).x - 1u;
    bool known = last < push.capacity && texelFetch(last_places, 2 * int(last) + 1) == vec4(node);
    vec4 place = known ? texelFetch(last_places, 2 * int(last)) : vec4(0.0, 0.0, 1.0, 0.0);
    vec3 to_eye = direction_to_eye(camera, position_of_cache(cache));
    Frame now = frame_around(to_eye);
    Frame then = frame_around(place.xyz);
    float frames = min(place.w + 1.0, push.most_frames);
    for (int texel = int(gl_LocalInvocationIndex); texel < FINEST; texel += 64) {
        vec3 light = maps[first_texel + uint(texel)].rgb;
        if (known) {
            light = mix(light_before(now, then, int(last), texel), light, 1.0 / frames);
        }
        maps[first_texel + uint(texel)] = vec4(light, 0.0);
        next_maps[map * uint(FINEST) + uint(texel)] = vec4(light, 0.0);
    }
    if (gl_LocalInvocationIndex == 0u) {
        next_slots[slot] = map + 1u;
        next_places[2u * map] = vec4(to_eye, frames);
        next_places[2u * map + 1u] = vec4(node);
    }
    finish_level();
    sum_levels();
}
