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

mod context;
pub(crate) mod declare;
mod error;
mod frame;
mod options;
mod path_frame;
mod render;
mod settings;
mod slots;

pub use context::Context;
pub use error::Error;
pub use frame::{ColorImage, Estimate, Frame, FrameRequest, FrameTimings, PassTiming, Timing, ToneMap};
pub use options::{
    LightSettings, ListProjection, PathSettings, PhotonFootprint, PhotonGeometry, PhotonKernel, PhotonSettings,
    PhotonSplatting, PhotonTracing, RsmSettings, ShadowSettings, TracedSettings, VplSettings, VplShading,
    VplVisibility,
};
pub use render::Renderer;
pub use settings::{
    CausticsMethod, DiffuseMethod, DirectMethod, Methods, Preset, Settings, SettingsError, SpecularMethod, Technique,
};
pub use slots::Slot;

pub use crate::graph::GraphDescription;
pub use crate::vulkan::{ContextOptions, DeviceReport, Validation, VulkanError};
