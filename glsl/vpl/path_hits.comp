#version 460
#include "lib/prelude.glsl"
#include "groups/scene_rays.glsl"
#include "groups/vpl_visibility.glsl"
#include "lib/microfacet.glsl"
#include "lib/sobol.glsl"
#include "lib/vpl.glsl"
#include "vpl/paths.glsl"

// One invocation sends the light of one VPL on in a random direction, cosine-distributed as a Lambertian surface reflects it, and finds
// what it meets (Keller 1997): distance [m], barycentric coordinates of corners 1 and 2, bits of the triangle's number.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer vpls;
layout(set = 0, binding = 1) writeonly buffer Hits { vec4 hits[]; };

layout(push_constant, scalar) uniform Push { Bounce bounce; } push;

#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"

void main() {
    uint child = gl_GlobalInvocationID.x;
    if (child >= push.bounce.child_count) {
        return;
    }
    vec4 random = sobol_sample(sobol, child, seed_of_bounce(push.bounce));
    int parent = int(parent_of_path(push.bounce, child, random.z));
    Vpl vpl = unpack_vpl(texelFetch(vpls, 2 * parent), texelFetch(vpls, 2 * parent + 1));
    vec4 found = vec4(0.0, 0.0, 0.0, uintBitsToFloat(NO_TRIANGLE));
    if (max3(vpl.strength) > 0.0) {
        float radius = sqrt(random.x);
        float azimuth = 2.0 * PI * random.y;
        vec3 local = vec3(radius * cos(azimuth), radius * sin(azimuth), sqrt(max(1.0 - random.x, 1e-7)));
        vec3 normal = normalize(vpl.normal);
        vec3 origin = lifted_vpl(vpl) + vpl_rays.shift;
        Hit hit = closest_hit(origin, to_world(frame_around(normal), local), 3e38);
        found = vec4(hit.distance, hit.barycentric, uintBitsToFloat(hit.triangle));
    }
    hits[child] = found;
}
