//! The points of a grid: all combinations, each with an id that other runs and other machines give it too.

use std::collections::BTreeMap;
use std::str::FromStr;

use serde_json::{Value, json};

use super::grid::{Grid, GridScene, Series};
use crate::renderer::{Settings, SettingsError, UnknownMethod};

/// One technique with one set of settings on one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Sixteen hexadecimal digits, a hash of everything that is measured: the same on every machine.
    pub id: String,
    /// Which of the grid's scenes.
    pub scene: usize,
    /// Which of the grid's series.
    pub series: usize,
    /// Which of the combinations of all series together; the same for all scenes.
    pub combination: usize,
    /// What distinguishes it within its series: the settings that vary, and `preset` if there are several.
    pub values: BTreeMap<String, Value>,
    /// All settings.
    pub settings: Settings,
}

/// The points of a grid cannot be told. One sentence: which series, what is wrong with it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PointsError {
    /// A setting does not exist or does not take a value.
    #[error("series {series:?}: {what}")]
    Setting {
        /// The series.
        series: String,
        /// What is wrong.
        what: SettingsError,
    },
    /// A slot has no such method.
    #[error("series {series:?}: {what}")]
    Method {
        /// The series.
        series: String,
        /// What is wrong.
        what: UnknownMethod,
    },
    /// Two combinations of a series are the same.
    #[error("series {series:?} names the point {values} twice; leave one out")]
    Twice {
        /// The series.
        series: String,
        /// The values of the point, `{"rsm.vpls":16}`.
        values: String,
    },
}

impl Grid {
    /// All points, scene by scene and series by series. Within a series the settings vary in alphabetical order, the last
    /// one fastest, and presets slowest.
    ///
    /// # Errors
    /// Unknown settings, values out of range, points that are there twice.
    pub fn points(&self) -> Result<Vec<Point>, PointsError> {
        let mut points = Vec::new();
        for (scene_index, scene) in self.scenes.iter().enumerate() {
            for (combination, (series, (values, settings))) in self.combinations(scene)?.into_iter().enumerate() {
                points.push(Point {
                    id: self.id(scene, &self.series[series], &settings),
                    scene: scene_index,
                    series,
                    combination,
                    values,
                    settings,
                });
            }
        }
        Ok(points)
    }

    /// Those of all series on one scene, with the number of the series.
    fn combinations(&self, scene: &GridScene) -> Result<Vec<(usize, Combination)>, PointsError> {
        let mut combinations = Vec::new();
        for (index, series) in self.series.iter().enumerate() {
            let of_series = series.combinations(&scene.set)?;
            for (position, (values, _)) in of_series.iter().enumerate() {
                if of_series[..position].iter().any(|(other, _)| other == values) {
                    return Err(PointsError::Twice { series: series.name.clone(), values: json!(values).to_string() });
                }
            }
            combinations.extend(of_series.into_iter().map(|combination| (index, combination)));
        }
        Ok(combinations)
    }

    /// What is measured, hashed. How long a point may take and what is shown of it are not part of that.
    fn id(&self, scene: &GridScene, series: &Series, settings: &Settings) -> String {
        let measured = json!({
            "scene": scene,
            "series": series.name,
            "settings": settings,
            "size": self.size,
            "reference": self.reference,
            "frames": self.frames,
            "warmup": self.warmup,
        });
        format!("{:016x}", fnv1a(measured.to_string().as_bytes()))
    }
}

/// What distinguishes a point within its series, and all its settings.
type Combination = (BTreeMap<String, Value>, Settings);

impl Series {
    fn combinations(&self, of_scene: &BTreeMap<String, Value>) -> Result<Vec<Combination>, PointsError> {
        let failed = |what| PointsError::Setting { series: self.name.clone(), what };
        let unknown = |what| PointsError::Method { series: self.name.clone(), what };
        let mut combinations = Vec::new();
        for preset in &self.preset {
            let mut settings = Settings::new(self.technique, *preset);
            for (slot, method) in &self.methods {
                settings.methods.set(*slot, method).map_err(unknown)?;
            }
            for (key, value) in of_scene.iter().chain(&self.set) {
                settings.set(key, &written(value)).map_err(failed)?;
            }
            let mut values = BTreeMap::new();
            if self.preset.len() > 1 {
                values.insert("preset".to_owned(), Value::from(preset.name()));
            }
            combinations.push((values, settings));
        }
        for (key, varied) in &self.vary {
            let mut longer = Vec::with_capacity(combinations.len() * varied.len());
            for (values, settings) in &combinations {
                for value in varied {
                    let (mut values, mut settings) = (values.clone(), settings.clone());
                    settings.set(key, &written(value)).map_err(failed)?;
                    values.insert(key.clone(), value.clone());
                    longer.push((values, settings));
                }
            }
            combinations = longer;
        }
        Ok(combinations)
    }
}

/// A value as it is written on the command line.
pub(super) fn written(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// The 64-bit hash of Fowler, Noll and Vo, variant 1a (RFC 9923): unlike the standard library's, it stays what it is.
fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// One of several equal parts of a grid, measured by different machines or jobs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which one, from 1.
    pub index: u32,
    /// Of how many.
    pub count: u32,
}

