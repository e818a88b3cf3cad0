//! The renderer: a device, settings and a scene in, frames out.
//!
//! ```no_run
//! use irradia::renderer::{Context, ContextOptions, FrameRequest, Preset, Renderer, Settings, Technique};
//! use irradia::scene::Scene;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let context = Context::new(&ContextOptions::default())?;
//! let mut scene = Scene::open("cornell-point")?;
//! let mut renderer = Renderer::new(&context, Settings::new(Technique::Rsm, Preset::Default))?;
//! for number in 0..60 {
//!     scene.set_frame(number);
//!     let request = FrameRequest::new([512, 512], scene.camera_view(None)?);
//!     let frame = renderer.render(&scene, &request)?;
//!     println!("frame {number}: {:.2} ms on the device", frame.timings.gpu_ms);
//! }
//! # Ok(())
//! # }
//! ```

mod choices;
mod context;
pub(crate) mod declare;
mod estimates;
mod fault;
mod frame;
#[cfg(feature = "capi")]
mod hand_out;
#[cfg(feature = "capi")]
mod handed;
mod light_on_surfaces;
pub(crate) mod limits;
mod methods;
mod render;
mod repeat;
mod settings;
mod technique;

pub use choices::{CausticsMethod, DiffuseMethod, DirectMethod, Methods, SpecularMethod, UnknownMethod};
pub use context::Context;
pub use frame::{Estimate, Frame, FrameRequest};
#[cfg(feature = "capi")]
pub(crate) use handed::Handed;
pub(crate) use light_on_surfaces::SurfaceLight;
pub use render::Renderer;
pub use repeat::{RepeatError, Repetition, check_piece};
pub use settings::{Settings, SettingsError, options};
pub use technique::{Technique, UnknownTechnique};

pub use crate::graph::{Cancel, FrameTimings, GraphDescription, PassTiming, Progress, Timing};
pub use crate::image::{ColorImage, ToneMap};
pub use crate::method::{Error, OptionFault, OptionInfo, OptionKind, Options, Preset, UnknownPreset};
pub use crate::slot::Slot;
pub use crate::vulkan::{ContextOptions, CrashMarkers, DeviceReport, Validation, VulkanError};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn everything_may_go_to_another_thread() {
        fn sent<T: Send>() {}
        fn shared<T: Sync>() {}
        sent::<Context>();
        shared::<Context>();
        sent::<Renderer>();
        sent::<Scene>();
        shared::<Scene>();
        sent::<Frame>();
        sent::<Error>();
    }
}
