#version 460
#include "lib/prelude.glsl"
#include "photon_lists/line.glsl"

// An end of the line that a photon's ray draws on the texels of a view (Quyen 2014, section 3.3.2.2). The ray is cut to the view in space, so that
// no end lies behind the camera.

layout(location = 0) flat out uint ray_index;

void main() {
    ray_index = gl_InstanceIndex;
    ListView view = load_list_view(list_views, push.view_index);
    ViewRay along = view_ray(view, load_photon_ray(rays, gl_InstanceIndex));
    vec2 range = clip_to_view(view, along, float(push.resolution), NO_HIT_DISTANCE);
    gl_Position = vec4(2.0, 2.0, 0.5, 1.0);
    if (range.x <= range.y) {
        vec3 near = along.start + range.x * along.step;
        vec3 far = along.start + range.y * along.step;
        vec2 ends[2] = vec2[2](near.xy / near.z, far.xy / far.z);
        // A line leaves out its last texel, and one that begins and ends in one texel is none: both ends are drawn out by a texel.
        vec2 way = ends[1] - ends[0];
        float longest = max(abs(way.x), abs(way.y));
        vec2 out_by = longest > 1e-6 ? way / longest : vec2(1.0, 0.0);
        vec2 texel = gl_VertexIndex == 0 ? ends[0] - out_by : ends[1] + out_by;
        gl_Position = vec4(texel * (2.0 / float(push.resolution)) - 1.0, 0.5, 1.0);
    }
}
