// What moved since the last frame (src/frame/rays/motion.rs): a bit for each triangle, and boxes around what moved, as it was and as it is.
#ifndef PARTICLES_MOVED
#define PARTICLES_MOVED

// Two bits for each particle, sixteen to a word: links that end on it, and points that it stands for, are to be found again; its list is to be made again.
const uint TOUCHED = 1u;
const uint LIST_TOUCHED = 2u;

// Of a particle whose links are looked at: set if any is traced again; the lower bits count those that go on escaping.
const uint TRACED_AGAIN = 0x10000u;

uint touched_bits(usamplerBuffer touched, uint particle) {
    return texelFetch(touched, int(particle >> 4)).x >> (2u * (particle & 15u)) & 3u;
}

bool has_moved(usamplerBuffer moved_triangles, uint triangle) {
    return (texelFetch(moved_triangles, int(triangle >> 5)).x >> (triangle & 31u) & 1u) != 0u;
}

vec3 low_corner(samplerBuffer boxes, uint number) {
    return texelFetch(boxes, int(2u * number)).xyz;
}

vec3 high_corner(samplerBuffer boxes, uint number) {
    return texelFetch(boxes, int(2u * number + 1u)).xyz;
}

#endif
