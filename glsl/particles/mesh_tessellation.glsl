// Radiance particles (Chang et al. 3.2): the vertices of a tessellation of every triangle with a diffuse lobe, found by formula from the record of their triangle
// (src/frame/rays/tessellation.rs). The including file binds `tessellation`, three texels a triangle:
//
//   numbers of the particles at corners A, B, C | of the first inner one of edge AB
//   of the first inner one of AC, of BC | how it is cut | of the first particle that belongs to this triangle
//   of the first subtriangle
//
// Row r of 2^k from A to BC has ⌈r/2^(k−c)⌉ parts. Points of two-sided surfaces follow each other by twos, front and back; so do their subtriangles.
#ifndef PARTICLES_MESH_TESSELLATION
#define PARTICLES_MESH_TESSELLATION

#include "lib/traced_scene.glsl"

const uint NO_CORNER = 0xFFFFFFFFu;

struct Tessellated {
    uint corners[3];   // A, B, C
    uint edges[3];     // AB, AC, BC
    uint cuts;
    uint first;
    uint first_subtriangle;
};

Tessellated load_tessellated(uint triangle) {
    int texel = 3 * int(triangle);
    uvec4 a = texelFetch(tessellation, texel);
    uvec4 b = texelFetch(tessellation, texel + 1);
    uint first_subtriangle = texelFetch(tessellation, texel + 2).x;
    return Tessellated(uint[](a.x, a.y, a.z), uint[](a.w, b.x, b.y), b.z, b.w, first_subtriangle);
}

bool has_radiance_particles(Tessellated t) {
    return t.corners[0] != NO_CORNER;
}

uint level_of_rows(Tessellated t) {
    return t.cuts & 15u;
}

// Rows of BC's length for each of its parts, as a power of two.
uint level_of_row_parts(Tessellated t) {
    return (t.cuts & 15u) - (t.cuts >> 4 & 15u);
}

uint sides_of(Tessellated t) {
    return 1u + (t.cuts >> 31);
}

uint parts_of_row(uint row, uint shift) {
    return (row + (1u << shift) - 1u) >> shift;
}

// Of the rows 1 to `row`.
uint parts_until(uint row, uint shift) {
    uint whole = row >> shift;
    uint rest = row & ((1u << shift) - 1u);
    return (whole * (whole + 1u) / 2u << shift) + rest * (whole + 1u);
}

// A place in a tessellated triangle: a row and a point of it, or a strip, which ends with its row, and one of its subtriangles.
struct RowPlace {
    uint row;
    uint place;
};

uint inner_points_before(uint row, uint shift) {
    return parts_until(row - 1u, shift) - (row - 1u);
}

uint subtriangles_before(uint row, uint shift) {
    return parts_until(max(row, 2u) - 2u, shift) + parts_until(row - 1u, shift);
}

uint points_of_edge(Tessellated t, uint edge) {
    return (1u << (t.cuts >> (8u + 4u * edge) & 15u)) - 1u;
}

// The particle at `place` of 2^level parts of an edge, which may be cut more finely by its other triangle.
uint particle_on_edge(Tessellated t, uint edge, uint place, uint level) {
    uint own = t.cuts >> (8u + 4u * edge) & 15u;
    uint part = place << (own - level);
    part = (t.cuts >> (20u + edge) & 1u) != 0u ? (1u << own) - part : part;
    return t.edges[edge] + sides_of(t) * (part - 1u);
}

uint first_inner(Tessellated t) {
    uint before = uint(bitCount(t.cuts >> 23 & 7u));
    for (uint edge = 0u; edge < 3u; ++edge) {
        before += (t.cuts >> (26u + edge) & 1u) != 0u ? points_of_edge(t, edge) : 0u;
    }
    return before;
}

// The particle at a point, on one side.
uint particle_at(Tessellated t, RowPlace at, uint side) {
    uint rows = level_of_rows(t);
    uint shift = level_of_row_parts(t);
    uint last = parts_of_row(at.row, shift);
    uint particle;
    if (at.row == 0u) {
        particle = t.corners[0];
    } else if (at.row == 1u << rows) {
        particle = at.place == 0u ? t.corners[1] : at.place == last ? t.corners[2] : particle_on_edge(t, 2u, at.place, rows - shift);
    } else if (at.place == 0u || at.place == last) {
        particle = particle_on_edge(t, at.place == 0u ? 0u : 1u, at.row, rows);
    } else {
        particle = t.first + sides_of(t) * (first_inner(t) + inner_points_before(at.row, shift) + at.place - 1u);
    }
    return particle + side;
}

// From weights of A, B, C to the weights of the triangle's corners 1 and 2.
vec2 place_of_weights(Tessellated t, vec3 weights) {
    uint apex = t.cuts >> 29 & 3u;
    vec3 own = apex == 0u ? weights : apex == 1u ? weights.zxy : weights.yzx;
    return own.yz;
}

// `place` along the row: a share of it.
vec2 place_in_row(Tessellated t, float row, float share) {
    float down = row / float(1u << level_of_rows(t));
    return place_of_weights(t, vec3(1.0 - down, down * (1.0 - share), down * share));
}

// A point's weights of the triangle's corners 1 and 2.
vec2 place_of_point(Tessellated t, RowPlace at) {
    return place_in_row(t, float(at.row), float(at.place) / float(max(parts_of_row(at.row, level_of_row_parts(t)), 1u)));
}

