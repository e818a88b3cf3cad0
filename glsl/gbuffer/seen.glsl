// Where the camera sees a point of an instance. Precise: every program computes the same bits, so that one may draw where the depth equals
// that of another.
layout(set = 0, binding = 0) uniform CameraBlock { Camera camera; };

vec4 seen_position(vec3 position, uint instance) {
    precise vec3 position_rs = vec4(position, 1.0) * load_transform(instances, instance);
    precise vec4 clip = camera.view_projection * vec4(position_rs, 1.0);
    return clip;
}
