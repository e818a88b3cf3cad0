// What photons that met surfaces bring there and leave (photons/landing.glsl, photons/records.glsl, photons/arrivals.glsl).
// group: bindings 112 to 123
#ifndef GROUPS_LANDING
#define GROUPS_LANDING

layout(set = 0, binding = 112) uniform usamplerBuffer rays;
layout(set = 0, binding = 113) uniform usamplerBuffer hits;
layout(set = 0, binding = 114) uniform usamplerBuffer choice;
layout(set = 0, binding = 115) writeonly buffer PhotonBlock { uvec4 photons[]; };
layout(set = 0, binding = 116) writeonly buffer ArrivalBlock { uvec4 arrivals[]; };
layout(set = 0, binding = 117) writeonly buffer SurfaceBlock { uvec4 surfaces[]; };
layout(set = 0, binding = 118) buffer CountBlock { uint counts[]; };
layout(set = 0, binding = 119) buffer ArrivalCountBlock { uint arrival_counts[]; };
layout(set = 0, binding = 120) uniform samplerBuffer beams;
layout(set = 0, binding = 121) writeonly buffer BeamBlock { vec4 arrival_beams[]; };
layout(set = 0, binding = 122) writeonly buffer EllipseBlock { vec4 ellipses[]; };

#endif
