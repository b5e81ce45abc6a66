//! Results in text, without `core::fmt`, which can panic: lines of a name and a value on the host's output.

use super::exit;
use cortex_m_semihosting::hio;

/// A line of a name and a number.
pub fn number(name: &str, value: u32) {
    // Least digit last; a number of 32 bits has ten at most.
    let mut digits = [b'0'; 10];
    let mut rest = value;
    let mut count = 0;
    for digit in digits.iter_mut().rev() {
        *digit = b'0' + (rest % 10) as u8;
        rest /= 10;
        count += 1;
        if rest == 0 {
            break;
        }
    }
    line(name, digits.get(digits.len() - count..).unwrap_or(&[]));
}

/// A line of a name and 64 bits, hexadecimal.
pub fn bits(name: &str, value: u64) {
    let mut digits = [0; 16];
    let mut rest = value;
    for digit in digits.iter_mut().rev() {
        let nibble = (rest & 15) as u8;
        *digit = if nibble < 10 {
            b'0' + nibble
        } else {
            b'a' + nibble - 10
        };
        rest >>= 4;
    }
    line(name, &digits);
}

/// A line of a name and a text.
pub fn text(name: &str, value: &str) {
    line(name, value.as_bytes());
}

/// Says why, and ends.
pub fn failed(why: &str) -> ! {
    text("failed", why);
    exit::failure()
}

fn line(name: &str, value: &[u8]) {
    let Ok(mut output) = hio::hstdout() else {
        exit::failure()
    };
    for part in [name.as_bytes(), b" ", value, b"\n"] {
        if output.write_all(part).is_err() {
            exit::failure();
        }
    }
}
