// Which triangles have particles on both sides: double-sided ones, and those of one-sided parts whose backs other surfaces see (src/frame/rays/backs.rs).
#ifndef PARTICLES_SIDES
#define PARTICLES_SIDES

#include "groups/scene_rays.glsl"
#include "lib/traced_scene.glsl"

// 1: there are such parts.
layout(constant_id = 5) const uint HAS_BACKS = 0u;

// `backs`: a bit for each triangle.
bool has_both_sides(usamplerBuffer backs, uint triangle, Material material) {
    bool seen = HAS_BACKS != 0u && (texelFetch(backs, int(triangle >> 5)).x >> (triangle & 31u) & 1u) != 0u;
    return seen || (material.flags & MATERIAL_DOUBLE_SIDED) != 0u;
}

#endif
