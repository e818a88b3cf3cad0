// Which specular lobes are narrow: emissive surfaces are found by the rays that such a lobe sends out; of wider ones they are found from points drawn on
// them. Either way finds all of the light, so that no weights are needed.
#ifndef LIB_NARROW
#define LIB_NARROW

const float NARROW_ROUGHNESS = 0.3;

bool is_narrow(float alpha) {
    return alpha < NARROW_ROUGHNESS * NARROW_ROUGHNESS;
}

#endif
