//! The grid of a sweep: which series of settings are measured on which scenes, and what their error is.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::bench::report::{ImageErrors, Run};
use crate::renderer::{Preset, Slot, Technique};
use crate::scene::{LightSpec, LoadOptions, Scene, SceneError, builtin_names};

/// The column of the whole frame.
pub const FRAME_COLUMN: &str = "frame";

/// A grid: every series on every scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Grid {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel of the references; `None`: times alone.
    pub reference: Option<u32>,
    /// Rounds of every point.
    pub frames: u32,
    /// Frames before them, after the first one.
    pub warmup: u32,
    /// A point begins no round after this many seconds; its first round it always has.
    pub max_seconds: Option<f64>,
    /// Which points render in turn.
    pub interleave: Interleave,
    /// What the error is counted against.
    pub compare: Compare,
    /// What the error is of: `image`, `covered` or a slot.
    pub entry: String,
    /// How the error is counted.
    pub metric: Metric,
    /// Columns of tables: times of passes added up, by the beginnings of their full names.
    #[serde(default)]
    pub columns: BTreeMap<String, Vec<String>>,
    /// Further columns: counters of work in one frame, each by its full name, `piece/pass.name`.
    #[serde(default)]
    pub counts: BTreeMap<String, String>,
    /// Scenes over which exponents of the columns are told, by what these scenes differ in.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub growth: BTreeMap<GrowsWith, Vec<String>>,
    /// What others have measured, shown beside the points that it belongs to.
    #[serde(default)]
    pub published: Vec<Published>,
    /// The scenes, at least one.
    pub scenes: Vec<GridScene>,
    /// The series, at least one.
    pub series: Vec<Series>,
}

/// A scene of a grid, and what is added to it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GridScene {
    /// What tables and plots call it; no two scenes of a grid have the same.
    pub name: String,
    /// A built-in scene, or a .gltf or .glb file seen from the grid's folder.
    pub path: String,
    /// The camera, by name or index; `None`: the scene's first.
    pub camera: Option<String>,
    /// Lights to add, written as on the command line.
    pub light: Vec<String>,
    /// Radiance of the sky, W/(m² sr); `None`: the scene's own.
    pub sky: Option<[f32; 3]>,
    /// Width and height in pixels; `None`: the grid's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<[u32; 2]>,
    /// How often every triangle is cut into four.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub split: u32,
    /// Settings that belong to the scene; what a series sets or varies comes after.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub set: BTreeMap<String, Value>,
}

fn is_zero(count: &u32) -> bool {
    *count == 0
}

/// Times that somebody published of one point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Published {
    /// The scene's name in the grid.
    pub scene: String,
    /// That of the series; `None`: any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub series: Option<String>,
    /// The settings that tell the point from others of the scene.
    #[serde(default)]
    pub values: BTreeMap<String, Value>,
    /// Milliseconds by the names of columns, and of the whole `frame`.
    pub ms: BTreeMap<String, f64>,
}

/// One technique with settings that vary; a line of a plot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// What tables and plots call it; no two series of a grid have the same.
    pub name: String,
    /// The technique.
    pub technique: Technique,
    /// Methods in place of the technique's, by slot.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub methods: BTreeMap<Slot, String>,
    /// The presets, each a point of its own.
    pub preset: Vec<Preset>,
    /// Settings changed after the preset, the same for all points.
    pub set: BTreeMap<String, Value>,
    /// The values of each setting that varies; the points are all combinations.
    pub vary: BTreeMap<String, Vec<Value>>,
}

/// Which points of a scene are measured by one call, rendering in turn, so that drift of the machine hits them alike.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Interleave {
    /// None: a point renders alone.
    Point,
    /// Those of one series.
    #[default]
    Series,
    /// All.
    Scene,
}

/// What scenes differ in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum GrowsWith {
    /// The size of the picture.
    Pixels,
    /// The number of triangles.
    Triangles,
}

impl GrowsWith {
    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            GrowsWith::Pixels => "pixels",
            GrowsWith::Triangles => "triangles",
        }
    }
}

/// What an error is counted against.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Compare {
    /// Full light transport.
    #[default]
    Full,
    /// The light paths that the technique sets out to find.
    Equal,
}

/// How an error is counted; see [`ImageErrors`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Metric {
    /// Root of the mean squared difference, W/(m² sr).
    Rmse,
    /// The same over the mean of the reference.
    #[default]
    Rrmse,
    /// That of the means of blocks of 8×8 pixels.
    Blocks,
    /// Mean of the squared relative difference.
    Relmse,
    /// Mean FLIP.
    Flip,
}

impl Grid {
    /// The error of a run that the grid asks for; `None` if it was not compared.
    pub fn error(&self, run: &Run) -> Option<f64> {
        let errors = self.errors(run, self.compare)?;
        Some(match self.metric {
            Metric::Rmse => errors.rmse,
            Metric::Rrmse => errors.rrmse,
            Metric::Blocks => errors.block_rrmse,
            Metric::Relmse => errors.relmse,
            Metric::Flip => errors.flip,
        })
    }

