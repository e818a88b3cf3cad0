//! What a method is: one folder with a [`Method`] and its [`Options`], and one line in the list of `list.rs`.

mod choices;
mod error;
mod frame_cx;
mod light_options;
mod list;
mod options;
mod preset;

pub(crate) use self::choices::choices;
pub use self::error::Error;
pub(crate) use self::frame_cx::{FrameCx, Inputs, Rays};
pub use self::light_options::LightOptions;
pub(crate) use self::list::{for_all_methods, modules};
pub use self::options::{OptionFault, OptionInfo, OptionKind, Options};
pub(crate) use self::options::{Piece, options, written};
pub use self::preset::{Preset, UnknownPreset};

use crate::graph::bindings::ImageRef;
use crate::scene::Facts;
use crate::slot::{LightPaths, Slot};

/// One way to fill a slot.
pub(crate) trait Method {
    /// The name on the command line, and in its piece `slot/name`.
    const NAME: &'static str;
    const SLOT: Slot;
    type Options: Options;
    /// Of the slots `diffuse` and `caustics`: it says what of its light comes to points that mirrors show (`frame/mirrored.rs`).
    const LIGHTS_MIRRORED: bool = false;
    /// Of the slot `direct`: mirrors show lamps and the sky.
    const SHOWS_LAMPS: bool = false;
    /// Of the slot `specular`: where the method of the slot `direct` does not, it shows lamps and the sky in mirrors.
    const FOLLOWS_LAMPS: bool = false;

    /// Which light it can find: what it is compared with.
    fn light_paths(options: &Self::Options) -> LightPaths;

    /// What it takes of a frame, besides the G-buffer.
    fn inputs(options: &Self::Options) -> Inputs;

    /// The programs that it may run, by their names below `glsl/`, or how these begin before a star: a device that lacks what one of them needs cannot run the
    /// method with these options. `software`: shaders run on the host's processor.
    fn shaders(options: &Self::Options, software: bool) -> Vec<&'static str>;

    /// Why the scene or the options leave it nothing to do.
    fn skip(options: &Self::Options, facts: &Facts) -> Option<&'static str>;

    /// What the options ask for and the method does less of, since buffers hold no more: a sentence.
    fn reduced(_: &Self::Options) -> Option<String> {
        None
    }

    /// How many frames it takes until what it keeps over frames says what it will go on to say; zero if it keeps nothing.
    fn lead_in(_: &Self::Options) -> u32 {
        0
    }

    /// Declares what other methods have to know of before they declare their passes. The one of the slot `direct` has declared its own (`frame/direct_light.rs`).
    fn prepare(_: &mut FrameCx<'_, '_>, _: &Self::Options) {}

    /// Declares its passes in the order in which they run. Returns the slot's radiance in W/(m² sr), one texel a pixel; none where it is black.
    ///
    /// # Errors
    /// What the device does not allow.
    fn declare(cx: &mut FrameCx<'_, '_>, options: &Self::Options) -> Result<Option<ImageRef>, Error>;

    /// Declares what it makes better, in place, of the slots that methods fill and the frame shows. For those that take [`Inputs::slots`].
    fn refine(_: &mut FrameCx<'_, '_>, _: &Self::Options, _: &[(Slot, ImageRef)]) {}
}
