//! Texels from their neighbours: those that nobody knows, and those that are noisy.

/// Fills a rectangle, row by row, ring by ring: each unknown texel is the mean of the known ones around it. `known` is true everywhere afterwards, unless nothing was known.
pub(super) fn fill<const N: usize>(values: &mut [[f32; N]], known: &mut [bool], size: [u32; 2]) {
    let around = |place: usize| {
        let [width, height] = size.map(|side| side as usize);
        let (x, y) = (place % width, place / width);
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        rows.flat_map(move |row| (x.saturating_sub(1)..(x + 2).min(width)).map(move |column| row * width + column))
    };
    let mut ring: Vec<usize> =
        (0..values.len()).filter(|&place| !known[place] && around(place).any(|other| known[other])).collect();
    while !ring.is_empty() {
        for &place in &ring {
            let of: Vec<usize> = around(place).filter(|&other| known[other]).collect();
            let mean = |channel: usize| of.iter().map(|&other| values[other][channel]).sum::<f32>() / of.len() as f32;
            values[place] = std::array::from_fn(mean);
        }
        ring.iter().for_each(|&place| known[place] = true);
        let mut next: Vec<usize> = ring.iter().flat_map(|&place| around(place)).filter(|&it| !known[it]).collect();
        next.sort_unstable();
        next.dedup();
        ring = next;
    }
}

/// The means of the known texels of a rectangle over squares that reach so far to either side of each texel, and those means' means over the same squares.
pub(super) fn smoothed(values: &[[f32; 3]], known: &[bool], size: [u32; 2], reach: u32) -> Vec<[f32; 3]> {
    if values.iter().flatten().all(|&value| value == 0.0) {
        return values.to_vec();
    }
    let weighted = |(value, known): (&[f32; 3], &bool)| {
        let weight = f32::from(u8::from(*known));
        [weight * value[0], weight * value[1], weight * value[2], weight]
    };
    let mut sums: Vec<[f32; 4]> = values.iter().zip(known).map(weighted).collect();
    for _ in 0..2 {
        for axis in 0..2 {
            sums = along(&sums, size, axis, reach as usize);
        }
    }
    let mean = |[red, green, blue, weight]: &[f32; 4]| [red, green, blue].map(|sum| sum / weight.max(1e-30));
    sums.iter().map(mean).collect()
}

/// Means along rows (0) or columns (1); beyond the border there is nothing.
fn along(values: &[[f32; 4]], size: [u32; 2], axis: usize, reach: usize) -> Vec<[f32; 4]> {
    let [width, height] = size.map(|side| side as usize);
    let (length, step) = if axis == 0 { (width, 1) } else { (height, width) };
    let of = |place: usize| {
        let at = if axis == 0 { place % width } else { place / width };
        let range = at.saturating_sub(reach)..(at + reach + 1).min(length);
        let start = place - at * step;
        let scale = 1.0 / (2 * reach + 1) as f32;
        range.fold([0.0; 4], |sum: [f32; 4], other| {
            std::array::from_fn(|channel| sum[channel] + scale * values[start + other * step][channel])
        })
    };
    (0..values.len()).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is even stays so up to borders and holes, and a bright texel keeps its sum.
    #[test]
    fn smoothing_keeps_what_is_even_and_sums() {
        let size = [9, 7];
        let mut known = vec![true; 63];
        (known[3], known[40]) = (false, false);
        let even = smoothed(&vec![[2.0, 1.0, 0.5]; 63], &known, size, 2);
        assert!(even.iter().all(|it| (it[0] - 2.0).abs() < 1e-5 && (it[2] - 0.5).abs() < 1e-5), "{even:?}");
        let mut spot = vec![[0.0; 3]; 31 * 31];
        spot[15 * 31 + 15] = [961.0; 3];
        let spread = smoothed(&spot, &vec![true; 31 * 31], [31, 31], 3);
        let sum: f32 = spread.iter().map(|it| it[0]).sum();
        assert!((sum / 961.0 - 1.0).abs() < 1e-4, "{sum}");
        assert!((spread[15 * 31 + 15][0] / 961.0 - 1.0 / 49.0).abs() < 1e-4);
    }

    #[test]
    fn the_nearest_known_ones_decide() {
        let mut values = vec![[0.0_f32]; 7 * 2];
        let mut known = vec![false; 14];
        (values[0], known[0]) = ([4.0], true);
        (values[13], known[13]) = ([8.0], true);
        fill(&mut values, &mut known, [7, 2]);
        assert!(known.iter().all(|known| *known));
        assert_eq!([values[1], values[2], values[7], values[6], values[4]], [[4.0], [4.0], [4.0], [8.0], [8.0]]);
        assert_eq!(values[3], [6.0], "as near to both");
        let (mut nothing, mut unknown) = (vec![[1.0_f32]; 4], vec![false; 4]);
        fill(&mut nothing, &mut unknown, [2, 2]);
        assert_eq!((nothing, unknown), (vec![[1.0]; 4], vec![false; 4]));
    }
}
