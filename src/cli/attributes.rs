//! What a picture's file says of how it was made.

use irradia::output::Attributes;
use irradia::renderer::{DeviceReport, Estimate, Settings, Slot, ToneMap};
use serde_json::{Map, Value};

use super::values;

/// The picture that the attributes describe.
pub(crate) struct Picture<'a> {
    pub(crate) scene: &'a str,
    pub(crate) camera: &'a str,
    pub(crate) frame: u32,
    /// Frames rendered before the first of its sequence.
    pub(crate) lead_in: u32,
    pub(crate) size: [u32; 2],
    pub(crate) settings: &'a Settings,
    pub(crate) device: &'a DeviceReport,
    /// How its pixels were made; `None` for radiance.
    pub(crate) tonemap: Option<ToneMap>,
    /// Pixels along each side that were averaged into one.
    pub(crate) aa: u32,
    /// How its slots were sampled, if they were.
    pub(crate) estimate: Option<&'a Estimate>,
}

impl Picture<'_> {
    /// The attributes: names as in the JSON of the bench; methods and settings are JSON.
    pub(crate) fn attributes(&self) -> Attributes {
        let methods = &self.settings.methods;
        let methods: Map<String, Value> =
            Slot::ALL.into_iter().map(|slot| (slot.name().to_owned(), methods.name_of(slot).into())).collect();
        let [width, height] = self.size;
        let attributes = [
            ("irradia", env!("CARGO_PKG_VERSION").to_owned()),
            ("scene", self.scene.to_owned()),
            ("camera", self.camera.to_owned()),
            ("frame", self.frame.to_string()),
            ("size", format!("{width}x{height}")),
            ("technique", self.settings.technique.name().to_owned()),
            ("preset", self.settings.preset.name().to_owned()),
            ("methods", Value::Object(methods).to_string()),
            ("settings", Value::Object(self.settings.options()).to_string()),
            ("device", self.device.name.clone()),
            ("driver", self.device.driver.clone()),
            ("api", self.device.api.clone()),
        ];
        let mut sampled = Vec::new();
        if let Some(estimate) = self.estimate {
            let samples = f64::from(estimate.spp * self.aa * self.aa) * f64::from(width) * f64::from(height);
            let seconds = estimate.seconds.max(1e-9);
            sampled.push(("spp".to_owned(), estimate.spp.to_string()));
            sampled.push(("samples_per_second".to_owned(), (samples / seconds).to_string()));
            sampled.push(("rays_per_second".to_owned(), (estimate.rays as f64 / seconds).to_string()));
            for (part, noise) in &estimate.noise {
                sampled.push((format!("noise.{part}.rmse"), noise.rmse.to_string()));
                sampled.push((format!("noise.{part}.rrmse"), noise.rrmse.to_string()));
            }
        }
        if self.lead_in > 0 {
            sampled.push(("lead_in".to_owned(), self.lead_in.to_string()));
        }
        if self.aa > 1 {
            sampled.push(("aa".to_owned(), self.aa.to_string()));
        }
        let tonemap = self.tonemap.map(|map| ("tonemap", values::tone_map_name(map).to_owned()));
        attributes.into_iter().chain(tonemap).map(|(name, value)| (name.to_owned(), value)).chain(sampled).collect()
    }
}
