//! What a reference is of, and what it took: the words that its file, its table and its list entry say.

use serde_json::json;

use super::key::{estimator_name, hexadecimal};
use super::{REFERENCE_VERSION, ReferenceKey, ReferenceRequest};
use crate::output::Attributes;
use crate::scene::{CameraView, Projection, Scene};

/// The attributes of [`About`], all of which a reference's file has.
const NAMES: [&str; 13] = [
    "key",
    "reference_version",
    "scene",
    "scene_hash",
    "camera",
    "camera_view",
    "size",
    "estimator",
    "bounces",
    "caustics",
    "filter",
    "seed",
    "chunk_samples",
];

/// What a reference is of.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct About {
    pub(crate) key: ReferenceKey,
    pub(crate) size: [u32; 2],
    /// Everything that the key is made of, and the names that it is not made of.
    pub(crate) attributes: Attributes,
}

impl About {
    pub(crate) fn new(scene: &Scene, scene_name: &str, request: &ReferenceRequest) -> About {
        let key = ReferenceKey::of(scene, request);
        let [width, height] = request.size;
        let bounces = request.bounces.map_or("unlimited".to_owned(), |bounces| bounces.to_string());
        let bounces = request.mirrors.map_or(bounces.clone(), |mirrors| format!("{bounces} before {mirrors} mirrors"));
        let values = [
            key.as_str().to_owned(),
            REFERENCE_VERSION.to_string(),
            scene_name.to_owned(),
            hexadecimal(&scene.content_hash()),
            request.camera.name.clone(),
            camera_view(&request.camera),
            format!("{width}x{height}"),
            estimator_name(request.estimator).to_owned(),
            bounces,
            request.caustics.name().to_owned(),
            request.filter.name().to_owned(),
            request.seed.to_string(),
            super::CHUNK_SAMPLES.to_string(),
        ];
        let attributes = NAMES.map(str::to_owned).into_iter().zip(values).collect();
        About { key, size: request.size, attributes }
    }

    /// What a file's attributes say.
    ///
    /// # Errors
    /// A clause on what is missing or wrong.
    pub(crate) fn read(size: [u32; 2], attributes: &Attributes) -> Result<About, String> {
        let value = |name: &str| {
            attributes.get(name).cloned().ok_or_else(|| format!("it is no reference: it has no attribute {name}"))
        };
        let key = value("key")?;
        let key = ReferenceKey::parse(&key).ok_or_else(|| format!("{key:?} is no key of a reference"))?;
        let version = value("reference_version")?;
        if version != REFERENCE_VERSION.to_string() {
            return Err(format!(
                "it is of version {version} of how references are made, this is version {REFERENCE_VERSION}; make it anew"
            ));
        }
        let attributes =
            NAMES.iter().map(|name| Ok(((*name).to_owned(), value(name)?))).collect::<Result<_, String>>()?;
        Ok(About { key, size, attributes })
    }

    pub(crate) fn attribute(&self, name: &str) -> &str {
        self.attributes.get(name).map_or("", String::as_str)
    }
}

/// Position, viewing direction, up direction and projection, as JSON.
fn camera_view(camera: &CameraView) -> String {
    let matrix = &camera.world.matrix3;
    let projection = match camera.projection {
        Projection::Perspective { vertical_fov, aspect: _, near } => {
            json!({"vertical_fov": vertical_fov, "near": near})
        }
        Projection::Orthographic { half_width, half_height, near, far } => {
            json!({"half_width": half_width, "half_height": half_height, "near": near, "far": far})
        }
    };
    json!({
        "position": camera.world.translation.to_array(),
        "direction": (-matrix.z_axis).to_array(),
        "up": matrix.y_axis.to_array(),
        "projection": projection,
    })
    .to_string()
}

/// What the samples so far took, on all machines together.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Spent {
    pub(crate) seconds: f64,
    /// 0 if the source does not count them.
    pub(crate) rays: u64,
    /// The names of the devices, each once.
    pub(crate) devices: Vec<String>,
}

impl Spent {
    const SEPARATOR: &str = "; ";

    pub(crate) fn add(&mut self, other: &Spent) {
        self.seconds += other.seconds;
        self.rays = self.rays.saturating_add(other.rays);
        for device in &other.devices {
            if !self.devices.contains(device) {
                self.devices.push(device.clone());
            }
        }
    }

    /// A number of things per second; 0 if no time was measured.
    pub(crate) fn rate(&self, count: f64) -> f64 {
        if self.seconds > 0.0 { count / self.seconds } else { 0.0 }
    }

    pub(crate) fn attributes(&self) -> [(&'static str, String); 3] {
        [
            ("seconds", self.seconds.to_string()),
            ("rays", self.rays.to_string()),
            ("device", self.devices.join(Self::SEPARATOR)),
        ]
    }

    /// What a file's attributes say; nothing where they say nothing.
    pub(crate) fn read(attributes: &Attributes) -> Spent {
        let value = |name: &str| attributes.get(name).map_or("", String::as_str);
        let devices = value("device").split(Self::SEPARATOR).filter(|device| !device.is_empty());
        Spent {
            seconds: value("seconds").parse().ok().filter(|seconds: &f64| seconds.is_finite()).unwrap_or_default(),
            rays: value("rays").parse().unwrap_or_default(),
            devices: devices.map(str::to_owned).collect(),
        }
    }
}
