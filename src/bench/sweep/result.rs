//! What a sweep measured: its JSON, schema `irradia-sweep/1`, resumed and merged. Other programs read it: names stay what
//! they are.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::grid::Grid;
use super::points::{Point, PointsError};
use crate::bench::report::{Device, Run};
use crate::output::{OutputError, Target};

/// A grid and what of it has been measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// [`Sweep::SCHEMA`].
    pub schema: String,
    /// The version of irradia.
    pub irradia: String,
    /// What all points were measured on.
    pub device: Device,
    /// The grid, all of it, also if this is a part.
    pub grid: Grid,
    /// The points that are done, in the order of [`Grid::points`].
    pub points: Vec<Measured>,
    /// The points that failed; they are tried again when the sweep is resumed.
    pub failures: Vec<PointFailure>,
}

/// A point that is done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// See [`Point::id`].
    pub id: String,
    /// The scene's name in the grid.
    pub scene: String,
    /// The series' name.
    pub series: String,
    /// See [`Point::values`].
    pub values: BTreeMap<String, Value>,
    /// What was measured.
    pub run: Run,
}

/// A point that failed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointFailure {
    /// See [`Point::id`].
    pub id: String,
    /// The scene's name in the grid.
    pub scene: String,
    /// The series' name.
    pub series: String,
    /// See [`Point::values`].
    pub values: BTreeMap<String, Value>,
    /// One sentence.
    pub error: String,
}

impl std::fmt::Display for PointFailure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}, {}", self.scene, self.series)?;
        for (key, value) in &self.values {
            write!(f, ", {key} = {value}")?;
        }
        write!(f, ": {}", self.error)
    }
}

/// A result that cannot be used. One sentence: which file, why, what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// The file cannot be read or holds something else.
    #[error("{path} is no result of a sweep: {reason}", path = .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// The points were measured by something else.
    #[error("{path} was measured by {theirs}, and {other} by {ours}: their times do not go into one sweep; {advice}", path = .path.display())]
    Mixed {
        /// The file.
        path: PathBuf,
        /// What measured it.
        theirs: String,
        /// What it would be mixed with.
        other: String,
        /// What measured that.
        ours: String,
        /// What to do.
        advice: &'static str,
    },
    /// The file holds points that the grid does not.
    #[error("{foreign} of the {count} points in {path} are not in the grid; write to another file, or measure all anew with --restart", path = .path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// How many points the grid does not hold.
        foreign: usize,
        /// Of how many.
        count: usize,
    },
    /// Two files to merge are of different grids.
    #[error("{path} and {other} are of different grids and cannot be merged", path = .path.display(), other = .other.display())]
    Grids {
        /// The file.
        path: PathBuf,
        /// The first file.
        other: PathBuf,
    },
    /// The grid in a file cannot be told in points.
    #[error("the grid in {path} is not one of this version of irradia: {what}", path = .path.display())]
    Grid {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: PointsError,
    },
}

impl Sweep {
    /// The schema of the JSON.
    pub const SCHEMA: &str = "irradia-sweep/1";

    /// A sweep of which nothing has been measured yet.
    pub fn new(grid: Grid, device: Device) -> Sweep {
        let (schema, irradia) = (Sweep::SCHEMA.to_owned(), env!("CARGO_PKG_VERSION").to_owned());
        Sweep { schema, irradia, device, grid, points: Vec::new(), failures: Vec::new() }
    }

    /// Reads a result.
    ///
    /// # Errors
    /// [`SweepError::Unreadable`].
    pub fn read(path: &Path) -> Result<Sweep, SweepError> {
        let failed = |reason: String| SweepError::Unreadable { path: path.to_owned(), reason };
        let text = fs::read_to_string(path).map_err(|error| failed(error.to_string()))?;
        let document: Value = serde_json::from_str(&text).map_err(|error| failed(error.to_string()))?;
        if document["schema"] != Sweep::SCHEMA {
            return Err(failed(format!("its schema is {}, not {:?}", document["schema"], Sweep::SCHEMA)));
        }
        serde_json::from_value(document).map_err(|error| failed(error.to_string()))
    }

