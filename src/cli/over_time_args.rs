//! Playing a scene frame by frame: the bench's arguments for it, and the files that tell of the frames.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context as _, Result};
use clap::Args;
use irradia::bench::over_time::{csv, errors_plot, passes_plot};
use irradia::bench::report::Run;
use irradia::output::Target;

use super::{files, values};

/// Frames over time.
#[derive(Debug, Args)]
#[command(next_help_heading = "Frames over time")]
pub(crate) struct OverTimeArgs {
    /// Play the scene's animation, and its camera's or the --flight, at so many frames a second, and measure each of the --frames by itself [default: 30]
    #[arg(long, value_name = "FPS", num_args = 0..=1, require_equals = true, default_missing_value = "30")]
    #[arg(value_parser = values::frame_rate, conflicts_with = "piece")]
    animate: Option<f64>,
    /// Also measure how much of each picture is late: what is kept over frames is left out of a second rendering of it
    #[arg(long, requires = "animate")]
    lag: bool,
    /// Write plots of errors and of times over the frames, as SVG, and all numbers of all frames, frames.csv, into this folder
    #[arg(long, value_name = "DIR", requires = "animate")]
    over_time: Option<PathBuf>,
    /// A work counter that is drawn over the times, by its full name in `counts` of the JSON
    #[arg(long, value_name = "NAME", requires = "over_time")]
    counter: Option<String>,
}

impl OverTimeArgs {
    /// Frames a second, if the scene is played.
    pub(crate) fn fps(&self) -> Option<f64> {
        self.animate
    }

    /// Whether lateness is measured.
    pub(crate) fn lag(&self) -> bool {
        self.lag
    }

    /// Makes the folder, if there shall be one.
    pub(crate) fn make_folder(&self) -> Result<()> {
        let Some(folder) = &self.over_time else { return Ok(()) };
        fs::create_dir_all(folder).with_context(|| format!("the folder {} cannot be made", folder.display()))
    }

    /// The plots of one scene: `SCENE-frames.svg`, and `SCENE-TECHNIQUE-PRESET-passes.svg` of each run.
    pub(crate) fn write_plots(&self, runs: &[&Run]) -> Result<()> {
        let (Some(folder), Some(first)) = (&self.over_time, runs.first()) else { return Ok(()) };
        if let Some(text) = errors_plot(runs) {
            let path = folder.join(files::from_words(&[&first.scene, "frames"]) + ".svg");
            Target::from(&path).write(text.as_bytes())?;
        }
        for run in runs {
            let Some(text) = passes_plot(run, self.counter.as_deref()) else { continue };
            let path = folder.join(files::from_words(&[&run.scene, &run.technique, &run.preset, "passes"]) + ".svg");
            Target::from(&path).write(text.as_bytes())?;
        }
        Ok(())
    }

    /// All frames of all runs.
    pub(crate) fn write_csv(&self, runs: &[Run]) -> Result<()> {
        let Some(folder) = &self.over_time else { return Ok(()) };
        Ok(Target::from(&folder.join("frames.csv")).write(csv(runs).as_bytes())?)
    }
}
