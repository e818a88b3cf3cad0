// What a specular lobe reflects of a uniform light (src/frame/lobe_albedos.rs).
#ifndef LIB_DIRECTIONAL_ALBEDO
#define LIB_DIRECTIONAL_ALBEDO

const int ALBEDO_SIDE = 16;

// For Fresnel terms of 1 and 0, and of 0 and 1, by √(n·v) and roughness. `first`: texel of the table.
vec2 directional_albedo(samplerBuffer table, int first, float cosine, float roughness) {
    vec2 place = clamp(vec2(sqrt(cosine), roughness), 0.0, 1.0) * float(ALBEDO_SIDE - 1);
    ivec2 low = min(ivec2(place), ivec2(ALBEDO_SIDE - 2));
    vec2 along = place - vec2(low);
    int corner = first + low.y * ALBEDO_SIDE + low.x;
    vec2 lower = mix(texelFetch(table, corner).xy, texelFetch(table, corner + 1).xy, along.x);
    vec2 upper = mix(texelFetch(table, corner + ALBEDO_SIDE).xy, texelFetch(table, corner + ALBEDO_SIDE + 1).xy, along.x);
    return mix(lower, upper, along.y);
}

#endif
