// A row of bits, the bits before each of its words (mesh_bits.comp), and by these the place of a set bit among all that are set.
#ifndef PARTICLES_MESH_FOUND
#define PARTICLES_MESH_FOUND

bool is_marked(usamplerBuffer marks, uint number) {
    return (texelFetch(marks, int(number >> 5)).x >> (number & 31u) & 1u) != 0u;
}

uint place_among_marked(usamplerBuffer marks, usamplerBuffer starts, uint number) {
    int word = int(number >> 5);
    uint below = texelFetch(marks, word).x & ((1u << (number & 31u)) - 1u);
    return texelFetch(starts, word).x + uint(bitCount(below));
}

// Of a dispatch by the words that mesh_bits.comp leaves.
uint invocation_of_found() {
    return gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
}

#endif
