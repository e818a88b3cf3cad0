// Whether four squares form one flat region, and its plane.
//
// Depth here is the G-buffer's: near/z, or 1 − (z − near)/range of an orthographic camera. Over a plane it is an affine function of the pixel,
// however grazing, which z itself is not. So a region's pixels lie in a plane if one affine function gives all their depths: the plane of its
// first quarter is carried through the levels, with a bound of what the others are off it,
//
//   e = max over the quarters (e_i + max over the quarter |plane_i − plane_0|)      the maximum of an affine function is at a corner
//
// In place of the minimum and maximum of depth (Nichols & Wyman 2009; Quyen 2014, section 3.2.2.1), a grazing floor stays one
// region and a step does not. A change of near/z over its value is the change of z over z: e/d is relative to the distance. Where surfaces
// turn without a step, the components of the normals tell, by minimum and maximum as in the paper. What lies flat along a grazing line of sight is many times as long as
// a square that faces the eye: where light that changes along it is read, depth may not change by too much over one region.
#ifndef VPL_REGION_PLANES
#define VPL_REGION_PLANES


struct Square {
    vec4 plane;        // as in regions/regions.glsl, at the square's centre; 0: not flat
    vec3 low_normal;
    vec3 high_normal;
};

uvec4 pack_normals(Square square) {
    return uvec4(
        packSnorm2x16(square.low_normal.xy), packSnorm2x16(vec2(square.low_normal.z, square.high_normal.x)),
        packSnorm2x16(square.high_normal.yz), 0u);
}

Square unpack_square(vec4 plane, uvec4 normals) {
    vec2 middle = unpackSnorm2x16(normals.y);
    return Square(plane, vec3(unpackSnorm2x16(normals.x), middle.x), vec3(middle.y, unpackSnorm2x16(normals.z)));
}

// `side`: of one of the four, in pixels; their order: (0,0), (1,0), (0,1), (1,1).
Square merged(Square quarters[4], float side, float depth_threshold, float depth_unit, float normal_threshold, float slope_threshold) {
    Square whole = quarters[0];
    bool flat_ = whole.plane.x > 0.0;
    whole.plane.x += 0.5 * side * (whole.plane.y + whole.plane.z);
    for (int i = 1; i < 4; ++i) {
        Square quarter = quarters[i];
        flat_ = flat_ && quarter.plane.x > 0.0;
        vec2 offset = side * (vec2(i & 1, i >> 1) - 0.5);
        vec3 difference = quarter.plane.xyz - vec3(whole.plane.x + dot(whole.plane.yz, offset), whole.plane.yz);
        // Pixels' centres end half a pixel before the square does.
        float off = abs(difference.x) + 0.5 * (side - 1.0) * (abs(difference.y) + abs(difference.z));
        whole.plane.w = max(whole.plane.w, quarter.plane.w + off);
        whole.low_normal = min(whole.low_normal, quarter.low_normal);
        whole.high_normal = max(whole.high_normal, quarter.high_normal);
    }
    float unit = depth_unit > 0.0 ? depth_unit : whole.plane.x;
    flat_ = flat_ && whole.plane.w <= depth_threshold * unit
            && 2.0 * side * (abs(whole.plane.y) + abs(whole.plane.z)) <= slope_threshold * unit
            && max3(whole.high_normal - whole.low_normal) <= normal_threshold;
    if (!flat_ || whole.plane.x <= 0.0) {
        whole.plane = vec4(0.0);
    }
    return whole;
}

#endif
