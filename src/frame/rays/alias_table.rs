//! Drawing one of many by weight with one look-up.

/// Vose 1991: every place holds one entry up to a threshold and another above it. Threshold and other entry of each place.
pub(super) fn alias_table(weights: &[f64], total: f64) -> Vec<(f32, u32)> {
    let count = weights.len();
    let mut shares: Vec<f64> = weights.iter().map(|weight| weight / total * count as f64).collect();
    let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..count).rev().partition(|&place| shares[place] < 1.0);
    let mut places: Vec<(f32, u32)> = (0_u32..).take(count).map(|place| (1.0, place)).collect();
    while let (Some(poor), Some(&rich)) = (small.pop(), large.last()) {
        places[poor] = (shares[poor] as f32, u32::try_from(rich).unwrap_or(0));
        shares[rich] -= 1.0 - shares[poor];
        if shares[rich] < 1.0 {
            large.pop();
            small.push(rich);
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_entry_is_drawn_by_its_weight() {
        let weights = [3.0, 0.5, 1.0, 7.5, 0.0, 1e-3];
        let total: f64 = weights.iter().sum();
        let mut drawn = [0.0; 6];
        for (place, (threshold, alias)) in alias_table(&weights, total).into_iter().enumerate() {
            drawn[place] += f64::from(threshold) / 6.0;
            drawn[alias as usize] += (1.0 - f64::from(threshold)) / 6.0;
        }
        for (drawn, weight) in drawn.iter().zip(weights) {
            assert!((drawn - weight / total).abs() < 1e-7, "{drawn} {weight}");
        }
        assert_eq!(drawn[4], 0.0, "what has no weight is never drawn");
    }

    #[test]
    fn equal_entries_keep_their_order() {
        for (place, (threshold, alias)) in alias_table(&[2.0; 4], 8.0).into_iter().enumerate() {
            assert!(threshold == 1.0 || alias as usize == place);
        }
    }
}
