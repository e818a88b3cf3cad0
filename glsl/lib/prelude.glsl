// The extensions and the block layout that every shader here uses.
//
// Scalar layout gives GLSL structs the offsets of their `repr(C)` counterparts: no padding rules to remember.
// `[[dont_unroll]]` marks loops whose bound is a constant: unrolled and masked, they are slower on a CPU driver.

#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

layout(scalar) uniform;
layout(scalar) buffer;
