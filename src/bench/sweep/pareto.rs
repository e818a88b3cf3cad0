//! The Pareto front: what nothing else beats in both time and error.

/// Which of some pairs, of which less is better, no other pair dominates: is no worse in both and better in one. Equal
/// pairs do not dominate each other. `None` and what is not finite takes no part.
pub fn pareto_front(pairs: &[Option<(f64, f64)>]) -> Vec<bool> {
    let finite = |pair: &&(f64, f64)| pair.0.is_finite() && pair.1.is_finite();
    let dominates = |a: &(f64, f64), b: &(f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
    let on_front = |pair: &Option<(f64, f64)>| {
        let Some(pair) = pair.as_ref().filter(finite) else { return false };
        !pairs.iter().flatten().filter(finite).any(|other| dominates(other, pair))
    };
    pairs.iter().map(on_front).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_of_known_points() {
        let front = |pairs: &[(f64, f64)]| pareto_front(&pairs.iter().copied().map(Some).collect::<Vec<_>>());
        assert_eq!(front(&[(1.0, 4.0), (2.0, 3.0), (3.0, 3.5), (4.0, 1.0)]), [true, true, false, true]);
        assert_eq!(front(&[(1.0, 2.0), (1.0, 1.0), (2.0, 1.0)]), [false, true, false], "ties in one count");
        assert_eq!(front(&[(1.0, 1.0), (1.0, 1.0)]), [true, true], "equal pairs stand side by side");
        assert!(front(&[]).is_empty());
    }

    #[test]
    fn what_has_no_error_takes_no_part() {
        let pairs = [None, Some((0.0, f64::NAN)), Some((f64::NAN, 0.0)), Some((5.0, 5.0)), Some((f64::INFINITY, 0.0))];
        assert_eq!(pareto_front(&pairs), [false, false, false, true, false]);
    }
}
