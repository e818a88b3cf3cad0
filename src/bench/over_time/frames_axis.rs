//! What both plots of a sequence have in common: frames to the right, a grid, titles.

use plotters::style::FontTransform;
use plotters::style::text_anchor::HPos;

use super::axis::{LinearAxis, label};
use crate::bench::report::Run;
use crate::bench::sweep::canvas::{Canvas, Drawn, FAINT_INK, GRID, INK, body, small, title};
use crate::bench::sweep::chart::Area;

pub(super) const WIDTH: u32 = 860;
pub(super) const LEFT: i32 = 78;
pub(super) const RIGHT: i32 = 800;

/// The axis of the frames of a run.
pub(super) fn frames_axis(frames: usize) -> LinearAxis {
    LinearAxis::new([0.0, frames.saturating_sub(1) as f64], [LEFT, RIGHT])
}

impl Canvas<'_> {
    /// The title, and what is shown.
    pub(super) fn sequence_head(&self, run: &Run, what: &str) -> Drawn {
        let Some(over_time) = &run.over_time else { return Ok(()) };
        let ([width, height], frames) = (run.size, over_time.frames.len());
        let heading = format!("{}, {}, {width} × {height} pixels", run.scene, run.camera);
        self.text((LEFT, 24), &heading, &title(), HPos::Left)?;
        self.text((LEFT, 45), what, &body(INK), HPos::Left)?;
        let sequence = format!("{frames} frames, {} a second", label(over_time.fps));
        self.text((LEFT, 63), &sequence, &small(FAINT_INK), HPos::Left)
    }

    /// Frame numbers below a panel; their name too below the last one.
    pub(super) fn frame_ticks(&self, panel: &Area, x: &LinearAxis, named: bool) -> Drawn {
        for frame in x.ticks(true) {
            let at = x.place(frame);
            self.path(&[(at, panel.bottom), (at, panel.bottom + 5)], INK, 1)?;
            self.text((at, panel.bottom + 16), &label(frame), &body(INK), HPos::Center)?;
        }
        self.path(&[(panel.left, panel.top), (panel.left, panel.bottom), (panel.right, panel.bottom)], INK, 1)?;
        if named {
            self.text(((panel.left + panel.right) / 2, panel.bottom + 38), "frame", &body(INK), HPos::Center)?;
        }
        Ok(())
    }

    /// Values at the left of a panel, a line across it for each, and what they are of.
    pub(super) fn value_ticks(&self, panel: &Area, ticks: impl Iterator<Item = (i32, String)>, name: &str) -> Drawn {
        for (at, written) in ticks {
            self.path(&[(panel.left, at), (panel.right, at)], GRID, 1)?;
            self.path(&[(panel.left - 5, at), (panel.left, at)], INK, 1)?;
            self.text((panel.left - 9, at), &written, &body(INK), HPos::Right)?;
        }
        let upright = body(INK).transform(FontTransform::Rotate270);
        self.text((20, (panel.top + panel.bottom) / 2), name, &upright, HPos::Center)
    }
}