    /// All errors of the grid's entry, against what `compare` says.
    pub fn errors<'a>(&self, run: &'a Run, compare: Compare) -> Option<&'a ImageErrors> {
        let entries = match compare {
            Compare::Full => &run.error_full,
            Compare::Equal => &run.error,
        };
        entries.as_ref()?.get(&self.entry)
    }

    /// The relative noise of what the entry of a run was compared with, of its pixels or of blocks of them; `None` if it was not, and of metrics
    /// that are no relative RMSE.
    pub fn noise(&self, run: &Run, compare: Compare, metric: Metric) -> Option<f64> {
        let entries = match (metric, compare) {
            (Metric::Rrmse, Compare::Full) => &run.noise_full,
            (Metric::Rrmse, Compare::Equal) => &run.noise,
            (Metric::Blocks, Compare::Full) => &run.block_noise_full,
            (Metric::Blocks, Compare::Equal) => &run.block_noise,
            _ => return None,
        };
        entries.as_ref()?.get(&self.entry).copied()
    }

    /// What the error is, for a title: `relative RMSE of the image against full light transport`.
    pub fn error_words(&self) -> String {
        let entry = match self.entry.as_str() {
            "image" => "the image".to_owned(),
            "covered" => "the covered pixels".to_owned(),
            slot => format!("the {slot} slot"),
        };
        let against = match self.compare {
            Compare::Full => "full light transport",
            Compare::Equal => "equal light paths",
        };
        format!("{} of {entry} against {against}", self.metric_words())
    }

    /// How the error is counted, for an axis.
    pub fn metric_words(&self) -> &'static str {
        match self.metric {
            Metric::Rmse => "RMSE",
            Metric::Rrmse => "relative RMSE",
            Metric::Blocks => "relative RMSE of 8×8 pixels",
            Metric::Relmse => "relMSE",
            Metric::Flip => "mean FLIP",
        }
    }

    /// The entries that an error can be of.
    pub fn entries() -> Vec<&'static str> {
        ["image", "covered"].into_iter().chain(Slot::ALL.into_iter().map(Slot::name)).collect()
    }
}

impl Grid {
    /// Width and height of a scene's frames.
    pub fn size_of(&self, scene: &GridScene) -> [u32; 2] {
        scene.size.unwrap_or(self.size)
    }

    /// What somebody published of a point of a series with these values: milliseconds by column.
    pub fn published_of(
        &self,
        (scene, series): (&str, &str),
        values: &BTreeMap<String, Value>,
    ) -> Option<&BTreeMap<String, f64>> {
        let is_of = |entry: &&Published| {
            entry.scene == scene
                && entry.series.as_deref().is_none_or(|name| name == series)
                && entry.values.iter().all(|(key, value)| values.get(key) == Some(value))
        };
        self.published.iter().find(is_of).map(|entry| &entry.ms)
    }
}

impl GridScene {
    /// Whether there is such a scene, found out before the work on others; `folder` is where the grid's file lies.
    ///
    /// # Errors
    /// A sentence: there is no such file or no built-in scene of this name.
    pub fn find(&self, folder: &Path) -> Result<(), String> {
        let spec = self.spec(folder);
        if self.is_file() && !Path::new(&spec).is_file() {
            return Err(format!("scene {:?}: there is no file {spec}", self.name));
        }
        if !self.is_file() && !builtin_names().contains(&spec.as_str()) {
            let known = builtin_names().join(", ");
            let advice = "a file ends in .gltf or .glb";
            return Err(format!(
                "scene {:?}: there is no built-in scene {spec:?}, and {advice}; scenes: {known}",
                self.name
            ));
        }
        Ok(())
    }

    fn is_file(&self) -> bool {
        let lower = self.path.to_ascii_lowercase();
        lower.ends_with(".glb") || lower.ends_with(".gltf")
    }

    /// What a command line would call it.
    fn spec(&self, folder: &Path) -> String {
        if self.is_file() { folder.join(&self.path).to_string_lossy().into_owned() } else { self.path.clone() }
    }

    /// Opens the scene and adds its lights. A file's path is seen from `folder`, where the grid's file lies.
    ///
    /// # Errors
    /// Those of [`Scene::open`] and of the lights, as a sentence.
    pub fn open(&self, folder: &Path, options: &LoadOptions) -> Result<Scene, String> {
        let said = |error: SceneError| error.to_string();
        let mut scene = Scene::open_with(&self.spec(folder), options).map_err(said)?;
        for light in &self.light {
            scene.add_light_spec(&LightSpec::parse(light)?).map_err(said)?;
        }
        if let Some(sky) = self.sky {
            scene.set_sky(sky);
        }
        for _ in 0..self.split {
            scene.split_triangles();
        }
        Ok(scene)
    }
}
