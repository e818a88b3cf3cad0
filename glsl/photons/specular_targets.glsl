// What a light view gets on top of its depth where a surface reflects or transmits specularly: the surface (photons/surface_texel.glsl), and
// the mask: the flux that the texel receives times the share that its specular lobes may send on, in W. The share is what photons are drawn by,
// so that any positive one is right; of light lost in a closed body on its way to the texel nothing is received.

#include "lib/brdf.glsl"
#include "light_views/flux.glsl"
#include "photons/medium.glsl"
#include "photons/surface_texel.glsl"

layout(set = 0, binding = 6) uniform usamplerBuffer lights;

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
    vec3 incident = incident_flux(load_light(lights, view.light), view, gl_FragCoord.xy, gl_FragCoord.z);
    incident *= transmittance_behind(material, front, length(ray) * linear_depth(view, gl_FragCoord.z));
    float cosine = abs(dot(normal, ray)) / length(ray);
    vec3 mean = lobes.f0 + (vec3(lobes.f90) - lobes.f0) / 21.0;
    float share = max3(max(mean, schlick_fresnel(lobes.f0, lobes.f90, cosine))) + max3(transmission);
    mask = max3(incident) * clamp(share, 0.0, 1.0);
}
