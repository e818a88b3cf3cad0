// Irradiance of the four squares of level l that make up a flat region of level l + 1 (Quyen 2014, alg. 3.2): bilinear between the regions of
// level l + 1 whose centres surround the square's, of weights 9 : 3 : 3 : 1.
//
// A neighbour that is not flat has no irradiance at its level; its own quarters next to the region may have. They lie closer, three quarters of the
// way: linear interpolation then gives them 1/2 instead of 1/3 of the region's weight an axis. What lies on another surface
// takes no part: its depth is off the region's plane, or its normal is another one. So nothing bleeds over edges, and there
// is no step where sizes change.
//
// The including file defines `vec4 irradiance_at(ivec2 texel)` of the flattened image, rgb W/m², a the packed normal or 0, and
// `float depth_of_square(ivec2 cell)` of level l, and binds `sampler2D region_planes`, level l + 1.

struct Upsampling {
    ivec2 size;              // pixels
    int level;               // of the squares
    float depth_threshold;   // relative to the distance
    float depth_unit;        // unit_of_depth()
    float normal_threshold;
};

// The squares' irradiance.
struct Quarters {
    vec3 upper_left;
    vec3 upper_right;
    vec3 lower_left;
    vec3 lower_right;
    float normal;            // of the region, packed
};

// Irradiance times weight, and weight, at a place `way` pixels from the region's centre; 0 on another surface.
vec4 tap(Upsampling by, vec4 plane, vec3 normal, ivec2 texel, float depth_there, vec2 way, float weight) {
    vec4 found = irradiance_at(texel);
    float expected = plane.x + dot(plane.yz, way);
    float tolerance = 2.0 * by.depth_threshold * (by.depth_unit > 0.0 ? by.depth_unit : expected);
    vec3 turned = abs(unpack_direction_in_float_unnormalized(found.a) - normal);
    bool same = found.a > 0.0 && depth_there > 0.0 && abs(depth_there - expected) <= tolerance
                && max3(turned) <= 2.0 * by.normal_threshold;
    return same ? weight * vec4(found.rgb, 1.0) : vec4(0.0);
}

bool is_within(ivec2 cell, ivec2 size) {
    return all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, size));
}

Quarters upsampled(Upsampling by, ivec2 region, vec4 plane) {
    ivec2 regions = size_of_level(by.size, by.level + 1);
    ivec2 squares = size_of_level(by.size, by.level);
    ivec2 first_region = place_of_level(by.size, by.level + 1);
    ivec2 first_square = place_of_level(by.size, by.level);
    float side = float(1 << by.level);
    vec4 own = irradiance_at(first_region + region);
    vec3 normal = unpack_direction_in_float_unnormalized(own.a);
    vec4 upper_left = vec4(own.rgb, 1.0);
    vec4 upper_right = upper_left;
    vec4 lower_left = upper_left;
    vec4 lower_right = upper_left;
    [[dont_unroll]] for (int i = 0; i < 8; ++i) {
        // The eight steps around the region.
        int number = i + (i >> 2);
        ivec2 step = ivec2(number % 3, number / 3) - 1;
        ivec2 other = region + step;
        float depth_there = is_within(other, regions) ? texelFetch(region_planes, other, 0).x : 0.0;
        vec4 found = vec4(0.0);
        if (depth_there > 0.0) {
            float weight = step.x * step.y == 0 ? 1.0 / 3.0 : 1.0 / 9.0;
            found = tap(by, plane, normal, first_region + other, depth_there, 2.0 * side * vec2(step), weight);
        } else {
            [[dont_unroll]] for (int quarter = 0; quarter < 2; ++quarter) {
                // Towards the region on the axes of the step, both on the other one.
                ivec2 towards = ivec2(
                    step.x == 0 ? quarter : step.x < 0 ? 1 : 0, step.y == 0 ? quarter : step.y < 0 ? 1 : 0);
                ivec2 square = 2 * other + towards;
                if (is_within(square, squares)) {
                    float weight = step.x * step.y == 0 ? 1.0 / 4.0 : 1.0 / 8.0;
                    vec2 way = side * (vec2(2 * step + towards) - 0.5);
                    found += tap(by, plane, normal, first_square + square, depth_of_square(square), way, weight);
                }
            }
        }
        upper_left += step.x <= 0 && step.y <= 0 ? found : vec4(0.0);
        upper_right += step.x >= 0 && step.y <= 0 ? found : vec4(0.0);
        lower_left += step.x <= 0 && step.y >= 0 ? found : vec4(0.0);
        lower_right += step.x >= 0 && step.y >= 0 ? found : vec4(0.0);
    }
    return Quarters(
        upper_left.rgb / upper_left.a, upper_right.rgb / upper_right.a, lower_left.rgb / lower_left.a,
        lower_right.rgb / lower_right.a, own.a);
}
