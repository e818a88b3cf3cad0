// Whether something lies above a particle's tangent plane nearby: the lowest bit of its packed normal, 3·10⁻⁵ of a radian.
#ifndef PARTICLES_CROWDED
#define PARTICLES_CROWDED

// Share of the spacing.
const float ABOVE = 0.1;

uint with_crowded(uint packed_normal, bool crowded) {
    return (packed_normal & ~1u) | (crowded ? 1u : 0u);
}

bool is_crowded(uint packed_normal) {
    return (packed_normal & 1u) != 0u;
}

#endif
