//! What plots are drawn with: colours, type, lines and markers, by way of plotters' SVG backend.

use plotters::coord::Shift;
use plotters::drawing::DrawingAreaErrorKind;
use plotters::element::{Circle, PathElement, Polygon, Rectangle, Text};
use plotters::prelude::{Color, DrawingArea, IntoDrawingArea, RGBColor, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontFamily, FontStyle, ShapeStyle, TextStyle};

pub(in crate::bench) const INK: RGBColor = RGBColor(34, 34, 34);
pub(in crate::bench) const FAINT_INK: RGBColor = RGBColor(102, 102, 102);
pub(in crate::bench) const GRID: RGBColor = RGBColor(214, 214, 214);
pub(in crate::bench) const FAINT_GRID: RGBColor = RGBColor(238, 238, 238);
const PAPER: RGBColor = RGBColor(255, 255, 255);
/// Okabe and Ito's colours, told apart with any kind of colour vision, without the yellow that is lost on white paper.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(60, 60, 60),
];

/// In pixels from the upper left corner.
pub(in crate::bench) type Point = (i32, i32);
pub(in crate::bench) type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// An SVG on white paper.
pub(in crate::bench) struct Canvas<'a>(DrawingArea<SVGBackend<'a>, Shift>);

impl<'a> Canvas<'a> {
    /// Draws into `text`, which holds the whole document once [`present`](Canvas::present) has been called.
    pub(in crate::bench) fn new(text: &'a mut String, size: (u32, u32)) -> Canvas<'a> {
        Canvas(SVGBackend::with_string(text, size).into_drawing_area())
    }

    /// White all over, before anything else is drawn.
    pub(in crate::bench) fn blank(&self) -> Drawn {
        self.0.fill(&PAPER)
    }

    /// Ends the document.
    pub(in crate::bench) fn present(&self) -> Drawn {
        self.0.present()
    }

    /// Series differ in shape as well as colour.
    pub(in crate::bench) fn marker(&self, at: Point, series: usize) -> Drawn {
        let style = colour(series).filled();
        let polygon = |corners: &[Point]| {
            let corners: Vec<Point> = corners.iter().map(|(x, y)| (at.0 + x, at.1 + y)).collect();
            self.0.draw(&Polygon::new(corners, style))
        };
        match series % 5 {
            0 => self.0.draw(&Circle::new(at, 5, style)),
            1 => self.0.draw(&Rectangle::new([(at.0 - 4, at.1 - 4), (at.0 + 5, at.1 + 5)], style)),
            2 => polygon(&[(0, -6), (6, 5), (-6, 5)]),
            3 => polygon(&[(0, -6), (6, 0), (0, 6), (-6, 0)]),
            _ => polygon(&[(0, 6), (6, -5), (-6, -5)]),
        }
    }

    pub(in crate::bench) fn ring(&self, at: Point) -> Drawn {
        self.0.draw(&Circle::new(at, 9, PAPER.filled()))?;
        self.0.draw(&Circle::new(at, 9, ShapeStyle::from(INK).stroke_width(1)))
    }

    pub(in crate::bench) fn path(&self, points: &[Point], colour: RGBColor, width: u32) -> Drawn {
        if points.len() < 2 {
            return Ok(());
        }
        self.0.draw(&PathElement::new(points.to_vec(), ShapeStyle::from(colour).stroke_width(width)))
    }

    /// A filled shape.
    pub(in crate::bench) fn area(&self, corners: &[Point], colour: RGBColor) -> Drawn {
        self.0.draw(&Polygon::new(corners.to_vec(), colour.filled()))
    }

    pub(in crate::bench) fn dashed(&self, points: &[Point], colour: RGBColor) -> Drawn {
        for pair in points.windows(2) {
            let (dx, dy) = (f64::from(pair[1].0 - pair[0].0), f64::from(pair[1].1 - pair[0].1));
            let length = dx.hypot(dy);
            let at = |along: f64| {
                let share = (along / length).min(1.0);
                (pair[0].0 + (share * dx).round() as i32, pair[0].1 + (share * dy).round() as i32)
            };
            for dash in 0..(length / 8.0).ceil() as u32 {
                let start = 8.0 * f64::from(dash);
                self.path(&[at(start), at(start + 4.0)], colour, 1)?;
            }
        }
        Ok(())
    }

    pub(in crate::bench) fn text(&self, at: Point, text: &str, style: &TextStyle<'_>, horizontal: HPos) -> Drawn {
        self.0.draw(&Text::new(text.to_owned(), at, style.pos(Pos::new(horizontal, VPos::Center))))
    }
}

pub(in crate::bench) fn colour(series: usize) -> RGBColor {
    COLOURS[series % COLOURS.len()]
}

/// Thin strokes of the paler colours would be hard to read.
pub(in crate::bench) fn darker(RGBColor(red, green, blue): RGBColor) -> RGBColor {
    let darker = |channel: u8| (f64::from(channel) * 0.75) as u8;
    RGBColor(darker(red), darker(green), darker(blue))
}

pub(in crate::bench) fn title() -> TextStyle<'static> {
    font(18.0, FontStyle::Bold, INK)
}

pub(in crate::bench) fn body(colour: RGBColor) -> TextStyle<'static> {
    font(13.0, FontStyle::Normal, colour)
}

pub(in crate::bench) fn small(colour: RGBColor) -> TextStyle<'static> {
    font(12.0, FontStyle::Normal, colour)
}

/// Of so many pixels; the backend divides by 1.24.
fn font(pixels: f64, style: FontStyle, colour: RGBColor) -> TextStyle<'static> {
    let style = TextStyle::from((FontFamily::SansSerif, 1.24 * pixels, style));
    TextStyle { color: colour.to_backend_color(), ..style }
}
