//! Light caches around what the camera sees, and virtual area lights that they are lit by (Reich 2015, chapter 4). What they hold, the methods that light them say: `volumes`
//! keeps incoming light as spherical harmonics.

mod allocate;
mod cascades;
mod chunks;
mod lights;
mod nodes;
mod settings;
mod spread;

pub(crate) use self::allocate::{Caches, allocate};
pub(crate) use self::cascades::CascadeRule;
pub(crate) use self::chunks::{Chunk, LANES};
pub(crate) use self::lights::{AreaLights, LightRule, area_lights, grouped};
pub(crate) use self::nodes::nodes;
pub(crate) use self::settings::{CacheSettings, CacheSight, PlaceRule};
pub(crate) use self::spread::{Picture, Points, Samples, spread_lights};
