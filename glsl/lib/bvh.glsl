// Rays against the scene's triangles: eight-wide bounding volume hierarchy with quantised boxes (Ylitie, Karras & Laine 2017),
// watertight triangle test (Woop, Benthin & Wald 2013). The host's side, with the layout, is src/scene/bvh.rs.
//
// If the including shader defines BVH_ACCEPTS_HITS and, before the include, a function `bool accepts_hit(uint triangle, vec2 barycentric)`,
// hits of flagged triangles must pass that.
#ifndef LIB_BVH
#define LIB_BVH

#include "groups/scene_rays.glsl"

const uint NO_TRIANGLE = 0xffffffffu;

// A group of children waits at each level at most; the host builds no deeper tree.
const int BVH_STACK_SIZE = 32;

// Bounds the rounding of where a triangle is met, 16 units in the last place (meets_triangle).
const float HIT_SLACK = 1.0 / 1048576.0;
// Where a ray to a surface ends, over its length.
const float END = 0.9999;
// Share of the way to a hit that this may be before the triangle's plane is asked.
const float LARGEST_SLACK = 1.0 / 4096.0;

// Bounds the rounding of a box's distances, as shares of the distance and of the way to the node's corner.
const float BVH_DISTANCE_SLACK = 1.000001;
const float BVH_CORNER_SLACK = 4e-7;

struct Hit {
    float distance;    // in lengths of the direction; the ray's end if nothing was hit
    vec2 barycentric;  // weights of corners 1 and 2
    uint triangle;     // index in the host's list, NO_TRIANGLE if none
};

// What all tests of one ray share.
struct PreparedRay {
    vec3 origin;
    vec3 inverse_direction;
    bvec3 backwards;
    uint octant;  // bits 2, 1, 0: x, y, z do not decrease
    // Rows of the shear that turns the direction into the third axis, of length 1.
    vec3 shear_x;
    vec3 shear_y;
    vec3 shear_z;
    float slowness;  // lengths of the direction for a meter along its largest axis
    float start;     // nearer than this, in lengths of the direction, rays were moved off the surface that they leave (lib/ray_offset.glsl)
};

PreparedRay prepare_ray(vec3 origin, vec3 direction) {
    vec3 size = abs(direction);
    float largest = max(size.x, max(size.y, size.z));
    // An axis along which the ray stands still gets a slope that moves it less than a rounding error.
    float least = 1e-12 * largest;
    vec3 moving = mix(direction, vec3(least), lessThan(size, vec3(least)));

    PreparedRay ray;
    ray.origin = origin;
    ray.inverse_direction = 1.0 / moving;
    ray.backwards = lessThan(moving, vec3(0.0));
    ray.octant = (ray.backwards.x ? 0u : 4u) | (ray.backwards.y ? 0u : 2u) | (ray.backwards.z ? 0u : 1u);
    vec3 inverse = ray.inverse_direction;
    ray.slowness = 1.0 / largest;
    ray.start = uintBitsToFloat(texelFetch(bvh_nodes, textureSize(bvh_nodes) - 1).x) * ray.slowness;
    if (size.x >= largest) {
        ray.shear_x = vec3(-direction.y * inverse.x, 1.0, 0.0);
        ray.shear_y = vec3(-direction.z * inverse.x, 0.0, 1.0);
        ray.shear_z = vec3(inverse.x, 0.0, 0.0);
    } else if (size.y >= largest) {
        ray.shear_x = vec3(0.0, -direction.z * inverse.y, 1.0);
        ray.shear_y = vec3(1.0, -direction.x * inverse.y, 0.0);
        ray.shear_z = vec3(0.0, inverse.y, 0.0);
    } else {
        ray.shear_x = vec3(1.0, 0.0, -direction.x * inverse.z);
        ray.shear_y = vec3(0.0, 1.0, -direction.y * inverse.z);
        ray.shear_z = vec3(0.0, 0.0, inverse.z);
    }
    return ray;
}

