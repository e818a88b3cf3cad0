//! The TOML of a grid, and the sentences on what is wrong in it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::Value;

use super::grid::{Compare, FRAME_COLUMN, Grid, GridScene, GrowsWith, Interleave, Metric, Published, Series};
use crate::renderer::{Preset, Slot, Technique};
use crate::scene::LightSpec;

/// A grid that cannot be read. One sentence: which file, where in it, what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// The file cannot be read.
    #[error("{path} cannot be read: {reason}", path = .path.display())]
    Read {
        /// The file asked for.
        path: PathBuf,
        /// What the operating system says.
        reason: String,
    },
    /// The file does not describe a grid.
    #[error("{path}: {what}", path = .path.display())]
    Wrong {
        /// The file asked for.
        path: PathBuf,
        /// What is wrong in it.
        what: String,
    },
}

impl Grid {
    /// Reads a TOML file; `docs/sweeps.md` says what it holds.
    ///
    /// # Errors
    /// The file cannot be read, is no TOML, or names something that does not exist.
    pub fn load(path: &Path) -> Result<Grid, GridError> {
        let text = fs::read_to_string(path)
            .map_err(|error| GridError::Read { path: path.to_owned(), reason: error.to_string() })?;
        Grid::parse(&text, path)
    }

    /// Reads the text of a TOML file; `path` is what errors call it.
    ///
    /// # Errors
    /// Those of [`Grid::load`], but for the reading.
    pub fn parse(text: &str, path: &Path) -> Result<Grid, GridError> {
        let wrong = |what: String| GridError::Wrong { path: path.to_owned(), what };
        let grid = parse(text).map_err(wrong)?;
        grid.points().map_err(|error| wrong(error.to_string()))?;
        Ok(grid)
    }
}

/// The file as it is written, scenes and series still unread: their errors name them.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default = "default_size")]
    size: [u32; 2],
    reference: Option<u32>,
    #[serde(default = "default_frames")]
    frames: u32,
    #[serde(default = "default_warmup")]
    warmup: u32,
    max_seconds: Option<f64>,
    #[serde(default)]
    interleave: Interleave,
    #[serde(default)]
    compare: Compare,
    #[serde(default = "default_entry")]
    entry: String,
    #[serde(default)]
    metric: Metric,
    #[serde(default)]
    columns: BTreeMap<String, Vec<String>>,
    #[serde(default)]
    counts: BTreeMap<String, String>,
    #[serde(default)]
    growth: BTreeMap<GrowsWith, Vec<String>>,
    #[serde(default)]
    published: Vec<Published>,
    scenes: Vec<toml::Value>,
    series: Vec<toml::Table>,
}

/// Cuts into four beyond which even a small scene has millions of triangles.
const MOST_SPLITS: u32 = 8;

fn default_size() -> [u32; 2] {
    [256, 256]
}

fn default_frames() -> u32 {
    5
}

fn default_warmup() -> u32 {
    1
}

