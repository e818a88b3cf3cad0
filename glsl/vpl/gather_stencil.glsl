// The body of gather_stencil*.frag: irradiance of the region behind one texel of the flattened image. It counts itself. A file that
// defines `vpl_visibility` binds what it needs for it from 8 on.

layout(early_fragment_tests) in;

layout(set = 0, binding = 6) buffer Invocations { uint invocations[]; };

layout(location = 0) out vec4 irradiance;

layout(push_constant, scalar) uniform Push {
    ivec2 size;         // pixels
    int level_count;
    VplRange range;
} push;

void main() {
    bool first = push.range.first == 0;
    if (first) {
        atomicAdd(invocations[0], 1u);
    }
    Receiver receiver = receiver_of_region(region_at(push.size, ivec2(gl_FragCoord.xy), push.level_count), push.size);
    vec3 sum;
    gather(push.range, receiver, sum);
    irradiance = vec4(sum, first ? pack_direction_in_float(receiver.normal) : 0.0);
}
