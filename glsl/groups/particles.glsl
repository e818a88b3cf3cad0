// Area particles and the grid that finds them (src/diffuse/particles/geometry.rs): sorted by bucket, the particles of bucket b are those from
// particle_starts[b] to particle_starts[b + 1].
// group: bindings 136 to 143
#ifndef GROUPS_PARTICLES
#define GROUPS_PARTICLES

layout(set = 0, binding = 136) uniform usamplerBuffer particle_places;   // position in the rays' space, packed shading normal
layout(set = 0, binding = 137) uniform usamplerBuffer particle_starts;
layout(set = 0, binding = 138) uniform SpacingBlock { float particle_spacing; };     // √(area/count), m

#endif
