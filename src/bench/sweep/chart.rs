//! What a plot with logarithmic axes is drawn with: axes with ticks, and labels that keep clear of each other.

/// A logarithmic axis on a stretch of pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::bench) struct LogAxis {
    /// Logarithms to base 10 at the first and the last pixel.
    low: f64,
    high: f64,
    first: f64,
    last: f64,
}

/// A place on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::bench) struct Tick {
    /// Pixels.
    pub(in crate::bench) at: i32,
    /// The value, if it is written beside the axis.
    pub(in crate::bench) label: Option<f64>,
    /// Whether it is a power of ten.
    pub(in crate::bench) decade: bool,
}

/// Up to this many decades the values 2 and 5 are written too.
const FEW_DECADES: f64 = 2.2;
/// An axis is at least this long, decades: so that two ticks of 1, 2 and 5 lie on it.
const SHORTEST: f64 = 0.8;

impl LogAxis {
    /// An axis from pixel `first` to `last` that holds `values` with some room. `None` if none is positive and finite.
    pub(in crate::bench) fn around(values: impl Iterator<Item = f64>, first: i32, last: i32) -> Option<LogAxis> {
        let logs = values.map(f64::log10).filter(|log| log.is_finite());
        let (low, high) =
            logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), log| (log.min(low), log.max(high)));
        if low > high {
            return None;
        }
        let room = (0.5 * (SHORTEST - (high - low))).max(0.09 * (high - low));
        Some(LogAxis { low: low - room, high: high + room, first: f64::from(first), last: f64::from(last) })
    }

    /// The pixel of a value.
    pub(in crate::bench) fn place(&self, value: f64) -> i32 {
        let share = (value.log10() - self.low) / (self.high - self.low);
        (self.first + share * (self.last - self.first)).round() as i32
    }

    /// All powers of ten on the axis and their multiples by 2 to 9.
    pub(in crate::bench) fn ticks(&self) -> Vec<Tick> {
        let mut ticks = Vec::new();
        for exponent in self.low.floor() as i32..=self.high.floor() as i32 {
            for digit in 1..=9 {
                // Parsed, not multiplied: 3·10⁻¹ would not be written 0.3.
                let value: f64 = format!("{digit}e{exponent}").parse().unwrap_or(f64::NAN);
                if !(self.low..=self.high).contains(&value.log10()) {
                    continue;
                }
                let written = digit == 1 || ([2, 5].contains(&digit) && self.high - self.low < FEW_DECADES);
                ticks.push(Tick { at: self.place(value), label: written.then_some(value), decade: digit == 1 });
            }
        }
        ticks
    }
}

/// A time for an axis: `20 µs`, `1 ms`, `500 ms`, `10 s`.
pub(in crate::bench) fn time_label(ms: f64) -> String {
    let (value, unit) = if ms < 0.9995 {
        (1e3 * ms, "µs")
    } else if ms < 999.5 {
        (ms, "ms")
    } else {
        (1e-3 * ms, "s")
    };
    format!("{} {unit}", plain(value))
}

/// A number for an axis: `0.002`, `1`, `20`; beyond that with an exponent.
pub(in crate::bench) fn number_label(value: f64) -> String {
    if (0.9e-4..1.1e5).contains(&value) { plain(value) } else { format!("{value:e}") }
}

/// Without the digits that rounding leaves behind.
fn plain(value: f64) -> String {
    let text = format!("{value:.7}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A rectangle: left, top, right, bottom, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::bench) struct Area {
    pub(in crate::bench) left: i32,
    pub(in crate::bench) top: i32,
    pub(in crate::bench) right: i32,
    pub(in crate::bench) bottom: i32,
}

impl Area {
    /// A square around a point.
    pub(in crate::bench) fn around(centre: (i32, i32), half: i32) -> Area {
        Area { left: centre.0 - half, top: centre.1 - half, right: centre.0 + half, bottom: centre.1 + half }
    }

    fn overlaps(&self, other: &Area) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }

    fn within(&self, other: &Area) -> bool {
        self.left >= other.left && self.right <= other.right && self.top >= other.top && self.bottom <= other.bottom
    }

    fn holds(&self, (x, y): (i32, i32)) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }
}

/// What is drawn so far, so that labels find a place of their own.
#[derive(Debug)]
pub(in crate::bench) struct Places {
    frame: Area,
    taken: Vec<Area>,
    segments: Vec<Segment>,
}

/// A piece of a line, pixels.
pub(in crate::bench) type Segment = [(i32, i32); 2];

/// Height of a label, the mean width of its characters, and the room around it, pixels; fonts differ, so all are generous.
const LABEL_HEIGHT: i32 = 14;
const LABEL_CHARACTER: f64 = 7.2;
const LABEL_ROOM: i32 = 3;

impl Places {
    /// Places within `frame` that keep clear of markers and lines.
    pub(in crate::bench) fn new(frame: Area, markers: Vec<Area>, segments: Vec<Segment>) -> Places {
        Places { frame, taken: markers, segments }
    }

