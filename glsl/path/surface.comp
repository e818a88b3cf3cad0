#version 460
#include "lib/prelude.glsl"
#include "groups/light_targets.glsl"
#include "groups/paths.glsl"
#include "groups/scene_rays.glsl"
#include "lib/emissive_cells.glsl"
#include "lib/hit_material.glsl"
#include "lib/traced_scene.glsl"
#include "path/mis.glsl"
#include "path/queue.glsl"
#include "path/state.glsl"
#include "path/vertex.glsl"

// What one path met. A camera's path adds the light that it ran into, weighted against other ways of finding it (mis.glsl); if
// the surface scatters, its normals and lobes are left for the kernels that follow.

layout(local_size_x = 64) in;

// 1: textures are filtered over the pixel at the first vertex, as rasterisation does.
layout(constant_id = 2) const uint PIXEL_FOOTPRINT = 0u;

layout(set = 0, binding = 0) uniform samplerBuffer path_hits;
layout(set = 0, binding = 1) uniform CameraBlock { Camera camera; };
layout(set = 0, binding = 2) writeonly buffer VertexBlock { uvec4 vertices[]; };
layout(set = 0, binding = 3) buffer RadianceBlock { vec4 path_radiance[]; };
layout(set = 0, binding = 4) buffer QueueBlock { uint alive_queue[]; };

layout(push_constant, scalar) uniform Push {
    vec3 sky;              // W/(m²·sr)
    uint depth;            // vertices before this one
    CameraRays rays;
    vec2 pixel_size;       // of the image plane's half sides: 2/width, 2/height
    LightPaths light_paths;
    uint path_count;
    uint ends;             // 1: nothing scatters here, the path only looks for light
} push;

// The change of the texture coordinates from this pixel to the next one, where the neighbour's ray meets the plane of the triangle.
vec4 texcoord_step(Triangle triangle, vec3 position, vec3 ray_step) {
    vec3 normal = cross(triangle.edge1, triangle.edge2);
    bool orthographic = camera.depth_range > 0.0;
    vec3 eye = camera.position_rs + (orthographic ? ray_step : vec3(0.0));
    vec3 way = position - camera.position_rs;
    vec3 ray = orthographic ? camera.forward : way / max(dot(way, camera.forward), 1e-20) + ray_step;
    vec3 start = orthographic ? position + ray_step : eye;
    float along = dot(position - start, normal) / dot(ray, normal);
    vec3 moved = start + along * ray - position;
    float inverse = 1.0 / max(dot(normal, normal), 1e-37);
    float u = dot(cross(moved, triangle.edge2), normal) * inverse;
    float v = dot(cross(triangle.edge1, moved), normal) * inverse;
    return interpolated(corner_texcoords, triangle, vec3(-u - v, u, v));
}

void add_radiance(uint path, uint slot, vec3 radiance) {
    uint place = slot * push.path_count + path;
    path_radiance[place] = vec4(path_radiance[place].rgb + radiance, 0.0);
}

// The slot of light that the path runs into here.
uint slot_of_emission(uint flags, bool unlit) {
    bool mirrored = FOLLOWED != 0u && push.depth == 1u && ((flags & FLAG_FIRST_BEHIND) != 0u || (unlit && (flags & FLAG_FIRST_DIFFUSE) == 0u));
    return mirrored ? SLOT_SPECULAR : push.depth == 0u ? SLOT_EMISSION : push.depth == 1u ? SLOT_DIRECT : flags & FLAG_SLOT_MASK;
}

