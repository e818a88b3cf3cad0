// Which texels of a light map stand for a point of a surface: the four around it, by bilinear interpolation. Where geometry cuts their cell, those alone that the
// point sees, so that no light comes through a wall which stands on one floor; if it sees none, the nearest one of the sixteen around that it sees, or, in
// nooks where it sees none of these either, the nearest one of all that lie in the open.
#ifndef LIGHTMAPS_LOOKUP
#define LIGHTMAPS_LOOKUP

#include "lightmaps/texels.glsl"

// Light by the texels of a cell; weights add up to 1, or to 0 where no texel stands for the point.
const Cell NO_CELL = Cell(uvec4(0u), vec4(0.0));

bool is_valid(uint texel) {
    return (texelFetch(lightmap_flags, int(texel)).x & TEXEL_VALID) != 0u;
}

// `place`: weights of corners 1 and 2 of the triangle. `face`: its normal on the side of the point.
Cell texels_at(uint triangle, vec2 place, bool back, vec3 position, vec3 face) {
    Chart chart = load_chart(lightmap_charts, triangle);
    uint first = first_of_side(chart, back);
    if (first == NO_TEXEL) {
        return NO_CELL;
    }
    vec2 at = point_on_map(chart, place);
    Cell cell = cell_at(first, chart.size, at);
    if ((texelFetch(lightmap_flags, int(cell.texels.x)).x & CELL_CUT) == 0u) {
        return cell;
    }
    vec3 origin = lifted(position, face, chart.texel);
    ivec2 corner = min(ivec2(clamp(at, vec2(0.0), vec2(chart.size - 1))), max(chart.size - 2, ivec2(0))) - 1;
    vec4 weights = vec4(0.0);
    vec2 nearest = vec2(3e38);  // squared, of those that are seen, and of all
    uvec2 others = uvec2(NO_TEXEL);
    [[dont_unroll]] for (uint number = 0u; number < 20u; ++number) {
        bool around = number >= 4u;
        if (around && weights.x + weights.y + weights.z + weights.w > 0.0) {
            break;
        }
        ivec2 away = corner + ivec2((number - 4u) & 3u, (number - 4u) >> 2);
        if (around && (any(lessThan(away, ivec2(0))) || any(greaterThanEqual(away, chart.size)))) {
            continue;
        }
        uint texel = around ? first + uint(away.y * chart.size.x + away.x) : cell.texels[number & 3u];
        float weight = around ? 1.0 : cell.weights[number & 3u];
        if (weight <= 0.0 || !is_valid(texel)) {
            continue;
        }
        LightTexel known = load_light_texel(texel);
        vec3 way = known.position - position;
        float away2 = dot(way, way);
        if (around && away2 < nearest.y) {
            nearest.y = away2;
            others.y = texel;
        }
        if ((around && away2 >= nearest.x) || !sees_texel(origin, known)) {
            continue;
        }
        if (around) {
            nearest.x = away2;
            others.x = texel;
        } else {
            weights[number] = weight;
        }
    }
    if (others.y != NO_TEXEL) {
        return Cell(uvec4(others.x != NO_TEXEL ? others.x : others.y), vec4(1.0, 0.0, 0.0, 0.0));
    }
    float total = weights.x + weights.y + weights.z + weights.w;
    return total > 0.0 ? Cell(cell.texels, weights / total) : NO_CELL;
}

// What they hold; `first`: where their map begins.
vec3 light_of(Cell cell, samplerBuffer light, uint first) {
    vec3 sum = vec3(0.0);
    for (int corner = 0; corner < 4; ++corner) {
        sum += cell.weights[corner] * texelFetch(light, int(first + cell.texels[corner])).rgb;
    }
    return sum;
}

#endif
