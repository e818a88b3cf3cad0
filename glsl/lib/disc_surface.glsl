// How much of a disc around a point of a surface is surface that photons could lie on: rays are sent through random points of it, from a quarter of its radius
// above to a quarter below. The including file has the hierarchy (lib/bvh.glsl).
#ifndef LIB_DISC_SURFACE
#define LIB_DISC_SURFACE

#include "lib/microfacet.glsl"
#include "lib/traced_scene.glsl"

// Textures of metals and of glass are not asked.
bool is_disc_surface(Hit hit, vec3 offset, vec3 normal, float radius) {
    if (hit.triangle == NO_TRIANGLE || dot(offset, offset) >= radius * radius) {
        return false;
    }
    Triangle triangle = load_triangle(triangles, hit.triangle);
    Material material = load_material(materials, triangle.material);
    float diffuse = max3(material.base_color.rgb) * (1.0 - material.metallic) * (1.0 - material.transmission);
    return diffuse > 0.0 && abs(dot(front_normal(triangle), normal)) > 0.5;
}

// Whether one random point is. `frame`: around the triangle's normal.
bool meets_disc_surface(vec3 position, Frame frame, float radius, vec2 random) {
    float distance = radius * sqrt(random.x);
    float azimuth = 2.0 * PI * random.y;
    vec3 across = distance * (cos(azimuth) * frame.tangent + sin(azimuth) * frame.bitangent);
    Hit hit = closest_hit(position + across + 0.25 * radius * frame.normal, -frame.normal, 0.5 * radius);
    return is_disc_surface(hit, across + (0.25 * radius - hit.distance) * frame.normal, frame.normal, radius);
}

#endif
