// Lights, and the views from them (reflective shadow maps).
//
// All views of all lights share one atlas of squares and half squares. A view maps an atlas texel to a tangent coordinate,
// tangent = tangent_origin + (texel centre − rect_origin)·tangent_step, and that to a ray: in the plane at distance 1 before
// a perspective view, in metres across an orthographic one. Rays and depths give positions without an inverse matrix.
#ifndef LIB_LIGHTS
#define LIB_LIGHTS

#include "lib/vectors.glsl"

const uint LIGHT_POINT = 0u;
const uint LIGHT_SPOT = 1u;
const uint LIGHT_DIRECTIONAL = 2u;
const uint LIGHT_EMITTER = 3u;  // a patch of an emissive surface: a one-sided cosine emitter

struct Light {
    vec3 position_rs;
    uint kind;
    vec3 direction;      // unit: where a directional light travels, a spot points, an emitter faces
    uint first_view;
    vec3 intensity;      // W/sr (point, spot); W/m² across the beam (directional); W/sr along the normal = power/π (emitter)
    float area_over_pi;  // emitter: its area/π, m²; else 0
    float spot_scale;    // glTF: clamp(cosθ·scale + offset, 0, 1)²
    float spot_offset;
    float range;         // glTF; metres; 0: unlimited
    uint view_count;     // 6 point and wide spot, 1 spot and directional, 5 emitter; 0: the light casts no shadow
};

struct LightView {
    mat4 view_projection;   // render space to the clip space of the view's rectangle
    vec3 origin_rs;         // orthographic: in the far plane
    float near;             // perspective: metres along `forward`
    vec3 right;             // unit
    float depth_range;      // orthographic: from the near plane to the far one; perspective, which is infinite: 0
    vec3 down;              // unit
    float tangent_step;     // between texels: tangent units (perspective) or metres (orthographic)
    vec3 forward;           // unit
    float flux_scale;       // W for 1.0 in `light_flux`
    vec2 tangent_origin;    // of the rectangle's upper left corner
    vec2 lit_low;           // texels with their centre outside [lit_low, lit_high), the guard band, carry no flux:
    vec2 lit_high;          // another view of the light does, or nobody
    ivec2 rect_origin;      // texels in the atlas
    ivec2 rect_size;
    uint light;
    uint reserved;          // fills the last of eleven vec4
};

// The atlas cut into squares of 16x16 texels, listed view by view, along Hilbert's curve inside a view.
struct LightTile {
    ivec2 origin;      // texels in the atlas
    uint view;
    uint orientation;  // of the curve in the tile (lib/hilbert.glsl)
};

// ---- the two lists as texel buffers (rgba32ui), which a CPU driver reads several times faster than structs in storage buffers

Light load_light(usamplerBuffer lights, uint light) {
    int index = int(light);
    uvec4 a = texelFetch(lights, 4 * index);
    uvec4 b = texelFetch(lights, 4 * index + 1);
    uvec4 c = texelFetch(lights, 4 * index + 2);
    uvec4 d = texelFetch(lights, 4 * index + 3);
    return Light(
        uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz), uintBitsToFloat(c.w),
        uintBitsToFloat(d.x), uintBitsToFloat(d.y), uintBitsToFloat(d.z), d.w);
}

mat4 load_view_projection(usamplerBuffer views, uint index) {
    int first = 11 * int(index);
    return mat4(
        uintBitsToFloat(texelFetch(views, first)), uintBitsToFloat(texelFetch(views, first + 1)),
        uintBitsToFloat(texelFetch(views, first + 2)), uintBitsToFloat(texelFetch(views, first + 3)));
}

// Without `view_projection`, which shading does not need.
LightView load_view(usamplerBuffer views, uint index) {
    int first = 11 * int(index);
    uvec4 origin = texelFetch(views, first + 4);
    uvec4 right = texelFetch(views, first + 5);
    uvec4 down = texelFetch(views, first + 6);
    uvec4 forward = texelFetch(views, first + 7);
    uvec4 tangents = texelFetch(views, first + 8);
    uvec4 place = texelFetch(views, first + 9);
    uvec4 last = texelFetch(views, first + 10);
    return LightView(
        mat4(0.0), uintBitsToFloat(origin.xyz), uintBitsToFloat(origin.w), uintBitsToFloat(right.xyz), uintBitsToFloat(right.w),
        uintBitsToFloat(down.xyz), uintBitsToFloat(down.w), uintBitsToFloat(forward.xyz), uintBitsToFloat(forward.w),
        uintBitsToFloat(tangents.xy), uintBitsToFloat(tangents.zw), uintBitsToFloat(place.xy), ivec2(place.zw), ivec2(last.xy), last.z, 0u);
}

// ---- emission

// glTF 2.0, KHR_lights_punctual: angular falloff between the inner and the outer cone.
float spot_attenuation(float cosine, float scale, float offset) {
    float attenuation = clamp(cosine * scale + offset, 0.0, 1.0);
    return attenuation * attenuation;
}

