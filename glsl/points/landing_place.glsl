// The pixel that a photon falls on, if that shows the surface that it landed on. The paper's depth test compares with the pixel's depth, which on a surface seen at a slant
// differs from the photon's; here both have to lie on one surface, within the pixel.
#ifndef POINTS_LANDING_PLACE
#define POINTS_LANDING_PLACE

#include "photons/kept.glsl"
#include "points/place.glsl"

// A point on the pixel's surface is no farther from the pixel's middle.
bool is_within_pixel(KeptPhoton photon, Place place, vec3 to_eye) {
    float cosine = max(abs(dot(place.normal, to_eye)), 0.05);
    float most = 1.5 * place.extent / cosine;
    vec3 way = photon.position_rs - place.position_rs;
    return dot(way, way) <= most * most;
}

// In pixels, of a point before the eye.
vec2 image_place(vec3 position_rs, ivec2 size) {
    vec4 clip = camera.view_projection * vec4(position_rs, 1.0);
    return (0.5 * clip.xy / clip.w + 0.5) * vec2(size);
}

bool lands_in_view(KeptPhoton photon, ivec2 size, out ivec2 pixel, out Place place) {
    pixel = ivec2(0);
    place.valid = false;
    vec4 clip = camera.view_projection * vec4(photon.position_rs, 1.0);
    if (clip.w <= 0.0 || any(greaterThan(abs(clip.xy), vec2(clip.w)))) {
        return false;
    }
    pixel = clamp(ivec2(floor(image_place(photon.position_rs, size))), ivec2(0), size - 1);
    place = place_of_pixel(pixel, size);
    return place.valid && is_same_surface(place, photon.position_rs, photon.normal)
        && is_within_pixel(photon, place, direction_to_eye(camera, place.position_rs));
}

#endif
