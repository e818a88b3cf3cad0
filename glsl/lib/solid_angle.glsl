// The solid angle of one texel of a perspective view.
#ifndef LIB_SOLID_ANGLE
#define LIB_SOLID_ANGLE

// Van Oosterom & Strackee 1983 on a triangle of the plane z = 1 seen from the origin:
//   tan(Ω/2) = a·(b×c) / (|a||b||c| + (a·b)|c| + (a·c)|b| + (b·c)|a|)
// Every term is positive. The numerator is twice the triangle's area, known without a subtraction: unlike the difference of four
// corner arc tangents nothing cancels, however small the texel.
// Returns tan(Ω/2); `lengths` holds |a|, |b|, |c|.
float half_angle_tangent(float twice_area, vec2 a, vec2 b, vec2 c, vec3 lengths) {
    return twice_area / (lengths.x * lengths.y * lengths.z + (dot(a, b) + 1.0) * lengths.z
                         + (dot(a, c) + 1.0) * lengths.y + (dot(b, c) + 1.0) * lengths.x);
}

// Of the square of side `extent` around `tangent` in the plane z = 1, in sr. The arc tangent is its series to the fifth power,
// exact to float precision up to 0.1: views have at least 8 texels a side. Drivers' own atan() may be off by 4096 ulp.
float solid_angle_of_texel(vec2 tangent, float extent) {
    vec2 low = tangent - 0.5 * extent;
    vec2 high = tangent + 0.5 * extent;
    vec2 low_high = vec2(low.x, high.y);
    vec2 high_low = vec2(high.x, low.y);
    float length_low = sqrt(dot(low, low) + 1.0);
    float length_high = sqrt(dot(high, high) + 1.0);
    float length_low_high = sqrt(dot(low_high, low_high) + 1.0);
    float length_high_low = sqrt(dot(high_low, high_low) + 1.0);
    float twice_area = extent * extent;
    vec2 x = vec2(
        half_angle_tangent(twice_area, low, high_low, high, vec3(length_low, length_high_low, length_high)),
        half_angle_tangent(twice_area, low, high, low_high, vec3(length_low, length_high, length_low_high)));
    vec2 x2 = x * x;
    vec2 angles = x * (1.0 - x2 * (1.0 / 3.0 - 0.2 * x2));
    return 2.0 * (angles.x + angles.y);
}

#endif
