// The surface that a pixel shows, as points and their filter see it.
#ifndef POINTS_PLACE
#define POINTS_PLACE

#include "groups/surface.glsl"
#include "lib/octahedral.glsl"
#include "lib/pixel_grid.glsl"

struct Place {
    vec3 position_rs;
    vec3 normal;   // geometric, on the viewer's side
    float extent;  // metres across a pixel there, at right angles to the view
    float area;    // of the surface that the pixel shows, m²: Δω·d²/cosθ
    bool valid;    // there is a surface
};

// A surface seen more edge-on than this shows no more of itself.
const float EDGE_ON = 1e-3;

Place place_of_pixel(ivec2 pixel, ivec2 size) {
    Place place;
    place.valid = false;
    if (any(lessThan(pixel, ivec2(0))) || !is_inside(pixel, size)) {
        return place;
    }
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    if (pixel_depth <= 0.0) {
        return place;
    }
    place.valid = true;
    place.position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
    place.normal = unpack_direction(texelFetch(surface, pixel, 0).y);
    vec2 step = 2.0 * vec2(length(camera.right_scaled), length(camera.down_scaled)) / vec2(size);
    if (camera.depth_range > 0.0) {
        place.extent = max(step.x, step.y);
        place.area = step.x * step.y / max(abs(dot(place.normal, camera.forward)), EDGE_ON);
    } else {
        // A pixel of area a at distance 1 along the axis sees a·z³/(d·cosθ) of the surface, z along the axis and d along the ray: Δω = a·z³/d³.
        vec3 away = place.position_rs - camera.position_rs;
        float along = dot(away, camera.forward);
        place.extent = max(step.x, step.y) * along;
        place.area = step.x * step.y * along * along * along / max(abs(dot(place.normal, away)), EDGE_ON * along);
    }
    return place;
}

// Moves it to where the line of sight through `inside`, in [0, 1]² of the pixel, meets its plane; if that is nowhere near, it stays.
void move_within_pixel(inout Place place, ivec2 pixel, vec2 inside, ivec2 size) {
    vec2 ndc = 2.0 * (vec2(pixel) + inside) / vec2(size) - 1.0;
    vec3 across = ndc.x * camera.right_scaled + ndc.y * camera.down_scaled;
    bool parallel = camera.depth_range > 0.0;
    vec3 start = parallel ? camera.position_rs + across : camera.position_rs;
    vec3 sight = parallel ? camera.forward : camera.forward + across;
    float slope = dot(place.normal, sight);
    vec3 moved = start + sight * (dot(place.normal, place.position_rs - start) / (abs(slope) > 1e-30 ? slope : 1e-30));
    if (distance(moved, place.position_rs) * abs(slope) <= place.extent * length(sight)) {
        place.position_rs = moved;
    }
}

// The surface at a place goes on to another point: it does not bend away, and the point is off the place's plane by less than a third of the way that the plane goes
// between the two lines of sight. The way between the points themselves is no measure: seen at a slant, that to a plane far behind is nearly parallel.
const float SAME_NORMAL = 0.7;
const float SAME_PLANE = 0.35;

bool is_same_surface(Place place, vec3 other_rs, vec3 other_normal) {
    float off = dot(place.normal, other_rs - place.position_rs);
    vec3 sight = camera.depth_range > 0.0 ? camera.forward : other_rs - camera.position_rs;
    float slope = dot(place.normal, sight);
    // The other line of sight meets the plane before the eye, or nowhere.
    float back = off / (abs(slope) > 1e-30 ? slope : 1e-30);
    if (dot(place.normal, other_normal) < SAME_NORMAL || (camera.depth_range <= 0.0 && back >= 1.0)) {
        return false;
    }
    float along = distance(other_rs - back * sight, place.position_rs);
    return abs(off) <= SAME_PLANE * min(along, distance(other_rs, place.position_rs)) + 1e-3 * place.extent;
}

#endif
