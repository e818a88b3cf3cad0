//! The JSON of `irradia bench`, schema `irradia-bench/1`. Other programs read it: names stay what they are.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::over_time::OverTime;
use super::statistics::Spread;
use crate::graph::{joined, lies_in};
pub use crate::metrics::ImageErrors;
use crate::renderer::{DeviceReport, Slot};

/// The schema that [`Report`] writes.
pub const SCHEMA: &str = "irradia-bench/1";

/// All runs of one call of the bench.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// [`SCHEMA`].
    pub schema: String,
    /// The version of irradia.
    pub irradia: String,
    /// What it ran on.
    pub device: Device,
    /// The runs, scene by scene.
    pub runs: Vec<Run>,
    /// What could not be run.
    pub failures: Vec<Failure>,
}

impl Report {
    /// A report without runs yet.
    pub fn new(device: &DeviceReport) -> Report {
        Report {
            schema: SCHEMA.to_owned(),
            irradia: env!("CARGO_PKG_VERSION").to_owned(),
            device: Device::from(device),
            runs: Vec::new(),
            failures: Vec::new(),
        }
    }

    /// What ran on what: `irradia 0.1.0 on NAME (discrete, DRIVER, Vulkan 1.3.275)`.
    pub fn heading(&self) -> String {
        let Device { name, kind, driver, api } = &self.device;
        format!("irradia {} on {name} ({kind}, {driver}, Vulkan {api})", self.irradia)
    }
}

/// The device that a report's runs were made on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Device {
    /// As the driver calls it.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `cpu` or `other`.
    #[serde(rename = "type")]
    pub kind: String,
    /// The driver's name and version.
    pub driver: String,
    /// The Vulkan version.
    pub api: String,
}

impl From<&DeviceReport> for Device {
    fn from(device: &DeviceReport) -> Device {
        Device {
            name: device.name.clone(),
            kind: device.kind.clone(),
            driver: device.driver.clone(),
            api: device.api.clone(),
        }
    }
}

/// One technique on one scene. Times are in milliseconds; spreads are over the rounds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// The scene's name.
    pub scene: String,
    /// The technique's name.
    pub technique: String,
    /// The method of every slot.
    pub methods: BTreeMap<Slot, String>,
    /// The preset's name.
    pub preset: String,
    /// The options of every piece, `{"lights": {…}, …}`.
    pub settings: Map<String, Value>,
    /// The camera's name.
    pub camera: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Rounds measured.
    pub frames: u32,
    /// Frames rendered before them, after the first one.
    pub warmup: u32,
    /// Frames rendered before those of warm-up, so that what the methods keep over frames has settled.
    #[serde(default)]
    pub lead_in: u32,
    /// GPU time of a whole frame made anew, its passes overlapping as the driver likes. What methods keep over frames is at hand: a steady frame.
    pub frame_ms: Spread,
    /// GPU time of the same frame with full barriers between its passes. The passes below are parts of this one.
    pub serialised_ms: Spread,
    /// GPU time of a frame in which nothing changed since the one before.
    pub unchanged_ms: Spread,
    /// GPU time of a frame made anew without a past: all that methods keep over frames is zero. Null if nothing is kept.
    #[serde(default)]
    pub cold_ms: Option<Spread>,
    /// Host time of a whole frame made anew, from the call to the finished frame.
    pub host_ms: Spread,
    /// Host time of a frame in which nothing changed.
    pub unchanged_host_ms: Spread,
    /// Host time of the very first frame.
    pub first_frame_ms: f64,
    /// What of the first frame went into bringing the scene onto the device.
    pub upload_ms: f64,
    /// Time spent creating pipelines, in all frames together.
    pub pipeline_ms: f64,
    /// What the first frame took on the host beyond the upload and the median frame made anew: compilation by the driver, at creation
    /// of the pipelines or at their first use, and first allocations.
    pub compile_ms: f64,
    /// Host time of loading the scene.
    pub load_ms: f64,
    /// The passes in their order, the skipped ones included; those of the same name are one entry.
    pub passes: Vec<Pass>,
    /// The passes of one piece together, and those of every level within it; a piece comes before its levels.
    pub pieces: Vec<Piece>,
    /// Pieces that were timed on their own, as they were asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub piece_alone: Vec<PieceAlone>,
    /// Median over the rounds of the serialised frame less the sum of its passes.
    pub unexplained_ms: f64,
    /// Triangles of the scene.
    #[serde(default)]
    pub triangles: u64,
    /// Device memory held by the frame's pieces and the scene.
    pub memory_bytes: u64,
    /// The same by piece; `scene` is the scene itself.
    pub memory: BTreeMap<String, u64>,
    /// Each piece's by its images and buffers: `{"diffuse/particles": {"particles.links": …}}`.
    #[serde(default)]
    pub memory_parts: BTreeMap<String, BTreeMap<String, u64>>,
    /// All work counters of one frame, by the pass's full name and their own: `piece/pass.name`.
    pub counts: BTreeMap<String, u64>,
    /// What the image was compared with; null if it was not.
    pub reference: Option<Reference>,
    /// Errors by slot, `image` and `covered`, against the reference of the same light paths.
    pub error: Option<BTreeMap<String, ImageErrors>>,
    /// The same against full light transport.
    pub error_full: Option<BTreeMap<String, ImageErrors>>,
    /// The reference of full light transport; null if there is none.
    pub reference_full: Option<Reference>,
    /// The relative noise (root mean square over mean) of the parts of `reference` that `error` is about.
    pub noise: Option<BTreeMap<String, f64>>,
    /// The same of `reference_full` and `error_full`.
    pub noise_full: Option<BTreeMap<String, f64>>,
    /// `noise` of blocks of 8×8 pixels.
    #[serde(default)]
    pub block_noise: Option<BTreeMap<String, f64>>,
    /// `noise_full` of blocks of 8×8 pixels.
    #[serde(default)]
    pub block_noise_full: Option<BTreeMap<String, f64>>,
    /// The frames one by one, if a sequence was played: then spreads are over its frames, and errors are those of the frames.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over_time: Option<OverTime>,
    /// Light in rooms that none gets into; absent if the scene names no such room.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leaks: Option<Leaks>,
}

