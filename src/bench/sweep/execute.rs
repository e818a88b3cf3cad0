//! Measuring the points of a sweep: group by group, the result saved after each.

use super::grid::{Grid, GridScene, Interleave};
use super::points::Point;
use super::result::{Measured, PointFailure, Sweep};
use crate::bench::report::Run;

/// Points of one scene that are measured together.
#[derive(Debug)]
pub struct Group<'a> {
    /// The scene.
    pub scene: &'a GridScene,
    /// The points, at least one, in the order of the grid.
    pub points: Vec<&'a Point>,
}

/// What becomes of a group: a run for each of its points or a sentence on why there is none, or one sentence for all.
pub type Outcomes = Result<Vec<Result<Run, String>>, String>;

/// Puts points, in the order of the grid, into groups as the grid's `interleave` says.
pub fn groups<'a>(grid: &'a Grid, points: &[&'a Point]) -> Vec<Group<'a>> {
    let together = |a: &&Point, b: &&Point| match grid.interleave {
        Interleave::Point => false,
        Interleave::Series => a.scene == b.scene && a.series == b.series,
        Interleave::Scene => a.scene == b.scene,
    };
    points
        .chunk_by(together)
        .map(|group| Group { scene: &grid.scenes[group[0].scene], points: group.to_vec() })
        .collect()
}

/// Measures those of `points` that `sweep` does not hold yet, group by group; `save` is called after each, with the result
/// so far.
///
/// # Errors
/// Those of `save`, which end the sweep. Points that fail do not.
pub fn run<E>(
    sweep: &mut Sweep,
    points: &[Point],
    measure: &mut dyn FnMut(&Group<'_>) -> Outcomes,
    save: &mut dyn FnMut(&Sweep) -> Result<(), E>,
) -> Result<(), E> {
    let grid = sweep.grid.clone();
    let order = grid.points().unwrap_or_default();
    let pending: Vec<&Point> = points.iter().filter(|point| !sweep.holds(point)).collect();
    for group in groups(&grid, &pending) {
        let outcomes = measure(&group).unwrap_or_else(|error| vec![Err(error); group.points.len()]);
        for (point, outcome) in group.points.iter().zip(outcomes) {
            let (id, values) = (point.id.clone(), point.values.clone());
            let (scene, series) = (group.scene.name.clone(), grid.series[point.series].name.clone());
            match outcome {
                Ok(run) => sweep.add(Measured { id, scene, series, values, run }),
                Err(error) => sweep.failures.push(PointFailure { id, scene, series, values, error }),
            }
        }
        sweep.sort(&order);
        save(sweep)?;
    }
    Ok(())
}

#[cfg(test)]
pub(super) mod tests {
    use std::collections::BTreeMap;
    use std::convert::Infallible;
    use std::path::{Path, PathBuf};

    use super::*;
    use crate::bench::report::{Device, ImageErrors};
    use crate::bench::statistics::Spread;
    use crate::bench::sweep::{Shard, SweepError};

    pub(in crate::bench::sweep) const GRID: &str = "reference = 64\nscenes = [\"ring\", \"corridor\"]\n\
        [[series]]\nname = \"gathered\"\ntechnique = \"rsm\"\nvary = { \"rsm.vpls\" = [16, 64, 256, 1024, 4096] }\n\
        [[series]]\nname = \"shadows\"\ntechnique = \"direct\"\nvary = { \"lights.resolution\" = [64, 256] }\n";

    pub(in crate::bench::sweep) fn grid() -> Grid {
        Grid::parse(GRID, Path::new("x.toml")).expect("sound")
    }

    fn empty() -> Sweep {
        Sweep::new(grid(), Device { name: "a device".to_owned(), ..Device::default() })
    }

    /// Time and error as a power of what varies.
    fn made_up(group: &Group<'_>, point: &Point) -> Run {
        let value = f64::from(point.settings.rsm.vpls.max(1) * point.settings.lights.resolution);
        let time = 0.01 * value.powf(0.9);
        let error = |bias: f64| {
            let rrmse = bias + 10.0 * value.powf(-0.5);
            BTreeMap::from([("image".to_owned(), ImageErrors { rrmse, rmse: 0.5 * rrmse, ..ImageErrors::default() })])
        };
        Run {
            scene: group.scene.name.clone(),
            technique: point.settings.technique.name().to_owned(),
            preset: point.settings.preset.name().to_owned(),
            size: [256, 256],
            frame_ms: Spread { min: time, median: time, p95: time },
            error: Some(error(0.0)),
            error_full: Some(error(0.05)),
            ..Run::default()
        }
    }

    /// Measures `points` of a sweep with made-up numbers; returns the sizes of the groups and how often it was saved.
    fn measure(sweep: &mut Sweep, points: &[Point]) -> (Vec<usize>, usize) {
        let (mut sizes, mut saved) = (Vec::new(), 0);
        let mut measured = |group: &Group<'_>| {
            sizes.push(group.points.len());
            Ok(group.points.iter().map(|point| Ok(made_up(group, point))).collect())
        };
        let mut save = |_: &Sweep| -> Result<(), Infallible> {
            saved += 1;
            Ok(())
        };
        run(sweep, points, &mut measured, &mut save).expect("saving cannot fail");
        (sizes, saved)
    }

    pub(in crate::bench::sweep) fn whole() -> Sweep {
        let mut sweep = empty();
        let points = sweep.grid.points().expect("sound");
        measure(&mut sweep, &points);
        sweep
    }

    #[test]
    fn groups_are_as_large_as_the_grid_says() {
        for (interleave, expected) in
            [(Interleave::Point, vec![1; 14]), (Interleave::Series, vec![5, 2, 5, 2]), (Interleave::Scene, vec![7, 7])]
        {
            let mut sweep = empty();
            sweep.grid.interleave = interleave;
            let points = sweep.grid.points().expect("sound");
            assert_eq!(measure(&mut sweep, &points), (expected.clone(), expected.len()));
        }
    }

    #[test]
    fn what_is_done_is_not_measured_again() {
        let points = grid().points().expect("sound");
        let mut sweep = empty();
        measure(&mut sweep, &points[2..4]);
        let text = serde_json::to_string(&sweep).expect("plain data");
        let earlier: Sweep = serde_json::from_str(&text).expect("its own");
        let mut sweep = empty().resume(Path::new("a.json"), earlier).expect("the same grid");
        let (sizes, _) = measure(&mut sweep, &points);
        assert_eq!(sizes, [3, 2, 5, 2]);
        assert_eq!(sweep, whole());
        assert_eq!(measure(&mut sweep, &points), (vec![], 0));
    }

    #[test]
    fn a_longer_grid_goes_on_and_another_one_does_not() {
        let longer = Grid::parse(&GRID.replace("[64, 256]", "[64, 128, 256]"), Path::new("x.toml")).expect("sound");
        let earlier = whole();
        let resumed = Sweep::new(longer, earlier.device.clone()).resume(Path::new("a.json"), earlier.clone());
        assert_eq!(resumed.expect("all its points are there").points.len(), 14);
        let other = Sweep::new(Grid { size: [64, 64], ..grid() }, earlier.device.clone());
        let error = other.resume(Path::new("a.json"), earlier.clone()).expect_err("other points").to_string();
        assert!(error.contains("14 of the 14 points in a.json") && error.contains("--restart"), "{error}");
        let device = Device { name: "another".to_owned(), ..Device::default() };
        let error =
            Sweep::new(grid(), device).resume(Path::new("a.json"), earlier.clone()).expect_err("device").to_string();
        assert!(["a.json", "a device", "another", "--restart"].iter().all(|word| error.contains(word)), "{error}");
        let old = Sweep { irradia: "0.0.1".to_owned(), ..earlier };
        assert!(matches!(empty().resume(Path::new("a.json"), old), Err(SweepError::Mixed { .. })));
    }

    #[test]
    fn shards_merge_to_the_whole() {
        let grid = grid();
        let points = grid.points().expect("sound");
        let parts = (1..=3).map(|index| {
            let shard = Shard { index, count: 3 };
            let own: Vec<Point> = points.iter().filter(|point| shard.holds(point, 2)).cloned().collect();
            let mut part = empty();
            measure(&mut part, &own);
            assert!(part.points.len() < points.len() / 2);
            (PathBuf::from(format!("{index}.json")), part)
        });
        let mut parts: Vec<(PathBuf, Sweep)> = parts.collect();
        parts.reverse();
        assert_eq!(Sweep::merge(parts.clone()).expect("parts of one sweep"), whole());

        let mut again = parts[0].clone();
        again.1.points[0].run.frames = 77;
        let id = again.1.points[0].id.clone();
        parts.push(again);
        let merged = Sweep::merge(parts.clone()).expect("parts of one sweep");
        assert_eq!(merged.points.len(), points.len());
        let later = merged.points.iter().find(|measured| measured.id == id).expect("it is there");
        assert_eq!(later.run.frames, 77, "the later one counts");

        parts[1].1.grid.frames = 6;
        let error = Sweep::merge(parts).expect_err("different grids").to_string();
        assert!(error.contains("2.json and 3.json are of different grids"), "{error}");
    }

    #[test]
    fn failures_are_told_and_tried_again() {
        let points = grid().points().expect("sound");
        let mut sweep = empty();
        let mut measured = |group: &Group<'_>| match group.scene.name.as_str() {
            "ring" => Err("no such file".to_owned()),
            _ => Ok(vec![Err("out of memory".to_owned()); group.points.len()]),
        };
        run(&mut sweep, &points, &mut measured, &mut |_| Ok::<(), Infallible>(())).expect("saving cannot fail");
        assert_eq!((sweep.points.len(), sweep.failures.len()), (0, 14));
        assert_eq!(sweep.failures[0].to_string(), "ring, gathered, rsm.vpls = 16: no such file");
        let merged = Sweep::merge(vec![("a".into(), sweep.clone()), ("b".into(), whole())]).expect("one grid");
        assert_eq!(merged, whole(), "what another part has measured is no failure");
        let mut resumed = empty().resume(Path::new("a.json"), sweep).expect("the same grid");
        measure(&mut resumed, &points);
        assert_eq!(resumed, whole());
    }
}
