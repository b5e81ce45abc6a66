//! Text in figures and around them: numbers, colours, what users wrote.

use plotters::style::RGBColor;

use crate::report::plot::thin::Interval;

/// `text` for use in HTML and SVG, in content and in quoted attributes.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// `#rrggbb`.
pub fn hex(colour: RGBColor) -> String {
    format!("#{:02x}{:02x}{:02x}", colour.0, colour.1, colour.2)
}

/// Three significant figures; a dash for what is no number.
pub fn figures(v: f64) -> String {
    if !v.is_finite() {
        return "–".to_owned();
    }
    let size = v.abs();
    let text = if size == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e6).contains(&size) {
        // As `trimmed` does without a power of ten.
        let text = format!("{v:.2e}");
        let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
        format!("{}e{power}", trimmed(mantissa))
    } else {
        let decimals = (2.0 - size.log10().floor()).clamp(0.0, 6.0) as usize;
        trimmed(&format!("{v:.decimals$}")).to_owned()
    };
    text.replace('-', "\u{2212}")
}

/// A value on an axis, with as many decimals as tell its neighbours apart.
pub(crate) fn number(v: f64, axis: Interval) -> String {
    // No axis has numbers closer to each other than this; what is much smaller is a zero with a
    // rounding error.
    let step = axis.size() / 10.0;
    let v = if v.abs() < 0.1 * step { 0.0 } else { v };
    let text = if axis.magnitude() >= 1e6 && v != 0.0 {
        format!("{v:.1e}")
    } else {
        let decimals = (-step.log10()).ceil().clamp(0.0, 9.0) as usize;
        trimmed(&format!("{v:.decimals$}")).to_owned()
    };
    text.replace('-', "\u{2212}")
}

/// Without zeros at the end of a fraction.
fn trimmed(number: &str) -> &str {
    if number.contains('.') {
        number.trim_end_matches('0').trim_end_matches('.')
    } else {
        number
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_cannot_leave_its_place() {
        assert_eq!(
            escape("<a b=\"c\">&'\0"),
            "&lt;a b=&quot;c&quot;&gt;&amp;&#39; "
        );
    }

    #[test]
    fn numbers_are_short_and_distinct() {
        let axis = |lo, hi| Interval { lo, hi };
        assert_eq!(
            number(0.30000000000000004, Interval { lo: 0.0, hi: 1.0 }),
            "0.3"
        );
        assert_eq!(number(-1e-17, Interval { lo: 0.0, hi: 1.0 }), "0");
        assert_eq!(number(-20_000.0, axis(-3e4, 0.0)), "\u{2212}20000");
        assert_eq!(number(2e6, axis(0.0, 4e6)), "2.0e6");
        assert_eq!(number(248.26, axis(248.0, 249.0)), "248.3");
        assert_eq!(number(248.25, axis(248.2, 248.4)), "248.25");
    }

    #[test]
    fn figures_are_three() {
        let cases = [
            (0.0, "0"),
            (19_683.2, "19683"),
            (6.4449, "6.44"),
            (8.4, "8.4"),
            (-0.0123, "\u{2212}0.0123"),
            (4.3e-15, "4.3e\u{2212}15"),
            (2.136e6, "2.14e6"),
            (f64::NAN, "–"),
        ];
        for (value, text) in cases {
            assert_eq!(figures(value), text);
        }
    }
}
