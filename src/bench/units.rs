//! Numbers as people read them: three digits and a unit.

/// Milliseconds with about three digits that count: `0.123`, `12.3`, `1234`.
pub(crate) fn milliseconds(value: f64) -> String {
    let magnitude = value.abs();
    let decimals = if magnitude < 9.9995 {
        3
    } else if magnitude < 99.995 {
        2
    } else if magnitude < 999.95 {
        1
    } else {
        0
    };
    format!("{value:.decimals$}")
}

/// A count: `999`, `1.2 k`, `262 k`, `1.2 M`, `3.4 G`.
pub(crate) fn count(value: u64) -> String {
    scaled(value as f64, 1000.0, &["", " k", " M", " G", " T", " P", " E"])
}

/// Bytes in powers of 1024: `512 B`, `1.5 KiB`, `120 MiB`.
pub(crate) fn bytes(value: u64) -> String {
    scaled(value as f64, 1024.0, &[" B", " KiB", " MiB", " GiB", " TiB", " PiB", " EiB"])
}

/// A share of one as a percentage: `12.3 %`.
pub(crate) fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// An error with three digits that count: `0.0123`, `12.3`, `1.23e-5`, `∞`.
pub(crate) fn error(value: f64) -> String {
    if value == 0.0 || value.is_infinite() {
        return if value == 0.0 { "0" } else { "∞" }.to_owned();
    }
    // Rounded first, so that 0.99996 counts as 1.00.
    let rounded = format!("{value:.2e}");
    let exponent = rounded.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    match exponent {
        Some(exponent @ -3..=2) => format!("{value:.*}", (2 - exponent) as usize),
        _ => rounded,
    }
}

fn scaled(value: f64, step: f64, units: &[&str]) -> String {
    let (mut value, mut unit) = (value, 0);
    // 999.5 would print as 1000 of the smaller unit.
    while value >= if unit == 0 { step } else { step - 0.5 } && unit + 1 < units.len() {
        value /= step;
        unit += 1;
    }
    let decimals = if unit == 0 || value >= 99.95 { 0 } else { 1 };
    format!("{value:.decimals$}{}", units[unit])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_and_a_unit() {
        assert_eq!(
            [0.0, 0.1234, 9.9996, 45.678, 456.78, 45678.9].map(milliseconds),
            ["0.000", "0.123", "10.00", "45.68", "456.8", "45679"]
        );
        assert_eq!(
            [0, 999, 1000, 1234, 262_267, 999_999, 1_200_000].map(count),
            ["0", "999", "1.0 k", "1.2 k", "262 k", "1.0 M", "1.2 M"]
        );
        assert_eq!(count(u64::MAX), "18.4 E");
        assert_eq!([0, 1023, 1024, 1536, 120 << 20].map(bytes), ["0 B", "1023 B", "1.0 KiB", "1.5 KiB", "120 MiB"]);
        assert_eq!(percent(0.1234), "12.3 %");
    }

    #[test]
    fn errors_have_three_digits_at_any_scale() {
        let errors = [0.0, 1.234e-5, 9.999e-4, 0.001_234, 0.012_34, 0.999_6, 1.5, 123.4, 12_345.6, f64::INFINITY];
        let expected = ["0", "1.23e-5", "0.00100", "0.00123", "0.0123", "1.00", "1.50", "123", "1.23e4", "∞"];
        assert_eq!(errors.map(error), expected);
    }
}
