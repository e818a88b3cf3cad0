//! Textures read as shaders read them: the finest level, filtered and wrapped (glsl/lib/texels.glsl).

use std::ops::RangeInclusive;
use std::sync::LazyLock;

use super::material::{Texture, Wrap, srgb_to_linear};

static SRGB: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|byte| srgb_to_linear(byte as f32 / 255.0)));

impl Texture {
    /// What a sampler gives at (u, v): linear RGBA.
    pub(super) fn sample(&self, uv: [f32; 2]) -> [f32; 4] {
        let [(x, part_x), (y, part_y)] = [0, 1].map(|axis| self.place(axis, uv[axis]));
        let texel = |column: i64, row: i64| {
            let at = self.wrapped(1, row) * self.width as usize + self.wrapped(0, column);
            self.decoded(&self.rgba8[4 * at..4 * at + 4])
        };
        if self.nearest {
            return texel(x, y);
        }
        let mut sum = [0.0; 4];
        for (column, row) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let weight = if column == 0 { 1.0 - part_x } else { part_x } * if row == 0 { 1.0 - part_y } else { part_y };
            if weight > 0.0 {
                let texel = texel(x + column, y + row);
                sum = std::array::from_fn(|channel| sum[channel] + weight * texel[channel]);
            }
        }
        sum
    }

    /// Whether any texel that samples within a box of texture coordinates can read passes a test.
    pub(super) fn any_texel(&self, low: [f32; 2], high: [f32; 2], test: impl Fn(&[u8]) -> bool) -> bool {
        let [columns, rows] = [0, 1].map(|axis| self.texels_of(axis, low[axis], high[axis]));
        let width = self.width as usize;
        rows.into_iter().any(|row| {
            let row = row * width * 4;
            let texels = &self.rgba8[row + columns.start() * 4..row + (columns.end() + 1) * 4];
            texels.chunks_exact(4).any(&test)
        })
    }

    fn size(&self, axis: usize) -> u32 {
        if axis == 0 { self.width } else { self.height }
    }

    /// The lower of the texels that a coordinate lies between, before wrapping, and the weight of the upper one.
    fn place(&self, axis: usize, coordinate: f32) -> (i64, f32) {
        let place = coordinate * self.size(axis) as f32 - if self.nearest { 0.0 } else { 0.5 };
        // As in the shader, which converts to 32-bit integers.
        let place = place.clamp(-1e9, 1e9);
        let low = place.floor();
        (low as i64, place - low)
    }

    fn wrapped(&self, axis: usize, texel: i64) -> usize {
        let size = i64::from(self.size(axis));
        let inside = match self.wrap[axis] {
            Wrap::Clamp => texel.clamp(0, size - 1),
            Wrap::Repeat => texel.rem_euclid(size),
            Wrap::Mirror => {
                let inside = texel.rem_euclid(2 * size);
                inside.min(2 * size - 1 - inside)
            }
        };
        inside as usize
    }

    /// The columns or rows that samples between two coordinates read, one more on both sides for what rounding does; all of them
    /// where the interval crosses a border of the texture.
    fn texels_of(&self, axis: usize, low: f32, high: f32) -> RangeInclusive<usize> {
        let size = i64::from(self.size(axis));
        let (low, high) = (self.place(axis, low).0 - 1, self.place(axis, high).0 + 2);
        let within = match self.wrap[axis] {
            Wrap::Clamp => true,
            Wrap::Repeat | Wrap::Mirror => low.div_euclid(size) == high.div_euclid(size),
        };
        if !within {
            return 0..=size as usize - 1;
        }
        let ends = [self.wrapped(axis, low), self.wrapped(axis, high)];
        ends[0].min(ends[1])..=ends[0].max(ends[1])
    }

    fn decoded(&self, texel: &[u8]) -> [f32; 4] {
        std::array::from_fn(|channel| {
            let byte = texel[channel];
            if self.srgb && channel < 3 { SRGB[usize::from(byte)] } else { f32::from(byte) / 255.0 }
        })
    }
}
