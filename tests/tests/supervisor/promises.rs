//! What the supervisor promises at its border, whatever comes in.

use proptest::prelude::*;
use supervisor::{
    Command, Config, Events, IntegratorHint, Limits, Mode, PARAMETERS, Sample, Status, Supervisor,
};
use system_tests::rig::config;
use system_tests::storm::consistent;

pub(super) fn new() -> Supervisor<64> {
    Supervisor::new(&config()).unwrap()
}

pub(super) fn sample(sequence: u32, position_m: [f32; 2]) -> Sample {
    Sample {
        sequence,
        status: Status::SPIN_VALID | Status::BEARING_ON | Status::LEVITATED_BEFORE,
        position_m,
        spin_rad_s: 1000.0,
        levitation_n: [3.0, -4.0],
        ..Sample::default()
    }
}

fn length(force_n: [f32; 2]) -> f64 {
    f64::hypot(f64::from(force_n[0]), f64::from(force_n[1]))
}

/// Any bit pattern of a float: every exponent, NaN payloads, infinities, subnormals.
fn any_bits() -> impl Strategy<Value = f32> {
    prop_oneof![
        3 => any::<u32>().prop_map(f32::from_bits),
        4 => -3e-4..3e-4_f32,
        1 => prop_oneof![
            Just(f32::NAN), Just(f32::INFINITY), Just(f32::NEG_INFINITY), Just(f32::MAX),
            Just(f32::MIN_POSITIVE), Just(0.0), Just(-0.0),
        ],
    ]
}

fn any_sample() -> impl Strategy<Value = Sample> {
    let sequence = prop_oneof![Just(None), any::<u32>().prop_map(Some)];
    (
        sequence,
        any::<u32>(),
        [any_bits(), any_bits()],
        any_bits(),
        [any_bits(), any_bits()],
        [any_bits(), any_bits()],
    )
        .prop_map(
            |(sequence, status, position_m, spin_rad_s, levitation_n, applied_n)| Sample {
                sequence: sequence.unwrap_or(0),
                status: Status::from_bits_retain(status),
                position_m,
                spin_rad_s,
                levitation_n,
                applied_n,
            },
        )
}

