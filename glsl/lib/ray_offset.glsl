// Rays that start on a surface: moved off it by a few units in the last place, whatever the scale of the scene.
#ifndef LIB_RAY_OFFSET
#define LIB_RAY_OFFSET

// Wächter & Binder 2019 (Ray Tracing Gems, chapter 6). `normal`: unit, on the side that the ray leaves to.
vec3 offset_ray_origin(vec3 position, vec3 normal) {
    ivec3 steps = ivec3(256.0 * normal);
    vec3 moved = intBitsToFloat(floatBitsToInt(position) + ivec3(
        position.x < 0.0 ? -steps.x : steps.x, position.y < 0.0 ? -steps.y : steps.y, position.z < 0.0 ? -steps.z : steps.z));
    const float small = 1.0 / 32.0;
    return mix(moved, position + normal * (1.0 / 65536.0), lessThan(abs(position), vec3(small)));
}

#endif