// The three points of a subtriangle, which is numbered along its strip: even ones have two on the strip's last row, odd ones one.
RowPlace[3] points_of_subtriangle(Tessellated t, uint index) {
    uint shift = level_of_row_parts(t);
    uint low = 1u;
    uint high = (1u << level_of_rows(t)) + 1u;
    [[dont_unroll]] for (uint halving = 0u; halving < 16u && high - low > 1u; ++halving) {
        uint middle = (low + high) / 2u;
        if (subtriangles_before(middle, shift) <= index) {
            low = middle;
        } else {
            high = middle;
        }
    }
    uint along = index - subtriangles_before(low, shift);
    uint j = along >> 1;
    bool odd = (along & 1u) != 0u;
    return RowPlace[](
        RowPlace(low - 1u, j), odd ? RowPlace(low - 1u, j + 1u) : RowPlace(low, j), RowPlace(low, j + 1u));
}

struct Subtriangle {
    uint index;
    vec3 weights;  // of its points
};

// The subtriangle at a point of the triangle with these weights of its corners 1 and 2. Lines from A and such as lead from point j of a row to j + 1 of the
// next one bound it.
Subtriangle subtriangle_at(Tessellated t, vec2 place) {
    uint apex = t.cuts >> 29 & 3u;
    vec3 own = vec3(1.0 - place.x - place.y, place);
    vec3 weights = apex == 0u ? own : apex == 1u ? own.yzx : own.zxy;
    uint shift = level_of_row_parts(t);
    float rows = float(1u << level_of_rows(t));
    float down = clamp((weights.y + weights.z) * rows, 0.0, rows);
    float along = clamp(weights.z * rows, 0.0, down);
    uint row = clamp(uint(ceil(down)), 1u, uint(rows));
    uint upper_parts = parts_of_row(row - 1u, shift);
    uint lower_parts = parts_of_row(row, shift);
    float t_down = clamp(down - float(row - 1u), 0.0, 1.0);
    float upper_step = upper_parts > 0u ? float(row - 1u) / float(upper_parts) : 0.0;
    float lower_step = float(row) / float(lower_parts);
    float step_here = mix(upper_step, lower_step, t_down);
    uint j = min(uint(along / max(step_here, 1e-30)), lower_parts - 1u);
    float upper = float(j) * upper_step;
    float lower = float(j) * lower_step;
    bool odd = j < upper_parts && along > mix(upper, lower + lower_step, t_down);
    float second;
    vec3 shares;
    if (odd) {
        second = (along - t_down * (lower + lower_step) - (1.0 - t_down) * upper) / max(upper_step, 1e-30);
        second = clamp(second, 0.0, 1.0 - t_down);
        shares = vec3(1.0 - t_down - second, second, t_down);
    } else {
        second = clamp((along - (1.0 - t_down) * upper) / lower_step - t_down * float(j), 0.0, t_down);
        shares = vec3(1.0 - t_down, t_down - second, second);
    }
    return Subtriangle(subtriangles_before(row, shift) + 2u * j + (odd ? 1u : 0u), shares);
}

// The triangle whose particles, or subtriangles, hold a number: the last one of `triangle_count` that begins with no larger one.
uint triangle_of_number(uint number, bool of_subtriangle, uint triangle_count) {
    uint low = 0u;
    uint high = triangle_count;
    [[dont_unroll]] for (uint halving = 0u; halving < 32u && high - low > 1u; ++halving) {
        uint middle = (low + high) / 2u;
        int texel = 3 * int(middle);
        uint first = of_subtriangle ? texelFetch(tessellation, texel + 2).x : texelFetch(tessellation, texel + 1).w;
        if (first <= number) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

uint tessellated_triangle_count() {
    return uint(textureSize(tessellation)) / 3u - 1u;
}

// Where the particle number `local` of those that belong to a triangle lies: weights of its corners 1 and 2.
vec2 place_of_particle(Tessellated t, uint local) {
    for (uint corner = 0u; corner < 3u; ++corner) {
        if ((t.cuts >> (23u + corner) & 1u) != 0u) {
            if (local == 0u) {
                return place_of_weights(t, vec3(corner == 0u ? 1.0 : 0.0, corner == 1u ? 1.0 : 0.0, corner == 2u ? 1.0 : 0.0));
            }
            --local;
        }
    }
    for (uint edge = 0u; edge < 3u; ++edge) {
        if ((t.cuts >> (26u + edge) & 1u) != 0u) {
            uint count = points_of_edge(t, edge);
            if (local < count) {
                float share = float(local + 1u) / float(count + 1u);
                share = (t.cuts >> (20u + edge) & 1u) != 0u ? 1.0 - share : share;
                vec3 weights = edge == 0u   ? vec3(1.0 - share, share, 0.0)
                               : edge == 1u ? vec3(1.0 - share, 0.0, share)
                                            : vec3(0.0, 1.0 - share, share);
                return place_of_weights(t, weights);
            }
            local -= count;
        }
    }
    uint shift = level_of_row_parts(t);
    uint low = 1u;
    uint high = 1u << level_of_rows(t);
    [[dont_unroll]] for (uint halving = 0u; halving < 16u && high - low > 1u; ++halving) {
        uint middle = (low + high) / 2u;
        if (inner_points_before(middle, shift) <= local) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return place_of_point(t, RowPlace(low, local - inner_points_before(low, shift) + 1u));
}

#endif
