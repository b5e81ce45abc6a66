//! Products of two numbers of 32 bits.
//!
//! Cortex-M0 has a multiplier whose product is cut to 32 bits. What the compiler calls there for a wide product is made
//! for two factors of 64 bits, and was more than half of all instructions of a tick; so there the factors are taken in
//! halves. Elsewhere one instruction does it. Both give the same bits.

/// Whether products come in halves: an Arm without atomic exchange is Armv6-M, or so old that it costs nobody anything.
const IN_HALVES: bool = cfg!(all(target_arch = "arm", not(target_has_atomic = "8")));

/// a·b.
#[inline]
pub(crate) fn signed(a: i32, b: i32) -> i64 {
    if IN_HALVES {
        halves::signed(a, b)
    } else {
        i64::from(a) * i64::from(b)
    }
}

/// a·b.
#[inline]
pub(crate) fn unsigned(a: u32, b: u32) -> u64 {
    if IN_HALVES {
        halves::unsigned(a, b)
    } else {
        u64::from(a) * u64::from(b)
    }
}

/// a·b.
#[inline]
pub(crate) fn mixed(a: i32, b: u32) -> i64 {
    if IN_HALVES {
        halves::mixed(a, b)
    } else {
        i64::from(a) * i64::from(b)
    }
}

/// a·b/2^`SHIFT`, rounded down, and the nearest number there is where it is beyond all; `SHIFT` in 16 … 31.
#[inline]
pub(crate) fn narrowed<const SHIFT: u32>(a: i32, b: i32) -> i32 {
    if IN_HALVES {
        halves::narrowed::<SHIFT>(a, b)
    } else {
        cut::<SHIFT>(i64::from(a) * i64::from(b))
    }
}

/// (a·b + c·d)/2^`SHIFT`, likewise.
#[inline]
pub(crate) fn narrowed_sum<const SHIFT: u32>([a, b]: [i32; 2], [c, d]: [i32; 2]) -> i32 {
    if IN_HALVES {
        halves::narrowed_sum::<SHIFT>(a, b, c, d)
    } else {
        let [first, second] = [(a, b), (c, d)].map(|(x, y)| i64::from(x) * i64::from(y));
        // The sum of two that are −2³¹·−2³¹ alone has no room.
        cut::<SHIFT>(first.saturating_add(second))
    }
}

/// `wide`/2^`SHIFT`, rounded down, and the nearest number there is where it is beyond all; `SHIFT` in 1 … 31.
#[inline]
pub(crate) fn cut<const SHIFT: u32>(wide: i64) -> i32 {
    let (high, low) = ((wide >> 32) as i32, wide as u32);
    // In the upper word, which Cortex-M3 saturates with one instruction. Not by `clamp`, whose assertion stays in where
    // the compiler saves size.
    let largest = (1 << (SHIFT - 1)) - 1;
    let held = high.max(!largest).min(largest);
    let low = if held == high {
        low
    } else {
        !(high >> 31) as u32
    };
    (held << (32 - SHIFT)) | (low >> SHIFT) as i32
}

/// Whether a vector is longer than a limit; sizes of at most 2³¹.
#[inline]
pub(crate) fn longer(x: u32, y: u32, limit: u32) -> bool {
    if IN_HALVES {
        halves::longer(x, y, limit)
    } else {
        let square = |v: u32| u64::from(v) * u64::from(v);
        square(x) + square(y) > square(limit)
    }
}

/// The nearest number of 32 bits.
#[inline]
pub(crate) fn saturated(wide: i64) -> i32 {
    let low = wide as i32;
    if i64::from(low) == wide {
        low
    } else if wide < 0 {
        i32::MIN
    } else {
        i32::MAX
    }
}

/// The same from products of 16 by 16 bits. Out of line: the places that multiply are many, and flash is small.
mod halves {
    /// The product in pieces: from 2³² on, between 2¹⁶ and 2³², and below.
    #[inline(always)]
    fn pieces(a: i32, b: i32) -> (i32, u32, u32) {
        let [a_low, b_low] = [a & 0xFFFF, b & 0xFFFF];
        let [a_high, b_high] = [a >> 16, b >> 16];
        let low = (a_low as u32).wrapping_mul(b_low as u32);
        // At most 32 767·65 535 + 65 535 and no less than −32 768·65 535: each of the sums has room.
        let first = a_high.wrapping_mul(b_low).wrapping_add((low >> 16) as i32);
        let second = (a_low.wrapping_mul(b_high)).wrapping_add(first & 0xFFFF);
        let high = (a_high.wrapping_mul(b_high))
            .wrapping_add(first >> 16)
            .wrapping_add(second >> 16);
        (high, (second as u32) & 0xFFFF, low & 0xFFFF)
    }

    #[inline(never)]
    pub(super) fn signed(a: i32, b: i32) -> i64 {
        let (high, middle, low) = pieces(a, b);
        (i64::from(high) << 32) | i64::from((middle << 16) | low)
    }

