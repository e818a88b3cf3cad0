// A view that per-pixel lists of the scene are drawn from (src/caustics/photons/list_views.rs): eight texels, rgba32f.
#ifndef PHOTON_LISTS_VIEW
#define PHOTON_LISTS_VIEW

struct ListView {
    // Render space to the list's texels, times w, and to metres along the axis: dot(row, vec4(position_rs, 1)).
    vec4 row_x;
    vec4 row_y;
    vec4 row_w;
    vec4 row_depth;
    // And back: the point at `depth` metres behind the texel coordinate (x, y) is base + depth·axis + s·(x·across + y·down), where s is
    // the depth in perspective and 1 in a parallel view.
    vec3 base;
    float near;   // metres along the axis; 0: a parallel view
    vec3 axis;
    float far;    // depth of the farthest surface, metres
    vec3 across;
    vec3 down;
    float texel;  // its longer side in metres, at distance 1 in perspective
};

ListView load_list_view(samplerBuffer views, uint index) {
    int first = 8 * int(index);
    vec4 base = texelFetch(views, first + 4);
    vec4 axis = texelFetch(views, first + 5);
    vec4 across = texelFetch(views, first + 6);
    vec4 down = texelFetch(views, first + 7);
    return ListView(
        texelFetch(views, first), texelFetch(views, first + 1), texelFetch(views, first + 2), texelFetch(views, first + 3),
        base.xyz, base.w, axis.xyz, axis.w, across.xyz, down.xyz, down.w);
}

// The line of points behind a texel coordinate: start + depth·way.
struct Column {
    vec3 start;
    vec3 way;
};

Column column_of(ListView view, vec2 texel) {
    vec3 lateral = texel.x * view.across + texel.y * view.down;
    bool perspective = view.near > 0.0;
    return Column(view.base + (perspective ? vec3(0.0) : lateral), view.axis + (perspective ? lateral : vec3(0.0)));
}

#endif
