// The particle that stands for a point that the eye or a mirror's ray sees, by the rule of links (home.glsl); it is marked as used. The including file has
// `buffer Marks { uint marks[]; }`.

#include "particles/home.glsl"

// Cosine.
const float EDGE_ON = 0.02;

// `normal`: of the triangle, `to_viewer`: unit, the viewer `distance` away.
uint seen_home(vec3 position, vec3 normal, vec3 to_viewer, float distance) {
    Lifted lift = lift_of_point(position, normal, to_viewer, distance);
    uint home = home_of(position, normal, lift);
    // Edge-on, rounding decides which side one sees.
    if (home == NO_PARTICLE && dot(to_viewer, normal) < EDGE_ON) {
        home = home_of(position, -normal, lift);
    }
    // A thing smaller than the spacing, on which no particle came to lie, gets the light of what is around.
    if (home == NO_PARTICLE) {
        home = home_among(position, normal, lift, NOT_OPPOSITE, false);
    }
    if (home != NO_PARTICLE) {
        atomicOr(marks[home], 1u);
    }
    return home;
}