// Returns whether the path goes on from here.
bool meet_surface(uint path) {
    Ray ray = load_ray(path_rays, path);
    vec4 state = texelFetch(path_states, int(path));
    uint flags = texelFetch(path_flags, int(path)).x;
    vec4 hit = texelFetch(path_hits, int(path));
    uint index = floatBitsToUint(hit.w);
    if (index == 0xFFFFFFFFu) {
        if (FROM_LIGHT == 0u && max3(push.sky) > 0.0) {
            add_radiance(path, slot_of_emission(flags, false), state.rgb * push.sky);
        }
        return false;
    }
    // What hides a target is reached by other paths.
    bool first_of_light = FROM_LIGHT != 0u && PHOTONS == PHOTONS_NONE && push.depth == 0u;
    if (first_of_light && flags >> TARGET_SHIFT != 0u && flags >> TARGET_SHIFT != target_mark(index)) {
        return false;
    }
    Triangle triangle = load_triangle(triangles, index);
    vec3 weights = vec3(1.0 - hit.y - hit.z, hit.yz);
    vec3 face = front_normal(triangle);
    vec3 position = point_of_hit(triangle, hit.yz, face, ray.origin, hit.x * ray.direction);
    bool front = dot(face, ray.direction) < 0.0;
    vec3 geometric_normal = front ? face : -face;
    float cosine = abs(dot(face, ray.direction));

    Material material = load_material(materials, triangle.material);
    vec4 color = VERTEX_COLORS != 0u ? interpolated(corner_colors, triangle, weights) : vec4(1.0);
    MaterialPoint point = material_factors(material, color);
    vec3 normal_texel = vec3(0.0, 0.0, 1.0);
    if ((material.flags & TEXTURES & MATERIAL_ALL_TEXTURES) != 0u) {
        vec4 sets = interpolated(corner_texcoords, triangle, weights);
        Footprint footprint = Footprint(vec4(0.0), vec4(0.0));
        if (PIXEL_FOOTPRINT != 0u && push.depth == 0u) {
            footprint.dx = texcoord_step(triangle, position, camera.right_scaled * push.pixel_size.x);
            footprint.dy = texcoord_step(triangle, position, camera.down_scaled * push.pixel_size.y);
        }
        apply_textures(point, normal_texel, material, triangle.material, sets, footprint);
    }

    // ---- what the densities of mis.glsl need
    float reverse_geometry = ray.cosine / max(hit.x * hit.x, 1e-30);
    float ratio = state.w;
    if (LIGHT_PATHS != 0u) {
        if (FROM_LIGHT != 0u) {
            ratio *= (ray.cosine < 0.0 ? 1.0 : hit.x * hit.x) / max(cosine, 1e-9);
        } else if (push.depth == 0u) {
            ratio = 1.0 / max(camera_rays_per_area(push.rays, camera.position_rs, camera.forward, position, face), 1e-37);
        } else {
            ratio *= hit.x * hit.x / max(cosine, 1e-9);
        }
    }

    // ---- light
    vec3 transmittance = vec3(1.0);
    if (TRANSMISSIVE != 0u && !front) {
        vec4 medium = texelFetch(media, int(triangle.material));
        transmittance = exp(-medium.xyz * (medium.w * hit.x));
    }
    if (FROM_LIGHT == 0u && (PHOTONS == PHOTONS_NONE || (flags & FLAG_BEYOND_DIFFUSE) == 0u)) {
        bool unlit = (material.flags & MATERIAL_UNLIT) != 0u;
        vec3 emitted = emitted_radiance(material, point, front);
        if (max3(emitted) > 0.0 && (!unlit || (flags & FLAG_ALL_SPECULAR) != 0u)) {
            float weight = 1.0;
            if (push.depth > 0u && triangle.light_density > 0.0) {
                float sides = (material.flags & MATERIAL_DOUBLE_SIDED) != 0u ? 2.0 : 1.0;
                float next = emissive_density(triangle, hit.yz) * hit.x * hit.x / max(cosine, 1e-9);
                float others = next;
                if (LIGHT_PATHS != 0u && push.depth > 1u) {
                    // state.w · density is C_k · p(z_k → z_{k−1}) of the vertex that the ray left.
                    float anywhere = (cosine * INVERSE_PI / sides) * reverse_geometry;
                    float sent = light_path_density(push.light_paths, anywhere, uintBitsToFloat(flags & DENSITY_MASK));
                    others += next * state.w * ray.density * push.light_paths.count * sent;
                }
                weight = ray.density / (ray.density + others);
            }
            add_radiance(path, slot_of_emission(flags, unlit), state.rgb * transmittance * emitted * weight);
        }
    }
    Lobes lobes = lobes_of_material(material, point);
    vec3 transmission = point.base_color.rgb * ((1.0 - point.metallic) * point.transmission);
    bool unlit = (material.flags & MATERIAL_UNLIT) != 0u;
    bool dark = max3(lobes.diffuse_albedo) <= 0.0 && (SPECULAR_LOBES == 0u || unlit || max(max3(lobes.f0), max(lobes.f90, max3(transmission))) <= 0.0);
    bool gathered = PHOTONS == PHOTONS_ALL && FROM_LIGHT == 0u && (flags & FLAG_ALL_SPECULAR) == 0u;
    if (push.ends != 0u || dark || gathered) {
        return false;
    }

    // ---- the vertex
    vec3 normal = mapped_normal(triangle, material, weights, face, geometric_normal, normal_texel);
    uint first = uint(VERTEX_TEXELS) * path;
    vertices[first] = uvec4(floatBitsToUint(position), pack_direction(geometric_normal));
    vertices[first + 1u] = uvec4(floatBitsToUint(clamp(lobes.diffuse_albedo, 0.0, 1.0)), pack_direction(normal));
    if (SPECULAR_LOBES != 0u) {
        float relative_ior = 1.0;
        if (TRANSMISSIVE != 0u && max3(transmission) > 0.0 && texelFetch(media, int(triangle.material)).w > 0.0) {
            relative_ior = front ? material.ior : 1.0 / material.ior;
        }
        vertices[first + 2u] = uvec4(
            floatBitsToUint(clamp(lobes.f0, 0.0, 1.0)), packUnorm2x16(vec2(lobes.f90, lobes.roughness)));
        vertices[first + 3u] = uvec4(floatBitsToUint(clamp(transmission, 0.0, 1.0)), floatBitsToUint(relative_ior));
        uint target_density = 0u;
        if (LIGHT_PATHS != 0u && push.light_paths.targeted > 0.0) {
            target_density = floatBitsToUint(texelFetch(target_densities, int(index)).x) & DENSITY_MASK;
        }
        vertices[first + 4u] = uvec4(
            floatBitsToUint(ratio), floatBitsToUint(reverse_geometry), packHalf2x16(transmittance.rg),
            packHalf2x16(vec2(transmittance.b, 0.0)) | target_density);
    }
    return true;
}

void main() {
    uint path = queued_path(active_paths);
    bool alive = path != NO_PATH && meet_surface(path);
    APPEND_TO_QUEUE(alive_queue, path, alive)
}
