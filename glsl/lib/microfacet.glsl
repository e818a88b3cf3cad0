// Microfacet lobes in the frame of the shading normal (z), without Fresnel: densities, sampling and shadowing of GGX.
// Walter et al. 2007; Heitz 2014 (height-correlated Smith); Dupuy & Benyoub 2023 (sampling of visible normals by spherical caps).
#ifndef LIB_MICROFACET
#define LIB_MICROFACET

#include "lib/vectors.glsl"

struct Frame {
    vec3 tangent;
    vec3 bitangent;
    vec3 normal;
};

// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
Frame frame_around(vec3 normal) {
    float side = normal.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (side + normal.z);
    float b = normal.x * normal.y * a;
    return Frame(
        vec3(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x),
        vec3(b, side + normal.y * normal.y * a, -normal.y), normal);
}

vec3 to_local(Frame frame, vec3 direction) {
    return vec3(dot(direction, frame.tangent), dot(direction, frame.bitangent), dot(direction, frame.normal));
}

vec3 to_world(Frame frame, vec3 local) {
    return local.x * frame.tangent + local.y * frame.bitangent + local.z * frame.normal;
}

// D(h) [1/sr]; the spread is written without the difference that cancels near the peak.
float ggx_distribution(vec3 middle, float alpha) {
    float alpha2 = alpha * alpha;
    float spread = alpha2 * middle.z * middle.z + dot(middle.xy, middle.xy);
    return alpha2 / (PI * spread * spread);
}

// Λ of Smith: (−1 + √(1 + α² tan²θ))/2.
float smith_lambda(float cosine, float alpha) {
    float cosine2 = max(cosine * cosine, 1e-8);
    float tangent2 = max(1.0 - cosine2, 0.0) / cosine2;
    float scaled = alpha * alpha * tangent2;
    return 0.5 * scaled / (1.0 + sqrt(1.0 + scaled));
}

float smith_masking(float cosine, float alpha) {
    return 1.0 / (1.0 + smith_lambda(cosine, alpha));
}

// The density of h among the normals that `viewer` sees, per solid angle of h: G1(v) D(h) (v·h)⁺ / v.z.
float visible_normal_density(vec3 viewer, vec3 middle, float alpha) {
    return smith_masking(viewer.z, alpha) * ggx_distribution(middle, alpha) * max(dot(viewer, middle), 0.0) / viewer.z;
}

vec3 sample_visible_normal(vec3 viewer, float alpha, vec2 random) {
    vec3 stretched = normalize(vec3(viewer.xy * alpha, viewer.z));
    float azimuth = 2.0 * PI * random.x;
    float z = (1.0 - random.y) * (1.0 + stretched.z) - stretched.z;
    float across = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
    vec3 middle = vec3(across * cos(azimuth), across * sin(azimuth), z) + stretched;
    return normalize(vec3(middle.xy * alpha, max(middle.z, 1e-9)));
}

vec3 sample_cosine_hemisphere(vec2 random) {
    float azimuth = 2.0 * PI * random.x;
    float radius = sqrt(random.y);
    return vec3(radius * cos(azimuth), radius * sin(azimuth), sqrt(max(1.0 - random.y, 0.0)));
}

#endif
