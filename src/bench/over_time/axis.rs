//! A linear axis on a stretch of pixels, from zero or a first frame up.

/// About so many ticks.
const TICKS: f64 = 6.0;

/// A linear axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LinearAxis {
    low: f64,
    high: f64,
    first: f64,
    last: f64,
}

impl LinearAxis {
    /// From `low` at pixel `first` to `high` at pixel `last`; a span of nothing becomes one of 1.
    pub(super) fn new([low, high]: [f64; 2], [first, last]: [i32; 2]) -> LinearAxis {
        let high = if high > low { high } else { low + 1.0 };
        LinearAxis { low, high, first: f64::from(first), last: f64::from(last) }
    }

    /// From zero to the largest of `values`, with some room.
    pub(super) fn from_zero(values: impl Iterator<Item = f64>, pixels: [i32; 2]) -> LinearAxis {
        let high = values.filter(|value| value.is_finite()).fold(0.0, f64::max);
        LinearAxis::new([0.0, 1.06 * high], pixels)
    }

    /// The pixel of a value.
    pub(super) fn place(&self, value: f64) -> i32 {
        let share = (value - self.low) / (self.high - self.low);
        (self.first + share * (self.last - self.first)).round() as i32
    }

    /// Values at multiples of 1, 2 or 5 times a power of ten, whole ones alone if `whole`.
    pub(super) fn ticks(&self, whole: bool) -> Vec<f64> {
        let rough = (self.high - self.low) / TICKS;
        let power = 10_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|digit| digit * power).find(|step| *step >= rough);
        let step = step.unwrap_or(10.0 * power);
        let step = if whole { step.max(1.0).round() } else { step };
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step).floor() as i64;
        (first..=last).map(|number| number as f64 * step).collect()
    }
}

/// A number beside an axis, without the digits that rounding leaves behind.
pub(super) fn label(value: f64) -> String {
    let text = format!("{value:.6}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_few() {
        let axis = LinearAxis::from_zero([3.0, 41.0, f64::NAN].into_iter(), [400, 100]);
        assert_eq!(axis.ticks(false), [0.0, 10.0, 20.0, 30.0, 40.0]);
        assert_eq!((axis.place(0.0), axis.place(1.06 * 41.0)), (400, 100));
        let frames = LinearAxis::new([0.0, 7.0], [0, 70]);
        assert_eq!(frames.ticks(true), [0.0, 2.0, 4.0, 6.0]);
        assert_eq!(LinearAxis::new([0.0, 2.0], [0, 70]).ticks(true), [0.0, 1.0, 2.0]);
        assert_eq!(LinearAxis::new([0.0, 0.0], [0, 70]).place(0.0), 0);
    }

    #[test]
    fn labels_are_short() {
        assert_eq!([0.0, 0.30000000000000004, 20.0, 100.0, 0.005].map(label), ["0", "0.3", "20", "100", "0.005"]);
    }
}
