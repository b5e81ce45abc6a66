//! The supervisor as Miri interprets it.

use miri::config as plausible;
use supervisor::{Config, Core, Prepared, Q, Sample, Scalar, Stamp, Status, Supervisor};

/// Every mode in every number, with the same answers as on any other processor.
#[test]
fn self_tests_pass() {
    assert!(passes::<f32>() && passes::<f64>() && passes::<Q>());
}

fn passes<S: Scalar>() -> bool {
    let prepared = Prepared::<S>::new(&Config::example()).unwrap();
    Core::<S, 4>::new(&prepared).self_test().passed
}

/// Any bits in any field, past a frozen record.
#[test]
fn any_bits_are_survived() {
    let mut random = 0x9E37_79B9_7F4A_7C15_u64;
    let mut bits = || {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random >> 32) as u32
    };
    let with = plausible();
    let mut supervisor = Supervisor::<8>::new(&with).unwrap();
    let mut sequence = 0_u32;
    let mut records = 0;
    for i in 0..600_u32 {
        let odd = i % 8 == 7;
        sequence = sequence.wrapping_add(if odd { bits() % 6 } else { 1 });
        let status = Status::from_bits_retain(if odd { bits() } else { 3 });
        let mut numbers = |usual: [f32; 2]| {
            if odd {
                [0; 2].map(|_| f32::from_bits(bits()))
            } else {
                usual
            }
        };
        let angle = 0.1 * i as f32;
        // Round on the wall, and back to the middle.
        let radius_m = 2.05e-4 - 2.5e-6 * (i % 150).saturating_sub(60).min(80) as f32;
        let position_m = numbers([radius_m * angle.cos(), radius_m * angle.sin()]);
        let (levitation_n, applied_n) = (numbers([3.0, 4.0]), numbers([100.0, 0.0]));
        let command = supervisor.tick(&Sample {
            sequence,
            status,
            position_m,
            spin_rad_s: numbers([-1000.0, 0.0])[0],
            levitation_n,
            applied_n,
        });
        let [x, y] = command.force_n;
        assert!(x.hypot(y) <= with.force_max_n * 1.000_000_2);
        while supervisor.next_event().is_some() {}
        if let Some(record) = supervisor.record() {
            let sections = (0..).map_while(|i| record.section(i, &Stamp::default()));
            assert!(sections.map(|mut s| s.seal().len()).sum::<usize>() > 1000);
            records += 1;
            supervisor.rearm();
        }
    }
    assert!(records > 1);
}
