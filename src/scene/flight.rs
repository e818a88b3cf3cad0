//! Flights: a camera's way through a scene, from a small text file with keyframes, a smooth curve through them between.
//!
//! ```text
//! # seconds  eye             target          degrees
//! 0          8.5 2.2 -0.3    -1.0 1.4 -0.2   60
//! 10         0.0 1.7 -0.2    -8.0 1.6 -0.2
//! ```
//!
//! A line is a keyframe: a time, where the eye is, where it looks, and the vertical angle of view in degrees, by default that of the line before or 60. What follows
//! a `#` is left out.

use std::path::Path;

use glam::DVec3;

use super::animation::hermite;
use super::camera::{CameraView, Projection};

/// The vertical angle of view of a file that states none, degrees.
const DEGREES: f64 = 60.0;
/// The nearest distance that is seen, metres.
const NEAR: f64 = 0.01;
/// An eye this near to what it looks at, metres, looks nowhere.
const NEAREST_TARGET: f64 = 1e-6;

/// A camera's way. Before the first and after the last keyframe it stands still.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// The file's stem, or the built-in flight's name.
    pub name: String,
    keys: Vec<Key>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    seconds: f64,
    /// Eye, target, degrees.
    values: [f64; 7],
}

/// Why a flight cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FlightError {
    /// The file could not be read.
    #[error("cannot read the flight {path}: {source}")]
    Read {
        /// The path as given.
        path: String,
        /// What the system said.
        source: std::io::Error,
    },
    /// A line is no keyframe.
    #[error("line {line} of the flight {flight} {fault}")]
    Line {
        /// Name of the flight.
        flight: String,
        /// Counted from one.
        line: usize,
        /// What is wrong with it.
        fault: String,
    },
    /// A way needs two ends.
    #[error(
        "the flight {flight} has {count} keyframes, and a way needs two; a line is SECONDS, EYE x y z, TARGET x y z, and DEGREES if they change"
    )]
    TooShort {
        /// Name of the flight.
        flight: String,
        /// How many there are.
        count: usize,
    },
    /// No file and no built-in flight goes by this name.
    #[error("there is no flight {name:?}: give a file, or one of the built-in flights: {known}")]
    Unknown {
        /// What was asked for.
        name: String,
        /// The built-in flights' names, separated by commas.
        known: String,
    },
}

