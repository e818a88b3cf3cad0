#version 460
#include "lib/prelude.glsl"
#include "groups/splat.glsl"
#include "lib/pixels.glsl"
#include "photon_splat/levels.glsl"
#include "photon_splat/state.glsl"
#include "photon_splat/tile.glsl"

// Lists one tile of samples if a photon may reach it or a sample beside it, with the brightest disc among those photons.

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform usamplerBuffer cell_peaks;
layout(set = 0, binding = 1) uniform usamplerBuffer cell_counts;
layout(set = 0, binding = 2) writeonly buffer TilePeakBlock { uint tile_peaks[]; };
layout(set = 0, binding = 3) writeonly buffer TileBlock { uint tiles[]; };
layout(set = 0, binding = 4) writeonly buffer CrowdedBlock { uint crowded[]; };
layout(set = 0, binding = 5) buffer StateBlock { uint state[]; };

layout(push_constant, scalar) uniform Push {
    ivec2 tile_count;
    int level_count;
    uint ordinary;  // photons of a tile that is not crowded, at most
} push;

// Counts a tile in a list; returns its place there.
uint append(uint list) {
    uint listed = atomicAdd(state[list + 3u], 1u);
    if (listed < LISTED_A_ROW) {
        atomicMax(state[list], listed + 1u);
    }
    if (listed % LISTED_A_ROW == 0u) {
        atomicMax(state[list + 1u], listed / LISTED_A_ROW + 1u);
    }
    return listed;
}

void main() {
    ivec2 tile = pixel_of_invocation();
    if (!is_inside(tile, push.tile_count)) {
        return;
    }
    uint filled = state[STATE_LEVELS];
    uint peak = 0u;
    uint count = 0u;
    for (int level = 0; level < push.level_count; ++level) {
        if ((filled >> level & 1u) == 0u) {
            continue;
        }
        uvec4 cells = texelFetch(splat_levels, level);
        ivec4 around = cells_around(TILE_SIDE * tile, TILE_SIDE * tile + TILE_SIDE - 1, 1.0, level, cells);
        for (int y = around.y; y <= around.w; ++y) {
            for (int x = around.x; x <= around.z; ++x) {
                int cell = cell_index(ivec2(x, y), cells);
                peak = max(peak, texelFetch(cell_peaks, cell).x);
                count += texelFetch(cell_counts, cell).x;
            }
        }
    }
    int index = tile.y * push.tile_count.x + tile.x;
    tile_peaks[index] = peak;
    if (count > push.ordinary) {
        uint listed = append(STATE_CROWDED);
        crowded[listed] = uint(index);
        atomicMax(state[STATE_PARTS], min(listed + 1u, LISTED_A_ROW));
        atomicMax(state[STATE_PARTS + 1u], (count - 1u) / PART_PHOTONS + 1u);
        atomicMax(state[STATE_PARTS + 2u], listed / LISTED_A_ROW + 1u);
    } else if (count > 0u) {
        tiles[append(STATE_TILES)] = uint(index);
    }
}
