//! One image for the light maps of all surfaces: each side of a surface that has one lies in a rectangle of its own, with a margin around it.

use super::BakeError;
use crate::frame::rays::TriangleChart;

/// Texels a side, at most: more, and viewers refuse the image or make it smaller.
const LONGEST: u32 = 16_384;
/// The margin, texels: that of small surfaces, which are many, is as wide as these.
const MARGIN: u32 = 4;
/// Of the image's area, so much more than that of the rectangles is expected to be needed.
const SLACK: f64 = 1.05;

/// One side of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sheet {
    pub(super) surface: u32,
    /// 0: front, 1: back.
    pub(super) side: usize,
    /// Its first texel among those of the light maps; row by row.
    pub(super) first: u32,
    pub(super) size: [u32; 2],
    /// Where its first texel lies in the image.
    pub(super) place: [u32; 2],
}

impl Sheet {
    pub(super) fn texel_count(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// Nothing beside a sheet is read at its borders, where texels lie, as long as an image is not made smaller; the margin is for those that are.
    pub(super) fn margin(&self) -> u32 {
        self.size[0].max(self.size[1]).min(MARGIN)
    }

    /// The rectangle with its margin.
    fn outer(&self) -> [u32; 2] {
        self.size.map(|side| side + 2 * self.margin())
    }
}

/// The image.
pub(super) struct Atlas {
    pub(super) size: [u32; 2],
    pub(super) sheets: Vec<Sheet>,
    /// Of each surface, by side.
    by_surface: Vec<[Option<usize>; 2]>,
}

impl Atlas {
    /// For all triangles of a scene.
    ///
    /// # Errors
    /// They do not fit.
    pub(super) fn new(charts: &[Option<TriangleChart>]) -> Result<Atlas, BakeError> {
        let mut by_surface: Vec<[Option<usize>; 2]> = Vec::new();
        let mut sheets: Vec<Sheet> = Vec::new();
        for chart in charts.iter().flatten() {
            let number = chart.surface as usize;
            if by_surface.len() <= number {
                by_surface.resize(number + 1, [None; 2]);
            }
            for (side, first) in chart.firsts.into_iter().enumerate() {
                let Some(first) = first.filter(|_| by_surface[number][side].is_none()) else { continue };
                by_surface[number][side] = Some(sheets.len());
                sheets.push(Sheet { surface: chart.surface, side, first, size: chart.size, place: [0; 2] });
            }
        }
        let size = pack(&mut sheets)?;
        Ok(Atlas { size, sheets, by_surface })
    }

    /// The sheet of one side of a surface.
    pub(super) fn sheet(&self, surface: u32, side: usize) -> Option<usize> {
        *self.by_surface.get(surface as usize)?.get(side)?
    }

    pub(super) fn surface_count(&self) -> usize {
        self.by_surface.len()
    }

