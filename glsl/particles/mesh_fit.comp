#version 460
#include "lib/prelude.glsl"
#include "groups/particles.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"

// Whether light may be interpolated over one subtriangle that is seen: whether all of its radiance particles have a list, and none stands behind something as
// seen from its middle, such as a wall that stands on a floor which runs under it. Of what does not fit, where the paper leaks, each point is looked at by itself
// (mesh_views.glsl).

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer tessellation;
layout(set = 0, binding = 1) uniform usamplerBuffer subtriangles;
layout(set = 0, binding = 2) uniform usamplerBuffer found;
layout(set = 0, binding = 3) uniform usamplerBuffer particle_marks;
layout(set = 0, binding = 4) uniform usamplerBuffer marked_before;
layout(set = 0, binding = 5) uniform usamplerBuffer slots;
layout(set = 0, binding = 6) writeonly buffer Views { vec4 views[]; };  // mesh_views.glsl
layout(set = 0, binding = 7) buffer Counts { uint counts[]; };          // those that do not fit

layout(push_constant, scalar) uniform Push { uint all_slots; } push;  // 0: those found alone have one

#include "particles/mesh_found.glsl"
#include "particles/mesh_particle.glsl"
#include "particles/mesh_slot.glsl"

void main() {
    uint invocation = invocation_of_found();
    if (invocation >= texelFetch(found, 3).x) {
        return;
    }
    float spacing = particle_spacing;
    uint number = texelFetch(subtriangles, int(invocation)).x;
    uint index = triangle_of_number(number, true, tessellated_triangle_count());
    Tessellated t = load_tessellated(index);
    uint local = number - t.first_subtriangle;
    uint sides = sides_of(t);
    RowPlace points[3] = points_of_subtriangle(t, local / sides);
    vec2 middle = (place_of_point(t, points[0]) + place_of_point(t, points[1]) + place_of_point(t, points[2])) / 3.0;
    Triangle triangle = load_triangle(triangles, index);
    vec3 front = front_normal(triangle);
    vec3 face = local % sides == 1u ? -front : front;
    vec3 position = point_of_triangle(triangle, middle, front);
    vec3 from = position + face * free_lift(position, face, face, spacing);
    bool fits = true;
    vec4 first_view;
    [[dont_unroll]] for (uint point = 0u; point < 3u; ++point) {
        uint particle = particle_at(t, points[point], local % sides);
        uint slot = push.all_slots != 0u ? particle : place_among_marked(particle_marks, marked_before, particle);
        uvec4 record = texelFetch(slots, int(slot));
        bool has_list = length_of_slot(record) > 0u;
        RadianceParticle other = radiance_particle(particle, spacing);
        vec3 looks_from = other.position + other.normal * uintBitsToFloat(record.w);
        fits = fits && has_list && !is_occluded(from, looks_from - from, 1.0);
        vec4 view = vec4(looks_from, has_list ? 1.0 : 0.0);
        if (point == 0u) {
            first_view = view;
        } else {
            views[3u * invocation + point] = view;
        }
    }
    views[3u * invocation] = vec4(first_view.xyz, fits ? INTERPOLATES : first_view.w);
    if (!fits) {
        atomicAdd(counts[0], 1u);
    }
}
