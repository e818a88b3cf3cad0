// How ways are followed (ways.glsl).
#ifndef TRACE_WALKING
#define TRACE_WALKING

// A lobe below this roughness takes one ray: its reflections are sharp.
const float SMOOTH_ROUGHNESS = 0.05;

struct Walking {
    vec3 sky;              // W/(m²·sr)
    uint sample_count;     // rays of a wide lobe at the first surface
    uint depth;            // specular events at most
    uint capacity;         // points for which there is room
    uint point_lights;     // 1: there are lights that specular lobes alone can answer to
};

#endif
