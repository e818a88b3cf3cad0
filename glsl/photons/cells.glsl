// Cells of a light view's texel: where its photons sit, if it has several. The including shader declares `sampler2D mask`,
// `sampler2D light_depth` and `usampler2D specular_surface`.

bool is_in_view(LightView view, ivec2 texel) {
    ivec2 low = view.rect_origin;
    return all(greaterThanEqual(texel, low)) && all(lessThan(texel, low + view.rect_size));
}

// The depth of the texel one step further, if the surface goes on there; else 0.
float depth_of_neighbor(LightView view, ivec2 texel, ivec2 step, float depth, vec3 normal) {
    ivec2 next = texel + step;
    if (!is_in_view(view, next) || texelFetch(mask, next, 0).x <= 0.0) {
        return 0.0;
    }
    float next_depth = texelFetch(light_depth, next, 0).x;
    vec3 here = position_of_texel(view, tangent_of_texel(view, vec2(texel) + 0.5), depth);
    vec3 there = position_of_texel(view, tangent_of_texel(view, vec2(next) + 0.5), next_depth);
    vec3 next_normal = unpack_direction(texelFetch(specular_surface, next, 0).y);
    float width = view.tangent_step * (is_orthographic(view) ? 1.0 : linear_depth(view, depth));
    return abs(dot(normal, there - here)) < width && dot(normal, next_normal) > 0.5 ? next_depth : 0.0;
}

// The depth at which the light's ray through a tangent coordinate meets the plane of what the texel's middle sees.
float depth_of_plane(LightView view, vec2 middle, vec2 tangent, float depth, vec3 normal) {
    vec3 origin = by_kind(view, view.origin_rs + (tangent.x * view.right + tangent.y * view.down), view.origin_rs);
    float slope = dot(normal, ray_of_tangent(view, tangent));
    float z = dot(normal, position_of_texel(view, middle, depth) - origin) / (abs(slope) > 1e-6 ? slope : 1e-6);
    return depth_of_linear(view, is_orthographic(view) || z > 0.0 ? z : 1e37);
}

struct CellPoint {
    vec2 tangent;
    float depth;
};

// The point of the surface at a place in its texel, from the middle in texels, or at one that is as far from it: at an outline half of the
// cells would lie beside the surface, and change sides. Depth is linear across a plane; of the texel's plane and the chord to its neighbors'
// middles the one nearer to the light is never within a body.
CellPoint point_of_cell(LightView view, ivec2 texel, vec2 place, float depth, vec3 normal) {
    float chord = depth;
    vec2 range = vec2(depth);
    [[dont_unroll]] for (int axis = 0; axis < 2; ++axis) {
        int side = place[axis] < 0.0 ? -1 : 1;
        float neighbor = 0.0;
        [[dont_unroll]] for (int turn = 0; turn < 2 && neighbor <= 0.0; ++turn) {
            side = turn == 0 ? side : -side;
            neighbor = depth_of_neighbor(view, texel, axis == 0 ? ivec2(side, 0) : ivec2(0, side), depth, normal);
        }
        place[axis] = neighbor > 0.0 ? float(side) * abs(place[axis]) : 0.0;
        float reached = neighbor > 0.0 ? neighbor : depth;
        chord += abs(place[axis]) * (reached - depth);
        range = vec2(min(range.x, reached), max(range.y, reached));
    }
    vec2 middle = tangent_of_texel(view, vec2(texel) + 0.5);
    vec2 tangent = middle + place * view.tangent_step;
    float plane = depth_of_plane(view, middle, tangent, depth, normal);
    return CellPoint(tangent, max(chord, clamp(plane, range.x, range.y)));
}
