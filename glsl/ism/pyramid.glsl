// Pull and push (Gortler et al. 1996; Marroquim et al. 2007): a map's levels of half the side each. A texel of a level is the mean of the
// inverse distances known below it [1/m] and the share of it that is known. No texel reads across maps.
#ifndef ISM_PYRAMID
#define ISM_PYRAMID

// The texel of this invocation, among side² of map k.
bool texel_of_map(out ivec2 texel, uint side) {
    uint index = gl_GlobalInvocationID.x;
    texel = ivec2(index % side, index / side);
    return index < side * side;
}

int place_in_maps(uint k, ivec2 texel, uint side) {
    return int((k * side + uint(texel.y)) * side + uint(texel.x));
}

// Between the four nearest texels of the next coarser level, as far as they are known.
vec2 interpolated(samplerBuffer coarse, uint k, ivec2 texel, uint coarse_side) {
    ivec2 nearest = texel / 2;
    ivec2 other = nearest + 2 * (texel & 1) - 1;
    int last = int(coarse_side) - 1;
    vec2 sum = vec2(0.0);
    [[dont_unroll]] for (int i = 0; i < 4; ++i) {
        ivec2 place = ivec2((i & 1) == 0 ? nearest.x : other.x, (i & 2) == 0 ? nearest.y : other.y);
        float weight = ((i & 1) == 0 ? 0.75 : 0.25) * ((i & 2) == 0 ? 0.75 : 0.25);
        vec2 known = texelFetch(coarse, place_in_maps(k, clamp(place, ivec2(0), ivec2(last)), coarse_side)).xy;
        sum += weight * known.y * vec2(known.x, 1.0);
    }
    return vec2(sum.x / max(sum.y, 1e-6), sum.y);
}

#endif
