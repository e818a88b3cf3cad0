#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lib/microfacet.glsl"
#include "lib/sobol.glsl"
#include "lightmaps/texels.glsl"

// Whether one texel lies in the open: within geometry most rays by the cosine meet backs that have no light maps of their own, for nobody sees them.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) writeonly buffer Valid { uint valid[]; };  // TEXEL_VALID or 0

layout(push_constant, scalar) uniform Push { uint texel_count; } push;

const uint RAYS = 16u;
const uint STREAM = 0x9209BEu;

bool meets_dark_back(vec3 origin, vec3 direction) {
    Hit hit = closest_hit(origin, direction, 3e38);
    if (hit.triangle == NO_TRIANGLE) {
        return false;
    }
    vec3 face = front_normal(load_triangle(triangles, hit.triangle));
    return dot(face, direction) > 0.0 && load_chart(lightmap_charts, hit.triangle).first_front != NO_TEXEL
           && load_chart(lightmap_charts, hit.triangle).first_back == NO_TEXEL;
}

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.texel_count) {
        return;
    }
    LightTexel texel = load_light_texel(number);
    if (texel.triangle == NO_TEXEL) {
        valid[number] = 0u;
        return;
    }
    Frame frame = frame_around(texel.face);
    vec3 origin = offset_ray_origin(texel.position, texel.face);
    uint backs = 0u;
    [[dont_unroll]] for (uint i = 0u; i < RAYS; ++i) {
        vec3 direction = to_world(frame, sample_cosine_hemisphere(sobol_sample(sobol, i, seed_of(number, STREAM)).xy));
        backs += meets_dark_back(origin, direction) ? 1u : 0u;
    }
    valid[number] = 2u * backs > RAYS ? 0u : TEXEL_VALID;
}
