#version 460
#include "lib/prelude.glsl"
#include "groups/surface.glsl"
#include "lib/octahedral.glsl"
#include "photon_splat/disc.glsl"
#include "photon_splat/extent.glsl"

// One corner of the rectangle of samples that a photon's disc may light; nothing where project.comp left the photon out.

layout(set = 0, binding = 0) uniform usamplerBuffer discs;
layout(set = 0, binding = 1) uniform usamplerBuffer places;

layout(push_constant, scalar) uniform Push {
    ivec2 image_size;
    int downscale;
    float tolerance;
    ivec2 range;
} push;

layout(location = 0) flat out vec3 center;       // render space
layout(location = 1) flat out vec4 irradiance;   // W/m²; allowed height in m
layout(location = 2) flat out vec4 disc_normal;  // 1/h²
layout(location = 3) flat out vec3 squeeze;      // 1/m

void main() {
    int photon = gl_InstanceIndex;
    vec4 place = uintBitsToFloat(texelFetch(discs, 3 * photon));
    uvec4 disc = texelFetch(discs, 3 * photon + 1);
    float height = allowed_height(place.w, push.tolerance);
    vec3 normal = unpack_direction(disc.w);
    center = place.xyz;
    squeeze = uintBitsToFloat(texelFetch(discs, 3 * photon + 2).xyz);
    irradiance = vec4(uintBitsToFloat(disc.xyz), height);
    disc_normal = vec4(normal, 1.0 / (place.w * place.w));
    gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
    if (texelFetch(places, photon).x != NO_CELL) {
        Extent extent = disc_extent(camera, center, normal, place.w, height, push.image_size, push.downscale);
        vec2 size = vec2(lattice_size(push.image_size, push.downscale));
        // Around the samples that it holds, in whole squares: rasterisers move other edges, by up to 1/16 of a sample.
        vec2 low = clamp(ceil(extent.center - extent.radius - 0.5), vec2(0.0), size);
        vec2 high = clamp(floor(extent.center + extent.radius + 0.5), low, size);
        // Corners 3 1 2 and 2 1 0: two triangles.
        uint corner = 0x312210u >> (4u * (5u - gl_VertexIndex)) & 3u;
        vec2 position = vec2((corner & 1u) != 0u ? high.x : low.x, (corner & 2u) != 0u ? high.y : low.y);
        gl_Position = vec4(2.0 * position / size - 1.0, 0.0, 1.0);
    }
}
