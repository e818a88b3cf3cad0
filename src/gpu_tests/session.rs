//! A device for one test, watched by the validation layer.

use std::sync::Once;

use crate::graph::Store;
use crate::renderer::{Context, ContextOptions, Frame, FrameRequest, Renderer, Settings, Validation};
use crate::scene::Scene;
use crate::vulkan::DeviceTraits;

/// Names what the layer checks: `off`, `core`, `sync` (the default) or `gpu`.
const VALIDATION: &str = "IRRADIA_TEST_VALIDATION";
/// Names the device, as `--device` does.
pub(super) const DEVICE: &str = "IRRADIA_TEST_DEVICE";

/// A device. When it goes, after everything made on it, the test fails if the validation layer said anything or if
/// memory is still held.
pub(crate) struct Session {
    pub(crate) context: Context,
}

impl Session {
    pub(crate) fn open() -> Session {
        Session::with_traits(|known| known)
    }

    /// On a device that is taken for one of other traits.
    pub(crate) fn with_traits(traits: impl FnOnce(DeviceTraits) -> DeviceTraits) -> Session {
        let validation = match std::env::var(VALIDATION).as_deref() {
            Err(_) | Ok("sync") => Validation::Synchronization,
            Ok("core") => Validation::Core,
            Ok("gpu") => Validation::GpuAssisted,
            Ok("off") => Validation::Off,
            Ok(other) => panic!("{VALIDATION} is {other:?}; it takes off, core, sync or gpu"),
        };
        let options = ContextOptions { device: std::env::var(DEVICE).ok(), validation, ..ContextOptions::default() };
        let context = Context::with_traits(&options, traits).expect("a device for tests");
        static SAID: Once = Once::new();
        SAID.call_once(|| {
            let device = context.device();
            eprintln!("tests run on {}, driver {}, validation {validation:?}", device.name, device.driver);
        });
        Session { context }
    }

    pub(crate) fn renderer(&self, settings: &Settings) -> Renderer {
        Renderer::new(&self.context, settings.clone()).expect("a renderer")
    }

    pub(crate) fn store(&self) -> Store {
        Store::new(self.context.pipelines()).expect("a store")
    }

    /// A frame by a renderer that made none before.
    pub(crate) fn render(&self, scene: &Scene, settings: &Settings, request: &FrameRequest) -> Frame {
        self.renderer(settings).render(scene, request).expect("a frame")
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        if std::thread::panicking() {
            return;
        }
        let messages = self.context.validation_messages();
        assert!(messages.is_empty(), "{} validation messages:\n{}", messages.len(), messages.join("\n"));
        let alive = self.context.live_allocations();
        assert!(alive.is_empty(), "memory that outlives its renderer: {alive:?}");
    }
}
