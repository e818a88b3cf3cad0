// Visibility of a VPL from its imperfect shadow map (Ritschel et al. 2008).
#ifndef ISM_LOOKUP
#define ISM_LOOKUP

#include "ism/map.glsl"
#include "lib/vpl.glsl"

// Whether the VPL, the k-th, sees the point of a surface with this normal, which faces it. What a texel holds is compared with the plane
// of the receiver in the direction of the texel's centre: a flat wall does not shadow itself at any slope.
bool ism_sees(samplerBuffer maps, uint resolution, uint k, Vpl vpl, vec3 position_rs, vec3 normal) {
    float side = float(resolution);
    vec3 axis = vpl.normal * inversesqrt(dot(vpl.normal, vpl.normal));
    vec3 way = position_rs - vpl.position_rs;
    vec3 position = to_map_frame(axis, way);
    float distance = sqrt(dot(way, way));
    vec2 place = position.xy / max(distance + position.z, 1e-20);
    ivec2 texel = clamp(ivec2((0.5 * place + 0.5) * side), ivec2(0), ivec2(int(resolution) - 1));
    float known = texelFetch(maps, int((k * resolution + uint(texel.y)) * resolution + uint(texel.x))).x;
    float inverse = 1.0 / max(distance, 1e-20);
    float plane = dot(to_map_frame(axis, normal), direction_of_map(center_of_texel(texel, side))) / dot(normal, way);
    return known <= max(inverse, min(plane, 2.0 * inverse));
}

#endif