/// Flights through built-in scenes, named after these.
const BUILTINS: [(&str, &str); 4] = [
    ("corridor", include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/flights/corridor.txt"))),
    ("two-rooms", include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/flights/two-rooms.txt"))),
    ("rooms", include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/flights/rooms.txt"))),
    ("maze", include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/flights/maze.txt"))),
];

impl Flight {
    /// A file, if there is one of this path, else a built-in flight.
    ///
    /// # Errors
    /// [`FlightError`], in one sentence.
    pub fn open(spec: &str) -> Result<Flight, FlightError> {
        let builtin = BUILTINS.iter().find(|(name, _)| *name == spec);
        let path = Path::new(spec);
        match builtin {
            Some((name, text)) if !path.is_file() => Flight::parse(name, text),
            None if !path.exists() && path.components().count() == 1 && path.extension().is_none() => {
                let known = Flight::builtin_names().collect::<Vec<_>>().join(", ");
                Err(FlightError::Unknown { name: spec.to_owned(), known })
            }
            _ => {
                let read = std::fs::read_to_string(path);
                let text = read.map_err(|source| FlightError::Read { path: spec.to_owned(), source })?;
                let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
                Flight::parse(&name, &text)
            }
        }
    }

    /// The names of the built-in flights.
    pub fn builtin_names() -> impl Iterator<Item = &'static str> {
        BUILTINS.iter().map(|(name, _)| *name)
    }

    /// A flight written down.
    ///
    /// # Errors
    /// The first line that is no keyframe, or fewer than two of them.
    pub fn parse(name: &str, text: &str) -> Result<Flight, FlightError> {
        let mut keys: Vec<Key> = Vec::new();
        for (index, line) in text.lines().enumerate() {
            let written = line.split('#').next().unwrap_or_default();
            let words: Vec<&str> = written.split_whitespace().collect();
            if words.is_empty() {
                continue;
            }
            let key = Key::parse(&words, keys.last());
            let key = key.map_err(|fault| FlightError::Line { flight: name.to_owned(), line: index + 1, fault })?;
            keys.push(key);
        }
        match keys.len() {
            count @ 0..2 => Err(FlightError::TooShort { flight: name.to_owned(), count }),
            _ => Ok(Flight { name: name.to_owned(), keys }),
        }
    }

    /// Time of the last keyframe, seconds.
    pub fn duration(&self) -> f64 {
        self.keys.last().map_or(0.0, |key| key.seconds)
    }

    /// What is seen at a time.
    pub fn view(&self, seconds: f64) -> CameraView {
        let [x, y, z, to_x, to_y, to_z, degrees] = self.values(seconds);
        let (eye, target) = (DVec3::new(x, y, z), DVec3::new(to_x, to_y, to_z));
        let vertical_fov = degrees.clamp(1.0, 179.0).to_radians();
        let projection = Projection::Perspective { vertical_fov, aspect: None, near: NEAR };
        let view = CameraView::look_at(eye, target, DVec3::Y, projection);
        CameraView { name: format!("flight {}", self.name), ..view }
    }

    fn values(&self, seconds: f64) -> [f64; 7] {
        let after = self.keys.partition_point(|key| key.seconds <= seconds);
        let (Some(before), Some(next)) = (after.checked_sub(1), self.keys.get(after)) else {
            let end = if after == 0 { self.keys.first() } else { self.keys.last() };
            return end.map_or([0.0; 7], |key| key.values);
        };
        let key = &self.keys[before];
        let length = next.seconds - key.seconds;
        let t = (seconds - key.seconds) / length;
        let slopes = [self.slopes(before), self.slopes(after)];
        std::array::from_fn(|lane| {
            hermite([key.values[lane], next.values[lane]], slopes.map(|slope| length * slope[lane]), t)
        })
    }

    /// The change a second at a keyframe: that of the parabola through it and its neighbours; none at the ends, where the camera stands.
    fn slopes(&self, index: usize) -> [f64; 7] {
        let neighbours = (index.checked_sub(1).and_then(|before| self.keys.get(before)), self.keys.get(index + 1));
        let (Some(before), Some(after)) = neighbours else { return [0.0; 7] };
        let key = &self.keys[index];
        let (since, until) = (key.seconds - before.seconds, after.seconds - key.seconds);
        std::array::from_fn(|lane| {
            let [earlier, later] =
                [(key.values[lane] - before.values[lane]) / since, (after.values[lane] - key.values[lane]) / until];
            (earlier * until + later * since) / (since + until)
        })
    }
}

impl Key {
    fn parse(words: &[&str], before: Option<&Key>) -> Result<Key, String> {
        let numbers: Result<Vec<f64>, String> = words
            .iter()
            .map(|word| {
                let number = word.parse().ok().filter(|number: &f64| number.is_finite());
                number.ok_or_else(|| format!("has {word:?} where a number belongs"))
            })
            .collect();
        let numbers = numbers?;
        let inherited = before.map_or(DEGREES, |key| key.values[6]);
        let (seconds, values) = match numbers[..] {
            [seconds, x, y, z, to_x, to_y, to_z] => (seconds, [x, y, z, to_x, to_y, to_z, inherited]),
            [seconds, x, y, z, to_x, to_y, to_z, degrees] => (seconds, [x, y, z, to_x, to_y, to_z, degrees]),
            _ => {
                let count = words.len();
                return Err(format!(
                    "has {count} numbers, not SECONDS, EYE x y z, TARGET x y z, and DEGREES if they change"
                ));
            }
        };
        let [x, y, z, to_x, to_y, to_z, degrees] = values;
        if seconds < 0.0 || before.is_some_and(|before| seconds <= before.seconds) {
            return Err(format!("is at {seconds} s, and times must grow from 0 or later"));
        }
        if !(1.0..=179.0).contains(&degrees) {
            return Err(format!("has an angle of {degrees} degrees, not 1 to 179"));
        }
        if DVec3::new(x, y, z).distance(DVec3::new(to_x, to_y, to_z)) < NEAREST_TARGET {
            return Err("looks at where its own eye is".to_owned());
        }
        Ok(Key { seconds, values })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO: &str = "# a way\n0 0 1 4  0 1 0  50\n\n2  1 1 4  0 1 0 # still 50\n";

    #[test]
    fn a_flight_passes_its_keyframes_and_rests_at_its_ends() {
        let flight = Flight::parse("two", TWO).expect("two keyframes");
        assert_eq!(flight.duration(), 2.0);
        let eye = |seconds| flight.view(seconds).world.translation;
        assert_eq!([-1.0, 0.0, 2.0, 9.0].map(eye).map(|eye| eye.x), [0.0, 0.0, 1.0, 1.0]);
        assert!((eye(1.0).x - 0.5).abs() < 1e-12 && (0.0..0.01).contains(&eye(0.1).x), "{}", eye(0.1));
        let view = flight.view(1.0);
        assert!((-view.world.matrix3.z_axis).dot((DVec3::Y - eye(1.0)).normalize()) > 1.0 - 1e-12);
        let Projection::Perspective { vertical_fov, .. } = view.projection else { panic!("{view:?}") };
        assert!((vertical_fov - 50_f64.to_radians()).abs() < 1e-12);
        assert!(view.world.matrix3.determinant() > 0.999 && view.world.matrix3.y_axis.y > 0.9);
    }

    /// What falls freely through unevenly spaced keyframes goes on so, and nothing jumps.
    #[test]
    fn between_keyframes_the_way_is_smooth() {
        let fall = "0 0 0 5 0 0 0\n1 1 0 5 1 0 0\n4 16 0 5 16 0 0\n5 25 0 5 25 0 0\n9 81 0 5 81 0 0\n";
        let flight = Flight::parse("fall", fall).expect("five keyframes");
        let x = |seconds: f64| flight.view(seconds).world.translation.x;
        for step in 10..50 {
            let seconds = 0.1 * f64::from(step);
            assert!((x(seconds) - seconds * seconds).abs() < 1e-9, "{seconds}: {}", x(seconds));
        }
        for step in 0..900 {
            let speed = 100.0 * (x(0.01 * f64::from(step + 1)) - x(0.01 * f64::from(step)));
            assert!((-1e-9..22.0).contains(&speed), "{step}: {speed}");
        }
    }

    #[test]
    fn what_is_no_flight_is_one_sentence() {
        let cases = [
            ("", "has 0 keyframes"),
            ("0 0 0 1 0 0 0", "has 1 keyframes"),
            ("0 0 0 1 0 0 0\n1 2 3", "line 2 of the flight way has 3 numbers"),
            ("0 0 0 one 0 0 0", "line 1 of the flight way has \"one\" where a number belongs"),
            ("0 0 0 inf 0 0 0", "\"inf\""),
            ("1 0 0 1 0 0 0\n1 0 0 2 0 0 0", "line 2 of the flight way is at 1 s"),
            ("-1 0 0 1 0 0 0", "times must grow"),
            ("0 0 0 1 0 0 0 0.5", "0.5 degrees"),
            ("# eye in it\n0 1 2 3 1 2 3", "line 2 of the flight way looks at where its own eye is"),
        ];
        for (text, words) in cases {
            let message = Flight::parse("way", text).expect_err(text).to_string();
            assert!(message.contains(words) && !message.contains('\n'), "{message}");
        }
        for (spec, words) in [("no-such", "two-rooms"), ("no/such.txt", "no/such.txt")] {
            let message = Flight::open(spec).expect_err(spec).to_string();
            assert!(message.contains(words) && !message.contains('\n'), "{message}");
        }
    }

    #[test]
    fn the_built_in_flights_last_half_a_minute() {
        for name in Flight::builtin_names() {
            let flight = Flight::open(name).expect(name);
            assert_eq!(flight.duration(), 30.0, "{name}");
        }
    }
}
