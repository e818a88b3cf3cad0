// The surface that a path met, as the kernels after `surface` read it, in 2 texels (rgba32ui), or 5 in a scene with specular lobes:
//
//   position | geometric normal       normals: packed directions, on the viewer's side
//   diffuse albedo | shading normal
//   f0 | f90 and roughness (unorm16 each)
//   transmission | relative ior (lobes.glsl)
//   ratio of densities at arrival, |cos|/d² towards the last vertex, transmittance since then (half floats) and, in the upper half of
//   the last word, the density with which light paths are sent here (mis.glsl: the upper half of a float)
#ifndef PATH_VERTEX
#define PATH_VERTEX

#include "lib/octahedral.glsl"
#include "lib/lobes.glsl"

const int VERTEX_TEXELS = SPECULAR_LOBES != 0u ? 5 : 2;

struct Vertex {
    vec3 position_rs;
    vec3 geometric_normal;
    vec3 normal;
    Matter matter;
    float ratio;
    float reverse_geometry;
    float target_density;
};

Vertex load_vertex(usamplerBuffer vertices, uint path) {
    int first = VERTEX_TEXELS * int(path);
    uvec4 a = texelFetch(vertices, first);
    uvec4 b = texelFetch(vertices, first + 1);
    Vertex vertex;
    vertex.position_rs = uintBitsToFloat(a.xyz);
    vertex.geometric_normal = unpack_direction(a.w);
    vertex.normal = unpack_direction(b.w);
    vertex.matter = Matter(uintBitsToFloat(b.xyz), vec3(0.0), 0.0, 1.0, vec3(0.0), 1.0);
    vertex.ratio = 0.0;
    vertex.reverse_geometry = 0.0;
    vertex.target_density = 0.0;
    if (SPECULAR_LOBES != 0u) {
        uvec4 c = texelFetch(vertices, first + 2);
        uvec4 d = texelFetch(vertices, first + 3);
        uvec4 e = texelFetch(vertices, first + 4);
        vec2 layer = unpackUnorm2x16(c.w);
        vertex.matter.f0 = uintBitsToFloat(c.xyz);
        vertex.matter.f90 = layer.x;
        vertex.matter.alpha = max(layer.y * layer.y, MINIMUM_ALPHA);
        vertex.matter.transmission = uintBitsToFloat(d.xyz);
        vertex.matter.relative_ior = uintBitsToFloat(d.w);
        vertex.ratio = uintBitsToFloat(e.x);
        vertex.reverse_geometry = uintBitsToFloat(e.y);
        vertex.target_density = uintBitsToFloat(e.w & 0xFFFF0000u);
    }
    return vertex;
}

// Directions from the vertex in the frame of its shading normal. The viewer is kept above it.
vec3 local_viewer(Frame frame, vec3 to_viewer) {
    vec3 viewer = to_local(frame, to_viewer);
    return normalize(vec3(viewer.xy, max(viewer.z, 1e-4)));
}

#endif