fn default_entry() -> String {
    "image".to_owned()
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileScene {
    path: String,
    name: Option<String>,
    camera: Option<toml::Value>,
    #[serde(default)]
    light: Vec<String>,
    sky: Option<[f32; 3]>,
    size: Option<[u32; 2]>,
    #[serde(default)]
    split: u32,
    #[serde(default)]
    set: BTreeMap<String, Value>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileSeries {
    name: Option<String>,
    technique: String,
    #[serde(default)]
    methods: BTreeMap<String, String>,
    preset: Option<OneOrMore>,
    #[serde(default)]
    set: BTreeMap<String, Value>,
    #[serde(default)]
    vary: BTreeMap<String, Vec<Value>>,
}

#[derive(Debug, Deserialize)]
#[serde(untagged, expecting = "a preset is a name or a list of names")]
enum OneOrMore {
    One(String),
    More(Vec<String>),
}

/// Reads a grid.
///
/// # Errors
/// One sentence that names the line, or the scene or series and the key.
fn parse(text: &str) -> Result<Grid, String> {
    let file: File = toml::from_str(text).map_err(|error| located(text, &error))?;
    if file.size.contains(&0) || file.frames == 0 || file.reference == Some(0) {
        return Err("size, frames and reference are at least 1".to_owned());
    }
    if file.max_seconds.is_some_and(|seconds| seconds.is_nan() || seconds <= 0.0) {
        return Err("max_seconds is more than 0".to_owned());
    }
    if !Grid::entries().contains(&file.entry.as_str()) {
        return Err(format!("entry cannot be {:?}; entries: {}", file.entry, Grid::entries().join(", ")));
    }
    let scenes = file.scenes.into_iter().enumerate().map(|(index, scene)| read_scene(index, scene));
    let series = file.series.into_iter().enumerate().map(|(index, series)| read_series(index, series));
    let grid = Grid {
        size: file.size,
        reference: file.reference,
        frames: file.frames,
        warmup: file.warmup,
        max_seconds: file.max_seconds,
        interleave: file.interleave,
        compare: file.compare,
        entry: file.entry,
        metric: file.metric,
        columns: file.columns,
        counts: file.counts,
        growth: file.growth,
        published: file.published,
        scenes: scenes.collect::<Result<_, _>>()?,
        series: series.collect::<Result<_, _>>()?,
    };
    for published in &grid.published {
        check_published(&grid, published)?;
    }
    for name in grid.growth.values().flatten() {
        check_scene(&grid, "growth", name)?;
    }
    distinct("scene", grid.scenes.iter().map(|scene| &scene.name))?;
    distinct("series", grid.series.iter().map(|series| &series.name))?;
    Ok(grid)
}

fn check_scene(grid: &Grid, whose: &str, name: &str) -> Result<(), String> {
    let scenes: Vec<&str> = grid.scenes.iter().map(|scene| scene.name.as_str()).collect();
    let known = scenes.contains(&name);
    known.then_some(()).ok_or_else(|| format!("{whose}: there is no scene {name:?}; scenes: {}", scenes.join(", ")))
}

/// Whether what is published belongs to a scene and to columns that there are.
fn check_published(grid: &Grid, published: &Published) -> Result<(), String> {
    check_scene(grid, "published", &published.scene)?;
    let columns: Vec<&str> = grid.columns.keys().map(String::as_str).chain([FRAME_COLUMN]).collect();
    let series: Vec<&str> = grid.series.iter().map(|series| series.name.as_str()).collect();
    if let Some(name) = published.series.as_deref().filter(|name| !series.contains(name)) {
        return Err(format!("published: there is no series {name:?}; series: {}", series.join(", ")));
    }
    match published.ms.keys().find(|name| !columns.contains(&name.as_str())) {
        Some(name) => Err(format!("published: there is no column {name:?}; columns: {}", columns.join(", "))),
        None => Ok(()),
    }
}

fn read_scene(index: usize, scene: toml::Value) -> Result<GridScene, String> {
    let scene = match scene {
        toml::Value::String(path) => {
            let (name, camera, light, sky, size, split, set) = Default::default();
            FileScene { path, name, camera, light, sky, size, split, set }
        }
        table => {
            let named = table.get("name").or_else(|| table.get("path")).and_then(toml::Value::as_str);
            let label = label("scene", index, named);
            table.try_into().map_err(|error: toml::de::Error| format!("{label}: {}", one_line(error.message())))?
        }
    };
    let label = label("scene", index, Some(&scene.path));
    for light in &scene.light {
        LightSpec::parse(light).map_err(|error| format!("{label}: light {light:?}: {error}"))?;
    }
    if scene.sky.is_some_and(|sky| sky.iter().any(|value| !(0.0..=f32::MAX).contains(value))) {
        return Err(format!("{label}: sky takes three numbers of at least 0, W/(m² sr)"));
    }
    if scene.split > MOST_SPLITS {
        return Err(format!("{label}: split is at most {MOST_SPLITS}"));
    }
    if scene.size.is_some_and(|size| size.contains(&0)) {
        return Err(format!("{label}: size is at least 1"));
    }
    let camera = match scene.camera {
        None => None,
        Some(toml::Value::String(name)) => Some(name),
        Some(toml::Value::Integer(index)) => Some(index.to_string()),
        Some(_) => return Err(format!("{label}: camera takes a name or an index")),
    };
    let stem = Path::new(&scene.path).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let name = scene.name.or(stem).unwrap_or_default();
    let FileScene { path, light, sky, size, split, set, .. } = scene;
    Ok(GridScene { name, path, camera, light, sky, size, split, set })
}

fn read_series(index: usize, table: toml::Table) -> Result<Series, String> {
    let named = table.get("name").or_else(|| table.get("technique")).and_then(toml::Value::as_str);
    let label = label("series", index, named);
    let said = |error: &dyn std::fmt::Display| format!("{label}: {}", one_line(&error.to_string()));
    let series: FileSeries = table.try_into().map_err(|error: toml::de::Error| said(&error.message()))?;
    let technique = Technique::from_name(&series.technique).map_err(|error| said(&error))?;
    let presets = match series.preset {
        None => vec![Preset::default().name().to_owned()],
        Some(OneOrMore::One(name)) => vec![name],
        Some(OneOrMore::More(names)) => names,
    };
    let preset: Vec<Preset> =
        presets.iter().map(|name| Preset::from_name(name)).collect::<Result<_, _>>().map_err(|error| said(&error))?;
    if preset.is_empty() {
        return Err(said(&"the list of presets is empty"));
    }
    if let Some((key, _)) = series.vary.iter().find(|(_, values)| values.is_empty()) {
        return Err(said(&format!("{key} varies over an empty list")));
    }
    if let Some(key) = series.set.keys().find(|key| series.vary.contains_key(*key)) {
        return Err(said(&format!("{key} is both set and varied; leave it in one of them")));
    }
    let mut chosen = technique.methods();
    let mut methods = BTreeMap::new();
    for (slot, method) in series.methods {
        let slot = Slot::from_name(&slot).ok_or_else(|| said(&format!("there is no slot {slot:?}")))?;
        chosen.set(slot, &method).map_err(|error| said(&error))?;
        methods.insert(slot, method);
    }
    let name = series.name.unwrap_or_else(|| technique.name().to_owned());
    Ok(Series { name, technique, methods, preset, set: series.set, vary: series.vary })
}

/// `series "rsm"`, or `series 2` if it has no name.
fn label(kind: &str, index: usize, name: Option<&str>) -> String {
    name.map_or_else(|| format!("{kind} {}", index + 1), |name| format!("{kind} {name:?}"))
}

fn distinct<'a>(kind: &str, names: impl ExactSizeIterator<Item = &'a String>) -> Result<(), String> {
    if names.len() == 0 {
        return Err(format!(
            "{} is empty, and a sweep needs at least one",
            if kind == "scene" { "scenes" } else { kind }
        ));
    }
    let mut known = Vec::new();
    for name in names {
        if known.contains(&name) {
            return Err(format!("two entries of {kind} are called {name:?}; give one of them another name"));
        }
        known.push(name);
    }
    Ok(())
}

/// The message with the line that it is about.
fn located(text: &str, error: &toml::de::Error) -> String {
    let message = one_line(error.message());
    let start = error.span().and_then(|span| text.get(..span.start));
    start.map_or_else(|| message.clone(), |before| format!("line {}: {message}", before.matches('\n').count() + 1))
}

fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SERIES: &str = "[[series]]\nname = \"a\"\ntechnique = \"rsm\"\n";

    fn wrong(text: &str) -> String {
        let error = Grid::parse(text, Path::new("dir/x.toml")).expect_err("wrong").to_string();
        assert_eq!(error.lines().count(), 1, "{error}");
        error
    }

    fn assert_says(text: &str, words: &[&str]) {
        let error = wrong(text);
        for words in words {
            assert!(error.contains(words), "{words} is not in: {error}");
        }
    }

    #[test]
    fn what_is_left_out_has_a_default() {
        let grid = parse("scenes = [\"ring\"]\n[[series]]\ntechnique = \"rsm\"").expect("sound");
        assert_eq!((grid.size, grid.reference, grid.frames, grid.warmup), ([256, 256], None, 5, 1));
        assert_eq!((grid.compare, grid.entry.as_str(), grid.metric), (Compare::Full, "image", Metric::Rrmse));
        assert_eq!((grid.series[0].name.as_str(), grid.series[0].preset.as_slice()), ("rsm", &[Preset::Default][..]));
        assert_eq!(grid.scenes[0], GridScene { name: "ring".into(), path: "ring".into(), ..GridScene::default() });
    }

    #[test]
    fn scenes_may_be_tables() {
        let scene = "{ path = \"a/white-room.glb\", camera = 0, light = [\"sun:45,60\"], sky = [1, 2, 3], size = [64, 32], split = 2, \
            set = { \"particles.count\" = 5 } }";
        let grid = parse(&format!("scenes = [\"ring\", {scene}]\n{SERIES}")).expect("sound");
        let expected = GridScene {
            name: "white-room".to_owned(),
            path: "a/white-room.glb".to_owned(),
            camera: Some("0".to_owned()),
            light: vec!["sun:45,60".to_owned()],
            sky: Some([1.0, 2.0, 3.0]),
            size: Some([64, 32]),
            split: 2,
            set: BTreeMap::from([("particles.count".to_owned(), Value::from(5))]),
        };
        assert_eq!(grid.scenes[1], expected);
    }

    #[test]
    fn errors_name_file_place_and_what_there_is() {
        let scenes = "scenes = [\"ring\"]\n";
        assert_says(&format!("{scenes}sizes = 3\n{SERIES}"), &["dir/x.toml: line 2", "sizes", "reference"]);
        assert_says(&format!("{scenes}size = 3\n{SERIES}"), &["dir/x.toml: line 2"]);
        assert_says("scenes = [", &["dir/x.toml: line 1"]);
        assert_says(&format!("{scenes}{SERIES}vari = {{}}"), &["dir/x.toml", "series \"a\"", "vari", "vary"]);
        assert_says(
            &format!("{scenes}[[series]]\nname = \"a\"\ntechnique = \"rms\""),
            &["series \"a\"", "rms", "direct, rsm, hybrid, volumes, particles, lightmaps, path"],
        );
        assert_says(&format!("{scenes}{SERIES}preset = [\"fast\"]"), &["series \"a\"", "fast", "draft, default"]);
        assert_says(&format!("{scenes}{SERIES}preset = 3"), &["series \"a\"", "a name or a list"]);
        assert_says(
            &format!("{scenes}{SERIES}vary = {{ \"rsm.vlps\" = [1] }}"),
            &["series \"a\"", "rsm.vlps", "rsm.vpls"],
        );
        assert_says(&format!("{scenes}{SERIES}set = {{ \"rsm.vpls\" = -1 }}"), &["series \"a\"", "rsm.vpls", "-1"]);
        assert_says(&format!("{scenes}{SERIES}vary = {{ \"rsm.vpls\" = [] }}"), &["series \"a\"", "rsm.vpls", "empty"]);
        let both = "set = { \"rsm.vpls\" = 1 }\nvary = { \"rsm.vpls\" = [1] }";
        assert_says(&format!("{scenes}{SERIES}{both}"), &["series \"a\"", "rsm.vpls", "both"]);
        assert_says(&format!("{scenes}{SERIES}vary = {{ \"rsm.vpls\" = [4, 4] }}"), &["series \"a\"", "twice", "4"]);
        assert_says(&format!("{scenes}{SERIES}{SERIES}"), &["series", "\"a\"", "another name"]);
        let methods = |methods: &str| format!("{scenes}{SERIES}methods = {{ {methods} }}");
        assert_says(&methods("diffus = \"rsm\""), &["series \"a\"", "no slot \"diffus\""]);
        assert_says(&methods("diffuse = \"rms\""), &["series \"a\"", "rms", "final-gather"]);
        assert_says(&format!("{scenes}growth = {{ pixels = [\"maze\"] }}\n{SERIES}"), &["growth", "\"maze\"", "ring"]);
        assert_says(&format!("{scenes}growth = {{ time = [\"ring\"] }}\n{SERIES}"), &["time", "pixels", "triangles"]);
        assert_says(&format!("scenes = [{{ path = \"ring\", split = 9 }}]\n{SERIES}"), &["\"ring\"", "split", "8"]);
        assert_says(&format!("{scenes}entry = \"depth\"\n{SERIES}"), &["depth", "covered", "diffuse"]);
        assert_says(&format!("{scenes}compare = \"all\"\n{SERIES}"), &["line 2", "all", "full", "equal"]);
        assert_says(&format!("{scenes}frames = 0\n{SERIES}"), &["frames", "at least 1"]);
        assert_says(&format!("scenes = [{{ file = \"a.glb\" }}]\n{SERIES}"), &["scene 1", "file", "path"]);
        let light = "{ path = \"ring\", light = [\"moon:1,2\"] }";
        assert_says(&format!("scenes = [{light}]\n{SERIES}"), &["scene \"ring\"", "moon"]);
        let published =
            |entry: &str| format!("{scenes}columns = {{ a = [\"gbuffer\"] }}\n{SERIES}[[published]]\n{entry}");
        assert_says(&published("scene = \"maze\"\nms = { a = 1 }"), &["published", "maze", "scenes: ring"]);
        assert_says(&published("scene = \"ring\"\nms = { b = 1 }"), &["published", "\"b\"", "columns: a, frame"]);
        assert_says(&format!("scenes = []\n{SERIES}"), &["scenes is empty"]);
    }
}