    /// Texture coordinates of a place on a sheet, in its texels.
    pub(super) fn coordinates(&self, sheet: usize, place: [f32; 2]) -> [f32; 2] {
        let Sheet { size, place: first, .. } = self.sheets[sheet];
        [0, 1].map(|axis| {
            let inside = f64::from(place[axis]).clamp(0.0, f64::from(size[axis] - 1));
            ((f64::from(first[axis]) + inside + 0.5) / f64::from(self.size[axis])) as f32
        })
    }
}

/// Gives each sheet its place, in shelves: the highest first. Returns the image's size.
fn pack(sheets: &mut [Sheet]) -> Result<[u32; 2], BakeError> {
    let mut order: Vec<usize> = (0..sheets.len()).collect();
    order.sort_by_key(|&number| {
        let [width, height] = sheets[number].outer();
        (std::cmp::Reverse((height, width)), number)
    });
    let outers = || sheets.iter().map(Sheet::outer);
    let area: f64 = outers().map(|[width, height]| f64::from(width) * f64::from(height)).sum();
    let widest = outers().map(|[width, _]| width).max().unwrap_or(1);
    let width = ((SLACK * area).sqrt().ceil() as u32).max(widest).next_multiple_of(4);
    let (mut at, mut shelf) = ([0_u32; 2], 0_u32);
    for number in order {
        let sheet = &mut sheets[number];
        let [outer_width, outer_height] = sheet.outer();
        if at[0] + outer_width > width {
            at = [0, at[1].saturating_add(shelf)];
            shelf = 0;
        }
        sheet.place = at.map(|start| start.saturating_add(sheet.margin()));
        at[0] += outer_width;
        shelf = shelf.max(outer_height);
    }
    let height = at[1].saturating_add(shelf).max(1).next_multiple_of(4);
    if width.max(height) > LONGEST {
        return Err(BakeError::TooLarge { width, height, most: LONGEST });
    }
    Ok([width, height])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn charts(sizes: &[[u32; 2]]) -> Vec<Option<TriangleChart>> {
        let mut first = 0;
        let chart = |(surface, size): (usize, &[u32; 2])| {
            let firsts = [Some(first), (surface % 3 == 0).then_some(first + size[0] * size[1])];
            first += 2 * size[0] * size[1];
            Some(TriangleChart { corners: [[0.0; 2]; 3], firsts, size: *size, surface: surface as u32 })
        };
        sizes.iter().enumerate().map(chart).chain([None]).collect()
    }

    #[test]
    fn sheets_lie_apart_and_waste_little() {
        let sizes: Vec<[u32; 2]> = (0..97_u32).map(|number| [1 + number * 7 % 31, 1 + number * 13 % 23]).collect();
        let atlas = Atlas::new(&charts(&sizes)).expect("they fit");
        assert_eq!((atlas.sheets.len(), atlas.surface_count()), (97 + 33, 97));
        let mut taken = vec![false; (atlas.size[0] * atlas.size[1]) as usize];
        for sheet in &atlas.sheets {
            let margin = sheet.margin();
            for y in 0..sheet.outer()[1] {
                for x in 0..sheet.outer()[0] {
                    let [column, row] = [sheet.place[0] + x - margin, sheet.place[1] + y - margin];
                    assert!(column < atlas.size[0] && row < atlas.size[1]);
                    assert!(!std::mem::replace(&mut taken[(row * atlas.size[0] + column) as usize], true), "{sheet:?}");
                }
            }
        }
        let used = taken.iter().filter(|taken| **taken).count() as f64 / taken.len() as f64;
        assert!(used > 0.8, "{used}");
    }

    /// Whole numbers are the middles of texels, and nothing lies outside.
    #[test]
    fn coordinates_are_those_of_texels() {
        let atlas = Atlas::new(&charts(&[[5, 3], [9, 9]])).expect("they fit");
        let sheet = atlas.sheet(0, 0).expect("a front");
        let [x, y] = atlas.sheets[sheet].place;
        let texel = |place: [f32; 2]| {
            let at = atlas.coordinates(sheet, place);
            [0, 1].map(|axis| at[axis] * atlas.size[axis] as f32)
        };
        let close =
            |found: [f32; 2], expected: [f32; 2]| (0..2).all(|axis| (found[axis] - expected[axis]).abs() < 1e-3);
        assert!(close(texel([0.0, 0.0]), [x as f32 + 0.5, y as f32 + 0.5]));
        assert!(close(texel([2.25, 1.0]), [x as f32 + 2.75, y as f32 + 1.5]));
        assert!(close(texel([-3.0, 7.0]), [x as f32 + 0.5, y as f32 + 2.5]));
        assert_eq!((atlas.sheet(1, 1), atlas.sheet(7, 0)), (None, None));
    }

    #[test]
    fn what_does_not_fit_is_said() {
        let message = Atlas::new(&charts(&[[20_000, 3]])).err().expect("too wide").to_string();
        assert!(message.contains("20008x") && message.contains("--texel"), "{message}");
    }
}
