// Groups of lights that share a visibility where a cache sees them small (volumes/light.glsl, which this is a part of).
#ifndef VOLUMES_TOGETHER
#define VOLUMES_TOGETHER

shared float lane_given[64];
shared int lane_targets[64];
// Of the first lane of each node: its level, and how much of it is seen.
shared int lane_levels[64];
shared float lane_seen[64];
// First lanes whose nodes ask for a visibility.
shared uint asking[64];
shared uint asking_count;

vec4 sphere_of_node(int group, int level) {
    return texelFetch(light_nodes, first_node_of_level(push.group_count, level) + (group >> (2 * level)));
}

// The largest node around a group that the cache sees under the aperture; 0: the group itself. All groups of a node find the same.
int level_of_group(int group, vec3 position_rs) {
    for (int level = NODE_LEVELS; level > 0; --level) {
        vec4 sphere = sphere_of_node(group, level);
        if (sphere.w <= push.aperture * distance(sphere.xyz, position_rs)) {
            return level;
        }
    }
    return 0;
}

// The light that the ray to a node goes to: of the groups' own ones, drawn by what the groups give.
int target_of_node(uint first, int level, int group) {
    if (level == 0) {
        return lane_targets[first];
    }
    WeightedDraw draw = start_draw(mix_bits(uint(group) + 0x9E3779B9u * uint(level)));
    for (uint lane = first; lane < first + (1u << (2 * level)); ++lane) {
        if (lane_targets[lane] >= 0) {
            offer(draw, lane_targets[lane], lane_given[lane]);
        }
    }
    return draw.drawn;
}

// Of a cache's numbers in each turn an invocation adds up so many at most.
const uint OWN_NUMBERS = 4u;

// Adds what the 64 invocations have found for their groups, in the order in which the turns do it that take groups alone.
void add_found(inout float own[OWN_NUMBERS]) {
    for (uint index = 0u; index < OWN_NUMBERS; ++index) {
        uint place = gl_LocalInvocationIndex + 64u * index;
        [[dont_unroll]] for (uint lane = 0u; lane < 64u && place < uint(TURNS) * NUMBERS; lane += uint(TURNS)) {
            own[index] += found[lane * NUMBERS + place];
        }
    }
}

// All groups, 64 neighbours at a time: leaves in `found` what each turn has found, one after the other; returns for how many visibilities the invocation asked. All invocations must come here.
uint find_nodes(int end, Receiver receiver) {
    uint self = gl_LocalInvocationIndex;
    uint asked = 0u;
    float own[OWN_NUMBERS] = float[](0.0, 0.0, 0.0, 0.0);
    for (int base = push.first_group; base < end; base += 64) {
        int index = base + int(self);
        Target target = Target(-1, 0.0, NOTHING);
        int level = 0;
        if (index < end) {
            LightGroup group = load_light_group(area_light_groups, index);
            level = level_of_group(index, receiver.position_rs);
            if (may_be_above(receiver, group)) {
                target = target_of(group, uint(index), receiver);
            }
        }
        uint first = self & ~((1u << (2 * level)) - 1u);
        lane_given[self] = target.given;
        lane_targets[self] = target.light;
        lane_levels[self] = level;
        if (self == 0u) {
            asking_count = 0u;
        }
        barrier();
        int drawn = self == first ? target_of_node(first, level, index) : -1;
        if (drawn >= 0) {
            asking[atomicAdd(asking_count, 1u)] = self;
        }
        barrier();
        // Which invocation works for which node does not matter.
        lane_targets[self] = drawn;
        barrier();
        if (self < asking_count) {
            uint lane = asking[self];
            LightGroup node = load_light_group(area_light_groups, base + int(lane));
            if (lane_levels[lane] > 0) {
                vec4 sphere = sphere_of_node(base + int(lane), lane_levels[lane]);
                node.center_rs = sphere.xyz;
                node.radius = sphere.w;
            }
            lane_seen[lane] = visibility_of_group(push.rays, node, load_area_light(lane_targets[lane]), receiver.position_rs);
            ++asked;
        }
        barrier();
        put(self * NUMBERS, share_of(target.light >= 0 ? lane_seen[first] : 0.0, target.sums));
        barrier();
        add_found(own);
    }
    barrier();
    for (uint index = 0u; index < OWN_NUMBERS; ++index) {
        uint place = self + 64u * index;
        if (place < uint(TURNS) * NUMBERS) {
            found[place] = own[index];
        }
    }
    barrier();
    return asked;
}

#endif
