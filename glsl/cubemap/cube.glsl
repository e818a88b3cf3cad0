// A cube map in a buffer: levels follow each other, of each six faces, +x, −x, +y, −y, +z, −z, row by row. On face a of the axis k a direction has 1 or −1 along k and
// the coordinates u, v from −1 to 1 along the axes that follow k in turn. The texel in the middle of which a direction lies is the nearest one; between texels light is
// bilinear, across edges of faces too.
#ifndef CUBEMAP_CUBE
#define CUBEMAP_CUBE

#include "lib/vectors.glsl"

// Of a face, a power of two.
layout(constant_id = 0) const uint CUBE_SIDE = 128u;

// What lobes of α = 2^(l+1)/CUBE_SIDE take, up to α = 1.
const uint LOBE_LEVELS = CUBE_SIDE == 32u ? 5u : CUBE_SIDE == 64u ? 6u : CUBE_SIDE == 128u ? 7u : CUBE_SIDE == 256u ? 8u : 9u;
const uint LEAST_LOBE_SIDE = 8u;
// Means over squares of texels: the map itself, and levels above it down to faces of 4².
const uint BOX_LEVELS = LOBE_LEVELS - 1u;

uint side_of_boxes(uint level) {
    return CUBE_SIDE >> level;
}

uint first_of_boxes(uint level) {
    uint side = side_of_boxes(level);
    return 8u * (CUBE_SIDE * CUBE_SIDE - side * side);
}

uint side_of_lobes(uint level) {
    return max(CUBE_SIDE >> level, LEAST_LOBE_SIDE);
}

float alpha_of_lobes(uint level) {
    return float(2u << level) / float(CUBE_SIDE);
}

uint first_of_lobes(uint level) {
    // Levels that have halved sides, and those of the least.
    uint halved = min(level, LOBE_LEVELS - 3u);
    uint side = CUBE_SIDE >> halved;
    return 8u * (CUBE_SIDE * CUBE_SIDE - side * side) + (level - halved) * 6u * LEAST_LOBE_SIDE * LEAST_LOBE_SIDE;
}

// Its largest component is 1.
vec3 direction_of_face(uint face, vec2 place) {
    float along = (face & 1u) == 0u ? 1.0 : -1.0;
    uint axis = face >> 1;
    return axis == 0u ? vec3(along, place) : axis == 1u ? vec3(place.y, along, place.x) : vec3(place, along);
}

vec2 place_on_face(uint face, vec3 direction) {
    uint axis = face >> 1;
    return axis == 0u ? direction.yz / abs(direction.x) : axis == 1u ? direction.zx / abs(direction.y) : direction.xy / abs(direction.z);
}

uint face_of(vec3 direction) {
    vec3 size = abs(direction);
    uint axis = size.x >= max(size.y, size.z) ? 0u : size.y >= size.z ? 1u : 2u;
    float along = axis == 0u ? direction.x : axis == 1u ? direction.y : direction.z;
    return 2u * axis + (along < 0.0 ? 1u : 0u);
}

// The middle of a texel of a level.
vec3 direction_of_texel(uint texel, uint side) {
    uint in_face = texel % (side * side);
    vec2 place = (vec2(in_face % side, in_face / side) + 0.5) * (2.0 / float(side)) - 1.0;
    return direction_of_face(texel / (side * side), place);
}

// Its solid angle over that of a texel in the middle of a face.
float relative_solid_angle(vec3 direction) {
    float inverse = inversesqrt(dot(direction, direction));
    return inverse * inverse * inverse;
}

uint nearest_texel(vec3 direction, uint side) {
    uint face = face_of(direction);
    vec2 place = (place_on_face(face, direction) * 0.5 + 0.5) * float(side);
    uvec2 column_row = uvec2(clamp(ivec2(place), ivec2(0), ivec2(side - 1u)));
    return (face * side + column_row.y) * side + column_row.x;
}

// Light, and in the fourth component what a face holds by depth: 1 over the distance along its axis, which is linear in u and v on a plane.
vec4 bilinear(samplerBuffer map, uint first, uint side, vec3 direction) {
    uint face = face_of(direction);
    vec2 place = (place_on_face(face, direction) * 0.5 + 0.5) * float(side) - 0.5;
    ivec2 low = clamp(ivec2(floor(place)), ivec2(-1), ivec2(side) - 1);
    vec2 along = clamp(place - vec2(low), 0.0, 1.0);
    vec4 sum = vec4(0.0);
    for (int corner = 0; corner < 4; ++corner) {
        ivec2 column_row = low + ivec2(corner & 1, corner >> 1);
        vec2 shares = mix(1.0 - along, along, vec2(corner & 1, corner >> 1));
        // Beyond the edge lies another face.
        vec3 middle = direction_of_face(face, (vec2(column_row) + 0.5) * (2.0 / float(side)) - 1.0);
        vec4 texel = texelFetch(map, int(first + nearest_texel(middle, side)));
        texel.w *= max3(abs(middle));
        sum += shares.x * shares.y * texel;
    }
    return sum;
}

// The greatest fourth component of the four texels around: what is nearest.
float greatest_around(samplerBuffer map, uint side, vec3 direction) {
    uint face = face_of(direction);
    ivec2 low = ivec2(floor((place_on_face(face, direction) * 0.5 + 0.5) * float(side) - 0.5));
    float greatest = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        ivec2 column_row = low + ivec2(corner & 1, corner >> 1);
        vec3 middle = direction_of_face(face, (vec2(column_row) + 0.5) * (2.0 / float(side)) - 1.0);
        greatest = max(greatest, texelFetch(map, int(nearest_texel(middle, side))).w * max3(abs(middle)));
    }
    return greatest;
}

#endif
