// Objects with a map, five texels each (src/specular/cubemap/objects.rs), smaller ones first:
//
//   middle in the rays' space | first triangle
//   direction of a side of its box | half its length, m        three of these
//   the triangle after the last one | number
#ifndef CUBEMAP_OBJECTS
#define CUBEMAP_OBJECTS

const uint OBJECT_TEXELS = 5u;

// `away`: from the box's middle.
float distance_to_box(usamplerBuffer objects, uint object, vec3 away) {
    vec3 outside;
    for (int axis = 0; axis < 3; ++axis) {
        vec4 side = uintBitsToFloat(texelFetch(objects, int(object * OBJECT_TEXELS) + 1 + axis));
        outside[axis] = max(abs(dot(away, side.xyz)) - side.w, 0.0);
    }
    return length(outside);
}

// Whether the way from there on leads into the box.
bool leads_into_box(usamplerBuffer objects, uint object, vec3 away, vec3 way) {
    float enters = -1.0;
    float leaves = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        vec4 side = uintBitsToFloat(texelFetch(objects, int(object * OBJECT_TEXELS) + 1 + axis));
        float start = dot(away, side.xyz);
        float step = dot(way, side.xyz);
        float inverse = 1.0 / (abs(step) > 1e-20 ? step : 1e-20);
        float low = (-side.w - start) * inverse;
        float high = (side.w - start) * inverse;
        enters = max(enters, min(low, high));
        leaves = min(leaves, max(low, high));
    }
    // What starts within it is around it, or it around that.
    return enters > 0.0 && enters < leaves;
}

#endif
