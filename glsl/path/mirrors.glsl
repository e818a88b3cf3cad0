// Paths whose limits are those of what mirrors and glass show (MIRRORS of groups/paths.glsl): from the eye on specular vertices are counted apart.
#ifndef PATH_MIRRORS
#define PATH_MIRRORS

#include "groups/paths.glsl"
#include "lib/narrow.glsl"

// In path_flags: how many vertices, from the first on, scattered specularly.
const uint MIRRORS_SHIFT = 8u;
const uint MIRRORS_MASK = 0xFF00u;

uint mirrors_of(uint flags) {
    return (flags & MIRRORS_MASK) >> MIRRORS_SHIFT;
}

// Whether light may be found at vertex number `depth` and beyond it of a camera's path.
bool is_within_mirrors(uint flags, uint depth) {
    uint mirrors = mirrors_of(flags);
    return mirrors <= MIRRORS && depth - mirrors <= BOUNCES;
}

// Whether a specular lobe, of a surface that is not to be followed further, leaves lamps and the sky out: where it is narrow these are what a further reflection
// shows. Wide ones answer to them, as diffuse ones do.
bool is_beyond_mirrors(uint flags, uint depth, float alpha) {
    return mirrors_of(flags) == depth && depth == MIRRORS && is_narrow(alpha);
}

#endif
