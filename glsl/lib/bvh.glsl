#ifndef LIB_BVH
#define LIB_BVH
const uint NO_TRIANGLE = 0xFFFFFFFFu;
struct Hit { float distance; vec2 barycentric; uint triangle; };
Hit closest_hit(vec3 origin, vec3 direction, float t_max) {
    Hit hit = Hit(t_max, vec2(0.0), NO_TRIANGLE);
    int count = textureSize(bvh_triangles) / 3;
    for (int i = 0; i < count; ++i) {
        vec4 a = texelFetch(bvh_triangles, 3 * i);
        vec3 e1 = texelFetch(bvh_triangles, 3 * i + 1).xyz;
        vec3 e2 = texelFetch(bvh_triangles, 3 * i + 2).xyz;
        vec3 from = origin - a.xyz;
        vec3 across = cross(direction, e2);
        float inverse = 1.0 / dot(e1, across);
        float u = dot(from, across) * inverse;
        vec3 around = cross(from, e1);
        float v = dot(direction, around) * inverse;
        float t = dot(e2, around) * inverse;
        if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < hit.distance) {
            hit = Hit(t, vec2(u, v), floatBitsToUint(a.w));
        }
    }
    return hit;
}
bool is_occluded(vec3 origin, vec3 direction, float t_max) {
    return closest_hit(origin, direction, t_max).triangle != NO_TRIANGLE;
}
#endif
