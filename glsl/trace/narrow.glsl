// Which specular lobes are narrow: emissive surfaces are found by the rays that such a lobe sends out; of wider ones they are found from points drawn on
// them (emitters.comp). Either way finds all of the light, so that no weights are needed.
#ifndef TRACE_NARROW
#define TRACE_NARROW

const float NARROW_ROUGHNESS = 0.3;

bool is_narrow(float alpha) {
    return alpha < NARROW_ROUGHNESS * NARROW_ROUGHNESS;
}

// What a share of 1 counts for the number of samples, at most `most`: what changes the picture little takes few.
uint sample_count(uint most, float weight) {
    return clamp(uint(ceil(float(most) * min(4.0 * weight, 1.0))), 1u, most);
}

#endif
