#version 460
#include "lib/prelude.glsl"
#include "photons/append.glsl"
#include "photons/arrivals.glsl"
#include "photons/beam.glsl"
#include "photons/random.glsl"
#include "photons/surface_texel.glsl"
#include "lib/lobes.glsl"

// Sends one photon on from a specular surface: reflection or transmission by their shares, a direction by the lobe's density (glsl/lib/lobes.glsl;
// Quyen 2014, section 3.3.1.2, has Phong's lobe and rolls a die for absorption, where here the photon carries less),
//
//   Φ ← Φ · f·|cos|/p · |l·n_s||v·n_g| / (|l·n_g||v·n_s|)
//
// with the adjoint of the shading normal (Veach 1997, section 5.3) and no factor 1/η², since it is flux that is refracted. From the second
// surface on Russian roulette ends photons that lost most of their flux; those that survive carry the others' share.

layout(local_size_x = 64) in;

// 1: the surfaces that light meets first, whose photons were drawn by what they send on.
layout(constant_id = 2) const uint FIRST = 0u;

layout(set = 0, binding = 0) uniform usamplerBuffer arrivals;
layout(set = 0, binding = 1) uniform usamplerBuffer surfaces;
layout(set = 0, binding = 2) uniform usamplerBuffer arrival_counts;
layout(set = 0, binding = 3) writeonly buffer RayBlock { uvec4 rays[]; };
layout(set = 0, binding = 4) buffer CountBlock { uint counts[]; };

layout(set = 0, binding = 5) uniform samplerBuffer arrival_beams;
layout(set = 0, binding = 6) writeonly buffer BeamBlock { vec4 beams[]; };

layout(push_constant, scalar) uniform Push {
    uint stage;
    uint capacity;
    uint beams_decide;  // 1: discs stand for lobes (photons/beam.glsl)
} push;

// Directions nearer to the surface than this do not gain by the adjoint without bound.
const float GRAZING = 0.01;

// The roughest lobe on the way so far, in the upper half of the bits.
void note_lobe(inout PhotonRay photon, float alpha) {
    float before = unpackHalf2x16(photon.bits >> 16).x;
    photon.bits = (photon.bits & 0xFFFFu) | packHalf2x16(vec2(max(before, alpha), 0.0)) << 16;
}

// From the drawn direction towards the middle of its lobe about `normal`, as far as the disc stands for the lobe. `below`: it is transmitted.
vec3 towards_middle(vec3 drawn, vec3 arriving, vec3 normal, bool below, float relative_ior, float alpha) {
    vec3 middle = reflect(arriving, normal);
    if (below) {
        middle = relative_ior == 1.0 ? arriving : refract(arriving, normal, 1.0 / relative_ior);
    }
    float share = dot(middle, middle) > 0.5 ? lobe_in_disc(alpha) : 0.0;
    // Half way between opposite directions there is none.
    vec3 between = mix(drawn, middle, share);
    return dot(between, between) > 1e-12 ? normalize(between) : drawn;
}

// How the neighbours of a photon that arrived go on.
Beam scattered_beam(uint index, vec3 arriving, vec3 normal, bool refracted, float relative_ior) {
    int first = int(ARRIVAL_BEAM_TEXELS * index);
    Beam beam = load_beam(arrival_beams, first);
    vec4 a = texelFetch(arrival_beams, first + 3);
    vec4 b = texelFetch(arrival_beams, first + 4);
    vec3 normal_u = a.xyz;
    vec3 normal_v = vec3(a.w, b.xy);
    if (!refracted) {
        beam.direction_u = reflected_change(arriving, normal, beam.direction_u, normal_u);
        beam.direction_v = reflected_change(arriving, normal, beam.direction_v, normal_v);
    } else if (relative_ior != 1.0) {
        beam.direction_u = refracted_change(arriving, normal, 1.0 / relative_ior, beam.direction_u, normal_u);
        beam.direction_v = refracted_change(arriving, normal, 1.0 / relative_ior, beam.direction_v, normal_v);
    }
    return beam;
}

