// The flux that a light sends through one texel of its view.
#ifndef LIGHT_VIEWS_FLUX
#define LIGHT_VIEWS_FLUX

#include "lib/lights.glsl"
#include "lib/solid_angle.glsl"

// W before any surface reflects it. `texel` and `depth` as gl_FragCoord has them.
vec3 incident_flux(Light light, LightView view, vec2 texel, float depth) {
    vec2 tangent = tangent_of_texel(view, texel);
    if (any(lessThan(tangent, view.lit_low)) || any(greaterThanEqual(tangent, view.lit_high))) {
        return vec3(0.0);
    }
    if (is_orthographic(view)) {
        return light.intensity * (view.tangent_step * view.tangent_step);
    }
    vec3 ray = ray_of_tangent(view, tangent);
    float stretch = length(ray);
    float window = range_window(stretch * view.near / depth, light.range);
    return radiant_intensity(light, ray / stretch) * (window * solid_angle_of_texel(tangent, view.tangent_step));
}

#endif
