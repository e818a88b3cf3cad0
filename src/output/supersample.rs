//! Supersampling: means of blocks of pixels.

use crate::image::ColorImage;

/// The image with `factor` by `factor` pixels averaged into one; sides are divided by `factor`, what is left over is cut off.
pub fn box_reduced(image: &ColorImage, factor: u32) -> ColorImage {
    let factor = factor.max(1);
    let size = image.size.map(|side| side / factor);
    let scale = 1.0 / f64::from(factor * factor);
    let mean = |column: u32, row: u32| {
        let mut sum = [0.0_f64; 3];
        for y in row * factor..(row + 1) * factor {
            for x in column * factor..(column + 1) * factor {
                let pixel = image.pixels[y as usize * image.size[0] as usize + x as usize];
                sum = [0, 1, 2].map(|channel| sum[channel] + f64::from(pixel[channel]));
            }
        }
        sum.map(|value| (value * scale) as f32)
    };
    let pixels = (0..size[1]).flat_map(|row| (0..size[0]).map(move |column| (column, row)));
    ColorImage { size, pixels: pixels.map(|(column, row)| mean(column, row)).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_averaged() {
        let pixels = (0..16).map(|index| [index as f32, 1.0, 0.0]).collect();
        let reduced = box_reduced(&ColorImage { size: [4, 4], pixels }, 2);
        assert_eq!(reduced.size, [2, 2]);
        assert_eq!(reduced.pixels, [[2.5, 1.0, 0.0], [4.5, 1.0, 0.0], [10.5, 1.0, 0.0], [12.5, 1.0, 0.0]]);
    }
}
