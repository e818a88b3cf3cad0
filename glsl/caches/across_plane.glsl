// Where means of positions are moved to.
#ifndef CACHES_ACROSS_PLANE
#define CACHES_ACROSS_PLANE

// The part of `way` along the plane with this normal; nothing if it is longer than `longest`, and so leads off what is there.
vec3 across_plane(vec3 normal, vec3 way, float longest) {
    vec3 across = way - dot(normal, way) * normal;
    return dot(across, across) > longest * longest ? vec3(0.0) : across;
}

#endif
