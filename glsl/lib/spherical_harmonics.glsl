// Real spherical harmonics of the bands 0 to 2, orthonormal: nine functions in the order l² + l + m. The signs are those without the factor (−1)^m: a function and its
// negative serve alike as long as what is projected and what is evaluated share it (Reich 2015, appendix B.1, has the other ones).
//
// A radiance L(ω) = Σ c_lm y_lm(ω) gives the irradiance E(n) = Σ A_l c_lm y_lm(n), A = π, 2π/3, π/4: the clamped cosine is a zonal function, and convolving with
// it scales each band (Ramamoorthi & Hanrahan 2001; appendix B.2 holds A_l y_lm(n)).
#ifndef LIB_SPHERICAL_HARMONICS
#define LIB_SPHERICAL_HARMONICS

const int SH_COUNT = 9;

const float COSINE_BAND_0 = 3.14159265358979;
const float COSINE_BAND_1 = 2.09439510239320;
const float COSINE_BAND_2 = 0.785398163397448;

// y_00, then the three of band 1. `direction` is of unit length.
vec4 harmonics_of_low_bands(vec3 direction) {
    return vec4(0.282094791773878, 0.488602511902920 * direction.yzx);
}

// The first four of band 2.
vec4 harmonics_of_band_2(vec3 direction) {
    return vec4(
        1.09254843059208 * direction.x * direction.y, 1.09254843059208 * direction.y * direction.z,
        0.946174695757560 * direction.z * direction.z - 0.315391565252520, 1.09254843059208 * direction.x * direction.z);
}

// And its last one.
float last_harmonic(vec3 direction) {
    return 0.546274215296040 * (direction.x * direction.x - direction.y * direction.y);
}

// The same times what the clamped cosine scales each band by: what a radiance's coefficients are multiplied by to give the irradiance at a normal.
vec4 cosine_of_low_bands(vec3 normal) {
    return harmonics_of_low_bands(normal) * vec4(COSINE_BAND_0, vec3(COSINE_BAND_1));
}

vec4 cosine_of_band_2(vec3 normal) {
    return harmonics_of_band_2(normal) * COSINE_BAND_2;
}

float last_cosine(vec3 normal) {
    return last_harmonic(normal) * COSINE_BAND_2;
}

#endif
