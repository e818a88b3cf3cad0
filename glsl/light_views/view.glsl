// Set 0 and push constant of the programs that draw the scene into one light view's rectangle of the atlas.

#include "groups/geometry.glsl"
#include "groups/light_views.glsl"
#include "lib/lights.glsl"

layout(push_constant, scalar) uniform DrawnLightView { uint view_index; } push;

// Precise: every program computes the same bits, so that one may draw where the depth equals that of another.
vec4 clip_position(vec3 position, uint instance) {
    precise vec3 position_rs = vec4(position, 1.0) * load_transform(instances, instance);
    precise vec4 clip = load_view_projection(views, push.view_index) * vec4(position_rs, 1.0);
    return clip;
}
