// Which lobes kernels are compiled for (lib/lobes.glsl).
// group: constants 64 to 67
#ifndef GROUPS_LOBES
#define GROUPS_LOBES

// 1: the scene has specular or transmissive lobes; 0: kernels hold the diffuse lobe alone.
layout(constant_id = 64) const uint SPECULAR_LOBES = 1u;
// 1: some surface transmits.
layout(constant_id = 65) const uint TRANSMISSIVE = 1u;

#endif
