//! The context: one Vulkan device, shared by the renderers on it.

use std::sync::Arc;

use super::limits::lacks_by_method;
use crate::method::Error;
#[cfg(test)]
use crate::vulkan::DeviceTraits;
use crate::vulkan::{self, ContextOptions, Device, DeviceReport, Pipelines, Survey};

/// A Vulkan device, and the pipelines that renderers had it compile. Cloning shares both; they are destroyed with the last renderer on it.
#[derive(Clone)]
pub struct Context {
    device: Arc<Device>,
    pipelines: Arc<Pipelines>,
}

impl Context {
    /// Opens a device.
    ///
    /// # Errors
    /// A sentence that says what to install, when there is no loader, no device or no validation layer; which devices
    /// there are, when none matches; what the device lacks and what needs it, when it cannot be used.
    pub fn new(options: &ContextOptions) -> Result<Context, Error> {
        Ok(Context::on(Device::new(options)?))
    }

    /// On a device that is taken for one of other traits.
    #[cfg(test)]
    pub(crate) fn with_traits(
        options: &ContextOptions,
        traits: impl FnOnce(DeviceTraits) -> DeviceTraits,
    ) -> Result<Context, Error> {
        Ok(Context::on(Device::with_traits(options, traits)?))
    }

    pub(crate) fn on(device: Arc<Device>) -> Context {
        let pipelines = Pipelines::new(&device);
        Context { device, pipelines }
    }

    /// All devices of this machine, usable or not.
    ///
    /// # Errors
    /// Without a Vulkan loader.
    pub fn devices() -> Result<Vec<DeviceReport>, Error> {
        Ok(vulkan::devices()?.iter().map(report_of).collect())
    }

    /// The device in use.
    pub fn device(&self) -> DeviceReport {
        report_of(&self.device.survey)
    }

    /// What the validation layer found so far: warnings and worse. Always empty without validation.
    pub fn validation_messages(&self) -> Vec<String> {
        self.device.messages()
    }

    /// Names and bytes of the device allocations that are alive. Empty once all renderers are gone.
    pub fn live_allocations(&self) -> Vec<(String, u64)> {
        self.device.live_allocations()
    }

    pub(crate) fn pipelines(&self) -> &Arc<Pipelines> {
        &self.pipelines
    }

    pub(crate) fn shared_device(&self) -> &Arc<Device> {
        &self.device
    }
}

/// What is known of a device, and which methods it cannot run.
fn report_of(survey: &Survey) -> DeviceReport {
    let lacks = lacks_by_method(&survey.offer, survey.traits.software);
    DeviceReport { lacks, ..survey.report.clone() }
}

impl std::fmt::Debug for Context {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Context").field("device", &self.device.report().name).finish()
    }
}
