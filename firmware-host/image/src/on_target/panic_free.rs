//! The whole supervisor and nothing else, linked with a panic handler that does not exist: if any panic
//! could be reached, linking would fail. It is linked, not run; its sections are the supervisor's size.

use super::planted;
use crate::under_test::UnderTest;
use crate::wire::SampleBits;
use core::hint::black_box;
use supervisor::{Config, PARAMETERS};

/// Calls everything that firmware calls, with values that the optimiser knows nothing of.
#[inline(always)]
pub fn run<U: UnderTest>() -> ! {
    let config = Config::from_values(black_box([0.0; PARAMETERS.len()]));
    loop {
        let Some(mut supervisor) = U::new(black_box(&config)) else {
            continue;
        };
        black_box(supervisor.self_test());
        for _ in 0..black_box(10) {
            let sample = black_box(U::sample(&SampleBits::default()));
            black_box(U::TICK(&mut supervisor, &sample));
            supervisor.everything_else();
        }
        planted();
    }
}
