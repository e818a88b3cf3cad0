// The light of a group that a ray from a cache is sent to.
#ifndef RADIANCE_MAPS_TARGET
#define RADIANCE_MAPS_TARGET

#include "caches/arriving.glsl"
#include "lib/color.glsl"
#include "lib/sobol.glsl"
#include "lib/weighted_draw.glsl"
#include "radiance_maps/horizon.glsl"

// Drawn by what each gives that faces the cache and has a part before its horizon; -1 if none does.
int target_of(LightGroup group, uint number, MapHorizon horizon, vec3 position_rs) {
    WeightedDraw draw = start_draw(mix_bits(number));
    for (int index = group.first; index < group.end; ++index) {
        Vpl light = load_area_light(index);
        vec3 direction;
        float given = max3(point_light_from(light, position_rs, direction));
        vec3 farthest = light.position_rs - position_rs + sqrt(PI * light.area_over_pi) * horizon.normal;
        if (given > 0.0 && is_before(horizon, farthest)) {
            offer(draw, index, given);
        }
    }
    return draw.drawn;
}

#endif