/// Light in rooms that none gets into.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Leaks {
    /// The power of all lights, W, the three channels together.
    pub emitted_w: f64,
    /// By the camera that stands in the room and by slot: what arrives at the surfaces that it shows, over what is emitted.
    pub rooms: BTreeMap<String, BTreeMap<Slot, f64>>,
}

/// One pass of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// The piece that it belongs to.
    pub piece: String,
    /// The pass within its piece, in levels: `lists/clear`; empty for a piece that is skipped as a whole.
    pub pass: String,
    /// GPU time, serialised; zeros for a skipped pass.
    pub ms: Spread,
    /// Its median over the serialised frame's median.
    pub share: f64,
    /// Why it did not run; null if it did.
    pub skipped: Option<String>,
    /// What it did in one frame.
    pub work: BTreeMap<String, u64>,
}

impl Pass {
    /// The names of its piece and its own.
    pub fn full_name(&self) -> String {
        joined(&self.piece, &self.pass)
    }

    /// Whether it is part of `piece`: a piece, a level of one, or a pass by its full name.
    pub fn lies_in(&self, piece: &str) -> bool {
        lies_in(&self.full_name(), piece)
    }
}

/// One piece of a run, or a level of one: its passes together.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Piece {
    /// The piece, or the level by its full name: `caustics/photons`, `caustics/photons/lists`.
    pub piece: String,
    /// The piece or level that this level is part of; null for a piece. The pieces add up to the frame, levels to parts of their piece.
    #[serde(default)]
    pub within: Option<String>,
    /// Spread of the sum of its passes.
    pub ms: Spread,
    /// Its median over the serialised frame's median.
    pub share: f64,
}

/// A piece timed on its own: what it reads was made once, and it alone repeated. Spreads are over the repetitions, as many as rounds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PieceAlone {
    /// The piece, a level of one, or a pass, by its full name.
    pub piece: String,
    /// GPU time of its passes, serialised; zeros if it was not repeated.
    pub ms: Spread,
    /// GPU time of the same passes within the serialised frame, over the rounds.
    pub in_frame_ms: Spread,
    /// GPU time of a repetition as a whole, those of `also` included, its passes overlapping as the driver likes.
    pub whole_ms: Spread,
    /// Its passes.
    pub passes: Vec<PassAlone>,
    /// Passes beyond it that had to be repeated with it, because they make what it reads and what later passes change in place. They are not part
    /// of `ms`.
    pub also: Vec<PassAlone>,
    /// Why it was not repeated; null if it was.
    pub skipped: Option<String>,
}

