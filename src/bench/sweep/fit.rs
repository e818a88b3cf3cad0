//! Numbers that sum a line up: power laws, and the error that each reaches in the same time.

use super::lines::Line;

/// The exponent p of the power law y ~ x^p that fits best, by least squares of the logarithms. `None` without two
/// different abscissas. Pairs that have no logarithms are left out.
pub fn slope(pairs: &[(f64, f64)]) -> Option<f64> {
    let logs = logarithms(pairs);
    let count = logs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / count;
    let (mean_x, mean_y) = (mean(|log| log.0), mean(|log| log.1));
    let variance: f64 = logs.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
    let covariance: f64 = logs.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    (variance > 1e-12 * count).then(|| covariance / variance)
}

/// The errors of several lines at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct EqualTime {
    /// The time, milliseconds.
    pub time_ms: f64,
    /// The error of each line; `None` of a line that is a single point.
    pub errors: Vec<Option<f64>>,
}

/// Interpolates the lines, in logarithms, at the geometric mean of the times that all of them cover. `None` if there are no
/// two lines or no such times.
pub fn equal_time(lines: &[Line<'_>]) -> Option<EqualTime> {
    let sorted = lines.iter().map(|line| {
        let mut logs = logarithms(&line.pairs());
        logs.sort_by(|a, b| a.0.total_cmp(&b.0));
        logs
    });
    let lines: Vec<Vec<(f64, f64)>> = sorted.collect();
    let ranges = lines.iter().filter(|logs| logs.len() > 1).map(|logs| (logs[0].0, logs[logs.len() - 1].0));
    let (count, low, high) = ranges.fold((0, f64::NEG_INFINITY, f64::INFINITY), |(count, low, high), range| {
        (count + 1, range.0.max(low), range.1.min(high))
    });
    if count < 2 || low > high {
        return None;
    }
    let time = 0.5 * (low + high);
    let errors = lines.iter().map(|logs| interpolated(logs, time).map(f64::exp));
    Some(EqualTime { time_ms: time.exp(), errors: errors.collect() })
}

/// Of sorted pairs, between two of them.
fn interpolated(pairs: &[(f64, f64)], x: f64) -> Option<f64> {
    let (a, b) = pairs.windows(2).map(|pair| (pair[0], pair[1])).find(|(a, b)| (a.0..=b.0).contains(&x))?;
    let t = if b.0 > a.0 { (x - a.0) / (b.0 - a.0) } else { 0.0 };
    Some(a.1 + t * (b.1 - a.1))
}

fn logarithms(pairs: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let logs = pairs.iter().map(|(x, y)| (x.ln(), y.ln()));
    logs.filter(|(x, y)| x.is_finite() && y.is_finite()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::sweep::execute::tests::whole;
    use crate::bench::sweep::lines;

    #[test]
    fn a_power_law_is_found_again() {
        let law = |x: f64| (x, 3.0 * x.powf(-0.5));
        let pairs: Vec<(f64, f64)> = [1.0, 4.0, 16.0, 100.0].map(law).to_vec();
        assert!((slope(&pairs).expect("four points") + 0.5).abs() < 1e-12);
        let mut with_gaps = pairs.clone();
        with_gaps.extend([(0.0, 1.0), (2.0, f64::NAN), (3.0, 0.0)]);
        assert_eq!(slope(&with_gaps), slope(&pairs));
        // By hand: ln of (1, 1), (e, 1), (e², e³) is (0, 0), (1, 0), (2, 3).
        let e = std::f64::consts::E;
        assert!((slope(&[(1.0, 1.0), (e, 1.0), (e * e, e.powi(3))]).expect("three points") - 1.5).abs() < 1e-12);
        assert_eq!(slope(&pairs[..1]), None);
        assert_eq!(slope(&[(2.0, 1.0), (2.0, 3.0)]), None);
    }

    #[test]
    fn lines_are_compared_where_they_overlap() {
        let mut sweep = whole();
        for measured in &mut sweep.points {
            let (time, error) = match (measured.series.as_str(), measured.values.values().next()) {
                ("shadows", Some(value)) if value == 64 => (10.0, 8.0),
                ("shadows", _) => (1000.0, 0.08),
                (_, Some(value)) if value == 16 => (1.0, 4.0),
                _ => (100.0, 0.04),
            };
            measured.run.frame_ms.median = time;
            measured.run.error_full.as_mut().expect("compared").get_mut("image").expect("there").rrmse = error;
        }
        let EqualTime { time_ms, errors } = equal_time(&lines(&sweep, "ring")).expect("10 to 100 ms");
        assert!((time_ms - 1000.0_f64.sqrt()).abs() < 1e-9, "{time_ms}");
        let expected = [4.0 * 1000.0_f64.powf(-0.5), 80.0 * 1000.0_f64.powf(-0.5)];
        for (error, expected) in errors.into_iter().zip(expected) {
            assert!((error.expect("interpolated") / expected - 1.0).abs() < 1e-9, "{error:?}, not {expected}");
        }
        sweep.points.retain(|measured| measured.series == "shadows");
        assert_eq!(equal_time(&lines(&sweep, "ring")), None, "one line alone");
    }
}
