#version 460
#include "lib/prelude.glsl"
#include "voxels/triangle.glsl"

// A triangle seen along its dominant axis, a pixel for each column of voxels, enlarged so that it covers the centre of every column that it touches (Hasselgren,
// Akenine-Möller & Ohlsson 2005): its edges are moved outwards by the reach of half a pixel. One that is narrow is the box around it, since its corners would move far.

layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

layout(set = 0, binding = 0) uniform usamplerBuffer triangles;

layout(push_constant, scalar) uniform Push {
    VoxelGrid grid;
    uint triangle_capacity;
    uint side;  // of the area, in pixels
} push;

layout(location = 0) flat in int number[];
layout(location = 0) flat out int drawn;

// What rasterisers round corners by, and more, in pixels.
const float SLACK = 0.125;
// Boxes of so few columns are drawn whole.
const int FEW_COLUMNS = 4;

void emit(vec2 place) {
    drawn = number[0];
    gl_Position = vec4(2.0 * place / float(push.side) - 1.0, 0.0, 1.0);
    EmitVertex();
}

// The line of an edge, moved outwards: n·x = z for what lies on it.
vec3 moved_edge(vec2 a, vec2 b, float turn) {
    vec2 outwards = turn * vec2(b.y - a.y, a.x - b.x);
    return vec3(outwards, dot(outwards, a) + (0.5 + SLACK) * (abs(outwards.x) + abs(outwards.y)));
}

vec2 crossing(vec3 first, vec3 second) {
    float area = first.x * second.y - first.y * second.x;
    return vec2(first.z * second.y - second.z * first.y, first.x * second.z - second.x * first.z) / area;
}

void main() {
    if (uint(number[0]) >= push.triangle_capacity) {
        return;
    }
    VoxelTriangle triangle = unpacked_triangle(texelFetch(triangles, 2 * number[0]), texelFetch(triangles, 2 * number[0] + 1));
    triangle = turned_triangle(triangle, dominant_axis(normal_of(triangle)));
    int area = normal_of(triangle).z;
    float unit = 1.0 / float(push.grid.units);
    vec2 a = vec2(triangle.a.xy) * unit;
    vec2 b = vec2(triangle.b.xy) * unit;
    vec2 c = vec2(triangle.c.xy) * unit;
    ivec2 first = lowest(triangle).xy / push.grid.units;
    ivec2 last = highest(triangle).xy / push.grid.units;
    vec2 low = vec2(first) - SLACK;
    vec2 high = vec2(last) + 1.0 + SLACK;
    vec2 longest = high - low;
    // Twice the area over the longest side is the height at least.
    float height = abs(float(area)) * unit * unit / max(max(longest.x, longest.y), 1.0);
    ivec2 columns = last - first + 1;
    if (min(columns.x, columns.y) < FEW_COLUMNS || height < 2.0) {
        emit(low);
        emit(vec2(high.x, low.y));
        emit(vec2(low.x, high.y));
        emit(high);
    } else {
        float turn = area < 0 ? -1.0 : 1.0;
        vec3 ab = moved_edge(a, b, turn);
        vec3 bc = moved_edge(b, c, turn);
        vec3 ca = moved_edge(c, a, turn);
        emit(crossing(ca, ab));
        emit(crossing(ab, bc));
        emit(crossing(bc, ca));
    }
    EndPrimitive();
}
