// Where the eye or a mirror's ray sees a tessellated surface: a texel with the triangle and its side, the subtriangle among the triangle's, the weights of its
// second and third point, and the subtriangle among all. A place that none of its radiance particles sees is NO_SPOT and the area particle that is read instead.
#ifndef PARTICLES_MESH_SPOTS
#define PARTICLES_MESH_SPOTS

const uint NO_SPOT = 0xFFFFFFFFu;
const uint NO_AREA_PARTICLE = 0xFFFFFFFFu;
const uvec4 NOTHING_SEEN = uvec4(NO_SPOT, NO_AREA_PARTICLE, 0u, 0u);

vec3 weights_of_spot(uvec4 spot) {
    vec2 weights = unpackUnorm2x16(spot.z);
    return vec3(1.0 - weights.x - weights.y, weights);
}

#endif
