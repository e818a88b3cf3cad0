#version 460
#include "lib/prelude.glsl"
#include "groups/light_views.glsl"
#include "lib/lights.glsl"
#include "lib/octahedral.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "vpl/blocks.glsl"

// One invocation sums one block of 8x8 light-view texels: ΣΦ [W] in rgb and ΣA [m²], the surface that its reflecting texels see, in a.
// Every texel's flux is read, so that no light is lost, and left out and counted where it is no number; the surface is that of one lit texel times the number of lit texels.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) readonly buffer Tiles { LightTile tiles[]; };
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2D blocks;
layout(set = 0, binding = 2) buffer DroppedBlock { uint dropped_texels[]; };

layout(push_constant, scalar) uniform Push { uint tile_count; } push;

void main() {
    uint tile = gl_GlobalInvocationID.x / BLOCKS_PER_TILE;
    uint part = gl_GlobalInvocationID.x % BLOCKS_PER_TILE;
    if (tile >= push.tile_count) {
        return;
    }
    ivec2 origin = tiles[tile].origin + BLOCK_SIDE * ivec2(part & 1u, part >> 1);
    vec3 sum = vec3(0.0);
    float lit = 0.0;
    uint dropped = 0u;
    ivec2 last_lit = origin;
    [[dont_unroll]] for (int y = 0; y < BLOCK_SIDE; ++y) {
        [[dont_unroll]] for (int x = 0; x < BLOCK_SIDE; ++x) {
            ivec2 texel = origin + ivec2(x, y);
            vec3 flux = texelFetch(light_flux, texel, 0).rgb;
            bool sound = is_finite(flux);
            dropped += sound ? 0u : 1u;
            flux = sound ? flux : vec3(0.0);
            sum += flux;
            bool reflects = max3(flux) > 0.0;
            lit += reflects ? 1.0 : 0.0;
            // Of a lit block it ends at the fifth row and column, the middle.
            last_lit = reflects && (x <= BLOCK_SIDE / 2 && y <= BLOCK_SIDE / 2 || last_lit == origin) ? texel : last_lit;
        }
    }
    if (dropped > 0u) {
        atomicAdd(dropped_texels[0], dropped);
    }
    LightView view = load_view(views, tiles[tile].view);
    vec4 block = vec4(0.0);
    if (lit > 0.0) {
        float depth = texelFetch(light_depth, last_lit, 0).x;
        vec3 normal = unpack_direction(texelFetch(light_normal, last_lit, 0).x);
        vec2 tangent = tangent_of_texel(view, vec2(last_lit) + 0.5);
        float area = depth > 0.0 ? area_of_texel(view, tangent, depth, normal) : 0.0;
        area = is_finite(area) ? area : 0.0;
        block = vec4(sum * view.flux_scale, lit * area);
    }
    imageStore(blocks, origin / BLOCK_SIDE, block);
}
