//! Whatever bits come in, for as long as you like: no panic, finite, within every limit, in every mode and in every
//! number.

use supervisor::{Core, Events, Mode, Prepared, Q};
use system_tests::storm::{AnyBits, Bounds, Chance, Storm, any_config};

/// Ticks of one configuration.
const TICKS_PER_CONFIG: u64 = 20_000;
/// Ticks of one test.
const TICKS: u64 = 10_000_000;
/// The long ones.
const MANY_TICKS: u64 = 1_000_000_000;

/// Drives cores of any valid configurations; counts ticks in each mode.
fn drive<S: AnyBits>(ticks: u64) -> [u64; 7] {
    let mut modes = [0; 7];
    let mut chance = Chance::new(1);
    let mut done = 0;
    while done < ticks {
        let config = any_config(&mut chance);
        let seed = chance.bits();
        // Not every number holds every bearing.
        let Ok(prepared) = Prepared::<S>::new(&config) else {
            continue;
        };
        let mut core = Core::<S, 64>::new(&prepared);
        let mut bounds = Bounds::<S>::new(&config);
        let mut storm = Storm::new(seed);
        for i in 0..TICKS_PER_CONFIG {
            let sample = storm.next_sample::<S>();
            let command = core.tick(&sample);
            if let Err(broken) = bounds.check(&command, sample.status) {
                panic!("tick {i} of seed {seed} with {config:?}: {sample:?}: {broken}");
            }
            modes[command.mode as usize] += 1;
            if command.events.contains(Events::RECORD_FROZEN) {
                core.rearm();
            }
        }
        let report = core.report();
        assert!(report.severity_index.is_finite(), "{config:?}: {report:?}");
        let cap_n = f64::from(config.force_max_n) * (1.0 + S::LAST_PLACE);
        assert!(
            (0.0..=cap_n).contains(&f64::from(report.force_cap_n)),
            "{config:?}: {report:?}"
        );
        // Of a continuous force so small fixed point keeps no square.
        if config.continuous_force_n > 1e-3 * config.force_max_n {
            assert!(report.thermal_state.is_finite(), "{config:?}: {report:?}");
        }
        done += TICKS_PER_CONFIG;
    }
    modes
}

/// Each mode is gone through for at least a hundredth of the time.
fn keeps_every_limit<S: AnyBits>(ticks: u64) {
    let modes = drive::<S>(ticks);
    assert!(modes.iter().all(|count| *count > ticks / 100), "{modes:?}");
    assert!(
        modes[Mode::BackwardWhirl as usize] > ticks / 10,
        "{modes:?}"
    );
}

#[test]
fn f32_keeps_every_limit() {
    keeps_every_limit::<f32>(TICKS);
}

#[test]
fn fixed_point_keeps_every_limit() {
    keeps_every_limit::<Q>(TICKS);
}

#[test]
fn f64_keeps_every_limit() {
    keeps_every_limit::<f64>(TICKS);
}

#[test]
#[ignore = "takes some minutes"]
fn f32_keeps_every_limit_for_long() {
    keeps_every_limit::<f32>(MANY_TICKS);
}

#[test]
#[ignore = "takes some minutes"]
fn fixed_point_keeps_every_limit_for_long() {
    keeps_every_limit::<Q>(MANY_TICKS);
}
