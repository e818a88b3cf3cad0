//! What is said of a set of measurements: the least, the middle and the slow end.

use serde::{Deserialize, Serialize};

/// The least, the median and the 95th percentile of some measurements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// The smallest.
    pub min: f64,
    /// The middle one; of an even number the mean of the two in the middle.
    pub median: f64,
    /// The nearest-rank 95th percentile: the smallest measurement that at least 95 % do not exceed. It is always one
    /// that was measured; of fewer than 20 it is the largest.
    pub p95: f64,
}

impl Spread {
    /// Of some measurements in any order; `None` of none.
    pub fn of(measurements: &[f64]) -> Option<Spread> {
        let mut sorted = measurements.to_vec();
        sorted.sort_by(f64::total_cmp);
        let rank = (0.95 * sorted.len() as f64).ceil() as usize;
        Some(Spread { min: *sorted.first()?, median: middle(&sorted), p95: *sorted.get(rank.checked_sub(1)?)? })
    }
}

/// The median as in [`Spread`]; `None` of no measurements.
pub fn median(measurements: &[f64]) -> Option<f64> {
    Spread::of(measurements).map(|spread| spread.median)
}

fn middle(sorted: &[f64]) -> f64 {
    let half = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[half] } else { 0.5 * (sorted[half - 1] + sorted[half]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_sets_by_hand() {
        assert_eq!(Spread::of(&[]), None);
        assert_eq!(Spread::of(&[3.0]), Some(Spread { min: 3.0, median: 3.0, p95: 3.0 }));
        assert_eq!(Spread::of(&[4.0, 1.0]), Some(Spread { min: 1.0, median: 2.5, p95: 4.0 }));
        assert_eq!(Spread::of(&[9.0, 1.0, 2.0]), Some(Spread { min: 1.0, median: 2.0, p95: 9.0 }));
    }

    #[test]
    fn the_95th_percentile_is_the_nearest_rank() {
        let first = |count: u32| (1..=count).rev().map(f64::from).collect::<Vec<_>>();
        let p95 = |count: u32| Spread::of(&first(count)).expect("not empty").p95;
        assert_eq!([10, 19, 20, 21, 40, 100].map(p95), [10.0, 19.0, 19.0, 20.0, 38.0, 95.0]);
    }
}
