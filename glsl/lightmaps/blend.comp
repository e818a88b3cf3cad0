#version 460
#include "lib/prelude.glsl"
#include "lightmaps/changes.glsl"

// What one texel shows of one map moves towards what it gathered. Until it is gathered anew, what comes along its links says what changed since: it is made less by the share
// that is gone, or more by what came. So a light that is switched on arrives everywhere at once, coarsely, and one that is dimmed at its very share.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer gathered;
layout(set = 0, binding = 1) uniform samplerBuffer now;    // what comes along links
layout(set = 0, binding = 2) uniform samplerBuffer then;   // what came when it was gathered
layout(set = 0, binding = 3) uniform usamplerBuffer used;
layout(set = 0, binding = 4) buffer Shown { vec4 shown[]; };

layout(push_constant, scalar) uniform Push {
    uint used_count;
    float share;  // of the way
    uint texel_count;
    uint maps;
} push;

// Share of a texel's light that is no step any more.
const float LEAST = 1.0 / 1024.0;

void main() {
    uint place = gl_GlobalInvocationID.x;
    if (place >= push.maps * push.used_count) {
        return;
    }
    uint map = place / push.used_count;
    int number = int(map * push.texel_count + texelFetch(used, int(place % push.used_count)).x);
    vec3 light = texelFetch(gathered, number).rgb;
    vec3 after = texelFetch(now, number).rgb;
    vec3 before = texelFetch(then, number).rgb;
    // What makes no texel renew itself (rank.comp) shows in none.
    bool same = !is_change(after, before);
    vec3 less = light * after / max(before, vec3(1e-37));
    vec3 goal = same ? light : mix(less, light + (after - before), greaterThan(after, before));
    vec3 last = shown[number].rgb;
    bool near = max3(abs(goal - last)) <= LEAST * max3(goal);
    shown[number] = vec4(near ? goal : mix(last, goal, push.share), 1.0);
}
