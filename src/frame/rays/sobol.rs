//! The Sobol' points that glsl/lib/sobol.glsl scrambles.

/// Points in the table.
const POINTS: u32 = 1 << 12;

/// The first 4096 points of the first four dimensions, the bits of each coordinate reversed: the generator matrices of the primitive
/// polynomials 1, x + 1, x² + x + 1 and x³ + x + 1 with the initial numbers of Joe & Kuo 2008.
pub(super) fn sobol_points() -> Vec<[u32; 4]> {
    let directions = [
        std::array::from_fn(|bit| 1 << (31 - bit)),
        directions(&[1], 0),
        directions(&[1, 3], 1),
        directions(&[1, 3, 1], 1),
    ];
    let point = |index: u32| {
        directions.map(|directions: [u32; 32]| {
            let bits = (0..12).filter(|bit| index >> bit & 1 == 1).fold(0, |bits, bit| bits ^ directions[bit]);
            bits.reverse_bits()
        })
    };
    (0..POINTS).map(point).collect()
}

/// The recurrence of Bratley & Fox 1988 for a polynomial of degree `initial.len()` whose inner coefficients are the bits of `inner`.
fn directions(initial: &[u32], inner: u32) -> [u32; 32] {
    let degree = initial.len();
    let mut directions = [0_u32; 32];
    for bit in 0..32 {
        directions[bit] = if bit < degree {
            initial[bit] << (31 - bit)
        } else {
            let mut value = directions[bit - degree] ^ (directions[bit - degree] >> degree);
            for step in 1..degree {
                if inner >> (degree - 1 - step) & 1 == 1 {
                    value ^= directions[bit - step];
                }
            }
            value
        };
    }
    directions
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every elementary interval in base 2 of area 2^-m holds exactly one of the first 2^m points, for the pairs of dimensions that
    /// are (0, m, 2)-nets; all four are one-dimensionally stratified.
    #[test]
    fn the_points_are_stratified() {
        let points: Vec<[u32; 4]> = sobol_points().iter().map(|point| point.map(u32::reverse_bits)).collect();
        let m = 8;
        for dimension in 0..4 {
            let mut cells: Vec<u32> = points[..1 << m].iter().map(|point| point[dimension] >> (32 - m)).collect();
            cells.sort_unstable();
            cells.dedup();
            assert_eq!(cells.len(), 1 << m, "dimension {dimension}");
        }
        for split in 0..=m {
            let cell = |point: &[u32; 4]| {
                let part = |value: u32, bits: u32| if bits == 0 { 0 } else { value >> (32 - bits) };
                (part(point[0], split), part(point[1], m - split))
            };
            let mut cells: Vec<_> = points[..1 << m].iter().map(cell).collect();
            cells.sort_unstable();
            cells.dedup();
            assert_eq!(cells.len(), 1 << m, "split {split}");
        }
    }
}
