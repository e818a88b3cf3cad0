//! What is told of every frame of a sequence: `over_time` of a run in the JSON. Other programs read it: names stay what they are.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::bench::report::ImageErrors;

/// A run that was played frame by frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OverTime {
    /// Frames a second of the scene's own time.
    pub fps: f64,
    /// The camera's flight; null if a camera of the scene was followed.
    pub flight: Option<String>,
    /// The frames in their order.
    pub frames: Vec<FrameRecord>,
}

/// One frame of a sequence. Times are in milliseconds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameRecord {
    /// Its number, from 0.
    pub frame: u32,
    /// The scene's time.
    pub seconds: f64,
    /// GPU time of the frame as a whole, its passes overlapping as the driver likes.
    pub frame_ms: f64,
    /// Host time of the same.
    pub host_ms: f64,
    /// GPU time of the frame with full barriers between its passes.
    pub serialised_ms: f64,
    /// What of it belongs to no pass.
    pub unexplained_ms: f64,
    /// GPU time of the passes that ran, by their full names; parts of `serialised_ms`.
    pub passes_ms: BTreeMap<String, f64>,
    /// Work counters, by the pass's full name and their own: `piece/pass.name`.
    pub counts: BTreeMap<String, u64>,
    /// Errors by slot, `image` and `covered`, against the reference of this very frame, of the same light paths; null if there is none.
    pub error: Option<BTreeMap<String, ImageErrors>>,
    /// The relative noise of the parts of that reference.
    pub noise: Option<BTreeMap<String, f64>>,
    /// How late each part of the picture is; null if that was not asked for.
    pub lag: Option<BTreeMap<String, Lag>>,
    /// How the slot `diffuse` flickers; null in the first frame, without a reference, and where it is black.
    pub flicker: Option<Flicker>,
}

/// How far a picture is behind what the same technique shows once the frame has stood still.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Lag {
    /// What is late: the sum of the absolute differences from the settled picture over the sum of the brighter of the two.
    pub late: f64,
    /// Of what there was to change since the frame before, the late included: the share that this frame shows. Null if there was nothing.
    pub arrived: Option<f64>,
}

/// What changes from one frame to the next where the truth does not: luminance, over the truth's mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Flicker {
    /// The mean change of the picture.
    pub change: f64,
    /// That of the reference at the same pixels, which its own noise adds to.
    pub reference: f64,
    /// The share of the pixels that count: those where the reference changes by less than 1 % of its mean.
    pub still: f64,
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::bench::report::{Pass, Run};

    /// A run of so many frames: a light is switched before frame 1, and its light arrives by halves.
    pub(crate) fn example(frames: u32) -> Run {
        let passes = ["draw", "shade", "one/x", "one/y", "two/x", "three/x", "four/x", "five/x", "six/x"];
        let pass = |(index, pass): (usize, &&str)| {
            let piece = if index == 0 { "gbuffer" } else { "diffuse/a" };
            Pass { piece: piece.to_owned(), pass: (*pass).to_owned(), ..Pass::default() }
        };
        let passes: Vec<Pass> = passes.iter().enumerate().map(pass).collect();
        let parts = ["diffuse", "covered", "image"];
        let record = |frame: u32| {
            let late = if frame == 0 { 0.0 } else { 0.5_f64.powi(frame as i32) };
            let arrived = (frame > 0).then_some(0.5);
            let ms = |index: usize| 1.0 / (1 + index) as f64 + 0.1 * f64::from(frame);
            let passes_ms: BTreeMap<String, f64> =
                passes.iter().enumerate().map(|(index, pass)| (pass.full_name(), ms(index))).collect();
            let explained: f64 = passes_ms.values().sum();
            let error = |_| ImageErrors { rrmse: 0.05 + late, ..ImageErrors::default() };
            FrameRecord {
                frame,
                seconds: f64::from(frame) / 30.0,
                frame_ms: 2.0,
                host_ms: 3.0,
                serialised_ms: explained + 0.5,
                unexplained_ms: 0.5,
                passes_ms,
                counts: [("diffuse/a/one/x.texels".to_owned(), 100 + u64::from(frame))].into(),
                error: Some(parts.iter().map(|part| ((*part).to_owned(), error(part))).collect()),
                noise: Some(parts.iter().map(|part| ((*part).to_owned(), 0.01)).collect()),
                lag: Some(parts.iter().map(|part| ((*part).to_owned(), Lag { late, arrived })).collect()),
                flicker: (frame > 0).then_some(Flicker { change: 0.02, reference: 0.001, still: 0.9 }),
            }
        };
        Run {
            scene: "rooms".to_owned(),
            technique: "lightmaps".to_owned(),
            preset: "default".to_owned(),
            camera: "left".to_owned(),
            size: [64, 48],
            frames,
            over_time: Some(OverTime { fps: 30.0, flight: None, frames: (0..frames).map(record).collect() }),
            passes: passes.clone(),
            ..Run::default()
        }
    }

    #[test]
    fn the_json_keeps_its_names_and_reads_back() {
        let run = example(3);
        let json = serde_json::to_value(&run).expect("plain data");
        let (over_time, frame) = (&json["over_time"], &json["over_time"]["frames"][1]);
        assert_eq!((&over_time["fps"], over_time["flight"].is_null()), (&30.0.into(), true));
        for name in
            ["frame", "seconds", "frame_ms", "host_ms", "serialised_ms", "unexplained_ms", "passes_ms", "counts"]
        {
            assert!(!frame[name].is_null(), "{name}");
        }
        assert_eq!(frame["error"]["covered"]["rrmse"], 0.55);
        assert_eq!(frame["lag"]["covered"]["late"], 0.5);
        assert_eq!(frame["flicker"]["change"], 0.02);
        assert!(
            over_time["frames"][0]["flicker"].is_null() && over_time["frames"][0]["lag"]["image"]["arrived"].is_null()
        );
        let text = serde_json::to_string(&run).expect("plain data");
        assert_eq!(serde_json::from_str::<Run>(&text).expect("its own"), run);
        assert!(serde_json::to_value(Run::default()).expect("plain data").get("over_time").is_none());
    }
}
