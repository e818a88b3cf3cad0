//! The renderer: settings in, frames out.

mod frame;
mod settings;
mod slots;

pub use frame::{ColorImage, Frame, FrameRequest, FrameTimings, PassTiming, Timing, ToneMap};
pub use settings::{
    CausticsMethod, DiffuseMethod, DirectMethod, LightSettings, Methods, Preset, RsmSettings, Settings, SettingsError, ShadowSettings, SpecularMethod,
    Technique,
};
pub use slots::Slot;