// Along the ray to the plane of a triangle, and what rounding may make of that. The plane's distance from the origin is known (corner 2's fourth
// component), so that only the start's own coordinates round, and the normal, by as much as the corner is sharp.
vec2 plane_distance(vec3 corner0, vec3 corner1, vec4 corner2, PreparedRay ray) {
    vec3 edge1 = corner1 - corner0;
    vec3 edge2 = corner2.xyz - corner0;
    vec2 inverse_lengths = vec2(
        1.0 / max(abs(edge1.x), max(abs(edge1.y), abs(edge1.z))), 1.0 / max(abs(edge2.x), max(abs(edge2.y), abs(edge2.z))));
    vec3 normal = cross(edge1 * inverse_lengths.x, edge2 * inverse_lengths.y);
    float sharpness = inversesqrt(dot(normal, normal));
    normal *= sharpness;
    vec3 size = abs(ray.origin);
    float inverse_slope = 1.0 / dot(normal, 1.0 / ray.inverse_direction);
    float rounding = HIT_SLACK * (max(size.x, max(size.y, size.z)) + abs(corner2.w)) * (1.0 + sharpness);
    return vec2(corner2.w - dot(normal, ray.origin), rounding) * vec2(inverse_slope, abs(inverse_slope));
}

// Whether the ray meets the triangle at `place` of the tree's order nearer than `hit`, which it then replaces.
//
// All triangles at a corner shear it to the same point, and the signs of `weights` are exact or 0 there (products round
// monotonically, so none may be fused): of the triangles around an edge or a corner a ray cannot miss all.
//
// Of a hit that is nearer than rounding tells nobody knows whether it lies before or behind the ray's start: it is none, so that a ray does not
// meet the surface that it leaves (Pharr, Jakob & Humphreys, Physically Based Rendering, 4th ed., 6.8.2-3). With M the largest coordinate of the
// corners as seen from the start, S what the shear leaves of it across the ray, Z the depths that the triangle covers, and det twice its area
// across the ray, that is u·(M + M·S·Z/det), where u is HIT_SLACK. Where that is too much of
// the way, the triangle is a large one beside the ray, and its plane knows better (plane_distance).
bool meets_triangle(uint place, PreparedRay ray, bool to_surface, inout Hit hit) {
    int texel = 3 * int(place);
    vec4 corner0 = texelFetch(bvh_triangles, texel);
    vec4 corner1 = texelFetch(bvh_triangles, texel + 1);
    vec4 corner2 = texelFetch(bvh_triangles, texel + 2);
    vec3 a = corner0.xyz - ray.origin;
    vec3 b = corner1.xyz - ray.origin;
    vec3 c = corner2.xyz - ray.origin;
    precise vec3 x = vec3(dot(a, ray.shear_x), dot(b, ray.shear_x), dot(c, ray.shear_x));
    precise vec3 y = vec3(dot(a, ray.shear_y), dot(b, ray.shear_y), dot(c, ray.shear_y));
    precise vec3 weights = x.zxy * y.yzx - y.zxy * x.yzx;
    float least = min(weights.x, min(weights.y, weights.z));
    float greatest = max(weights.x, max(weights.y, weights.z));
    float inverse = 1.0 / (weights.x + weights.y + weights.z);
    vec3 shares = weights * inverse;
    vec3 z = vec3(dot(a, ray.shear_z), dot(b, ray.shear_z), dot(c, ray.shear_z));
    float distance = dot(shares, z);
    float end = to_surface ? hit.distance * END : hit.distance;
    // Of those that are met at the same distance the first of the host's list counts, in whatever order trees hold them; NO_TRIANGLE + 1 is 0.
    uint number = floatBitsToUint(corner0.w);
    bool first = number + 1u < hit.triangle + 1u;
    bool meets = (least >= 0.0 || greatest <= 0.0) && distance > ray.start && (distance < end || first && distance == end);
    // How near the ray's start rounding may matter, a power of two by the triangle's size (src/scene/bvh.rs).
    float doubtful = uintBitsToFloat(floatBitsToUint(corner1.w) & 0x7f800000u) * ray.slowness;
    if (WIDE != 0u && meets && distance < doubtful) {
        vec3 seen = max(abs(a), max(abs(b), abs(c)));
        vec3 across = max(abs(x), abs(y));
        float most = max(seen.x, max(seen.y, seen.z)) * HIT_SLACK;
        float depths = max(z.x, max(z.y, z.z)) - min(z.x, min(z.y, z.z));
        float slack = most * (ray.slowness + max(across.x, max(across.y, across.z)) * depths * abs(inverse));
        if (slack > LARGEST_SLACK * distance) {
            vec2 known = plane_distance(corner0.xyz, corner1.xyz, corner2, ray);
            distance = known.y < slack ? known.x : distance;
            slack = min(slack, known.y);
        }
        meets = distance > slack && (distance < end || first && distance == end);
    }
#ifdef BVH_ACCEPTS_HITS
    if (meets && (floatBitsToUint(corner1.w) & 1u) != 0u) {
        meets = accepts_hit(number, shares.yz);
    }
#endif
    if (meets) {
        hit = Hit(distance, shares.yz, number);
    }
    return meets;
}