fn any_config() -> impl Strategy<Value = Config> {
    let edges = prop::collection::vec(0.0..=1.0_f32, PARAMETERS.len());
    edges.prop_map(|shares| {
        let mut values = [0.0; PARAMETERS.len()];
        for ((value, p), share) in values.iter_mut().zip(PARAMETERS).zip(shares) {
            // Both ends often; what lies between on the scale of the parameter.
            let inside = if p.low > 0.0 {
                p.low * (p.high / p.low).powf(share)
            } else {
                p.low + share * (p.high - p.low)
            };
            *value = if share < 0.1 {
                p.low
            } else if share > 0.9 {
                p.high
            } else {
                inside.clamp(p.low, p.high)
            };
        }
        consistent(Config::from_values(values))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Any bits in every field, any valid configuration: a finite force no longer than the cap.
    /// Requirements: SR-01, SR-02
    #[test]
    fn any_bits_give_a_finite_capped_force(
        config in any_config(),
        samples in prop::collection::vec(any_sample(), 1..60),
    ) {
        let mut supervisor = Supervisor::<16>::new(&config).unwrap();
        for sample in &samples {
            let command = supervisor.tick(sample);
            prop_assert!(command.force_n.iter().all(|f| f.is_finite()), "{:?}", command);
            let cap = f64::from(config.force_max_n);
            prop_assert!(length(command.force_n) <= cap * (1.0 + 1e-7), "{:?} over {}", command, cap);
        }
    }

    /// In the middle the levitation command goes through bit for bit, signed zeros included.
    /// Requirement: SR-06
    #[test]
    fn levitated_is_transparent(
        positions in prop::collection::vec([-2e-5..2e-5_f32, -2e-5..2e-5_f32], 1..50),
        forces in prop::collection::vec([-700.0..700.0_f32, -700.0..700.0_f32], 50),
    ) {
        // An orbit that a sensor could see: positions that move slowly.
        let mut supervisor = new();
        let mut at = [0.0_f32; 2];
        for (i, (target, levitation_n)) in positions.iter().zip(&forces).enumerate() {
            for axis in 0..2 {
                at[axis] += 0.01 * (target[axis] - at[axis]);
            }
            let mut s = sample(i as u32, at);
            s.levitation_n = *levitation_n;
            let command = supervisor.tick(&s);
            prop_assert_eq!(command.mode, Mode::Levitated);
            prop_assert_eq!(command.force_n.map(f32::to_bits), levitation_n.map(f32::to_bits));
            prop_assert_eq!(command.limits, Limits::empty());
        }
    }

    /// Mirrored samples give mirrored commands, to the bit.
    #[test]
    fn mirror(samples in prop::collection::vec(any_sample(), 1..60)) {
        let (mut left, mut right) = (new(), new());
        for s in &samples {
            let mut m = *s;
            m.position_m[0] = -s.position_m[0];
            m.levitation_n[0] = -s.levitation_n[0];
            m.applied_n[0] = -s.applied_n[0];
            m.spin_rad_s = -s.spin_rad_s;
            // Without spin and without whirl there is no direction to mirror.
            let known = s.status.contains(Status::SPIN_VALID) && s.spin_rad_s.is_finite() && s.spin_rad_s != 0.0;
            if !known {
                continue;
            }
            let (a, b) = (left.tick(s), right.tick(&m));
            prop_assert_eq!(a.mode, b.mode);
            prop_assert_eq!([-a.force_n[0], a.force_n[1]], b.force_n);
        }
    }
}

/// Every parameter is refused just outside its range and for NaN, and named.
/// Requirement: SR-28
#[test]
fn config_errors_name_field_value_and_range() {
    for (i, p) in PARAMETERS.iter().enumerate() {
        let below = p.low - p.low.abs().max(1e-3);
        for wrong in [f32::NAN, f32::INFINITY, below, p.high * 2.0 + 1.0] {
            let mut values = config().values();
            values[i] = wrong;
            let error = Config::from_values(values).validate().unwrap_err();
            assert_eq!(error.parameter().name, p.name);
            let text = error.to_string();
            // Both ends, as a person would write them.
            let (_, range) = text.split_once("expected ").unwrap();
            let words: Vec<&str> = range.split(' ').collect();
            assert_eq!(
                (words[0].parse(), words[2].parse()),
                (Ok(p.low), Ok(p.high))
            );
            assert!(words[0].len().max(words[2].len()) <= 6, "{text}");
            assert!(text.starts_with(p.name), "{text}");
        }
        for edge in [p.low, p.high] {
            let mut values = config().values();
            values[i] = edge;
            // In its range, and refused at most beside another.
            let refused = Config::from_values(values).validate().err();
            assert!(
                refused.is_none_or(|error| error.contradiction.is_some()),
                "{} at {edge}",
                p.name
            );
        }
    }
}

/// A command beyond the cap is shortened in its direction; one that is no number becomes zero.
/// Requirement: SR-07
#[test]
fn levitation_commands_are_limited_with_a_flag() {
    let mut supervisor = new();
    let mut s = sample(0, [0.0; 2]);
    s.levitation_n = [3000.0, 0.0];
    let Command {
        force_n, limits, ..
    } = supervisor.tick(&s);
    assert!(
        force_n[0] > 999.9 && force_n[0] <= 1000.0 && force_n[1] == 0.0,
        "{force_n:?}"
    );
    assert_eq!(limits, Limits::LEVITATION_CLAMPED);
    s.sequence = 1;
    s.levitation_n = [f32::NAN, 5.0];
    let command = supervisor.tick(&s);
    assert_eq!(command.force_n, [0.0, 5.0]);
    assert_eq!(command.limits, Limits::LEVITATION_CLAMPED);
}

/// What the supervisor commands on the way to the wall ahead along x at 0.4 m/s, spin counter-clockwise
/// (backward is −y there), as long as a force still comes before the impact: 1.5 ticks and 3.2 of lag.
fn approaching(force_max_n: f32) -> Vec<Command> {
    const STEP_M: f32 = 2e-5;
    let config = Config {
        force_max_n,
        axis_force_max_n: force_max_n,
        ..config()
    };
    let mut supervisor = Supervisor::<64>::new(&config).unwrap();
    let commands = (0..12_u32).filter_map(|i| {
        let x = STEP_M * i as f32 - 6e-5;
        let command = supervisor.tick(&sample(i, [x, 0.0]));
        let in_time = (2e-4 - x) / STEP_M > 5.5;
        (command.mode == Mode::Approach && in_time).then_some(command)
    });
    commands.collect()
}

/// An impact that would drive the rotor beyond what a weak magnet can stop is met along the wall, never with the
/// whole capacity inwards; one that is harmless to a strong one is softened.
#[test]
fn approach_is_tangential_where_it_is_dangerous() {
    let dangerous = approaching(200.0);
    assert!(!dangerous.is_empty());
    for command in &dangerous {
        let [inward, tangential] = [-command.force_n[0], command.force_n[1]];
        assert!(command.severity > 2.0, "{command:?}");
        assert!(inward < 0.9 * 200.0, "{command:?}");
        // The rest damps the speed of the impact itself.
        assert!(
            tangential > 0.5 * length(command.force_n) as f32,
            "{command:?}"
        );
        assert!(tangential > 100.0, "{command:?}");
    }
    let harmless = approaching(3100.0);
    assert!(!harmless.is_empty());
    for command in &harmless {
        // A hair above the whirl limit's share from which on impacts count.
        assert!(command.severity < 0.61, "{command:?}");
        assert!(command.force_n[0] < -0.99 * 3100.0, "{command:?}");
    }
    assert!(dangerous[0].events.contains(Events::ENGAGED));
    // The controller asks outwards there: running undoes what it holds.
    assert_eq!(dangerous[0].integrator, IntegratorHint::Run);
}

/// In sustained backward whirl the force brakes: against the motion, and mostly along the wall.
/// Requirement: SR-23
#[test]
fn whirl_is_braked_along_the_wall() {
    for spin in [1000.0_f32, -1000.0] {
        let mut supervisor = new();
        let whirl = -spin.signum();
        let mut last = Command::default();
        let mut at = 0.0_f32;
        for i in 0..400_u32 {
            at = whirl * 500.0 * 50e-6 * i as f32;
            let mut s = sample(i, [2.05e-4 * at.cos(), 2.05e-4 * at.sin()]);
            s.spin_rad_s = spin;
            last = supervisor.tick(&s);
        }
        assert_eq!(last.mode, Mode::BackwardWhirl);
        // Delivered force: later by 1.5 ticks and the lag's atan(ωτ).
        let turn = whirl * 500.0 * 1.5 * 50e-6;
        let lag = whirl * (500.0_f32 * 1.6e-4).atan();
        let (n, t) = ((at + turn).cos(), (at + turn).sin());
        let rotate = |v: [f32; 2], a: f32| {
            [
                v[0] * a.cos() - v[1] * a.sin(),
                v[0] * a.sin() + v[1] * a.cos(),
            ]
        };
        let delivered = rotate(last.force_n, -lag);
        let radial = delivered[0] * n + delivered[1] * t;
        let along = whirl * (-delivered[0] * t + delivered[1] * n);
        assert!(along < -0.95 * 1000.0, "brakes with {along} N");
        // Inward of tangential by atan μ, never ahead of it.
        assert!((-0.2 * 1000.0..0.0).contains(&radial), "radial {radial} N");
    }
}

/// NaN for longer than the configured ticks: a sensor fault, and the force goes to zero in the
/// configured time; plausible samples for as long end it.
/// Requirement: SR-17
#[test]
fn sensor_fault_blends_to_zero_and_ends() {
    let mut supervisor = new();
    let mut sequence = 0..;
    let mut tick = |position_m| {
        let levitation_n = [900.0, 0.0];
        let now = sample(sequence.next().unwrap(), position_m);
        supervisor.tick(&Sample {
            levitation_n,
            ..now
        })
    };
    for _ in 0..20 {
        assert_eq!(tick([1e-5, 0.0]).mode, Mode::Levitated);
    }
    let refused: Vec<Command> = (0..40).map(|_| tick([f32::NAN; 2])).collect();
    assert!(
        refused
            .iter()
            .all(|c| c.limits.contains(Limits::SAMPLE_REFUSED))
    );
    let fault = refused
        .iter()
        .position(|c| c.mode == Mode::SensorFault)
        .unwrap();
    assert_eq!(fault, 9, "ten ticks");
    assert!(refused[fault].events.contains(Events::SENSOR_FAULT));
    // From 900 N, the cap of 1000 N in 20 ticks.
    for (i, command) in refused[fault..].iter().enumerate() {
        let left = (900.0 - 50.0 * (i + 1) as f32).max(0.0);
        assert!((command.force_n[0] - left).abs() < 0.01, "{command:?}");
        assert_eq!(command.force_n[1], 0.0);
    }
    let good: Vec<Command> = (0..10).map(|_| tick([1e-5, 0.0])).collect();
    assert!(good[9].events.contains(Events::SENSOR_OK));
    assert_ne!(good[9].mode, Mode::SensorFault);
}

/// Missed and repeated samples are reported, and a repeated one is not used twice.
/// Requirement: SR-20
#[test]
fn sequence_is_watched() {
    let mut supervisor = new();
    supervisor.tick(&sample(7, [0.0; 2]));
    assert!(
        !supervisor
            .tick(&sample(8, [0.0; 2]))
            .events
            .contains(Events::SEQUENCE)
    );
    let repeated = supervisor.tick(&sample(8, [0.0; 2]));
    assert!(repeated.events.contains(Events::SEQUENCE));
    assert!(repeated.limits.contains(Limits::SAMPLE_REFUSED));
    let missed = supervisor.tick(&sample(12, [0.0; 2]));
    assert!(missed.events.contains(Events::SEQUENCE));
    assert!(!missed.limits.contains(Limits::SAMPLE_REFUSED));
}

/// A bearing that is switched off is left alone, wherever the rotor lies; switched on, it is not.
/// Requirement: SR-08
#[test]
fn nothing_happens_while_the_bearing_is_off() {
    let mut supervisor = new();
    let mut s = sample(0, [2.01e-4, 0.0]);
    s.levitation_n = [0.0; 2];
    for i in 0..200 {
        s.sequence = i;
        s.status = Status::SPIN_VALID | Status::LEVITATED_BEFORE;
        let command = supervisor.tick(&s);
        assert_eq!((command.mode, command.force_n), (Mode::Levitated, [0.0; 2]));
    }
    // On the wall, and its controller has no force to spare.
    s.status |= Status::BEARING_ON;
    s.levitation_n = [-900.0, 0.0];
    s.sequence = 200;
    assert_ne!(supervisor.tick(&s).mode, Mode::Levitated);
}

/// However long the fault was, what it left in the observer is forgotten.
/// Requirement: SR-19
#[test]
fn a_long_sensor_fault_leaves_nothing_behind() {
    let after = |fault_ticks: u32| {
        let mut supervisor = new();
        for i in 0..20 {
            supervisor.tick(&sample(i, [1e-5, 0.0]));
        }
        for i in 0..fault_ticks {
            supervisor.tick(&sample(20 + i, [f32::NAN, 0.0]));
        }
        let forces: Vec<[f32; 2]> = (0..40)
            .map(|i| {
                supervisor
                    .tick(&sample(20 + fault_ticks + i, [1e-5, 0.0]))
                    .force_n
            })
            .collect();
        forces
    };
    assert_eq!(after(1000), after(5000));
    let strongest = after(5000).iter().map(|f| length(*f)).fold(0.0, f64::max);
    assert!(
        strongest < 100.0,
        "a rotor at rest near the middle needs no {strongest} N"
    );
}

/// With unknown spin and no whirl there is no sense to push in, and noise must not make one up.
#[test]
fn unknown_spin_does_not_make_the_force_jump() {
    let mut supervisor = new();
    let mut last = 0.0;
    let mut jumps = 0;
    for i in 0..18_u32 {
        let noise = if i % 2 == 0 { 1e-6 } else { -1e-6 };
        let mut s = sample(i, [1e-5 * i as f32, noise]);
        s.status = Status::BEARING_ON;
        let command = supervisor.tick(&s);
        if command.mode != Mode::Levitated {
            jumps += u32::from((command.force_n[1] - last).abs() > 600.0);
            last = command.force_n[1];
        }
    }
    assert_eq!(jumps, 0);
}
