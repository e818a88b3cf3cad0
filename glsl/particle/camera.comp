#version 460
#include "lib/prelude.glsl"
#include "groups/paths.glsl"
#include "groups/scene_rays.glsl"
#include "lib/scene.glsl"
#include "path/mis.glsl"
#include "path/queue.glsl"
#include "path/state.glsl"
#include "path/vertex.glsl"

// Connects a vertex of a light's path to the camera: what its diffuse lobe sends through the pixel that sees it,
//
//   Φ · f(l, v) |l·n_s|/|l·n_g| · c(z)/N        W/(m²·sr), averaged over the pixel
//
// with c(z) camera rays per m² of surface (mis.glsl). The light came from a diffuse vertex (slot `diffuse`) or a specular one
// (`caustics`). The ray to the camera is left for `splat`.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform CameraBlock { Camera camera; };
layout(set = 0, binding = 1) writeonly buffer ConnectionRayBlock { vec4 connection_rays[]; };
layout(set = 0, binding = 2) writeonly buffer ConnectionLightBlock { vec4 connection_light[]; };
layout(set = 0, binding = 3) buffer QueueBlock { uint connections[]; };

#include "lib/ray_offset.glsl"

layout(push_constant, scalar) uniform Push {
    CameraRays rays;
    uvec2 size;         // of the image
    float light_paths;  // N
    uint reserved;
} push;

struct Sight {
    vec3 to_camera;
    float distance;  // to the near plane
    ivec2 pixel;     // outside the image where the camera does not see the point
};

Sight sight_of(vec3 position) {
    vec3 way = position - camera.position_rs;
    float along = dot(way, camera.forward);
    bool orthographic = camera.depth_range > 0.0;
    vec2 across = vec2(
        dot(way, camera.right_scaled) / dot(camera.right_scaled, camera.right_scaled),
        dot(way, camera.down_scaled) / dot(camera.down_scaled, camera.down_scaled));
    vec2 ndc = orthographic ? across : across / max(along, 1e-20);
    vec2 place = floor((0.5 * ndc + 0.5) * vec2(push.size));
    bool seen = along > camera.near && all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(push.size)));
    vec3 to_camera = orthographic ? -camera.forward : -normalize(way);
    float slant = orthographic ? 1.0 : 1.0 / max(dot(-to_camera, camera.forward), 1e-6);
    return Sight(to_camera, (along - camera.near) * slant, seen ? ivec2(place) : ivec2(-1));
}

bool connect_to_camera(uint path) {
    Vertex vertex = load_vertex(path_vertices, path);
    Sight sight = sight_of(vertex.position_rs);
    vec3 to_light = -texelFetch(path_rays, 2 * int(path) + 1).xyz;
    Frame frame = frame_around(vertex.normal);
    vec3 direction = to_local(frame, to_light);
    float side = dot(vertex.geometric_normal, sight.to_camera);
    if (sight.pixel.x < 0 || side <= 0.0 || direction.z <= 0.0 || dot(frame.normal, sight.to_camera) <= 0.0) {
        return false;
    }
    vec3 viewer = local_viewer(frame, sight.to_camera);
    LobeValue diffuse = diffuse_lobe(vertex.matter, viewer, direction, lobe_shares(vertex.matter, viewer.z).x);
    if (diffuse.density <= 0.0) {
        return false;
    }
    float rays_per_area = camera_rays_per_area(push.rays, camera.position_rs, camera.forward, vertex.position_rs, vertex.geometric_normal);
    float others = vertex.ratio * diffuse.density * vertex.reverse_geometry * rays_per_area;
    uvec4 last = texelFetch(path_vertices, VERTEX_TEXELS * int(path) + 4);
    vec3 transmittance = vec3(unpackHalf2x16(last.z), unpackHalf2x16(last.w).x);
    vec3 flux = texelFetch(path_states, int(path)).rgb * transmittance;
    float arriving = max(abs(dot(vertex.geometric_normal, to_light)), 1e-6);
    vec3 light = flux * diffuse.value * (rays_per_area / (arriving * push.light_paths * (1.0 + others)));
    uint flags = texelFetch(path_flags, int(path)).x;
    uint slot = (flags & FLAG_LAST_SPECULAR) != 0u ? 1u : 0u;
    if (SPECULAR_CAUSTICS != 0u && slot == 1u && (flags & FLAG_ALL_SPECULAR) == 0u) {
        return false;
    }
    uint place = slot * push.size.x * push.size.y + uint(sight.pixel.y) * push.size.x + uint(sight.pixel.x);
    connection_rays[2u * path] = vec4(offset_ray_origin(vertex.position_rs, vertex.geometric_normal), sight.distance);
    connection_rays[2u * path + 1u] = vec4(sight.to_camera, uintBitsToFloat(place));
    connection_light[2u * path] = vec4(light, 0.0);
    return max3(light) > 0.0;
}

void main() {
    uint path = queued_path(alive_paths);
    bool wanted = path != NO_PATH && connect_to_camera(path);
    APPEND_TO_QUEUE(connections, path, wanted)
}