    #[inline(never)]
    pub(super) fn unsigned(a: u32, b: u32) -> u64 {
        let [a_low, b_low] = [a & 0xFFFF, b & 0xFFFF];
        let [a_high, b_high] = [a >> 16, b >> 16];
        let low = a_low.wrapping_mul(b_low);
        let first = a_high.wrapping_mul(b_low).wrapping_add(low >> 16);
        let second = a_low.wrapping_mul(b_high).wrapping_add(first & 0xFFFF);
        let high = (a_high.wrapping_mul(b_high))
            .wrapping_add(first >> 16)
            .wrapping_add(second >> 16);
        (u64::from(high) << 32) | u64::from((second << 16) | (low & 0xFFFF))
    }

    /// Most vectors are so short or so long that no square is needed.
    #[inline(never)]
    pub(super) fn longer(x: u32, y: u32, limit: u32) -> bool {
        if x.saturating_add(y) <= limit {
            return false;
        }
        if x > limit || y > limit {
            return true;
        }
        let square = |v: u32| unsigned(v, v);
        square(x).wrapping_add(square(y)) > square(limit)
    }

    #[inline]
    pub(super) fn mixed(a: i32, b: u32) -> i64 {
        // The highest bit of b counts +2³¹ and not −2³¹.
        let b = b as i32;
        signed(a, b).wrapping_add(i64::from(a & (b >> 31)) << 32)
    }

    #[inline(never)]
    pub(super) fn narrowed<const SHIFT: u32>(a: i32, b: i32) -> i32 {
        let (high, middle, _) = pieces(a, b);
        joined::<SHIFT>(high, middle)
    }

    #[inline(never)]
    pub(super) fn narrowed_sum<const SHIFT: u32>(a: i32, b: i32, c: i32, d: i32) -> i32 {
        let (high, middle, low) = pieces(a, b);
        let (other_high, other_middle, other_low) = pieces(c, d);
        let middle = middle + other_middle + ((low + other_low) >> 16);
        let high = (high + (middle >> 16) as i32).saturating_add(other_high);
        joined::<SHIFT>(high, middle & 0xFFFF)
    }

    #[inline(always)]
    fn joined<const SHIFT: u32>(high: i32, middle: u32) -> i32 {
        let left = 32 - SHIFT;
        let shifted = high << left;
        if shifted >> left == high {
            shifted | (middle >> (SHIFT - 16)) as i32
        } else if high < 0 {
            i32::MIN
        } else {
            i32::MAX
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::{halves, saturated};
    use std::format;

    /// Where halves carry, and where they do not; and a stride through everything between.
    fn factors() -> impl Iterator<Item = i32> + Clone {
        let edges = [
            0_i32,
            1,
            0x7FFF,
            0x8000,
            0xFFFF,
            0x1_0000,
            0x7FFF_FFFF,
            1 << 22,
        ];
        let edges = edges.into_iter().flat_map(|x| [x, -x, !x, x ^ 0x7FFF_8000]);
        let between = (0..300_u32).map(|i| (i.wrapping_mul(0x9E37_79B9) as i32) >> (i % 31));
        edges.chain(between)
    }

    #[test]
    fn halves_make_the_whole() {
        let factors = factors();
        for a in factors.clone() {
            for b in factors.clone() {
                let wide = i64::from(a) * i64::from(b);
                assert_eq!(halves::signed(a, b), wide, "{a}·{b}");
                let (a_size, b_size) = (a as u32, b as u32);
                let size = u64::from(a_size) * u64::from(b_size);
                assert_eq!(halves::unsigned(a_size, b_size), size, "{a_size}·{b_size}");
                for limit in [a_size, b_size, a_size ^ b_size, a_size.max(b_size), 1 << 22] {
                    let [x, y, limit] = [a, b, limit as i32].map(i32::unsigned_abs);
                    let square = |v: u32| u128::from(v) * u128::from(v);
                    let longer = square(x) + square(y) > square(limit);
                    assert_eq!(halves::longer(x, y, limit), longer, "{x}, {y} and {limit}");
                    assert_eq!(super::longer(x, y, limit), longer, "{x}, {y} and {limit}");
                }
                let mixed = i64::from(a) * i64::from(b_size);
                assert_eq!(halves::mixed(a, b_size), mixed, "{a}·{b_size}");
                same::<16>(a, b, wide);
                same::<22>(a, b, wide);
                same::<31>(a, b, wide);
            }
        }
    }

    fn same<const SHIFT: u32>(a: i32, b: i32, wide: i64) {
        let case = format!("{a}·{b}, {SHIFT}");
        let cut = saturated(wide >> SHIFT);
        assert_eq!(halves::narrowed::<SHIFT>(a, b), cut, "{case}");
        assert_eq!(super::narrowed::<SHIFT>(a, b), cut, "{case}");
        for (c, d) in [(a, b), (b, b), (-1, a), (i32::MIN, b), (b, 0x1_0001)] {
            let sum = wide.saturating_add(i64::from(c) * i64::from(d));
            let cut = saturated(sum >> SHIFT);
            let sum = halves::narrowed_sum::<SHIFT>(a, b, c, d);
            assert_eq!(sum, cut, "{case}, and {c}·{d}");
            let sum = super::narrowed_sum::<SHIFT>([a, b], [c, d]);
            assert_eq!(sum, cut, "{case}, and {c}·{d}");
        }
    }
}
