// What a light view gets on top of its depth where a surface reflects or transmits specularly: the surface (photons/surface_texel.glsl), and
// the mask: the flux that the texel receives times the share that its specular lobes may send on, in W. That is what photons are drawn by, so
// that it may be a little off: Δω is step²·cos³ here, at most 10⁻⁴ off at 128 texels a side. Of light that a closed body takes on its way
// to the texel nothing is received.

#include "groups/light_views.glsl"
#include "lib/brdf.glsl"
#include "lib/lights.glsl"
#include "photons/medium.glsl"
#include "photons/surface_texel.glsl"

layout(location = 0) out uvec4 specular_surface;
layout(location = 1) out uvec2 specular_layer;
layout(location = 2) out float mask;

void write_specular_texel(uint material_index, Material material, MaterialPoint point, vec3 normal, vec3 geometric, bool front) {
    Lobes lobes = lobes_of_material(material, point);
    bool unlit = (material.flags & MATERIAL_UNLIT) != 0u;
    vec3 transmission = unlit ? vec3(0.0) : point.base_color.rgb * ((1.0 - point.metallic) * point.transmission);
    specular_surface = uvec4(pack_direction(normal), pack_direction(geometric), pack_root_color(lobes.f0), pack_root_color(transmission));
    specular_layer = uvec2(
        packUnorm2x16(vec2(lobes.f90, lobes.roughness)), material_index | (front ? SURFACE_FRONT : 0u));

    LightView view = load_view(views, push.view_index);
    vec2 tangent = tangent_of_texel(view, gl_FragCoord.xy);
    vec3 ray = ray_of_tangent(view, tangent);
    float stretch = length(ray);
    float distance = stretch * depth_from_light(view, gl_FragCoord.z);
    bool lit = all(greaterThanEqual(tangent, view.lit_low)) && all(lessThan(tangent, view.lit_high));
    Light light = load_light(lights, view.light);
    vec3 incident = radiant_intensity(light, ray / stretch) * (view.tangent_step * view.tangent_step);
    if (!is_orthographic(view)) {
        incident *= range_window(distance, light.range) / (stretch * stretch * stretch);
    }
    incident *= transmittance_behind(material, front, distance);
    float cosine = abs(dot(normal, ray)) / stretch;
    vec3 mean = lobes.f0 + (vec3(lobes.f90) - lobes.f0) / 21.0;
    float share = max3(max(mean, schlick_fresnel(lobes.f0, lobes.f90, cosine))) + max3(transmission);
    mask = lit ? max3(incident) * clamp(share, 0.0, 1.0) : 0.0;
}
