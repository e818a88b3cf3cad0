// The hemisphere over a VPL as a square of depths: a paraboloid map (Heidrich & Seidel 1998; Brabec et al. 2002), which is the
// stereographic projection of the sphere. With ω = (ω_xy, ω_z) in the VPL's frame, ω_z along its normal,
//
//   uv = ω_xy / (1 + ω_z)      ω = (2u, 2v, 1 − |uv|²) / (1 + |uv|²)
//
// The hemisphere is the disc |uv| ≤ 1; the square's corners see a little below the horizon. A texel holds the inverse of the distance [1/m] along
// its centre's direction, 0 where nothing is known: over a plane n·p = h that is n·ω/h, linear in ω.
#ifndef ISM_MAP
#define ISM_MAP

// A vector in the frame of the VPL whose unit normal is n: the reflection that maps n to ∓z, so that no tangent is needed.
vec3 to_map_frame(vec3 n, vec3 v) {
    float side = n.z < 0.0 ? -1.0 : 1.0;
    float along = dot(n, v);
    return vec3(v.xy - n.xy * ((along + side * v.z) / (1.0 + abs(n.z))), along);
}

// The direction of a point of the square, in the VPL's frame.
vec3 direction_of_map(vec2 uv) {
    float squared = dot(uv, uv);
    return vec3(2.0 * uv, 1.0 - squared) / (1.0 + squared);
}

vec2 center_of_texel(ivec2 texel, float resolution) {
    return (vec2(texel) + 0.5) * (2.0 / resolution) - 1.0;
}

#endif
