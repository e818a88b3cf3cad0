//! The typed side of every shader program, generated from the SPIR-V by build.rs.

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
