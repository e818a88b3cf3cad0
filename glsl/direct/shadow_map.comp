#version 460
#include "lib/prelude.glsl"
#include "groups/light_views.glsl"
#include "groups/surface.glsl"
#include "lib/narrow.glsl"
#include "lib/pixels.glsl"
#include "lib/shadow.glsl"
#include "lib/surface_packing.glsl"

// The slot `direct` of one pixel: radiance in W/(m²·sr) that the lights send to the first surface x and x scatters to the eye,
//
//   L(x, v) = Σ_i f(l_i, v) · E⊥_i(x) · (n·l_i)⁺ · V_i(x)
//
// f: lib/brdf.glsl; E⊥: lib/lights.glsl; V: filtered shadow maps, lib/shadow.glsl. A light behind the shading normal or behind
// the triangle itself gives nothing.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, rgba32f) writeonly uniform image2D direct;

layout(push_constant, scalar) uniform Push {
    uint light_count;
    float normal_offset;  // in shadow texels at the receiver
    int filter_radius;    // (2·radius + 1)² taps
    uint diffuse_from;    // lights from this one on, samples of emissive surfaces and the sky, show in no narrow lobe: another method shows what they stand for
} push;

vec3 reflected_radiance(Surface point, vec3 to_eye, Light light, bool shows_in_narrow) {
    Illumination illumination = illuminate(light, point.position_rs);
    float cosine = dot(point.normal, illumination.to_light);
    if (min(cosine, dot(point.geometric_normal, illumination.to_light)) <= 0.0 || max3(illumination.irradiance) <= 0.0) {
        return vec3(0.0);
    }
    float visibility = 1.0;
    if (light.view_count != 0u) {
        LightView view = load_view(views, light.first_view);
        uint seeing = view_towards(light, view, -illumination.to_light);
        if (seeing != light.first_view) {
            view = load_view(views, seeing);
        }
        visibility = light_visibility(
            light_depth, view, point.position_rs, point.geometric_normal,
            ShadowFilter(push.normal_offset, push.filter_radius));
    }
    vec3 brdf = HAS_SPECULAR != 0u ? surface_brdf(point, illumination.to_light, to_eye) : point.diffuse_albedo * INVERSE_PI;
    if (!shows_in_narrow && is_narrow(point.roughness * point.roughness)) {
        brdf -= specular_brdf(point, illumination.to_light, to_eye);
    }
    return brdf * illumination.irradiance * (cosine * visibility);
}

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(direct);
    if (!is_inside(pixel, size)) {
        return;
    }
    float pixel_depth = texelFetch(depth, pixel, 0).x;
    vec3 radiance = vec3(0.0);
    if (pixel_depth > 0.0) {
        vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
        vec3 to_eye = direction_to_eye(camera, position_rs);
        for (uint i = 0u; i < push.light_count; ++i) {
            radiance += reflected_radiance(point, to_eye, load_light(lights, i), i < push.diffuse_from);
        }
    }
    imageStore(direct, pixel, vec4(radiance, 1.0));
}
