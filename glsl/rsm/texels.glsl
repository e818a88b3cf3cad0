// What the texels of a light tile add to the distribution that virtual point lights are drawn from.

#include "groups/light_views.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/hilbert.glsl"
#include "lib/lights.glsl"
#include "lib/octahedral.glsl"

const uint TILE_TEXELS = 256u;

layout(set = 0, binding = 0) readonly buffer Tiles { LightTile tiles[]; };

ivec2 texel_of_tile(LightTile tile, uint index) {
    return tile.origin + hilbert_decode(index, tile.orientation);
}

// Reflected flux [W] and lit surface [m²] of one texel; a texel that reflects nothing has no surface either. `dropped` becomes true where
// that is no number: one would make every sum none.
vec4 flux_and_area(LightView view, ivec2 texel, inout bool dropped) {
    vec3 flux = texelFetch(light_flux, texel, 0).rgb * view.flux_scale;
    float depth = texelFetch(light_depth, texel, 0).x;
    if (is_finite(flux) && luminance(flux) <= 0.0 || depth <= 0.0) {
        return vec4(0.0);
    }
    vec3 normal = unpack_direction(texelFetch(light_normal, texel, 0).x);
    vec4 seen = vec4(flux, area_of_texel(view, tangent_of_texel(view, vec2(texel) + 0.5), depth, normal));
    dropped = dropped || !is_finite(seen);
    return is_finite(seen) ? seen : vec4(0.0);
}
