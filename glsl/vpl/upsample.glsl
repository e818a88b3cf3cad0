// Irradiance of a square of level l inside a flat region of level l + 1 (Quyen 2014, alg. 3.2): bilinear between the regions of level l + 1
// whose centres surround its own, of weights 9 : 3 : 3 : 1.
//
// One of the other three that is not flat has no irradiance at its level; the square's own neighbour on that side, on level l, may have, which
// lies closer: linear interpolation gives it half instead of a third of the square's own region's weight an axis. What lies on another surface
// takes no part: its depth is off the plane, or its normal is another one. So nothing bleeds over edges, and where sizes
// change there is no step.
//
// The including file defines `vec4 irradiance_at(ivec2 texel)` of the flattened image, and `float depth_of_square(int level, ivec2 cell)`.

struct Upsampling {
    ivec2 size;              // pixels
    int level;               // of the square
    float depth_threshold;   // relative to the distance
    float depth_scale;       // 0: relative to the depth itself
    float normal_threshold;
};

// Whether a place of depth `found` with the normal in `alpha` is on the plane that has the depth `expected` there.
bool is_same_surface(Upsampling by, float found, float expected, float alpha, vec3 normal) {
    vec3 turned = abs(normalize(unpack_direction_in_float_unnormalized(alpha)) - normal);
    float tolerance = 2.0 * by.depth_threshold * (by.depth_scale > 0.0 ? by.depth_scale : expected);
    return abs(found - expected) <= tolerance && max3(turned) <= 2.0 * by.normal_threshold;
}

// rgb: W/m²; a: the region's normal.
vec4 upsampled(Upsampling by, ivec2 cell) {
    int above = by.level + 1;
    ivec2 parent = cell / 2;
    ivec2 side = 2 * (cell & 1) - 1;
    float extent = float(1 << by.level);
    vec4 plane = texelFetch(planes, parent, above - 1);
    vec4 own = irradiance_at(place_of_level(by.size, above) + parent);
    vec3 normal = normalize(unpack_direction_in_float_unnormalized(own.a));
    vec3 sum = own.rgb;
    float weights = 1.0;
    [[dont_unroll]] for (int i = 1; i < 4; ++i) {
        ivec2 step = side * ivec2(i & 1, i >> 1);
        bool diagonal = i == 3;
        ivec2 other = parent + step;
        float other_depth = all(greaterThanEqual(other, ivec2(0))) && all(lessThan(other, size_of_level(by.size, above)))
                          ? texelFetch(planes, other, above - 1).x : 0.0;
        vec2 way = 2.0 * extent * vec2(step);
        float weight = diagonal ? 1.0 / 9.0 : 1.0 / 3.0;
        ivec2 texel = place_of_level(by.size, above) + other;
        if (other_depth <= 0.0) {
            other = cell + step;
            bool inside = all(greaterThanEqual(other, ivec2(0))) && all(lessThan(other, size_of_level(by.size, by.level)));
            other_depth = inside ? depth_of_square(by.level, other) : 0.0;
            way = extent * (0.5 * vec2(side) + vec2(step));
            weight = diagonal ? 0.25 : 0.5;
            texel = place_of_level(by.size, by.level) + other;
        }
        if (other_depth > 0.0) {
            vec4 found = irradiance_at(texel);
            if (found.a > 0.0 && is_same_surface(by, other_depth, plane.x + dot(plane.yz, way), found.a, normal)) {
                sum += weight * found.rgb;
                weights += weight;
            }
        }
    }
    return vec4(sum / weights, own.a);
}
