//! Units in the base units of the International System, as the interface wants them.

/// Exponents of kg, m, s, A, K and rad, and how many of them the unit is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BaseUnits {
    pub(crate) exponents: [i32; 6],
    pub(crate) factor: f64,
}

/// Names of the exponents, as attributes.
pub(crate) const NAMES: [&str; 6] = ["kg", "m", "s", "A", "K", "rad"];

/// Symbols that units are written with.
const SYMBOLS: &[(&str, [i32; 6])] = &[
    ("kg", [1, 0, 0, 0, 0, 0]),
    ("m", [0, 1, 0, 0, 0, 0]),
    ("s", [0, 0, 1, 0, 0, 0]),
    ("A", [0, 0, 0, 1, 0, 0]),
    ("K", [0, 0, 0, 0, 1, 0]),
    ("rad", [0, 0, 0, 0, 0, 1]),
    ("1", [0; 6]),
    ("N", [1, 1, -2, 0, 0, 0]),
    ("J", [1, 2, -2, 0, 0, 0]),
    ("W", [1, 2, -3, 0, 0, 0]),
    ("V", [1, 2, -3, -1, 0, 0]),
    ("Ω", [1, 2, -3, -2, 0, 0]),
    ("H", [1, 2, -2, -2, 0, 0]),
    ("Hz", [0, 0, -1, 0, 0, 0]),
];

/// A unit such as `N s/m`, `kg m²` or `N/(m s)`; `None` of what is no unit of the system, as samples.
pub(crate) fn base_units(unit: &str) -> Option<BaseUnits> {
    if unit == "°" {
        return Some(BaseUnits {
            exponents: [0, 0, 0, 0, 0, 1],
            factor: 1f64.to_radians(),
        });
    }
    let mut exponents = [0; 6];
    for (side, sign) in unit.splitn(2, '/').zip([1, -1]) {
        for symbol in side.trim_matches(['(', ')']).split(' ') {
            let (symbol, power) = match symbol.strip_suffix('²') {
                Some(symbol) => (symbol, 2),
                None => (symbol, 1),
            };
            let (_, of_symbol) = SYMBOLS.iter().find(|(name, _)| *name == symbol)?;
            for (sum, exponent) in exponents.iter_mut().zip(of_symbol) {
                *sum += sign * power * exponent;
            }
        }
    }
    let factor = 1.0;
    Some(BaseUnits { exponents, factor })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_products_of_base_units() {
        let of = |unit| base_units(unit).map(|u| u.exponents);
        assert_eq!(of("m/s²"), Some([0, 1, -2, 0, 0, 0]));
        assert_eq!(of("N s/m"), Some([1, 0, -1, 0, 0, 0]));
        assert_eq!(of("N/(m s)"), Some([1, 0, -3, 0, 0, 0]));
        assert_eq!(of("kg m²"), Some([1, 2, 0, 0, 0, 0]));
        assert_eq!(of("V"), of("W").map(|w| [w[0], w[1], w[2], -1, 0, 0]));
        assert_eq!((of("samples"), of("N/mⁿ")), (None, None));
    }
}
