// How the photon beside a photon runs: what changes from one to the next along the two axes of the light view (ray differentials, Igehy
// 1999; of photons, Schjøth et al. 2007). The area between neighbours is the surface that a photon stands for where it lands, so that its
// disc is small where a caustic is sharp, and large where it is faint.
//
// A texel of `beams` has four floats: 3 texels a ray, 5 an arrival, whose last two hold the change of the shading normal.
#ifndef PHOTONS_BEAM
#define PHOTONS_BEAM

#include "lib/vectors.glsl"

const uint RAY_BEAM_TEXELS = 3u;
const uint ARRIVAL_BEAM_TEXELS = 5u;

struct Beam {
    vec3 origin_u;     // m
    vec3 origin_v;
    vec3 direction_u;  // of the unit direction
    vec3 direction_v;
};

Beam load_beam(samplerBuffer beams, int first) {
    vec4 a = texelFetch(beams, first);
    vec4 b = texelFetch(beams, first + 1);
    vec4 c = texelFetch(beams, first + 2);
    return Beam(a.xyz, vec3(a.w, b.xy), vec3(b.zw, c.x), c.yzw);
}

vec4[3] pack_beam(Beam beam) {
    return vec4[3](
        vec4(beam.origin_u, beam.origin_v.x), vec4(beam.origin_v.yz, beam.direction_u.xy),
        vec4(beam.direction_u.z, beam.direction_v));
}

// D = I − 2(I·N)N.
vec3 reflected_change(vec3 direction, vec3 normal, vec3 direction_change, vec3 normal_change) {
    float along = dot(direction, normal);
    float along_change = dot(direction_change, normal) + dot(direction, normal_change);
    return direction_change - 2.0 * (along * normal_change + along_change * normal);
}

// D = ηI + (ηc − c_t)N, c = −I·N, c_t = √(1 − η²(1 − c²)); N on the arriving side.
vec3 refracted_change(vec3 direction, vec3 normal, float eta, vec3 direction_change, vec3 normal_change) {
    float cosine = max(-dot(direction, normal), 1e-3);
    float beyond = sqrt(max(1.0 - eta * eta * (1.0 - cosine * cosine), 1e-4));
    float cosine_change = -(dot(direction_change, normal) + dot(direction, normal_change));
    return eta * direction_change + (eta * cosine - beyond) * normal_change + (eta - eta * eta * cosine / beyond) * cosine_change * normal;
}

// The surface between neighbours across the ray, m². Where a beam is focused to a line, neighbours on either side of it cross: the
// square of its longer side times FOCUS is the least that counts. `spread`: what the lobes add by chance, spread over all photons, m².
float beam_area(Beam beam, vec3 direction, float spread) {
    const float FOCUS = 0.1;
    vec3 u = beam.origin_u - dot(beam.origin_u, direction) * direction;
    vec3 v = beam.origin_v - dot(beam.origin_v, direction) * direction;
    float area = dot(cross(u, v), direction);
    float longer = FOCUS * max(dot(u, u), dot(v, v));
    return sqrt(area * area + longer * longer + spread * spread);
}

#endif
