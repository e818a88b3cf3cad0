// The estimation list of one radiance particle, as mesh_list.comp leaves it: which candidates it holds, as bits | length, and how often it was widened in bits
// 8 and up | how far above the particle segments begin. There is one for every radiance particle, or one for each that is found.
#ifndef PARTICLES_MESH_SLOT
#define PARTICLES_MESH_SLOT

// In mesh_views.glsl.
const float INTERPOLATES = 2.0;

uint length_of_slot(uvec4 slot) {
    return slot.z & 0xFFu;
}

#endif
