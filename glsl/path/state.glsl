// What is kept of a path between kernels, in texels:
//
//   path_rays    2 vec4   origin, |cos| at the vertex that the ray leaves (geometric normal) | direction, density of the direction, 1/sr
//   path_states  1 vec4   throughput (a camera's path: 1; a light's: flux in W), ratio of densities for the weights (see mis.glsl)
//   path_flags   1 uint   FLAG_ bits; above them what the vertex that the ray leaves has to tell, see below
//   path_seeds   1 uvec2  seed of the path's sequence, index of the sample in it
//   path_hits    1 vec4   distance, barycentric coordinates of corners 1 and 2, bits of the triangle's number
#ifndef PATH_STATE
#define PATH_STATE

// Where light found by a camera's path goes (the slots of glsl/compose/image.comp, in their order).
const uint SLOT_EMISSION = 0u;
const uint SLOT_DIRECT = 1u;
const uint SLOT_DIFFUSE = 2u;
const uint SLOT_CAUSTICS = 3u;
const uint SLOT_SPECULAR = 4u;
const uint SLOT_COUNT = 5u;

const uint FLAG_SLOT_MASK = 7u;          // the slot of what the path finds behind its next vertex but one
const uint FLAG_FIRST_DIFFUSE = 8u;      // a camera's path: its first vertex scattered diffusely
const uint FLAG_LAST_SPECULAR = 16u;     // the last vertex scattered specularly
const uint FLAG_ALL_SPECULAR = 32u;      // every vertex so far did
const uint FLAG_BEYOND_DIFFUSE = 64u;    // some vertex before the last scattered diffusely
const uint FLAG_FIRST_BEHIND = 128u;     // the first vertex transmitted; told only where the slots ask for it (FOLLOWED)

// Whether the last vertex is a diffuse one that mirrors or glass show: specular lobes that light it make caustics.
bool lights_mirrored(uint flags) {
    const uint others = FLAG_FIRST_DIFFUSE | FLAG_LAST_SPECULAR | FLAG_ALL_SPECULAR | FLAG_BEYOND_DIFFUSE;
    return (flags & FLAG_SLOT_MASK) == SLOT_SPECULAR && (flags & others) == 0u;
}

// A path that a light sends to a target carries the triangle's number in the bits above; one that scattered the
// density with which light paths are sent to the last vertex, the upper half of a float. Between them lie the bits of path/mirrors.glsl.
const uint TARGET_SHIFT = 8u;
const uint TARGETS_TOLD_APART = 0xFFFFFFu;
const uint DENSITY_MASK = 0xFFFF0000u;

// Never 0, which stands for no target.
uint target_mark(uint triangle) {
    return triangle % TARGETS_TOLD_APART + 1u;
}

// What photons carry (src/estimator/sppm.rs): the specialisation constant PHOTONS of kernels that leave that to them.
const uint PHOTONS_NONE = 0u;            // nothing: there are none
const uint PHOTONS_ALL = 1u;             // all light that scatters before a path's first diffuse vertex
const uint PHOTONS_SOME = 2u;            // the same without light of the sky and of lights with a range

// Streams of the sample sequence at each vertex.
const uint STREAM_CAMERA = 0u;
const uint STREAM_LIGHT = 1u;            // + 2 · depth
const uint STREAM_SCATTER = 2u;          // + 2 · depth
const uint STREAM_EMISSION = 0x80000000u;

struct Ray {
    vec3 origin;
    float cosine;
    vec3 direction;
    float density;
};

Ray load_ray(samplerBuffer rays, uint path) {
    vec4 a = texelFetch(rays, 2 * int(path));
    vec4 b = texelFetch(rays, 2 * int(path) + 1);
    return Ray(a.xyz, a.w, b.xyz, b.w);
}

#endif