/// A pass of a repetition.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PassAlone {
    /// The pass by its full name.
    pub pass: String,
    /// GPU time, serialised.
    pub ms: Spread,
}

/// What a run's image was compared with.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// The technique that made it.
    pub technique: String,
    /// Samples per pixel.
    pub spp: u32,
    /// Scatterings between the light and the first visible surface; null if they are not limited.
    pub bounces: Option<u32>,
    /// Which light its slot `caustics` shows: all, or that of specular paths alone.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub caustics: String,
    /// The limits of slots that have another one.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub slot_bounces: BTreeMap<String, Option<u32>>,
    /// Reflections and refractions at most between the eye and what mirrors show, in the slot `specular`, the bounces of which are those before that then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mirrors: Option<u32>,
}

/// What could not be run, and why.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// The scene.
    pub scene: String,
    /// The technique; null if the scene itself failed.
    pub technique: Option<String>,
    /// The preset; null if the scene itself failed.
    pub preset: Option<String>,
    /// One sentence.
    pub error: String,
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.scene)?;
        if let Some(technique) = &self.technique {
            write!(f, " with {technique}")?;
        }
        if let Some(preset) = &self.preset {
            write!(f, " ({preset})")?;
        }
        write!(f, ": {}", self.error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::samples::tests::example_run;

    fn names(value: &Value) -> Vec<&str> {
        value.as_object().expect("an object").keys().map(String::as_str).collect()
    }

    fn has(value: &Value, expected: &[&str]) {
        let names = names(value);
        for name in expected {
            assert!(names.contains(name), "{name} is not among {names:?}");
        }
    }

    #[test]
    fn the_schema_keeps_its_names() {
        let mut report = Report::new(&DeviceReport::default());
        report.runs.push(example_run());
        let json = serde_json::to_value(&report).expect("plain data");
        has(&json, &["schema", "irradia", "device", "runs", "failures"]);
        assert_eq!(json["schema"], "irradia-bench/1");
        has(&json["device"], &["name", "type", "driver", "api"]);
        let run = &json["runs"][0];
        has(run, &["scene", "technique", "methods", "preset", "settings", "size", "frames", "frame_ms", "passes"]);
        has(run, &["unexplained_ms", "memory_bytes", "counts", "reference", "error", "error_full"]);
        has(run, &["serialised_ms", "unchanged_ms", "first_frame_ms", "pipeline_ms", "compile_ms", "load_ms"]);
        has(run, &["camera", "warmup", "memory", "pieces"]);
        for spread in [&run["frame_ms"], &run["serialised_ms"], &run["unchanged_ms"], &run["passes"][0]["ms"]] {
            has(spread, &["min", "median", "p95"]);
        }
        has(&run["passes"][0], &["piece", "pass", "ms", "share", "skipped", "work"]);
        assert!(run["passes"][0]["skipped"].is_null());
        assert!(run["passes"].as_array().expect("a list").iter().any(|pass| pass["skipped"].is_string()));
        for null in ["reference", "error", "error_full", "reference_full", "noise", "noise_full"] {
            assert!(run[null].is_null(), "{null}");
        }
        has(&run["methods"], &["emission", "direct", "diffuse", "caustics", "specular"]);
    }

    #[test]
    fn a_report_reads_back() {
        let mut report = Report::new(&DeviceReport::default());
        let errors = BTreeMap::from([("image".to_owned(), ImageErrors { rmse: 0.1, ..ImageErrors::default() })]);
        let reference = Reference { technique: "path".to_owned(), spp: 1024, bounces: Some(1), ..Reference::default() };
        report.runs.push(Run { reference: Some(reference), error: Some(errors), ..example_run() });
        report.failures.push(Failure {
            scene: "a".to_owned(),
            error: "no such scene".to_owned(),
            ..Failure::default()
        });
        let text = serde_json::to_string_pretty(&report).expect("plain data");
        assert_eq!(serde_json::from_str::<Report>(&text).expect("its own"), report);
    }

    #[test]
    fn failures_are_sentences() {
        let mut failure = Failure { scene: "ring".to_owned(), error: "no such file".to_owned(), ..Failure::default() };
        assert_eq!(failure.to_string(), "ring: no such file");
        failure.technique = Some("rsm".to_owned());
        failure.preset = Some("draft".to_owned());
        assert_eq!(failure.to_string(), "ring with rsm (draft): no such file");
    }
}
