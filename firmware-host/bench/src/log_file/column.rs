//! A column of numbers, and how finely its file holds them.

/// Numbers of a column; NaN where there is none.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Column {
    pub(super) values: Vec<f64>,
    pub(super) held: Held,
    /// Why it is none of numbers.
    pub(super) wrong: Option<Wrong>,
}

/// What stands in a column that is no number.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Wrong {
    /// The first line, and its cell.
    Cell(u64, String),
    /// Numbers with an imaginary part.
    Complex,
}

/// How a file holds the numbers of a column.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) enum Held {
    Single,
    #[default]
    Double,
    /// Decimals of a text: at most so many places behind the point, and so many digits from the first that is not 0.
    Text {
        places: i32,
        digits: i32,
    },
    /// Found out before the numbers were multiplied.
    Known(Step),
}

/// Resolution of a column: how far apart two neighbouring numbers are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Step {
    pub(super) size: f64,
    /// Whether numbers may stand exactly on such steps, as counts and decimals do; rounded in binary they do not.
    pub(super) decimal: bool,
}

impl Held {
    /// With another cell of a text.
    pub(super) fn with_cell(self, cell: &str) -> Self {
        let (mantissa, exponent) = cell.split_once(['e', 'E']).unwrap_or((cell, "0"));
        let (whole, part) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let count = |n: usize| i32::try_from(n).unwrap_or(i32::MAX);
        let of_cell = (
            count(part.len()).saturating_sub(exponent.parse().unwrap_or(0)),
            count(
                (whole
                    .chars()
                    .chain(part.chars())
                    .filter(char::is_ascii_digit))
                .skip_while(|c| *c == '0')
                .count(),
            ),
        );
        let (places, digits) = match self {
            Self::Text { places, digits } => (places.max(of_cell.0), digits.max(of_cell.1)),
            _ => of_cell,
        };
        Self::Text { places, digits }
    }
}

impl Column {
    pub(super) fn new(values: Vec<f64>, held: Held) -> Self {
        Self {
            values,
            held,
            wrong: None,
        }
    }

    /// In another unit.
    pub(super) fn times(mut self, factor: f64) -> Self {
        if factor != 1.0 {
            let Step { size, decimal } = self.step();
            let size = size * factor.abs();
            self.held = Held::Known(Step { size, decimal });
            self.values.iter_mut().for_each(|x| *x *= factor);
        }
        self
    }

    /// Where its numbers are largest.
    pub(super) fn step(&self) -> Step {
        let finite = || self.values.iter().copied().filter(|x| x.is_finite());
        let largest = finite().fold(0.0_f64, |most, x| most.max(x.abs()));
        let counts = finite().all(|x| x.fract() == 0.0);
        let decimals = |x: f64| match self.held {
            _ if counts => 1.0,
            Held::Text { places, digits } => {
                let first = x.abs().max(f64::MIN_POSITIVE).log10().floor();
                let last = first + 1.0 - f64::from(digits);
                10_f64.powi(-places).max(10_f64.powf(last))
            }
            _ => 0.0,
        };
        // Single precision is often written out as double or as text.
        let single = |x: f64| (x - f64::from(x as f32)).abs() <= 0.5 * decimals(x);
        let binary = match self.held {
            Held::Known(step) => return step,
            Held::Single => f64::from((largest as f32).next_up() - largest as f32),
            _ if !counts && finite().all(single) => {
                f64::from((largest as f32).next_up() - largest as f32)
            }
            _ => largest.next_up() - largest,
        };
        let decimal = decimals(largest);
        Step {
            size: decimal.max(binary),
            decimal: decimal >= binary,
        }
    }
}