    /// Keeps clear of these too.
    pub(in crate::bench) fn take(&mut self, areas: impl Iterator<Item = Area>, segments: Vec<Segment>) {
        self.taken.extend(areas);
        self.segments.extend(segments);
    }

    /// The centre of a label near `point`, where it hides least; the place is taken from then on.
    pub(in crate::bench) fn find(&mut self, point: (i32, i32), text: &str) -> (i32, i32) {
        let half_width = (0.5 * LABEL_CHARACTER * text.chars().count() as f64).ceil() as i32 + LABEL_ROOM;
        let half_height = LABEL_HEIGHT / 2;
        let aside = half_width + 6;
        let above = half_height + 9;
        let offsets = [
            (0, -above),
            (aside, -above + 2),
            (0, above),
            (-aside, above - 2),
            (aside + 4, 0),
            (-aside - 4, 0),
            (aside, above - 2),
            (-aside, -above + 2),
            (0, -2 * above),
            (0, 2 * above),
        ];
        let area = |(x, y): (i32, i32)| Area {
            left: point.0 + x - half_width,
            top: point.1 + y - half_height,
            right: point.0 + x + half_width,
            bottom: point.1 + y + half_height,
        };
        let best = offsets.into_iter().min_by_key(|offset| self.hidden(&area(*offset))).unwrap_or_default();
        self.taken.push(area(best));
        (point.0 + best.0, point.1 + best.1)
    }

    /// How much a label would hide there.
    fn hidden(&self, area: &Area) -> usize {
        let outside = if area.within(&self.frame) { 0 } else { 100 };
        let overlapped = self.taken.iter().filter(|taken| taken.overlaps(area)).count();
        let crossed = self.segments.iter().filter(|segment| crosses(segment, area)).count();
        outside + 10 * overlapped + 4 * crossed
    }
}

/// Whether a segment enters an area, looked at pixel by pixel.
fn crosses(segment: &Segment, area: &Area) -> bool {
    let [(x0, y0), (x1, y1)] = *segment;
    let steps = (x1 - x0).abs().max((y1 - y0).abs()).max(1);
    (0..=steps).any(|step| area.holds((x0 + (x1 - x0) * step / steps, y0 + (y1 - y0) * step / steps)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_holds_its_values_and_names_decades() {
        let axis = LogAxis::around([3.0, 4000.0, f64::NAN, 0.0].into_iter(), 100, 700).expect("two values");
        assert!(axis.place(3.0) > 100 && axis.place(4000.0) < 700);
        let labels: Vec<f64> = axis.ticks().iter().filter_map(|tick| tick.label).collect();
        assert_eq!(labels, [10.0, 100.0, 1000.0]);
        let middle = axis.place(100.0);
        assert!((middle - (axis.place(10.0) + axis.place(1000.0)) / 2).abs() <= 1);
        assert_eq!(LogAxis::around([f64::NAN, -1.0].into_iter(), 0, 1), None);
    }

    #[test]
    fn a_short_axis_names_more_and_is_never_empty() {
        for value in [0.013, 1.0, 7.7, 31.0] {
            let axis = LogAxis::around(std::iter::once(value), 400, 0).expect("a value");
            let ticks = axis.ticks();
            assert!(ticks.iter().filter(|tick| tick.label.is_some()).count() >= 2, "{value}: {ticks:?}");
            assert!((axis.place(value) - 200).abs() <= 1);
        }
        let axis = LogAxis::around([0.02, 0.5].into_iter(), 400, 0).expect("two values");
        let labels: Vec<String> = axis.ticks().iter().filter_map(|tick| tick.label).map(number_label).collect();
        assert_eq!(labels, ["0.02", "0.05", "0.1", "0.2", "0.5"]);
    }

    #[test]
    fn labels_are_short() {
        assert_eq!([0.02, 1.0, 500.0, 1000.0, 2e6].map(time_label), ["20 µs", "1 ms", "500 ms", "1 s", "2000 s"]);
        assert_eq!([1e-5, 0.0001, 0.3, 10.0, 1e6].map(number_label), ["1e-5", "0.0001", "0.3", "10", "1e6"]);
    }

    #[test]
    fn labels_keep_clear_of_each_other() {
        let frame = Area { left: 0, top: 0, right: 200, bottom: 200 };
        let points = [(100, 100), (104, 100), (10, 100), (100, 5)];
        let markers = points.iter().map(|point| Area::around(*point, 5)).collect();
        let mut places = Places::new(frame, markers, vec![[(100, 100), (180, 20)]]);
        for point in points {
            places.find(point, "4096");
        }
        let labels = &places.taken[points.len()..];
        for (index, label) in labels.iter().enumerate() {
            assert!(label.within(&frame), "{label:?}");
            assert!(
                !places
                    .taken
                    .iter()
                    .enumerate()
                    .any(|(other, taken)| other != points.len() + index && taken.overlaps(label))
            );
            assert!(!places.segments.iter().any(|segment| crosses(segment, label)), "{label:?}");
        }
    }
}
