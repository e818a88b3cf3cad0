#version 460
#include "lib/prelude.glsl"
#include "photons/choice.glsl"

// Chooses how finely light is cut into photons (Quyen 2014, section 3.3.1.1): the finest level of the mask's pyramid on which no more blocks
// than there may be photons are not empty, and all photons that there may be shared evenly among these (photons/shares.glsl). The paper sends
// one photon a block, which uses a quarter of what is allowed at worst.

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) uniform usamplerBuffer levels;
layout(set = 0, binding = 1) readonly buffer PyramidBlock { uint pyramid[]; };
layout(set = 0, binding = 2) writeonly buffer ChoiceBlock { uint choice[]; };

layout(push_constant, scalar) uniform Push {
    uint level_count;
    uint most;  // photons
} push;

#include "photons/pyramid.glsl"

void main() {
    uint level = 0u;
    [[dont_unroll]] while (level + 1u < push.level_count && pyramid[level] > push.most) {
        ++level;
    }
    uint blocks = min(pyramid[level], push.most);
    uint photons = blocks > 0u ? push.most : 0u;
    Level chosen = load_level(level);
    choice[0] = uint(chosen.size.x + 31) / 32u;
    choice[1] = photons > 0u ? uint(chosen.size.y + 31) / 32u : 0u;
    choice[2] = 1u;
    choice[CHOICE_LEVEL] = level;
    choice[CHOICE_OF_BLOCK] = blocks > 0u ? push.most / blocks : 0u;
    choice[CHOICE_PHOTONS] = photons;
    choice[CHOICE_BLOCKS] = blocks;
}
