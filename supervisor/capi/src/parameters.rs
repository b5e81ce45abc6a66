//! Texts of the parameters as C wants them, ended by a zero byte: one pool, laid out at compile time.

use core::ffi::CStr;
use supervisor::{PARAMETERS, Parameter};

/// Texts of one parameter.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Texts {
    pub(crate) name: &'static CStr,
    pub(crate) unit: &'static CStr,
    pub(crate) text: &'static CStr,
    /// What to say when its value is outside its range.
    pub(crate) error: &'static CStr,
}

/// Texts of the parameter of this index.
pub(crate) fn texts(index: usize) -> Option<Texts> {
    let at = |offset: u16| {
        let rest = POOL.get(usize::from(offset)..)?;
        CStr::from_bytes_until_nul(rest).ok()
    };
    let [name, unit, text, error] = *OFFSETS.get(index)?;
    Some(Texts {
        name: at(name)?,
        unit: at(unit)?,
        text: at(text)?,
        error: at(error)?,
    })
}

const LENGTH: usize = Pool::<0>::filled().length;
static POOL: [u8; LENGTH] = Pool::<LENGTH>::filled().bytes;
static OFFSETS: [[u16; 4]; PARAMETERS.len()] = Pool::<0>::filled().offsets;

/// The first `N` bytes of the texts, the length of all of them, and where each begins.
struct Pool<const N: usize> {
    bytes: [u8; N],
    length: usize,
    offsets: [[u16; 4]; PARAMETERS.len()],
}

impl<const N: usize> Pool<N> {
    const fn filled() -> Self {
        let mut pool = Self {
            bytes: [0; N],
            length: 0,
            offsets: [[0; 4]; PARAMETERS.len()],
        };
        let mut i = 0;
        while i < PARAMETERS.len() {
            let Parameter {
                name,
                unit,
                low,
                high,
                text,
                ..
            } = PARAMETERS[i];
            pool.begin(i, 0);
            pool.push_str(name);
            pool.begin(i, 1);
            pool.push_str(unit);
            pool.begin(i, 2);
            pool.push_str(text);
            pool.begin(i, 3);
            pool.push_str(name);
            pool.push_str(" is outside ");
            pool.push_number(low);
            pool.push_str(" to ");
            pool.push_number(high);
            // "1" stands for no unit.
            if !matches!(unit.as_bytes(), b"1") {
                pool.push_str(" ");
                pool.push_str(unit);
            }
            i += 1;
        }
        pool.push_byte(0);
        pool
    }

    /// Ends the text before, and begins another.
    const fn begin(&mut self, parameter: usize, which: usize) {
        if self.length > 0 {
            self.push_byte(0);
        }
        assert!(self.length <= u16::MAX as usize, "offsets have 16 bits");
        self.offsets[parameter][which] = self.length as u16;
    }

    const fn push_byte(&mut self, byte: u8) {
        if self.length < N {
            self.bytes[self.length] = byte;
        }
        self.length += 1;
    }

    const fn push_str(&mut self, text: &str) {
        let bytes = text.as_bytes();
        let mut i = 0;
        while i < bytes.len() {
            assert!(bytes[i] != 0, "a zero byte would end the text in C");
            self.push_byte(bytes[i]);
            i += 1;
        }
    }

    /// A limit of the table, which people wrote with few digits: 0.99, 7, 1e-6.
    const fn push_number(&mut self, value: f32) {
        if value < 0.0 {
            self.push_byte(b'-');
        }
        let (digits, exponent) = decimal(value.abs());
        if digits == 0 {
            self.push_byte(b'0');
        } else if exponent >= -3 && exponent < 0 {
            let scale = 10_u32.pow(exponent.unsigned_abs());
            self.push_integer(digits / scale);
            self.push_byte(b'.');
            let mut place = scale / 10;
            while place > 0 {
                self.push_byte(b'0' + (digits / place % 10) as u8);
                place /= 10;
            }
        } else if exponent >= 0 && exponent <= 3 {
            self.push_integer(digits * 10_u32.pow(exponent.unsigned_abs()));
        } else {
            self.push_integer(digits);
            self.push_byte(b'e');
            if exponent < 0 {
                self.push_byte(b'-');
            }
            self.push_integer(exponent.unsigned_abs());
        }
    }

    const fn push_integer(&mut self, value: u32) {
        if value >= 10 {
            self.push_integer(value / 10);
        }
        self.push_byte(b'0' + (value % 10) as u8);
    }
}

/// The fewest digits and their exponent of ten that make this number, which has at most three digits.
#[expect(clippy::panic, reason = "runs at compile time alone")]
const fn decimal(value: f32) -> (u32, i32) {
    if value == 0.0 {
        return (0, 0);
    }
    // From large exponents downwards, so that 1000 is found as 1e3 and not as 100e1.
    let mut exponent = 30;
    while exponent >= -30 {
        let mut power = 1.0_f64;
        let mut i = 0;
        while i < exponent {
            power *= 10.0;
            i += 1;
        }
        let mut divisor = 1.0_f64;
        while i < -exponent {
            divisor *= 10.0;
            i += 1;
        }
        let digits = (value as f64 / power * divisor + 0.5) as u32;
        if digits > 0 && digits < 1000 && (digits as f64 * power / divisor) as f32 == value {
            return (digits, exponent);
        }
        exponent -= 1;
    }
    panic!("a limit of the table has more than three digits");
}
