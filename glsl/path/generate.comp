#version 460
#include "lib/prelude.glsl"
#include "groups/new_paths.glsl"
#include "groups/scene_rays.glsl"
#include "lib/scene.glsl"
#include "lib/sobol.glsl"
#include "path/pixels.glsl"
#include "path/queue.glsl"
#include "path/state.glsl"

// Starts one path from the camera: a ray through the pixel's centre, or through a point of it (box filter), where
// rasterisation would see it, from the near plane on. Its throughput is 1: a pixel is the mean of the radiance along its rays.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform CameraBlock { Camera camera; };

layout(push_constant, scalar) uniform Push {
    WavePixels wave;
    uint sample_count;  // of every pixel in this wave
    uint first_sample;
    uint seed;          // of this half
    uint box_filter;    // 0: centres
} push;

void main() {
    uint path = gl_GlobalInvocationID.x;
    uint paths_per_sample = 64u * push.wave.block_count;
    uint number = path / paths_per_sample;
    uvec2 pixel = pixel_of_place(push.wave, path - number * paths_per_sample);
    bool inside = number < push.sample_count && all(lessThan(pixel, push.wave.size));
    if (inside) {
        uint seed = mix_bits((pixel.y << 16 | pixel.x) ^ mix_bits(push.seed));
        uint index = push.first_sample + number;
        vec2 place = vec2(0.5);
        if (push.box_filter != 0u) {
            place = sobol_sample(sobol, index, seed_of(seed, STREAM_CAMERA)).xy;
        }
        vec2 ndc = 2.0 * (vec2(pixel) + place) / vec2(push.wave.size) - 1.0;
        vec3 across = ndc.x * camera.right_scaled + ndc.y * camera.down_scaled;
        bool orthographic = camera.depth_range > 0.0;
        vec3 ray = orthographic ? camera.forward : camera.forward + across;
        vec3 origin = camera.position_rs + ray * camera.near + (orthographic ? across : vec3(0.0));
        new_rays[2u * path] = vec4(origin, 1.0);
        new_rays[2u * path + 1u] = vec4(normalize(ray), 0.0);
        new_states[path] = vec4(vec3(1.0), 0.0);
        new_flags[path] = FLAG_ALL_SPECULAR;
        new_seeds[path] = uvec2(seed, index);
    }
    APPEND_TO_QUEUE(new_paths, path, inside)
}