bool scatter(inout PhotonRay photon, uvec4 surface, uvec4 layer, uint index, out Beam beam) {
    vec2 packed_layer = unpackUnorm2x16(layer.x);
    Matter matter = Matter(
        vec3(0.0), unpack_root_color(surface.z), packed_layer.x, max(packed_layer.y * packed_layer.y, MINIMUM_ALPHA),
        unpack_root_color(surface.w), uintBitsToFloat(layer.y));
    vec3 geometric_normal = unpack_direction(surface.y);
    Frame frame = frame_around(unpack_direction(surface.x));
    vec3 viewer = to_local(frame, -photon.direction);
    viewer = normalize(vec3(viewer.xy, max(viewer.z, 1e-4)));
    vec4 random = photon_random(photon.seed, push.stage + 1u);
    LobeSample drawn = sample_lobes(matter, viewer, random.z, random.xy);
    vec3 direction = to_world(frame, drawn.direction);
    float side = dot(geometric_normal, direction);
    if (drawn.density <= 0.0 || side * drawn.direction.z <= 0.0) {
        return false;
    }
    float arriving = abs(dot(geometric_normal, photon.direction));
    float adjoint = viewer.z * abs(side) / (max(arriving, GRAZING) * max(abs(drawn.direction.z), GRAZING));
    vec3 flux = photon.flux * drawn.weight * adjoint;
    if (!is_finite(flux) || max3(flux) <= 0.0) {
        return false;
    }
    if (FIRST == 0u) {
        float survival = min(2.0 * max3(flux) / max(max3(photon.flux), 1e-37), 1.0);
        if (random.w >= survival) {
            return false;
        }
        flux /= survival;
    }
    if (side < 0.0 && matter.relative_ior != 1.0) {
        photon.bits ^= PHOTON_INSIDE;
    }
    bool below = drawn.direction.z < 0.0;
    beam = scattered_beam(index, photon.direction, frame.normal, below, matter.relative_ior);
    if (push.beams_decide != 0u) {
        vec3 bent = unpack_direction(layer.w);
        vec3 middle = towards_middle(direction, photon.direction, bent, below, matter.relative_ior, matter.alpha);
        direction = dot(geometric_normal, middle) * side > 0.0 ? middle : direction;
    }
    note_lobe(photon, matter.alpha);
    photon.origin_rs += (side > 0.0 ? geometric_normal : -geometric_normal) * uintBitsToFloat(layer.z);
    photon.direction = normalize(direction);
    photon.flux = flux;
    return true;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    bool wanted = index < texelFetch(arrival_counts, int(push.stage * STAGE_WORDS + COUNT_WORD)).x;
    PhotonRay photon;
    Beam beam;
    if (wanted) {
        photon = load_photon_ray(arrivals, index);
        wanted = scatter(photon, texelFetch(surfaces, 2 * int(index)), texelFetch(surfaces, 2 * int(index) + 1), index, beam);
    }
    uint place;
    APPEND_TO_STAGE(counts, push.stage, wanted, place)
    if (wanted && place < push.capacity) {
        rays[3u * place] = uvec4(floatBitsToUint(photon.origin_rs), floatBitsToUint(photon.travelled));
        rays[3u * place + 1u] = uvec4(floatBitsToUint(photon.direction), photon.bits);
        rays[3u * place + 2u] = uvec4(floatBitsToUint(photon.flux), photon.seed);
        vec4 packed_beam[3] = pack_beam(beam);
        beams[RAY_BEAM_TEXELS * place] = packed_beam[0];
        beams[RAY_BEAM_TEXELS * place + 1u] = packed_beam[1];
        beams[RAY_BEAM_TEXELS * place + 2u] = packed_beam[2];
    }
}
