//! The paper's receivers: radiance particles, the vertices of a tessellation of all triangles (frame/rays/tessellation.rs). Preliminary rays mark the subtriangles
//! that pixels and mirrors show, and so the radiance particles that are evaluated, by estimation lists; pixels interpolate between the three of their subtriangle.
//!
//! Where a wall stands across a subtriangle, pixels read those of the three that they see; if there is none, the list of their area particle, as those of
//! `receivers=pixels` do.

mod found;
mod light;
mod lists;
mod receivers;
mod spots;

pub(super) use self::light::light;
pub(super) use self::receivers::MeshReceivers;
