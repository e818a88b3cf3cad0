// Groups of virtual area lights that share one visibility: the lit ones among 4^lod neighbours along Morton's curve, a square of the light view. Two texels (rgba32ui) each:
//   [2g]     the mean position_rs by flux, and the radius of a sphere around it, as floats' bits
//   [2g + 1] the first light, how many, the sum of their luminances, and how far any lies from the mean at most, both as floats' bits
#ifndef CACHES_LIGHT_GROUPS
#define CACHES_LIGHT_GROUPS

struct LightGroup {
    vec3 center_rs;
    float radius;
    float reach;
    int first;
    int end;
};

LightGroup load_light_group(usamplerBuffer groups, int group) {
    uvec4 sphere = texelFetch(groups, 2 * group);
    uvec4 list = texelFetch(groups, 2 * group + 1);
    return LightGroup(
        uintBitsToFloat(sphere.xyz), uintBitsToFloat(sphere.w), uintBitsToFloat(list.w), int(list.x), int(list.x + list.y));
}

#endif
