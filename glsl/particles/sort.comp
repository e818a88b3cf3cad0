#version 460
#include "lib/prelude.glsl"

// Puts one particle to its place among those of its bucket, in the order in which they were made: the same every time.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer order;
layout(set = 0, binding = 1) uniform usamplerBuffer starts;
layout(set = 0, binding = 2) uniform usamplerBuffer places;
layout(set = 0, binding = 3) uniform usamplerBuffer faces;
layout(set = 0, binding = 4) writeonly buffer SortedPlaces { uvec4 sorted_places[]; };
layout(set = 0, binding = 5) writeonly buffer SortedFaces { uint sorted_faces[]; };

layout(push_constant, scalar) uniform Push { uint particle_count; } push;

void main() {
    uint particle = gl_GlobalInvocationID.x;
    if (particle >= push.particle_count) {
        return;
    }
    uvec2 face = texelFetch(faces, int(particle)).xy;
    uint first = texelFetch(starts, int(face.y)).x;
    uint end = texelFetch(starts, int(face.y) + 1).x;
    uint place = first;
    [[dont_unroll]] for (uint other = first; other < end; ++other) {
        place += texelFetch(order, int(other)).x < particle ? 1u : 0u;
    }
    sorted_places[place] = texelFetch(places, int(particle));
    sorted_faces[place] = face.x;
}
