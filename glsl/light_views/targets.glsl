// What a texel of a reflective light view holds (Dachsbacher & Stamminger 2005): the surface that the light sees there and the flux
// that its diffuse lobe sends back,
//
//   Φ = I(ω)·window(d)·Δω·ρ     perspective: I in W/sr, Δω the texel's exact solid angle (lib/solid_angle.glsl)
//   Φ = E⊥·step²·ρ              orthographic: E⊥ in W/m² across the beam, step² the texel's area
//
// [W], ρ = indirect_diffuse_albedo(). No cosine: the flux through a texel lands whole on whatever is there. Summed over a light's views the
// texels in the lit rectangle tile all directions once, so the fluxes add up to what the light sends, times ρ.

#include "groups/light_views.glsl"
#include "lib/brdf.glsl"
#include "lib/lights.glsl"
#include "lib/octahedral.glsl"
#include "light_views/flux.glsl"

layout(location = 0) out uint normal_target; // r32ui: the triangle's normal on the light's side, pack_direction()
layout(location = 1) out vec4 flux_target;   // rgba32f: Φ/view.flux_scale; a: what the texel reflects or transmits specularly

vec4 reflected_flux(Light light, LightView view, vec4 fragment, vec3 normal, Lobes lobes, float transmission) {
    vec3 incident = incident_flux(light, view, fragment.xy, fragment.z);
    vec3 reflected = incident * indirect_diffuse_albedo(lobes.diffuse_albedo, lobes.f0, lobes.f90);
    vec3 ray = ray_of_tangent(view, tangent_of_texel(view, fragment.xy));
    float reflectance = max3(schlick_fresnel(lobes.f0, lobes.f90, abs(dot(normal, normalize(ray)))));
    float mask = reflectance + (1.0 - reflectance) * transmission;
    return vec4(reflected / view.flux_scale, max3(incident) > 0.0 ? clamp(mask, 0.0, 1.0) : 0.0);
}
