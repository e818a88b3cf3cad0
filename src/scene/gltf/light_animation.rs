//! Animation of lights by KHR_animation_pointer: the intensity of lights of KHR_lights_punctual.

use super::document::{self, get};
use super::loader::Loader;
use super::nodes::{LightIds, interpolation_of};
use crate::scene::animation::LightChannel;

impl Loader<'_> {
    /// A channel and the light that it changes; `None` if it changes none that is in the scene, or points nowhere.
    pub(super) fn read_light_channel(
        &self,
        animation: &document::Animation,
        number: usize,
        ids: &LightIds,
    ) -> Result<Option<LightChannel>, String> {
        let channel = get(&animation.channels, number, "channel")?;
        let (true, Some(pointer)) = (channel.target.path == "pointer", channel.target.pointer()) else {
            return Ok(None);
        };
        let index = light_of(pointer).ok_or_else(|| {
            format!("it changes {pointer:?}, and of such things only the intensity of lights can change")
        })?;
        let Some(light) = ids.get(&index).copied().flatten() else { return Ok(None) };
        let color = self.document.light(index)?.color.unwrap_or([1.0; 3]);
        let sampler = get(&animation.samplers, channel.sampler, "sampler")?;
        let (interpolation, values_per_key) = interpolation_of(sampler)?;
        let (times, values) = (self.times(sampler)?, self.accessors.scalars(sampler.output)?);
        if values.len() != times.len() * values_per_key {
            return Err(format!("it has {} values for {} times", values.len(), times.len()));
        }
        if !values.iter().all(|value| value.is_finite()) {
            return Err("a value is not finite".into());
        }
        Ok(Some(LightChannel { light, color, interpolation, times, values }))
    }
}

/// The number of the light whose intensity is pointed to.
fn light_of(pointer: &str) -> Option<usize> {
    let rest = pointer.strip_prefix("/extensions/KHR_lights_punctual/lights/")?;
    rest.strip_suffix("/intensity")?.parse().ok()
}
