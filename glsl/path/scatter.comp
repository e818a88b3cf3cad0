#version 460
#include "lib/prelude.glsl"
#include "groups/new_paths.glsl"
#include "groups/paths.glsl"
#include "groups/scene_rays.glsl"
#include "lib/color.glsl"
#include "lib/sobol.glsl"
#include "path/mirrors.glsl"
#include "path/mis.glsl"
#include "path/queue.glsl"
#include "path/state.glsl"
#include "path/vertex.glsl"

// Sends one path on: a lobe by its share, a direction by the lobe's density, β ← β · f·|cos|/p. Russian roulette ends paths that carry
// little; what survives carries more for it. A light's path takes the adjoint of a shading normal (Veach 1997, section 5.3),
// f*·|cos| = f·|cos| · |l·n_s||v·n_g| / (|l·n_g||v·n_s|), and no factor 1/η² where it is refracted.

layout(local_size_x = 64) in;

#include "lib/ray_offset.glsl"

layout(push_constant, scalar) uniform Push {
    uint depth;  // vertices before this one
    float flux;  // that a light's path carries at first, on the average, W (luminance)
    LightPaths light_paths;
} push;

// The slot that light found from the second vertex on goes to, and what later kernels need to know of the lobes so far.
uint flags_after(uint flags, uint lobe, bool behind) {
    bool diffuse = lobe == LOBE_DIFFUSE;
    uint slot = flags & FLAG_SLOT_MASK;
    uint kept = flags & (FLAG_FIRST_DIFFUSE | FLAG_ALL_SPECULAR | FLAG_FIRST_BEHIND);
    kept |= (flags & FLAG_ALL_SPECULAR) == 0u ? FLAG_BEYOND_DIFFUSE : 0u;
    if (push.depth == 0u) {
        slot = SLOT_SPECULAR;
        kept |= diffuse ? FLAG_FIRST_DIFFUSE : 0u;
        kept |= FOLLOWED != 0u && behind ? FLAG_FIRST_BEHIND : 0u;
    } else if (push.depth == 1u && (flags & FLAG_FIRST_DIFFUSE) != 0u) {
        slot = diffuse ? SLOT_DIFFUSE : SLOT_CAUSTICS;
    }
    bool mirrored = MIRRORS != 0u && FROM_LIGHT == 0u;
    bool reflects = !diffuse && mirrors_of(flags) == push.depth;
    kept |= !mirrored ? 0u : reflects ? min(push.depth + 1u, 255u) << MIRRORS_SHIFT : flags & MIRRORS_MASK;
    return slot | (diffuse ? kept & ~FLAG_ALL_SPECULAR : kept | FLAG_LAST_SPECULAR);
}

// How densities change: C for a camera's path, D for a light's (mis.glsl), up to the factor at arrival.
float ratio_after(Vertex vertex, LobeSample drawn, vec3 viewer, float arriving_density) {
    float reverse = lobe_density(vertex.matter, drawn.lobe, drawn.direction, viewer) * vertex.reverse_geometry;
    if (FROM_LIGHT != 0u) {
        // The first vertex: `arriving_density` is that of next-event estimation on the light, in 1/m².
        return vertex.ratio * (push.depth == 0u ? 1.0 + reverse / arriving_density : reverse) / drawn.density;
    }
    if (push.depth == 0u) {
        return drawn.lobe == LOBE_DIFFUSE ? vertex.ratio / drawn.density : 0.0;
    }
    return vertex.ratio * reverse / drawn.density;
}

