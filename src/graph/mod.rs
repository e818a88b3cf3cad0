//! The pass graph: a method declares images, buffers and passes; the graph drops what nobody asks for or what memory
//! still holds, places barriers, wraps every pass in label, timestamps and crash marker, and accounts for memory.
//!
//! A frame is declared anew each time, in the order in which its passes run:
//! ```text
//! let sums = graph.buffer::<[f32; 4]>("rsm.tile_sums", tiles);
//! graph.pass("diffuse/rsm/tile-flux", shaders::rsm::TileFlux {
//!     light_flux: views.flux.sampled(),
//!     tile_sums:  sums.write(),
//!     push:       TileFluxPush { tiles_per_row },
//! }).groups([tiles, 1, 1]);
//! ```
//! Usage flags, layouts, stage and access masks derive from these lines. Every content gets a key from what it is
//! made of ([`demand`]), so "nothing changed" needs no declaration of its own.

pub(crate) mod barriers;
mod bind;
pub(crate) mod bindings;
mod builder;
mod carried;
mod declare;
pub(crate) mod demand;
mod dependence;
mod describe;
mod execute;
#[cfg(feature = "capi")]
mod hand_out;
mod interrupt;
pub(crate) mod kept;
mod key;
mod mistakes;
mod needs;
mod nothing;
mod pass;
mod piece;
pub(crate) mod proof;
mod read_back;
mod record;
mod report;
mod resource;
mod store;
mod timing;
#[cfg(test)]
mod uses;
mod watch;

pub(crate) use declare::{Graph, Output};
pub(crate) use dependence::Dependence;
pub use describe::GraphDescription;
pub(crate) use execute::{Executed, Outgrown};
pub(crate) use interrupt::Interrupt;
pub use interrupt::{Cancel, Progress};
pub(crate) use key::hash_of;
pub(crate) use pass::{ClearColor, DrawCall, DrawGroup, DrawList};
#[cfg(feature = "plots")]
pub(crate) use piece::joined;
pub(crate) use piece::{levels, lies_in};
pub(crate) use resource::ReadBack;
pub(crate) use store::Store;
pub use timing::{FrameTimings, PassTiming, Timing};
