// What happens where a photon meets a surface: it lands if there is a diffuse lobe, and goes on if there are specular ones. Both take
// the whole flux that arrives: what each sends out is its own factor's business.
//
// A landed photon is spread over an ellipse by the way to its neighbours (photons/beam.glsl), or over the paper's disc of the radius [m], at
// most R/4,
//
//   h = C₀·√(A/N) · d/(R·√cosθ)      Quyen 2014, section 3.3.2.3: h = C√(A/N), C = C₀/√p, p = cosθ/d², with d over the scene's radius R so
//                                    that C₀ has no unit; A the area of the scene, N the photons sent out, d the way from the light
//
// θ the angle of incidence.

#include "groups/geometry.glsl"
#include "groups/landing.glsl"
#include "photons/append.glsl"
#include "photons/arrivals.glsl"
#include "photons/beam.glsl"
#include "photons/choice.glsl"
#include "photons/medium.glsl"
#include "photons/surface_texel.glsl"
#include "lib/brdf.glsl"

layout(push_constant, scalar) uniform LandingStage {
    vec3 shift;          // from render space to that of the traced scene
    uint stage;
    uint goes_on;        // 0: no surface sends photons on from here
    uint landed_stage;
    uint capacity;       // of the lists of arrivals
    uint landed_capacity;
    float radius;        // of the scene, m
    float disc_scale;    // C₀·√A/R, or C₀ where beams decide
    uint beams_decide;
} push;

// Where a photon is, and what it met there.
struct Landing {
    PhotonRay photon;   // its flux and way at arrival, its origin the point of arrival
    vec3 normal;        // geometric, on the arriving side
    vec3 shading_normal;
    float way;          // from where it came, m
    Beam beam;          // at the surface
    bool may_diffuse;   // some texture that is not known here decides about its diffuse lobe
    float spread;       // standard deviation in one dimension that the lobe gives it there, m
    bool front;
    Material material;
};

Landing arrive(uint index, uvec4 hit) {
    Landing landing;
    landing.photon = load_photon_ray(rays, index);
    vec3 face = unpack_direction(hit.y);
    float distance = uintBitsToFloat(hit.x);
    landing.front = dot(face, landing.photon.direction) < 0.0;
    landing.material = load_material(drawn_materials, hit.z);
    landing.normal = landing.front ? face : -face;
    landing.shading_normal = landing.normal;
    landing.may_diffuse = false;
    landing.way = distance;
    landing.photon.origin_rs += landing.photon.direction * distance;
    Beam beam = load_beam(beams, int(RAY_BEAM_TEXELS * index));
    beam.origin_u += distance * beam.direction_u;
    beam.origin_v += distance * beam.direction_v;
    landing.spread = LOBE_SPREAD * unpackHalf2x16(landing.photon.bits >> 16).x * distance;
    // Along their own rays to the plane of the surface.
    float slope = dot(landing.photon.direction, landing.normal);
    vec3 along = landing.photon.direction / min(slope, -1e-2);
    beam.origin_u -= along * dot(beam.origin_u, landing.normal);
    beam.origin_v -= along * dot(beam.origin_v, landing.normal);
    landing.beam = beam;
    landing.photon.travelled += distance;
    landing.photon.flux *= transmittance_behind(landing.material, landing.front, distance);
    return landing;
}