bool scatter(uint path) {
    Vertex vertex = load_vertex(path_vertices, path);
    vec4 arrival = new_rays[2u * path + 1u];
    Frame frame = frame_around(vertex.normal);
    vec3 viewer = local_viewer(frame, -arrival.xyz);
    uvec2 seed = texelFetch(path_seeds, int(path)).xy;
    vec4 random = sobol_sample(sobol, seed.y, seed_of(seed.x, STREAM_SCATTER + 2u * push.depth));
    LobeSample drawn = sample_lobes(vertex.matter, viewer, random.x, random.yz);
    vec3 direction = to_world(frame, drawn.direction);
    float side = dot(vertex.geometric_normal, direction);
    bool later = FROM_LIGHT == 0u && push.depth > 1u;
    if (SPECULAR_CAUSTICS != 0u && later && drawn.lobe == LOBE_DIFFUSE && (new_flags[path] & FLAG_SLOT_MASK) == SLOT_CAUSTICS) {
        return false;
    }
    if (DIFFUSE_ALONE != 0u && FROM_LIGHT == 0u && push.depth > 0u && drawn.lobe == LOBE_SPECULAR) {
        return false;
    }
    if (FOLLOWED == FOLLOWED_UNMIRRORED && FROM_LIGHT == 0u && drawn.lobe == LOBE_SPECULAR && lights_mirrored(new_flags[path])) {
        return false;
    }
    if (MIRRORS != 0u && FROM_LIGHT == 0u && !is_within_mirrors(new_flags[path], push.depth)) {
        return false;
    }
    if (MIRRORS != 0u && FROM_LIGHT == 0u && drawn.lobe == LOBE_SPECULAR && is_beyond_mirrors(new_flags[path], push.depth, vertex.matter.alpha)) {
        return false;
    }
    if (drawn.density <= 0.0 || side * drawn.direction.z <= 0.0) {
        return false;
    }
    vec4 state = new_states[path];
    vec3 weight = drawn.weight;
    if (SPECULAR_LOBES != 0u) {
        uvec4 last = texelFetch(path_vertices, VERTEX_TEXELS * int(path) + 4);
        weight *= vec3(unpackHalf2x16(last.z), unpackHalf2x16(last.w).x);
    }
    float scale = 1.0;
    if (FROM_LIGHT != 0u) {
        float arriving = abs(dot(vertex.geometric_normal, arrival.xyz));
        scale = viewer.z * abs(side) / (max(arriving, 1e-6) * max(abs(drawn.direction.z), 1e-6));
    } else if (TRANSMISSIVE != 0u && side < 0.0) {
        // Radiance changes by the square of the ratio of indices.
        scale = 1.0 / (vertex.matter.relative_ior * vertex.matter.relative_ior);
    }
    bool sent = FROM_LIGHT != 0u && PHOTONS == PHOTONS_NONE;
    if (sent && push.depth == 0u) {
        // The vertex knows how many paths are sent to it: fewer carry more.
        float anywhere = max(1.0 / max(push.light_paths.count * vertex.ratio, 1e-30), 1e-30);
        float change = anywhere / light_path_density(push.light_paths, anywhere, vertex.target_density);
        scale *= change;
        vertex.ratio *= change;
    }
    vec3 throughput = state.rgb * weight * scale;
    // A camera's path may carry 1, a light's what they start with.
    float before = FROM_LIGHT != 0u ? push.flux : 1.0;
    float carried = FROM_LIGHT != 0u ? luminance(throughput) : max3(throughput);
    if (TRANSMISSIVE != 0u && FROM_LIGHT == 0u) {
        // What radiance loses on its way into a medium it gains on its way out.
        float index = max(side < 0.0 ? vertex.matter.relative_ior : 1.0 / vertex.matter.relative_ior, 1.0);
        before /= index * index;
    }
    // The factor trades rays against noise: 2 is the best of 1, 2 and 4 in the Cornell boxes; for light paths, the first vertex of
    // which is worth most and always goes on, 1/4 of 1/8 to 1 in `ring`. The bound ends even what scatters without loss.
    float eagerness = sent ? (push.depth == 0u ? 1e9 : 0.25) : 2.0;
    float most = push.depth < 8u ? 1.0 : 0.95;
    // What is no number goes on: it is counted where it would be added (path/resolve.comp, particle/splat.comp).
    float survival = is_finite(throughput) ? min(eagerness * carried / max(before, 1e-37), most) : most;
    if (random.w >= survival) {
        return false;
    }
    float ratio = LIGHT_PATHS != 0u ? ratio_after(vertex, drawn, viewer, arrival.w) : 0.0;
    new_states[path] = vec4(throughput / survival, ratio);
    new_flags[path] = flags_after(new_flags[path], drawn.lobe, side < 0.0) | floatBitsToUint(vertex.target_density);
    vec3 origin = offset_ray_origin(vertex.position_rs, side > 0.0 ? vertex.geometric_normal : -vertex.geometric_normal);
    new_rays[2u * path] = vec4(origin, abs(side));
    new_rays[2u * path + 1u] = vec4(direction, drawn.density);
    return true;
}

void main() {
    uint path = queued_path(alive_paths);
    bool wanted = path != NO_PATH && scatter(path);
    APPEND_TO_QUEUE(new_paths, path, wanted)
}
