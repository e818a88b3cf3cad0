// A vertex of an alpha-masked primitive, seen in a view.
#include "geometry/masked_vertex.glsl"
#include "photon_lists/draw.glsl"

layout(location = 0) out float depth;

void main() {
    vec3 position_rs = vec4(position, 1.0) * load_transform(instances, gl_InstanceIndex);
    gl_Position = clip_position(position_rs);
    depth = linear_depth(position_rs);
    write_masked_vertex();
}
