#version 460
#include "lib/prelude.glsl"
#include "lib/voxel_cones.glsl"

// The visibility of one group of lights from one point, samples that it took, and steps that it skipped.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform samplerBuffer cones;  // three a cone: point and radius · middle of the group · its normal
layout(set = 0, binding = 1) writeonly buffer AnswerBlock { vec4 answers[]; };

layout(push_constant, scalar) uniform Push { uint count; } push;

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.count) {
        return;
    }
    vec4 point = texelFetch(cones, 3 * int(number));
    vec3 center = texelFetch(cones, 3 * int(number) + 1).xyz;
    vec3 normal = texelFetch(cones, 3 * int(number) + 2).xyz;
    ConeWork work = ConeWork(0u, 0u);
    float visibility = cone_visibility(point.xyz, center, point.w, normal, work);
    answers[number] = vec4(visibility, float(work.samples), float(work.skipped), 0.0);
}
