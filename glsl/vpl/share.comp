#version 460
#include "lib/prelude.glsl"
#include "lib/color.glsl"
#include "vpl/blocks.glsl"

// One invocation shares N VPLs among the views by the luminance of the flux that they reflect: with C_v the sum of all views before v,
// view v gets those numbered round(N·C_v/C) to round(N·C_{v+1}/C), which is within one of its share, for lights of many views too. The flux
// of a view that gets none goes to the next one that does (the last one, at the end).

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) readonly buffer ViewFluxes { vec4 view_fluxes[]; };
layout(set = 0, binding = 1) buffer Shares { ViewShare shares[]; };

layout(push_constant, scalar) uniform Push {
    uint view_count;
    uint vpl_count;
} push;

void main() {
    float total = 0.0;
    for (uint view = 0u; view < push.view_count; ++view) {
        total += luminance(view_fluxes[view].rgb);
    }
    float scale = total > 0.0 ? float(push.vpl_count) / total : 0.0;
    float before = 0.0;
    uint first = 0u;
    uint last_with_any = 0u;
    vec3 pending = vec3(0.0);
    for (uint view = 0u; view < push.view_count; ++view) {
        vec3 flux = view_fluxes[view].rgb;
        before += luminance(flux);
        // In the last view the sum is the total, bit for bit.
        uint end = min(uint(before * scale + 0.5), push.vpl_count);
        end = luminance(flux) > 0.0 ? end : first;
        shares[view] = ViewShare(end > first ? pending : vec3(0.0), first, end - first);
        pending = end > first ? vec3(0.0) : pending + flux;
        last_with_any = end > first ? view : last_with_any;
        first = end;
    }
    shares[last_with_any].extra += pending;
}