// Four children of a node: a bit for each that the ray may meet nearer than `reach`. Leaves set one bit for each triangle among
// bits 0 to 23; inner children one of bits 24 to 31, the sooner it comes along the ray the higher.
uint met_children(uint meta, uvec3 low, uvec3 high, PreparedRay ray, vec3 scale, vec3 near_corner, vec3 far_corner, float reach) {
    uint inner = ((meta & (meta << 1)) & 0x10101010u) >> 4;
    uint places = (meta ^ (ray.octant * inner)) & 0x1f1f1f1fu;
    uint bits = (meta >> 5) & 0x07070707u;
    uvec3 entry = mix(low, high, ray.backwards);
    uvec3 leave = mix(high, low, ray.backwards);
    vec3 far_scale = scale * BVH_DISTANCE_SLACK;
    uint met = 0u;
    for (int shift = 0; shift < 32; shift += 8) {
        vec3 enters = vec3(ivec3((entry >> shift) & 255u)) * scale + near_corner;
        vec3 leaves = vec3(ivec3((leave >> shift) & 255u)) * far_scale + far_corner;
        float first = max(max(enters.x, enters.y), max(enters.z, 0.0));
        float last = min(min(leaves.x, leaves.y), min(leaves.z, reach));
        met |= first <= last ? ((bits >> shift) & 255u) << ((places >> shift) & 255u) : 0u;
    }
    return met;
}

Hit traverse(vec3 origin, vec3 direction, float t_max, bool any) {
    Hit hit = Hit(t_max, vec2(0.0), NO_TRIANGLE);
    PreparedRay ray = prepare_ray(origin, direction);
    uvec2 stack[BVH_STACK_SIZE];
    int waiting = 0;
    // Children of one node: where they start; which are still to visit (bits 24 to 31), which slots hold nodes (bits 0 to 7).
    uvec2 nodes = uvec2(0u, 0x80000000u);
    while (nodes.y > 0x00ffffffu) {
        uint bit = uint(findMSB(nodes.y));
        uint slots = nodes.y;
        nodes.y ^= 1u << bit;
        if (nodes.y > 0x00ffffffu) {
            stack[waiting++] = nodes;
        }
        uint slot = (bit - 24u) ^ ray.octant;
        uint node = nodes.x + uint(bitCount(slots & ~(0xffffffffu << slot)));

        int texel = 5 * int(node);
        uvec4 head = texelFetch(bvh_nodes, texel);
        uvec4 links = texelFetch(bvh_nodes, texel + 1);
        uvec4 x = texelFetch(bvh_nodes, texel + 2);
        uvec4 y = texelFetch(bvh_nodes, texel + 3);
        uvec4 z = texelFetch(bvh_nodes, texel + 4);
        vec3 scale = uintBitsToFloat((uvec3(head.w, head.w >> 8, head.w >> 16) & 255u) << 23) * ray.inverse_direction;
        vec3 corner = (uintBitsToFloat(head.xyz) - ray.origin) * ray.inverse_direction;
        vec3 near_corner = corner - abs(corner) * BVH_CORNER_SLACK;
        vec3 far_corner = corner * BVH_DISTANCE_SLACK + abs(corner) * BVH_CORNER_SLACK;
        uint met = met_children(links.z, uvec3(x.x, y.x, z.x), uvec3(x.z, y.z, z.z), ray, scale, near_corner, far_corner, hit.distance)
                   | met_children(links.w, uvec3(x.y, y.y, z.y), uvec3(x.w, y.w, z.w), ray, scale, near_corner, far_corner, hit.distance);
        nodes = uvec2(links.x, (met & 0xff000000u) | (head.w >> 24));

        uint triangles = met & 0x00ffffffu;
        while (triangles != 0u) {
            uint place = uint(findMSB(triangles));
            triangles ^= 1u << place;
            if (meets_triangle(links.y + place, ray, any, hit) && any) {
                return hit;
            }
        }
        if (nodes.y <= 0x00ffffffu && waiting > 0) {
            nodes = stack[--waiting];
        }
    }
    return hit;
}

// The nearest triangle that the ray meets within `t_max` lengths of its direction, from either side.
Hit closest_hit(vec3 origin, vec3 direction, float t_max) {
    return traverse(origin, direction, t_max, false);
}

// Whether any triangle lies on the ray nearer than `t_max` lengths of its direction. A surface that the ray ends on does not count.
bool is_occluded(vec3 origin, vec3 direction, float t_max) {
    return traverse(origin, direction, t_max, true).triangle != NO_TRIANGLE;
}

#endif
