// The light of one punctual light at a point, by one ray. The including file has lib/bvh.glsl.
#ifndef LIB_PUNCTUAL_LIGHT
#define LIB_PUNCTUAL_LIGHT

#include "lib/lights.glsl"
#include "lib/receiver.glsl"

// W/(m²·sr). A light behind the shading normal or behind the triangle itself gives nothing.
vec3 reflected_radiance(Receiver receiver, Light light) {
    Surface point = receiver.surface;
    Illumination illumination = illuminate(light, point.position_rs);
    float cosine = dot(point.normal, illumination.to_light);
    if (min(cosine, dot(point.geometric_normal, illumination.to_light)) <= 0.0) {
        return vec3(0.0);
    }
    vec3 brdf = SPECULAR_LOBES != 0u ? surface_brdf(point, illumination.to_light, receiver.to_eye) : point.diffuse_albedo * INVERSE_PI;
    vec3 radiance = brdf * illumination.irradiance * cosine;
    if (max3(radiance) <= 0.0) {
        return vec3(0.0);
    }
    bool directional = light.kind == LIGHT_DIRECTIONAL;
    vec3 way = directional ? illumination.to_light : light.position_rs - receiver.ray_origin;
    return is_occluded(receiver.ray_origin, way, directional ? 3e38 : 1.0) ? vec3(0.0) : radiance;
}

#endif
