// A vertex as the camera sees it.
#include "geometry/vertex.glsl"

layout(set = 0, binding = 0) uniform CameraBlock { Camera camera; };

void write_seen_vertex() {
    vec3 position_rs = vec4(position, 1.0) * load_transform(instances, gl_InstanceIndex);
    gl_Position = camera.view_projection * vec4(position_rs, 1.0);
    write_vertex();
}
