// How the photon beside a photon runs: what changes from one to the next along the two axes of the light view (ray differentials, Igehy
// 1999; of photons, Schjøth et al. 2007). What lies between neighbours is the surface that a photon stands for where it lands: its disc is
// small where a caustic is sharp and large where it is faint, and an ellipse along the line to which a beam is focused.
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

// Directions in the lobe of a surface this smooth are not drawn: the photon takes their mean, and its disc is as wide as they spread. Between the two
// bounds there is some of both.
const float SMOOTH_ALPHA = 0.02;
const float ROUGH_ALPHA = 0.1;

// 1: the disc stands for the whole lobe; 0: for none of it.
float lobe_in_disc(float alpha) {
    return 1.0 - smoothstep(SMOOTH_ALPHA, ROUGH_ALPHA, alpha);
}

// The standard deviation of the Gaussian that stands for a lobe's directions in one dimension, over α. GGX has none of its own: half of its slopes are
// below α, which alone would make it 1.7, as a mirrored direction turns by twice the angle, but its tail is long. This one has the least error in
// the ring's caustic.
const float LOBE_SPREAD = 2.4;

// An ellipse in the plane of `normal`: its larger radius, and the smaller one with its direction.
struct Ellipse {
    float larger;
    vec4 smaller;
};

// With u and v the way to the neighbours in the plane, β what the lobe adds there,
//
//   h² = 8·(C₀²(u² + v²)/4 + β²)      in each direction: eight times the variance of the Gaussian disc's kernel
//
// A Gaussian whose deviation is half the way to the next photon adds up to an even sum over a lattice. `drawn` is the share of β² that chance
// decides, over all photons: 32·C₀²β²/N makes four photons count at a point.
Ellipse ellipse_of(Beam beam, vec3 normal, float scale, float disc_spread, float drawn_spread) {
    float side = normal.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (side + normal.z);
    float b = normal.x * normal.y * a;
    vec3 x_axis = vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x);
    vec3 y_axis = vec3(b, side + normal.y * normal.y * a, -normal.y);
    vec2 u = vec2(dot(beam.origin_u, x_axis), dot(beam.origin_u, y_axis));
    vec2 v = vec2(dot(beam.origin_v, x_axis), dot(beam.origin_v, y_axis));
    float between = 2.0 * scale * scale;
    float round = 8.0 * disc_spread * disc_spread + 32.0 * scale * scale * drawn_spread * drawn_spread;
    float xx = between * (u.x * u.x + v.x * v.x) + round;
    float yy = between * (u.y * u.y + v.y * v.y) + round;
    float xy = between * (u.x * u.y + v.x * v.y);
    float middle = 0.5 * (xx + yy);
    float off = 0.5 * (xx - yy);
    float apart = sqrt(off * off + xy * xy);
    // The direction of the larger radius has half the angle of (off, xy).
    vec2 doubled = apart > 1e-20 ? vec2(off, xy) / apart : vec2(1.0, 0.0);
    float cosine = sqrt(max(0.5 + 0.5 * doubled.x, 0.0));
    float sine = (doubled.y < 0.0 ? -1.0 : 1.0) * sqrt(max(0.5 - 0.5 * doubled.x, 0.0));
    return Ellipse(sqrt(middle + apart), vec4(cosine * y_axis - sine * x_axis, sqrt(max(middle - apart, 0.0))));
}

#endif
