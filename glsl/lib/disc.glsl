// A virtual point light as a disc, for receivers close to it, where a point shows as a bright spot beside dark ones.
#ifndef LIB_DISC
#define LIB_DISC

#include "lib/vpl.glsl"

// Area of a VPL's disc over the area that it stands for, at most: neighbours overlap so far that a wall of equal VPLs looks even to what is close
// to it. Measured against path tracing in a Cornell box with 256 VPLs: rrmse 0.090 at 1, 0.066 at 2, 0.050 at 4, 0.049 at 5.
const float OVERLAP = 5.0;

// Over the disc's radius: a receiver closer to the disc's plane gets nothing. A wall without thickness has VPLs on its other side, in front of which
// rounding may put it.
const float LEAST_HEIGHT = 2e-4;

// The VPL with its normal at unit length and the strength to match.
Vpl as_disc(Vpl vpl) {
    float scale = inversesqrt(dot(vpl.normal, vpl.normal));
    return Vpl(vpl.position_rs, vpl.area_over_pi, vpl.strength / scale, vpl.normal * scale);
}

// The factor of `strength` in the irradiance at x. With D = y − x, R² = A/π, h = (n_y·−D) the height over the disc's plane, n_z = −n_x·n_y
// and g = n_x·(D + h n_y), how far the disc lies in front of x's normal along that plane,
//
//   E(x) = Φ/π · 2/S · (n_z h²/(S + D² − R²) + h g/(S + D² + R²))⁺      S² = (D² − R²)² + 4R²h²
//
// Lambert's vector irradiance of a disc, exact while the plane of x does not cut it: its parts along and across the axis are the form
// factors of an element parallel and of one perpendicular to a disc (Howell's catalogue, B-12 and B-13), rewritten so that nothing cancels.
// Far away it is a point's, on the axis Φ/(πh² + A).
//
// Over the disc's foot the plane of x may cut it. What is behind counts negative in E. But a surface that meets the one of x ends there, and
// the VPL's flux is all in front. So the part is folded to the front: an element over the diameter of a disc sees of each half
//
//   Q = 1/π · (atan(R/h) − R h/(R² + h²))      of its radiosity
//
// and E's part across the axis, e, becomes √(e² + (2Q)²), with a weight that falls to 0 at the disc's edge. The fold itself goes to 0 where
// the disc's centre comes to the plane of x, the clipped half to 0 beyond. At most strength/R², the radiosity, along either axis.
float disc_form_factor(Vpl vpl, vec3 position_rs, vec3 normal) {
    vec3 difference = vpl.position_rs - position_rs;
    float squared = dot(difference, difference);
    float radius2 = vpl.area_over_pi;
    float height = -dot(vpl.normal, difference);
    bool in_front_of_disc = height > 0.0 && height * height > LEAST_HEIGHT * LEAST_HEIGHT * radius2;
    float beyond = squared - radius2;
    float s = sqrt(beyond * beyond + 4.0 * radius2 * height * height) + 1e-20;
    float axial = -dot(normal, vpl.normal);
    float in_front = dot(normal, difference);
    // h²/(S + D² − R²) = (S − D² + R²)/4R²: whichever does not cancel.
    float above = beyond > 0.0 ? height * height : s - beyond;
    float below = beyond > 0.0 ? s + beyond : 4.0 * radius2;
    float along = 2.0 * axial * above / (below * s);
    float across = 2.0 * height * (in_front - height * axial) / ((s + squared + radius2) * s);
    float from_axis2 = squared - height * height;
    if (from_axis2 < radius2 && in_front_of_disc) {
        float radius = sqrt(radius2);
        float turned = sqrt(max(1.0 - axial * axial, 1e-12));
        float half_disc = INVERSE_PI * (atan(radius / height) - radius * height / (radius2 + height * height)) / radius2;
        float along_radius2 = from_axis2 / radius2;
        float halves = 2.0 * half_disc * turned * (1.0 - along_radius2 * along_radius2 * along_radius2);
        float both = sqrt(across * across + halves * halves);
        float fold = clamp(4.0 * in_front / (turned * radius), 0.0, 1.0);
        across = 0.5 * (across + both) + 0.5 * fold * (both - across);
    }
    return in_front_of_disc ? max(along + across, 0.0) : 0.0;
}

// The same for a receiver without a normal: the vector whose component along any normal is the factor, while the plane of x does not cut the disc. Where it does, over the disc's
// foot, the part across the axis is folded as above for the surface that faces along `facing`, which need not be a unit vector: of length 0 nothing is folded.
vec3 disc_vector(Vpl vpl, vec3 position_rs, vec3 facing) {
    vec3 difference = vpl.position_rs - position_rs;
    float squared = dot(difference, difference);
    float radius2 = vpl.area_over_pi;
    float height = -dot(vpl.normal, difference);
    if (height <= 0.0 || height * height <= LEAST_HEIGHT * LEAST_HEIGHT * radius2) {
        return vec3(0.0);
    }
    float beyond = squared - radius2;
    float s = sqrt(beyond * beyond + 4.0 * radius2 * height * height) + 1e-20;
    float above = beyond > 0.0 ? height * height : s - beyond;
    float below = beyond > 0.0 ? s + beyond : 4.0 * radius2;
    vec3 across = (2.0 * height / ((s + squared + radius2) * s)) * (difference + height * vpl.normal);
    float from_axis2 = squared - height * height;
    vec3 sideways = facing - dot(facing, vpl.normal) * vpl.normal;
    float turned = length(sideways);
    if (from_axis2 < radius2 && turned > 1e-3) {
        sideways /= turned;
        float radius = sqrt(radius2);
        float half_disc = INVERSE_PI * (atan(radius / height) - radius * height / (radius2 + height * height)) / radius2;
        float along_radius2 = from_axis2 / radius2;
        float halves = 2.0 * half_disc * (1.0 - along_radius2 * along_radius2 * along_radius2);
        float own = dot(across, sideways);
        float both = sqrt(own * own + halves * halves);
        float fold = clamp(4.0 * dot(facing, difference) / (turned * radius), 0.0, 1.0);
        across += (0.5 * (own + both) + 0.5 * fold * (both - own) - own) * sideways;
    }
    return across - (2.0 * above / (below * s)) * vpl.normal;
}

#endif
