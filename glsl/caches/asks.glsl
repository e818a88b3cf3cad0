// What pixels ask for: the eight nodes around a point of a surface, listed once for all neighbours that ask for the same.
#ifndef CACHES_ASKS
#define CACHES_ASKS

#include "caches/cascades.glsl"

struct Ask {
    vec3 position_rs;
    vec3 normal;  // the surface's own, towards the eye
    uint lowest;  // the address of the lowest node, and NOT_DIFFUSE
};

// The surface reflects nothing diffusely: it has caches for what it mirrors, and takes nothing of their light.
const uint NOT_DIFFUSE = 0x80000000u;

uint node_of_ask(Ask ask, int resolution, int corner) {
    return (ask.lowest & ~NOT_DIFFUSE) + corner_offset(resolution, corner);
}

// Asks that a group of 64 invocations takes, one for each corner. Words 0 to 2 of the list's head are such groups, in rows of ROW_GROUPS; word 3 counts the asks.
const uint GROUP_ASKS = 8u;
const uint ROW_GROUPS = 32768u;

// The number of the ask that an invocation works for; it takes the corner gl_LocalInvocationIndex % 8.
uint ask_of_invocation() {
    return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * GROUP_ASKS + gl_LocalInvocationIndex / 8u;
}

#endif
