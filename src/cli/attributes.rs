//! What a picture's file says of how it was made.

use irradia::output::Attributes;
use irradia::renderer::{DeviceReport, Settings, Slot, ToneMap};
use serde_json::{Map, Value};

use super::values;

/// The picture that the attributes describe.
pub(crate) struct Picture<'a> {
    pub(crate) scene: &'a str,
    pub(crate) camera: &'a str,
    pub(crate) frame: u32,
    pub(crate) size: [u32; 2],
    pub(crate) settings: &'a Settings,
    pub(crate) device: &'a DeviceReport,
    /// How its pixels were made; `None` for radiance.
    pub(crate) tonemap: Option<ToneMap>,
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
        let tonemap = self.tonemap.map(|map| ("tonemap", values::tone_map_name(map).to_owned()));
        attributes.into_iter().chain(tonemap).map(|(name, value)| (name.to_owned(), value)).collect()
    }
}
