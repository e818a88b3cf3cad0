// Area particles and the grid that finds them (src/diffuse/particles/place.rs). Particles are numbered as they lie on the triangles, whatever these do: what is kept of
// a particle, and links, go by its number. The grid has entries sorted by bucket: those of bucket b from particle_starts[b] to particle_starts[b + 1].
// group: bindings 136 to 143
#ifndef GROUPS_PARTICLES
#define GROUPS_PARTICLES

layout(set = 0, binding = 136) uniform usamplerBuffer particle_places;   // by number (particles/places.glsl)
layout(set = 0, binding = 137) uniform usamplerBuffer particle_starts;
layout(set = 0, binding = 138) uniform SpacingBlock { float particle_spacing; };     // where they lie closest, m: √(area/count) if they lie evenly
// Of each entry the position in the rays' space and the packed shading normal with headroom; behind all these the number and the spacing's bits.
layout(set = 0, binding = 139) uniform usamplerBuffer particle_entries;
layout(set = 0, binding = 140) uniform LevelsBlock { uint particle_levels; };        // of the grid

#endif
