// Unit vectors in two numbers: the octahedron |x|+|y|+|z| = 1 unfolded onto the square [-1,1]².
// Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors".
// The axes map to the centre, the edges' middles and the corners, all of which both packings below hold exactly.
#ifndef LIB_OCTAHEDRAL
#define LIB_OCTAHEDRAL

vec2 octahedral_encode(vec3 direction) {
    vec2 square = direction.xy / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    vec2 signs = vec2(square.x >= 0.0 ? 1.0 : -1.0, square.y >= 0.0 ? 1.0 : -1.0);
    return direction.z >= 0.0 ? square : (1.0 - abs(square.yx)) * signs;
}

// The point of the octahedron, not yet of unit length: its components' absolute values sum to one.
vec3 octahedral_decode_unnormalized(vec2 square) {
    float z = 1.0 - abs(square.x) - abs(square.y);
    float fold = max(-z, 0.0);
    return vec3(square.x + (square.x >= 0.0 ? -fold : fold), square.y + (square.y >= 0.0 ? -fold : fold), z);
}

vec3 octahedral_decode(vec2 square) {
    return normalize(octahedral_decode_unnormalized(square));
}

// 2 × snorm16, at most 7·10⁻⁵ rad off.
uint pack_direction(vec3 direction) {
    return packSnorm2x16(octahedral_encode(direction));
}

vec3 unpack_direction(uint bits) {
    return octahedral_decode(unpackSnorm2x16(bits));
}

// The same in 31 bits that are always those of a positive, normal, finite float, so that the word survives buffers and
// caches that flush denormals or quieten NaNs: x in 16 bits, y in 15 bits whose top eight, the exponent, are neither 0 nor 255.
float pack_direction_in_float(vec3 direction) {
    vec2 square = octahedral_encode(direction);
    uint x = uint(32768 + int(round(square.x * 32767.0)));
    uint y = uint(16384 + int(round(square.y * 16255.0)));
    return uintBitsToFloat(y << 16 | x);
}

vec3 unpack_direction_in_float_unnormalized(float word) {
    uint bits = floatBitsToUint(word);
    vec2 square = vec2((float(bits & 0xFFFFu) - 32768.0) / 32767.0, (float(bits >> 16) - 16384.0) / 16255.0);
    return octahedral_decode_unnormalized(square);
}

#endif
