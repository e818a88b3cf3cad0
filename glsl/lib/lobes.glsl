// How a path's vertex scatters: the lobes of lib/brdf.glsl, transmission included, each with the density that it is sampled with.
//
// All directions are in the frame of the shading normal and point away from the vertex; the viewer is where the path comes
// from. A path is labelled with the lobe at each vertex, and so are its densities: density = P(lobe | viewer) · p(direction | lobe).
//
//   D   diffuse_albedo/π · (1 − F(v·h))                              cosine-distributed
//   S   above the surface: F · D · V                                 visible normals
//       below it: (1 − F) · tint · microfacet transmission           visible normals, refracted (Walter et al. 2007) or, for a thin
//                                                                    wall, reflected and mirrored through it
//
// F is the brightest channel's where it takes light from other lobes. Where light passes between media F is taken on the thinner
// side, and 1 beyond the critical angle, so that it is the same both ways.
#ifndef LIB_LOBES
#define LIB_LOBES

#include "groups/lobes.glsl"
#include "lib/brdf.glsl"
#include "lib/microfacet.glsl"

const uint LOBE_DIFFUSE = 0u;
const uint LOBE_SPECULAR = 1u;

// What a vertex is made of.
struct Matter {
    vec3 diffuse_albedo;
    vec3 f0;
    float f90;
    float alpha;         // GGX
    vec3 transmission;   // tint times the share that is transmitted
    float relative_ior;  // beyond the surface over the viewer's side; 1: a thin wall
};

vec3 fresnel(Matter matter, float cosine) {
    if (TRANSMISSIVE != 0u && matter.relative_ior < 1.0) {
        float beyond2 = 1.0 - (1.0 - cosine * cosine) / (matter.relative_ior * matter.relative_ior);
        return beyond2 <= 0.0 ? vec3(1.0) : schlick_fresnel(matter.f0, matter.f90, sqrt(beyond2));
    }
    return schlick_fresnel(matter.f0, matter.f90, cosine);
}

// P(D), P(reflection), P(transmission), for a viewer at this cosine. Any positive shares are right; these follow the albedos.
vec3 lobe_shares(Matter matter, float cosine) {
    if (SPECULAR_LOBES == 0u) {
        return vec3(1.0, 0.0, 0.0);
    }
    float reflected = max3(fresnel(matter, cosine));
    // The lobes see F(v·h), which at grazing views is below F(n·v); beyond the critical angle of the surface as a whole some of its
    // microfacets still transmit, the more the rougher it is.
    vec3 shares = vec3(
        max3(matter.diffuse_albedo) * (1.0 - 0.5 * reflected), reflected,
        max3(matter.transmission) * max(1.0 - reflected, 0.5 * matter.alpha));
    return shares / max(shares.x + shares.y + shares.z, 1e-20);
}

// f·|cos| and the labelled density of a direction, in one lobe.
struct LobeValue {
    vec3 value;     // 1
    float density;  // 1/sr
};

LobeValue diffuse_lobe(Matter matter, vec3 viewer, vec3 direction, float share) {
    if (direction.z <= 0.0 || share <= 0.0) {
        return LobeValue(vec3(0.0), 0.0);
    }
    float below_layer = 1.0;
    if (SPECULAR_LOBES != 0u) {
        vec3 middle = normalize_or(viewer + direction, vec3(0.0, 0.0, 1.0));
        below_layer = 1.0 - max3(schlick_fresnel(matter.f0, matter.f90, dot(viewer, middle)));
    }
    float cosine_density = direction.z * INVERSE_PI;
    return LobeValue(matter.diffuse_albedo * (below_layer * cosine_density), share * cosine_density);
}

LobeValue reflection_lobe(Matter matter, vec3 viewer, vec3 direction, float share) {
    vec3 middle = normalize_or(viewer + direction, vec3(0.0, 0.0, 1.0));
    float masking_viewer = smith_lambda(viewer.z, matter.alpha);
    float distribution = ggx_distribution(middle, matter.alpha) / (4.0 * viewer.z);
    float both = 1.0 + masking_viewer + smith_lambda(direction.z, matter.alpha);
    return LobeValue(
        fresnel(matter, dot(viewer, middle)) * (distribution / both), share * distribution / (1.0 + masking_viewer));
}