// KHR_lights_punctual: the window that takes a light with a range to zero at that range.
float range_window(float distance, float range) {
    float ratio = range > 0.0 ? distance / range : 0.0;
    float squared = ratio * ratio;
    return clamp(1.0 - squared * squared, 0.0, 1.0);
}

// I(ω) in W/sr towards the unit vector ω away from the light; for a directional light the irradiance across its beam in W/m².
vec3 radiant_intensity(Light light, vec3 away) {
    float cosine = dot(light.direction, away);
    float falloff = light.kind == LIGHT_SPOT ? spot_attenuation(cosine, light.spot_scale, light.spot_offset)
                  : light.kind == LIGHT_EMITTER ? max(cosine, 0.0) : 1.0;
    return light.intensity * falloff;
}

struct Illumination {
    vec3 to_light;    // unit
    vec3 irradiance;  // W/m² across the beam, unshadowed: the receiver's cosine is still to come
};

// E⊥ = I(ω)·window(d)/d². An emitter is a disc of area A, d² + A/π (see lib/vpl.glsl): finite at any distance.
Illumination illuminate(Light light, vec3 position_rs) {
    if (light.kind == LIGHT_DIRECTIONAL) {
        return Illumination(-light.direction, light.intensity);
    }
    vec3 difference = light.position_rs - position_rs;
    float distance = length(difference);
    vec3 to_light = difference / max(distance, 1e-18);
    vec3 intensity = radiant_intensity(light, -to_light);
    return Illumination(
        to_light, intensity * (range_window(distance, light.range) / max(distance * distance + light.area_over_pi, 1e-18)));
}

// ---- views

bool is_orthographic(LightView view) {
    return view.depth_range > 0.0;
}

// `texel`: atlas coordinates with texel centres at halves, as gl_FragCoord has them.
vec2 tangent_of_texel(LightView view, vec2 texel) {
    return view.tangent_origin + (texel - vec2(view.rect_origin)) * view.tangent_step;
}

// Which of two things, both made: what compilers on CPUs make of many branches in a loop takes them minutes (SwiftShader).
float by_kind(LightView view, float orthographic, float perspective) {
    return is_orthographic(view) ? orthographic : perspective;
}

vec3 by_kind(LightView view, vec3 orthographic, vec3 perspective) {
    return is_orthographic(view) ? orthographic : perspective;
}

// From the view through a tangent coordinate: of length 1 along `forward` when perspective, the unit `forward` when orthographic.
vec3 ray_of_tangent(LightView view, vec2 tangent) {
    return by_kind(view, view.forward, view.forward + tangent.x * view.right + tangent.y * view.down);
}

// Metres along `forward` from the view's origin, for a depth above 0; orthographic: below 0.
float linear_depth(LightView view, float depth) {
    return by_kind(view, -depth * view.depth_range, view.near / depth);
}

// The same from where light comes from: the perspective view's origin, or an orthographic view's near plane.
float depth_from_light(LightView view, float depth) {
    return by_kind(view, (1.0 - depth) * view.depth_range, view.near / depth);
}

// And back.
float depth_of_linear(LightView view, float z) {
    return by_kind(view, -z / view.depth_range, view.near / z);
}

vec3 position_of_texel(LightView view, vec2 tangent, float depth) {
    vec3 position = view.origin_rs + ray_of_tangent(view, tangent) * linear_depth(view, depth);
    return by_kind(view, position + tangent.x * view.right + tangent.y * view.down, position);
}

// The surface, in m², that one texel sees: (z·step)²/|n·ray| with the ray of ray_of_tangent(), which is d²·Δω/cosθ
// (perspective) and step²/cosθ (orthographic). Grazing texels count as if seen at a cosine of 0.1.
float area_of_texel(LightView view, vec2 tangent, float depth, vec3 normal) {
    vec3 ray = ray_of_tangent(view, tangent);
    float width = view.tangent_step * (is_orthographic(view) ? 1.0 : linear_depth(view, depth));
    return width * width / max(abs(dot(normal, ray)), 0.1 * length(ray));
}

// Which of the light's views sees the direction `away` from the light. A light with several views looks along the first one's
// axes in the order forward, right, left, down, up, back; a hemicube has no back.
uint view_towards(Light light, LightView first, vec3 away) {
    if (light.view_count <= 1u) {
        return light.first_view;
    }
    vec3 local = vec3(dot(away, first.right), dot(away, first.down), dot(away, first.forward));
    vec3 size = abs(local);
    if (size.z >= max(size.x, size.y)) {
        return light.first_view + (local.z < 0.0 ? min(5u, light.view_count - 1u) : 0u);
    }
    return light.first_view + (size.x >= size.y ? (local.x < 0.0 ? 2u : 1u) : (local.y < 0.0 ? 4u : 3u));
}

#endif