impl Shard {
    /// Whether a point of a grid with `scene_count` scenes belongs to this part. The points are dealt out one by one, the
    /// same combination on all scenes first: those cost about the same, so the parts do too.
    pub fn holds(self, point: &Point, scene_count: usize) -> bool {
        let dealt = (point.combination * scene_count + point.scene) as u64;
        dealt % u64::from(self.count) == u64::from(self.index - 1)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Shard, String> {
        let parts = text.split_once('/').map(|(index, count)| (index.parse(), count.parse()));
        match parts {
            Some((Ok(index), Ok(count))) if 1 <= index && index <= count => Ok(Shard { index, count }),
            _ => Err("a shard is I/N, the I-th of N parts, such as 1/4".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;
    use std::path::Path;

    use super::*;
    use crate::renderer::DirectMethod;

    const PRODUCT: &str = "scenes = [\"ring\", \"corridor\", \"maze\"]\n[[series]]\ntechnique = \"rsm\"\n\
        preset = [\"draft\", \"high\"]\nset = { \"lights.resolution\" = 64 }\n\
        vary = { \"shadow.filter_radius\" = [0, 1], \"rsm.vpls\" = [16, 64, 256] }\n\
        [[series]]\ntechnique = \"direct\"\n";

    fn grid(text: &str) -> Grid {
        Grid::parse(text, Path::new("x.toml")).expect("sound")
    }

    #[test]
    fn what_a_series_sets_comes_after_what_belongs_to_the_scene() {
        let scenes =
            "scenes = [\"ring\", { path = \"maze\", set = { \"rsm.vpls\" = 7, \"lights.resolution\" = 32 } }]\n";
        let series = "[[series]]\ntechnique = \"rsm\"\nmethods = { direct = \"traced\" }\nset = { \"rsm.vpls\" = 9 }\n";
        let points = grid(&format!("{scenes}{series}")).points().expect("sound");
        let resolution = |point: &Point| (point.settings.rsm.vpls, point.settings.lights.resolution);
        assert_eq!([resolution(&points[0]), resolution(&points[1])], [(9, 512), (9, 32)]);
        assert!(points.iter().all(|point| point.settings.methods.direct == DirectMethod::Traced));
    }

    #[test]
    fn the_product_holds_every_combination_once() {
        let grid = grid(PRODUCT);
        let points = grid.points().expect("sound");
        assert_eq!(points.len(), 3 * (2 * 2 * 3 + 1));
        assert_eq!(json!(points[0].values), json!({"preset": "draft", "rsm.vpls": 16, "shadow.filter_radius": 0}));
        assert_eq!(json!(points[1].values), json!({"preset": "draft", "rsm.vpls": 16, "shadow.filter_radius": 1}));
        assert_eq!(json!(points[11].values), json!({"preset": "high", "rsm.vpls": 256, "shadow.filter_radius": 1}));
        let last = &points[11].settings;
        assert_eq!((last.rsm.vpls, last.shadow_map.filter_radius, last.lights.resolution), (256, 1, 64));
        assert_eq!(last.lights.emitter_samples, 32, "of the preset high");
        assert!(points[12].values.is_empty());
        let ids: HashSet<&str> = points.iter().map(|point| point.id.as_str()).collect();
        assert_eq!(ids.len(), points.len());
    }

    #[test]
    fn ids_depend_on_what_is_measured_alone() {
        let before = grid(PRODUCT);
        let ids =
            |grid: &Grid| -> Vec<String> { grid.points().expect("sound").into_iter().map(|point| point.id).collect() };
        let shown = Grid { entry: "diffuse".to_owned(), max_seconds: Some(1.0), ..before.clone() };
        assert_eq!(ids(&shown), ids(&before));
        let more = grid(&PRODUCT.replace("[16, 64, 256]", "[4, 16, 64, 256]"));
        let known = ids(&more);
        assert!(ids(&before).iter().all(|id| known.contains(id)), "a longer list keeps the points it had");
        for other in [
            Grid { size: [256, 255], ..before.clone() },
            Grid { reference: Some(16), ..before.clone() },
            Grid { frames: 6, ..before.clone() },
            grid(&PRODUCT.replace("= 64 }", "= 128 }")),
            grid(&PRODUCT.replace("\"rsm\"\n", "\"rsm\"\nname = \"b\"\n")),
        ] {
            assert_ne!(ids(&other)[0], ids(&before)[0]);
        }
        assert_eq!(fnv1a(b"foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn shards_share_the_points_evenly() {
        let grid = grid(PRODUCT);
        let points = grid.points().expect("sound");
        for count in 1..=50 {
            let mut held = vec![0; points.len()];
            for index in 1..=count {
                let shard = Shard { index, count };
                let own = points.iter().enumerate().filter(|(_, point)| shard.holds(point, grid.scenes.len()));
                let own: Vec<usize> = own.map(|(index, _)| index).collect();
                assert!(own.len().abs_diff(points.len() / count as usize) <= 1);
                own.iter().for_each(|index| held[*index] += 1);
            }
            assert!(held.iter().all(|times| *times == 1), "{count} shards");
        }
    }

    #[test]
    fn a_shard_is_one_of_its_number() {
        assert_eq!("2/3".parse(), Ok(Shard { index: 2, count: 3 }));
        for wrong in ["", "1", "0/3", "4/3", "1/0", "-1/3", "1/3/5", "a/b"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }
}