Ellipse footprint(Landing landing) {
    float emitted = float(max(texelFetch(choice, int(CHOICE_PHOTONS)).x, 1u));
    float most = 0.25 * push.radius;
    vec3 size = abs(landing.photon.origin_rs);
    float least = max(exp2(-20.0) * max(size.x, max(size.y, size.z)), 1e-12 * push.radius);
    if (push.beams_decide == 0u) {
        float cosine = max(-dot(landing.normal, landing.photon.direction), 1e-3);
        float radius = clamp(push.disc_scale * inversesqrt(emitted * cosine) * landing.photon.travelled, least, most);
        return Ellipse(radius, vec4(0.0, 0.0, 0.0, radius));
    }
    float share = lobe_in_disc(unpackHalf2x16(landing.photon.bits >> 16).x);
    float drawn = landing.spread * (1.0 - share) * inversesqrt(emitted);
    Ellipse ellipse = ellipse_of(landing.beam, landing.normal, push.disc_scale, landing.spread * share, drawn);
    bool is_number = is_finite(ellipse.larger) && is_finite(ellipse.smaller);
    ellipse.larger = is_number ? clamp(ellipse.larger, least, most) : most;
    ellipse.smaller.xyz = is_number ? ellipse.smaller.xyz : vec3(0.0);
    ellipse.smaller.w = is_number ? clamp(ellipse.smaller.w, ellipse.larger / 32.0, ellipse.larger) : ellipse.larger;
    return ellipse;
}

// All invocations of the group come here; `met`: there is a surface.
void land(bool met, Landing landing, MaterialPoint point) {
    Material material = landing.material;
    PhotonRay photon = landing.photon;
    Lobes lobes = lobes_of_material(material, point);
    bool unlit = (material.flags & MATERIAL_UNLIT) != 0u;
    // Flux that is no number lands too: it is counted where discs are made of photons (photon_splat/project.comp).
    bool is_number = is_finite(photon.flux);
    bool carries = met && (!is_number || max3(photon.flux) > 0.0);
    bool lands = carries && (landing.may_diffuse || max3(lobes.diffuse_albedo) > 0.0);
    uint place;
    APPEND_TO_STAGE(counts, push.landed_stage, lands, place)
    if (lands && place < push.landed_capacity) {
        Ellipse ellipse = footprint(landing);
        photons[2u * place] = uvec4(floatBitsToUint(photon.origin_rs), pack_direction(landing.normal));
        photons[2u * place + 1u] = uvec4(floatBitsToUint(photon.flux), floatBitsToUint(ellipse.larger));
        ellipses[place] = ellipse.smaller;
    }
    if (push.goes_on == 0u) {
        return;
    }
    vec3 transmission = unlit ? vec3(0.0) : point.base_color.rgb * ((1.0 - point.metallic) * point.transmission);
    bool goes_on = carries && is_number && max(max3(lobes.f0), max(lobes.f90, max3(transmission))) > 0.0;
    APPEND_TO_STAGE(arrival_counts, push.stage + 1u, goes_on, place)
    if (goes_on && place < push.capacity) {
        bool refracts = medium_of(material).is_closed && material.ior > 0.0 && max3(transmission) > 0.0;
        float relative_ior = !refracts ? 1.0 : landing.front ? material.ior : 1.0 / material.ior;
        arrivals[3u * place] = uvec4(floatBitsToUint(photon.origin_rs), floatBitsToUint(photon.travelled));
        arrivals[3u * place + 1u] = uvec4(floatBitsToUint(photon.direction), photon.bits);
        arrivals[3u * place + 2u] = uvec4(floatBitsToUint(photon.flux), photon.seed);
        vec4 packed_beam[3] = pack_beam(landing.beam);
        uint first = ARRIVAL_BEAM_TEXELS * place;
        arrival_beams[first] = packed_beam[0];
        arrival_beams[first + 1u] = packed_beam[1];
        arrival_beams[first + 2u] = packed_beam[2];
        // As if the surface were flat: nobody knows its curvature here.
        arrival_beams[first + 3u] = vec4(0.0);
        arrival_beams[first + 4u] = vec4(0.0);
        surfaces[2u * place] = uvec4(
            pack_direction(landing.shading_normal), pack_direction(landing.normal), pack_root_color(lobes.f0), pack_root_color(transmission));
        surfaces[2u * place + 1u] = uvec4(
            packUnorm2x16(vec2(lobes.f90, lobes.roughness)), floatBitsToUint(relative_ior),
            floatBitsToUint(gap_at(photon.origin_rs, landing.way)), pack_direction(landing.shading_normal));
    }
}
