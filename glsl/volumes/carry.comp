#version 460
#include "lib/prelude.glsl"
#include "groups/light_caches.glsl"
#include "caches/asks.glsl"
#include "lib/sobol.glsl"
#include "volumes/numbers.glsl"

// One invocation a cache: either it takes over the light that the cache of its node had in the last frame, or it lists the cache to be lit anew (volumes/light.glsl). The thesis names rates by
// distance in section 6.3. Caches of cascade c take turns of min(2^c, period) frames, each by a number of its node's own, so that every frame has about as much to do. A cache is lit anew besides
// where there was none in the last frame, and where what pixels ask for has moved it since it was lit.
//
// Nodes are found again by their numbers from the anchor, wrapped around to the size of a volume: a word of `table` has the number of the cache plus one. Where two nodes share a word, they are
// a volume apart, and the place tells.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer nodes;          // addresses
layout(set = 0, binding = 1) uniform usamplerBuffer last_table;
layout(set = 0, binding = 2) uniform samplerBuffer last_places;     // where a cache was lit, and its cell
layout(set = 0, binding = 3) uniform samplerBuffer last_light;
layout(set = 0, binding = 4) writeonly buffer TableBlock { uint table[]; };
layout(set = 0, binding = 5) writeonly buffer PlaceBlock { vec4 places[]; };
layout(set = 0, binding = 6) writeonly buffer LightBlock { float light[]; };
// Words 0 to 2: groups of GROUP_CACHES caches, in rows of ROW_GROUPS; word 3: how many; from word 4 on the caches.
layout(set = 0, binding = 7) buffer DueBlock { uint due[]; };

layout(push_constant, scalar) uniform Push {
    uint capacity;
    uint frame;
    uint period;  // 0: no cache's turn comes
} push;

// How far a cache may move, in cells, until it counts as another one.
const float LONGEST_WAY = 0.25;

void main() {
    uint cache = gl_GlobalInvocationID.x;
    if (cache >= min(texelFetch(cache_head, 3).x, push.capacity)) {
        return;
    }
    uint address = texelFetch(nodes, int(cache)).x;
    int cascade = cascade_of_address(cascades, address);
    uint word = address_of(cascades, cascade, node_of_address(cascades, address) & (cascades.resolution - 1));
    vec4 place = texelFetch(cache_positions, int(cache));
    uint before = texelFetch(last_table, int(word)).x - 1u;
    vec4 lit_at = before < push.capacity ? texelFetch(last_places, int(before)) : vec4(0.0);
    bool stays = lit_at.w == place.w && distance(lit_at.xyz, place.xyz) <= LONGEST_WAY * place.w;
    uint turns = min(1u << uint(cascade), push.period);
    bool has_turn = turns > 0u && (push.frame + mix_bits(word)) % turns == 0u;
    table[word] = cache + 1u;
    places[cache] = stays && !has_turn ? lit_at : place;
    if (stays && !has_turn) {
        [[dont_unroll]] for (int texel = 0; texel < TEXELS; ++texel) {
            vec4 four = texelFetch(last_light, int(before) * TEXELS + texel);
            for (int number = 0; number < 4; ++number) {
                light[4 * (int(cache) * TEXELS + texel) + number] = four[number];
            }
        }
        return;
    }
    uint number = atomicAdd(due[3], 1u);
    uint group = number / GROUP_CACHES;
    atomicMax(due[0], min(group + 1u, ROW_GROUPS));
    atomicMax(due[1], group / ROW_GROUPS + 1u);
    atomicMax(due[2], 1u);
    due[4u + number] = cache;
}
