#version 460
#include "lib/prelude.glsl"

// One group lists the texels that a frame renews: those of the highest levels, of the last level that has room the first ones, as many as there may be.

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) uniform usamplerBuffer used;
layout(set = 0, binding = 1) uniform usamplerBuffer levels;
layout(set = 0, binding = 2) uniform usamplerBuffer histogram;
layout(set = 0, binding = 3) writeonly buffer List { uint list[]; };
layout(set = 0, binding = 4) writeonly buffer Head { uint head[]; };  // groups of 64 in three words, texels

layout(push_constant, scalar) uniform Push {
    uint used_count;
    uint most;
} push;

const uint LEVELS = 1024u;

shared uint least_level;  // the last one that has room
shared uint above;        // texels of higher ones

#define SCAN_TYPE uvec2

uvec2 scan_term(uint place) {
    uint level = texelFetch(levels, int(place)).x;
    return uvec2(level > least_level ? 1u : 0u, level == least_level ? 1u : 0u);
}

void scan_store(uint place, uvec2 before) {
    uint level = texelFetch(levels, int(place)).x;
    uint at = level > least_level ? before.x : above + before.y;
    if (level >= least_level && at < push.most) {
        list[at] = texelFetch(used, int(place)).x;
    }
}

#include "lib/prefix_scan.glsl"

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        uint total = 0u;
        uint level = LEVELS - 1u;
        [[dont_unroll]] for (; level > 1u; --level) {
            uint more = texelFetch(histogram, int(level)).x;
            if (total + more >= push.most) {
                break;
            }
            total += more;
        }
        least_level = level;
        above = total;
    }
    barrier();
    uvec2 before = scan_sum_before_run(push.used_count);
    scan_store_run(push.used_count, before);
    if (gl_LocalInvocationIndex == 0u) {
        uint count = min(above + scan_total().y, push.most);
        head[0] = (count + 63u) / 64u;
        head[1] = 1u;
        head[2] = 1u;
        head[3] = count;
    }
}
