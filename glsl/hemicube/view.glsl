// How a texel sees the scene: the front plane of a hemicube over it, 1 along its normal, from −a to a along both its axes (Larsen & Christensen 2004, section 4, after
// Sillion & Puech 1989). A point p metres from the texel is seen where |p·x| ≤ a·p·n and |p·y| ≤ a·p·n.
#ifndef HEMICUBE_VIEW
#define HEMICUBE_VIEW

#include "lib/microfacet.glsl"
#include "lightmaps/texels.glsl"

// What is nearer along the normal than this share of the texel's size is not seen: near planes lie somewhere, and depths are the finer the farther it is.
const float NEAR = 1e-3;

// Each view is turned about its normal by an angle of its own, multiples of the golden section of a quarter: what a grid of fragments misses would be bands across
// neighbouring texels, and is noise.
const uint GOLDEN = 0x9E3779B9u;
const float QUARTER = 1.5707963 / 4294967296.0;

struct View {
    vec3 origin;
    Frame axes;
    vec3 face;   // what lies below it is no light that arrives, though the normal of shading may lean there
    float near;  // m
};

View view_of_texel(uint number) {
    LightTexel texel = load_light_texel(number);
    vec3 origin = offset_ray_origin(texel.position, texel.face);
    Frame axes = frame_around(texel.normal);
    float angle = float(number * GOLDEN) * QUARTER;
    vec3 tangent = cos(angle) * axes.tangent + sin(angle) * axes.bitangent;
    return View(origin, Frame(tangent, cross(axes.normal, tangent), axes.normal), texel.face, NEAR * texel.size);
}

vec3 direction_through(View view, vec2 point) {
    return to_world(view.axes, vec3(point, 1.0));
}

#endif