    /// Writes the result, whole or not at all.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, target: impl Into<Target>) -> Result<(), OutputError> {
        let target = target.into();
        let unwritable =
            |error: serde_json::Error| OutputError::Write { path: target.path().to_owned(), reason: error.to_string() };
        let mut text = serde_json::to_string_pretty(self).map_err(unwritable)?;
        text.push('\n');
        target.write(text.as_bytes())
    }

    /// Goes on with the points that an earlier result at `path` has of this sweep's grid. Its failures are forgotten.
    ///
    /// # Errors
    /// Another device or version measured them, or they are points of another grid.
    pub fn resume(self, path: &Path, earlier: Sweep) -> Result<Sweep, SweepError> {
        let (theirs, ours) = (earlier.measured_by(), self.measured_by());
        if theirs != ours && !earlier.points.is_empty() {
            let (path, other) = (path.to_owned(), "the rest would be".to_owned());
            let advice = "write to another file, or measure all anew with --restart";
            return Err(SweepError::Mixed { path, theirs, other, ours, advice });
        }
        let points = self.planned(path)?;
        let known: HashSet<&str> = points.iter().map(|point| point.id.as_str()).collect();
        let foreign = earlier.points.iter().filter(|measured| !known.contains(measured.id.as_str())).count();
        if foreign > 0 {
            return Err(SweepError::Foreign { path: path.to_owned(), foreign, count: earlier.points.len() });
        }
        Ok(Sweep { points: earlier.points, ..self })
    }

    /// Puts parts of one sweep together. A point that several have is taken from the last one; a failure counts if no part
    /// has the point.
    ///
    /// # Errors
    /// Parts of different grids, devices or versions.
    ///
    /// # Panics
    /// There is no part at all.
    pub fn merge(parts: Vec<(PathBuf, Sweep)>) -> Result<Sweep, SweepError> {
        let mut parts = parts.into_iter();
        let (first, mut whole) = parts.next().expect("a merge is of at least one part");
        for (path, part) in parts {
            if part.grid != whole.grid {
                return Err(SweepError::Grids { path, other: first });
            }
            if part.measured_by() != whole.measured_by() {
                let (theirs, ours) = (part.measured_by(), whole.measured_by());
                let advice = "merge those of one device and version";
                return Err(SweepError::Mixed { path, theirs, other: first.display().to_string(), ours, advice });
            }
            whole.failures.extend(part.failures);
            for measured in part.points {
                whole.add(measured);
            }
        }
        let done: HashSet<String> = whole.points.iter().map(|measured| measured.id.clone()).collect();
        whole.failures.retain(|failure| !done.contains(&failure.id));
        let points = whole.planned(&first)?;
        whole.sort(&points);
        Ok(whole)
    }

    /// The points of the grid.
    fn planned(&self, path: &Path) -> Result<Vec<Point>, SweepError> {
        self.grid.points().map_err(|what| SweepError::Grid { path: path.to_owned(), what })
    }

    /// Adds a point in place of an earlier measurement of the same one.
    pub fn add(&mut self, measured: Measured) {
        match self.points.iter_mut().find(|known| known.id == measured.id) {
            Some(known) => *known = measured,
            None => self.points.push(measured),
        }
    }

    /// Brings what was measured into the order of the grid's points.
    pub fn sort(&mut self, points: &[Point]) {
        let order: HashMap<&str, usize> =
            points.iter().enumerate().map(|(index, point)| (point.id.as_str(), index)).collect();
        let place = |id: &str| order.get(id).copied().unwrap_or(usize::MAX);
        self.points.sort_by_key(|measured| place(&measured.id));
        self.failures.sort_by_key(|failure| place(&failure.id));
    }

    /// Whether a point is done.
    pub fn holds(&self, point: &Point) -> bool {
        self.points.iter().any(|measured| measured.id == point.id)
    }

    /// What measured the points: `irradia 0.1.0 on NAME (cpu, DRIVER, Vulkan 1.3.275)`.
    pub fn measured_by(&self) -> String {
        let Device { name, kind, driver, api } = &self.device;
        format!("irradia {} on {name} ({kind}, {driver}, Vulkan {api})", self.irradia)
    }
}