LobeValue transmission_lobe(Matter matter, vec3 viewer, vec3 direction, float share) {
    vec3 mirrored = vec3(direction.xy, -direction.z);
    bool thin = matter.relative_ior == 1.0;
    vec3 middle = thin ? viewer + mirrored : -(viewer + matter.relative_ior * direction);
    middle = normalize_or(matter.relative_ior < 1.0 ? -middle : middle, vec3(0.0, 0.0, 1.0));
    float viewer_cosine = dot(viewer, middle);
    float direction_cosine = dot(direction, middle);
    if (middle.z <= 0.0 || viewer_cosine <= 0.0 || (!thin && direction_cosine >= 0.0)) {
        return LobeValue(vec3(0.0), 0.0);
    }
    float density = visible_normal_density(viewer, middle, matter.alpha);
    float along = viewer_cosine + matter.relative_ior * direction_cosine;
    density *= thin ? 0.25 / viewer_cosine
                    : matter.relative_ior * matter.relative_ior * -direction_cosine / max(along * along, 1e-12);
    float masking = smith_masking(mirrored.z, matter.alpha);
    vec3 passed = matter.transmission * (1.0 - max3(fresnel(matter, viewer_cosine)));
    return LobeValue(passed * (density * masking), share * density);
}

// The lobe S. `shares`: lobe_shares() for the viewer.
LobeValue specular_lobe(Matter matter, vec3 viewer, vec3 direction, vec3 shares) {
    if (SPECULAR_LOBES == 0u) {
        return LobeValue(vec3(0.0), 0.0);
    }
    if (direction.z > 0.0) {
        return shares.y > 0.0 ? reflection_lobe(matter, viewer, direction, shares.y) : LobeValue(vec3(0.0), 0.0);
    }
    return TRANSMISSIVE != 0u && shares.z > 0.0 && direction.z < 0.0
        ? transmission_lobe(matter, viewer, direction, shares.z) : LobeValue(vec3(0.0), 0.0);
}

// The vertex as the other side sees it, when the viewer moves through the surface.
Matter seen_from(Matter matter, bool other_side) {
    if (TRANSMISSIVE != 0u && other_side) {
        matter.relative_ior = 1.0 / matter.relative_ior;
    }
    return matter;
}

// The labelled density with which a path that comes from `viewer` is sent towards `direction` by `lobe`. Either may be below.
float lobe_density(Matter matter, uint lobe, vec3 viewer, vec3 direction) {
    bool below = viewer.z < 0.0;
    if (below) {
        viewer.z = -viewer.z;
        direction.z = -direction.z;
        matter = seen_from(matter, true);
    }
    viewer.z = max(viewer.z, 1e-4);
    vec3 shares = lobe_shares(matter, viewer.z);
    return lobe == LOBE_DIFFUSE ? (direction.z > 0.0 ? shares.x * direction.z * INVERSE_PI : 0.0)
                                : specular_lobe(matter, viewer, direction, shares).density;
}

struct LobeSample {
    vec3 direction;
    vec3 weight;    // f·|cos|/density
    float density;  // 0: nothing is scattered
    uint lobe;
};

LobeSample sample_lobes(Matter matter, vec3 viewer, float choice, vec2 random) {
    vec3 shares = lobe_shares(matter, viewer.z);
    LobeSample drawn = LobeSample(vec3(0.0), vec3(0.0), 0.0, LOBE_DIFFUSE);
    LobeValue lobe;
    if (SPECULAR_LOBES == 0u || choice < shares.x) {
        drawn.direction = sample_cosine_hemisphere(random);
        lobe = diffuse_lobe(matter, viewer, drawn.direction, shares.x);
    } else {
        drawn.lobe = LOBE_SPECULAR;
        vec3 middle = sample_visible_normal(viewer, matter.alpha, random);
        vec3 mirrored = 2.0 * dot(viewer, middle) * middle - viewer;
        drawn.direction = mirrored;
        if (TRANSMISSIVE != 0u && choice >= shares.x + shares.y) {
            drawn.direction = matter.relative_ior == 1.0 ? vec3(mirrored.xy, -mirrored.z)
                                                         : refract(-viewer, middle, 1.0 / matter.relative_ior);
        }
        // A direction on the wrong side is one that the surface itself blocks.
        bool below = TRANSMISSIVE != 0u && choice >= shares.x + shares.y;
        if (dot(drawn.direction, drawn.direction) < 0.5 || (drawn.direction.z < 0.0) != below) {
            return drawn;
        }
        lobe = specular_lobe(matter, viewer, drawn.direction, shares);
    }
    if (lobe.density > 0.0) {
        drawn.density = lobe.density;
        drawn.weight = lobe.value / lobe.density;
    }
    return drawn;
}

#endif
