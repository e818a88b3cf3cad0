#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/surface.glsl"
#include "lib/octahedral.glsl"
#include "lib/pixels.glsl"
#include "lib/surface_packing.glsl"
#include "particles/grid.glsl"
#include "particles/lists.glsl"

// The slot `diffuse` of one pixel, W/(m²·sr): L(x) = ρ/π·E(x), with the pixel's own albedo ρ = indirect_diffuse_albedo(). E is a plane through the
// irradiances of the particles in the list of the pixel's particle, fitted by least squares with the weights of a kernel around x (local linear
// regression: a mean alone would be pulled inwards at the edges of a surface), and kept between the smallest and the largest of them.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usampler2D homes;
layout(set = 0, binding = 1) uniform usamplerBuffer list_lengths;
layout(set = 0, binding = 2) uniform usamplerBuffer lists;
layout(set = 0, binding = 3) uniform samplerBuffer irradiance;  // and the area of each
layout(set = 0, binding = 4, rgba32f) writeonly uniform image2D diffuse;

layout(push_constant, scalar) uniform Push { vec3 shift; } push;

const uint NO_PARTICLE = 0xFFFFFFFFu;

vec3 irradiance_at(vec3 position, vec3 normal, uint home) {
    float radius = KERNEL_SPACINGS * particle_spacing;
    // Moments of offsets (u, v) in units of the radius, and of irradiance with them.
    float weights = 0.0;
    vec2 first = vec2(0.0);
    vec3 second = vec3(0.0);
    vec3 sum = vec3(0.0);
    vec3 along_u = vec3(0.0);
    vec3 along_v = vec3(0.0);
    vec3 least = vec3(3e38);
    vec3 most = vec3(0.0);
    vec3 tangent = normalize(abs(normal.x) > 0.7 ? vec3(-normal.y, normal.x, 0.0) : vec3(0.0, -normal.z, normal.y));
    vec3 bitangent = cross(normal, tangent);
    uint start = home * LIST_CAPACITY;
    uint end = start + texelFetch(list_lengths, int(home)).x;
    [[dont_unroll]] for (uint place = start; place < end; ++place) {
        int particle = int(texelFetch(lists, int(place)).x);
        uvec4 record = texelFetch(particle_places, particle);
        vec3 way = (uintBitsToFloat(record.xyz) - position) / radius;
        float inside = max(1.0 - dot(way, way), 0.0);
        float weight = inside * inside * max(dot(unpack_direction(record.w), normal), 0.0);
        if (weight <= 0.0) {
            continue;
        }
        vec4 gathered = texelFetch(irradiance, particle);
        vec3 value = gathered.rgb;
        // By the share of the surface that the particle stands for.
        weight *= gathered.w;
        vec2 offset = vec2(dot(way, tangent), dot(way, bitangent));
        weights += weight;
        first += weight * offset;
        second += weight * vec3(offset.x * offset.x, offset.x * offset.y, offset.y * offset.y);
        sum += weight * value;
        along_u += weight * offset.x * value;
        along_v += weight * offset.y * value;
        least = min(least, value);
        most = max(most, value);
    }
    if (weights <= 0.0) {
        return texelFetch(irradiance, int(home)).rgb;
    }
    // The plane's value at the origin, by Cramer's rule.
    float scale = 1.0 / weights;
    vec2 m = first * scale;
    vec3 s = second * scale;
    vec3 mean = sum * scale;
    vec3 spread = vec3(s.x - m.x * m.x, s.y - m.x * m.y, s.z - m.y * m.y);
    float determinant = spread.x * spread.z - spread.y * spread.y;
    // Points on a line or a single one know of no plane.
    if (determinant <= 1e-4) {
        return mean;
    }
    vec3 cu = along_u * scale - mean * m.x;
    vec3 cv = along_v * scale - mean * m.y;
    vec3 slope_u = (cu * spread.z - cv * spread.y) / determinant;
    vec3 slope_v = (cv * spread.x - cu * spread.y) / determinant;
    return clamp(mean - slope_u * m.x - slope_v * m.y, least, most);
}

void main() {
    ivec2 pixel = pixel_of_invocation();
    ivec2 size = imageSize(diffuse);
    if (!is_inside(pixel, size)) {
        return;
    }
    vec3 radiance = vec3(0.0);
    uint home = texelFetch(homes, pixel, 0).x;
    if (home != NO_PARTICLE) {
        float pixel_depth = texelFetch(depth, pixel, 0).x;
        vec3 position_rs = position_of_pixel(camera, ndc_of_pixel(pixel, size), pixel_depth);
        vec4 lobe = HAS_SPECULAR != 0u ? texelFetch(specular, pixel, 0) : vec4(0.0);
        Surface point = unpack_surface(position_rs, texelFetch(surface, pixel, 0), lobe);
        vec3 received = irradiance_at(position_rs + push.shift, point.normal, home);
        radiance = indirect_diffuse_albedo(point) * received * INVERSE_PI;
    }
    imageStore(diffuse, pixel, vec4(radiance, 1.0));
}
