// Whether a ray meets the surface of a node. The paper (alg. 3.5) compares the depths of ray and node at the texel's centre, |Δd| < ε: ε is a length
// that no scene shares with another, the hit is where the ray is in the middle of the texel, and a ray that falls steeply passes between two
// texels' depths unseen. Here the ray meets the node's plane, through the surface's point at the texel's centre, and the hit counts if it lies
// in the texel's column. It is exact on flat surfaces, at any resolution, and knows no thickness.
#ifndef PHOTON_LISTS_HIT
#define PHOTON_LISTS_HIT

#include "lib/finite.glsl"
#include "photon_lists/node.glsl"
#include "photon_lists/view.glsl"
#include "photons/records.glsl"

// Half the widths of a column, texels: a texel's own, and a little more. Wider columns stretch every surface's edge; narrower ones lose hits on
// convex edges, where the planes of neighbours meet beyond either's column. A drawn line moreover leaves out texels that the ray crosses
// at a corner: their neighbours stand in for them.
const float MARCH_COLUMN = 0.75;
const float LINE_COLUMN = 1.0;

// Near its start a ray meets the surface that it leaves, since that is known as planes of texels: for so many texels along the ray, what it
// crosses from behind and what its start lies in, to a fraction of a texel, is no hit. The paper refuses hits with n·r > 0 all along the ray, but
// a wall that is a single sheet blocks light from its back too.
const float START_TEXELS = 2.0;
const float START_HEIGHT = 0.1;

// A ray in the space of a view: texel coordinates times w, w, and the depth, in metres, at its start and for each metre.
struct ViewRay {
    vec3 start;
    vec3 step;
    float depth;
    float depth_step;
};

ViewRay view_ray(ListView view, PhotonRay ray) {
    vec4 origin = vec4(ray.origin_rs, 1.0);
    vec3 direction = ray.direction;
    return ViewRay(
        vec3(dot(view.row_x, origin), dot(view.row_y, origin), dot(view.row_w, origin)),
        vec3(dot(view.row_x.xyz, direction), dot(view.row_y.xyz, direction), dot(view.row_w.xyz, direction)),
        dot(view.row_depth, origin), dot(view.row_depth.xyz, direction));
}

// Cuts off where a + t·b < 0.
void clip_where(inout vec2 range, float a, float b) {
    float at = -a / b;
    range.x = b > 0.0 ? max(range.x, at) : range.x;
    range.y = b < 0.0 ? min(range.y, at) : range.y;
    range.y = b == 0.0 && a < 0.0 ? -1.0 : range.y;
}

// Distances along the ray that the view covers, up to `end`; empty if the second is less than the first.
vec2 clip_to_view(ListView view, ViewRay ray, float resolution, float end) {
    vec2 range = vec2(0.0, end);
    clip_where(range, ray.start.x, ray.step.x);
    clip_where(range, resolution * ray.start.z - ray.start.x, resolution * ray.step.z - ray.step.x);
    clip_where(range, ray.start.y, ray.step.y);
    clip_where(range, resolution * ray.start.z - ray.start.y, resolution * ray.step.z - ray.step.y);
    clip_where(range, ray.depth - view.near, ray.depth_step);
    clip_where(range, view.far - ray.depth, -ray.depth_step);
    return range;
}

const float NO_HIT_DISTANCE = 3e38;

// Along the ray to the surface of a node in the column around `center`, `width` to each side, m; NO_HIT_DISTANCE if the ray does not meet it.
float distance_to_node(uvec4 node, ListView view, Column column, vec2 center, float width, ViewRay along, PhotonRay ray) {
    vec3 normal = unpack_direction(node.y);
    vec3 to_node = column.start + uintBitsToFloat(node.x) * column.way - ray.origin_rs;
    float height = dot(normal, to_node);
    float facing = dot(normal, ray.direction);
    float distance = height / facing;
    vec3 at = along.start + distance * along.step;
    // Magnitudes as bits, which order as the values do; those of what is no number are beyond any width. A ray in the node's plane meets it nowhere.
    uvec2 off = floatBitsToUint(at.xy / at.z - center) & 0x7FFFFFFFu;
    float texel = view.texel * at.z;
    bool from_behind = facing > 0.0 && (ray.bits & PHOTON_INSIDE) == 0u;
    bool is_start = distance < START_TEXELS * texel && (from_behind || abs(height) < START_HEIGHT * texel);
    bool in_column = max(off.x, off.y) < floatBitsToUint(width) && at.z > 0.0;
    return distance > 0.0 && in_column && !is_start ? distance : NO_HIT_DISTANCE;
}

struct NodeHit {
    float distance;
    uint normal;
    uint material;
};

// Takes the nearer of two. Of nodes at the same distance the content decides, never the place in the list.
void take_nearer(inout NodeHit nearest, float distance, uvec4 node) {
    bool nearer = distance < nearest.distance;
    bool least = node.y < nearest.normal || (node.y == nearest.normal && node.w < nearest.material);
    bool taken = nearer || (distance == nearest.distance && least);
    nearest.normal = taken ? node.y : nearest.normal;
    nearest.material = taken ? node.w : nearest.material;
    nearest.distance = min(nearest.distance, distance);
}

#endif
