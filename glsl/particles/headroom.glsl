// What low bits of a particle's packed normal (10⁻³ of a radian) say: five how far apart particles are around it (widths.glsl), four how much is free above it: 0
// where nothing stands near; otherwise segments to points that it may stand for are tested, and level k says that they may end LIFT·spacing/2^(k−1) above it: no
// higher than half of what is free there.
#ifndef PARTICLES_HEADROOM
#define PARTICLES_HEADROOM

// Share of the spacing: how far segments are lifted off surfaces.
const float LIFT = 0.15;
const uint LEVELS = 15u;

uint with_headroom(uint packed_normal, uint width, uint level) {
    uint words = (level & 3u) | (level >> 2) << 16;
    return (packed_normal & 0xFFF0FFE0u) | words | (width & 7u) << 2 | (width >> 3) << 18;
}

uint packed_width(uint packed_normal) {
    return (packed_normal >> 2 & 7u) | (packed_normal >> 18 & 3u) << 3;
}

uint headroom_level(uint packed_normal) {
    return (packed_normal & 3u) | (packed_normal >> 16 & 3u) << 2;
}

bool is_crowded(uint packed_normal) {
    return headroom_level(packed_normal) != 0u;
}

float lift_of(uint packed_normal, float spacing) {
    return LIFT * spacing * exp2(-max(float(headroom_level(packed_normal)) - 1.0, 0.0));
}

#endif
