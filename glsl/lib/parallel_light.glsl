// Where light paths of a directional light start: on a disc across it, as large as the sphere of radius R around all that matters, before that. Surfaces
// beside the disc, and before it, get no paths; camera paths find their light alone (path/light.comp).
#ifndef LIB_PARALLEL_LIGHT
#define LIB_PARALLEL_LIGHT

#include "lib/vectors.glsl"

// Over R: from the middle to the disc.
const float DISC_DISTANCE = 1.001;

vec3 point_of_disc(Frame frame, vec3 middle, float radius, vec2 random) {
    float from_middle = radius * sqrt(random.x);
    float azimuth = 2.0 * PI * random.y;
    return middle + from_middle * (cos(azimuth) * frame.tangent + sin(azimuth) * frame.bitangent) - DISC_DISTANCE * radius * frame.normal;
}

// Whether light that travels along `direction` comes to a point, seen from the middle, through the disc.
bool is_behind_disc(vec3 from_middle, vec3 direction, float radius2) {
    float along = dot(from_middle, direction);
    vec3 across = from_middle - along * direction;
    return dot(across, across) <= radius2 && (along >= 0.0 || along * along < DISC_DISTANCE * DISC_DISTANCE * radius2);
}

#endif
