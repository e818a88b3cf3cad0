// The slot `direct`, to which one kernel adds after the other (src/direct/traced/).
// group: bindings 128 to 131, constants 68 to 71
#ifndef GROUPS_DIRECT_SUM
#define GROUPS_DIRECT_SUM

// 1: `before` holds what earlier kernels found.
layout(constant_id = 68) const uint ADDS = 0u;

layout(set = 0, binding = 128) uniform sampler2D before;
layout(set = 0, binding = 129, rgba32f) writeonly uniform image2D direct;

#endif
