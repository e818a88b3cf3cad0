#version 460
#include "lib/prelude.glsl"
#include "groups/lightmap.glsl"
#include "groups/scene_rays.glsl"
#include "lib/cutouts.glsl"
#include "lib/bvh.glsl"
#include "lightmaps/texels.glsl"

// Whether geometry cuts the cell that begins with one texel: one of its four lies within geometry, or some two of them do not see each other.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer valid;
layout(set = 0, binding = 1) writeonly buffer Flags { uint flags[]; };
layout(set = 0, binding = 2) buffer Counts { uint counts[]; };   // texels within geometry · cells that are cut

layout(push_constant, scalar) uniform Push { uint texel_count; } push;

bool is_cut(uvec4 cell) {
    [[dont_unroll]] for (uint corner = 0u; corner < 4u; ++corner) {
        if (texelFetch(valid, int(cell[corner])).x == 0u) {
            return true;
        }
    }
    // The pairs 01, 02, 03, 12, 13, 23.
    [[dont_unroll]] for (uint pair = 0u; pair < 6u; ++pair) {
        uint a = pair < 3u ? 0u : (pair < 5u ? 1u : 2u);
        uint b = pair < 3u ? pair + 1u : (pair < 5u ? pair - 1u : 3u);
        LightTexel from = load_light_texel(cell[a]);
        if (cell[a] != cell[b] && !sees_texel(lifted(from.position, from.face, from.size), load_light_texel(cell[b]))) {
            return true;
        }
    }
    return false;
}

void main() {
    uint number = gl_GlobalInvocationID.x;
    if (number >= push.texel_count) {
        return;
    }
    uint own = texelFetch(valid, int(number)).x;
    LightTexel texel = load_light_texel(number);
    bool cut = false;
    if (texel.triangle != NO_TEXEL) {
        Chart chart = load_chart(lightmap_charts, texel.triangle & ~TEXEL_BACK);
        uint first = first_of_side(chart, (texel.triangle & TEXEL_BACK) != 0u);
        cut = is_cut(texels_of_cell(first, chart.size, place_on_map(chart, first, number)));
        if (own == 0u) {
            atomicAdd(counts[0], 1u);
        }
        if (cut) {
            atomicAdd(counts[1], 1u);
        }
    }
    flags[number] = own | (cut ? CELL_CUT : 0u);
}
