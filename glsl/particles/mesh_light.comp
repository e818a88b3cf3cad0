#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "lib/color.glsl"
#include "lib/octahedral.glsl"
#include "lib/vectors.glsl"

// The irradiance of indirect light at one radiance particle that is found, W/m² (Chang et al. 4.3.2): what the area particles i of its list receive over the area
// that they stand for, which at the edge of a surface is smaller than the disc around it,
//
//   E = Σ ΔA_i E_i / Σ ΔA_i
//
// with their mean normal, and, where normal maps turn surfaces, T/E as gather.comp has it.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint TURNS = 0u;

layout(set = 0, binding = 0) uniform usamplerBuffer numbers;
layout(set = 0, binding = 1) uniform usamplerBuffer found;
layout(set = 0, binding = 2) uniform usamplerBuffer starts;
layout(set = 0, binding = 3) uniform usamplerBuffer entries;
layout(set = 0, binding = 4) uniform samplerBuffer irradiance;  // and the area of each; behind all of them T/E
layout(set = 0, binding = 5) writeonly buffer Received { vec4 received[]; };  // rgb, packed normal; behind all of them T/E

layout(push_constant, scalar) uniform Push {
    uint all_lists;
    uint capacity;    // of what is received
} push;

#include "particles/mesh_found.glsl"

void main() {
    uint invocation = invocation_of_found();
    if (invocation >= texelFetch(found, 3).x) {
        return;
    }
    uint list = push.all_lists != 0u ? texelFetch(numbers, int(invocation)).x : invocation;
    vec4 sum = vec4(0.0);
    vec3 normals = vec3(0.0);
    vec4 tangential = vec4(0.0);  // and the weight
    uint end = min(texelFetch(starts, int(list) + 1).x, uint(textureSize(entries)));
    [[dont_unroll]] for (uint entry = texelFetch(starts, int(list)).x; entry < end; ++entry) {
        int particle = int(texelFetch(entries, int(entry)).x);
        vec4 gathered = texelFetch(irradiance, particle);
        sum += gathered.w * vec4(gathered.rgb, 1.0);
        if (TURNS != 0u) {
            normals += gathered.w * unpack_direction(texelFetch(particle_places, particle).w);
            vec3 turn = texelFetch(irradiance, textureSize(irradiance) / 2 + particle).xyz;
            tangential += gathered.w * luminance(gathered.rgb) * vec4(turn, 1.0);
        }
    }
    vec3 normal = normalize_or(normals, vec3(0.0, 0.0, 1.0));
    received[invocation] = vec4(sum.rgb / max(sum.w, 1e-30), pack_direction_in_float(normal));
    if (TURNS != 0u) {
        received[push.capacity + invocation] = vec4(tangential.xyz / max(tangential.w, 1e-30), 0.0);
    }
}
