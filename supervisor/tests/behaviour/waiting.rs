//! How long a held rotor waits for its levitation controller.

use supervisor::{Mode, Supervisor};
use test_support::rig::{asking, config};

/// A rotor that came out quickly and stands still off the wall, where a load holds it against the supervisor; its controller asks for so
/// many newtons outwards after so many ticks, knowing what holds it. Ticks of the approach until it is handed over, of so many at most.
fn held(outwards_n: impl Fn(u32, f32) -> f32, most: u32) -> u32 {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let (mut engaged_at, mut own_n) = (None, 0.0);
    for i in 0..most {
        let out_m = (8e-6 * i.saturating_sub(20) as f32).min(1.2e-4);
        let noise_m = 4e-7 * (i % 3) as f32;
        let (at_m, asked_n) = ([out_m + noise_m, noise_m], [outwards_n(i, own_n), 0.0]);
        let command = supervisor.tick(&asking(i, at_m, asked_n));
        own_n = command.force_n[0];
        match (command.mode, engaged_at) {
            (Mode::Approach, None) => engaged_at = Some(i),
            (Mode::Handover, Some(at)) => return i - at,
            _ => {}
        }
    }
    assert!(engaged_at.is_some(), "never engaged");
    most
}

/// Ticks of 40 t₀.
fn patience() -> u32 {
    let c = config();
    let t0_s = (c.mass_kg * c.clearance_m / c.force_max_n).sqrt();
    (40.0 * t0_s / c.sample_period_s) as u32
}

#[test]
fn a_held_rotor_waits_for_a_controller_that_comes_nearer_and_for_no_other() {
    let patience = patience();
    // One that asks for what holds it has it soon.
    assert!(held(|_, own_n| own_n, 6 * patience) < patience / 4);
    // One that stays where it is wants something else: it is asked once, and once more.
    for n in [-400.0, 0.0, 100.0, 400.0, 900.0] {
        let ticks = held(|_, _| n, 6 * patience);
        let twice = 2 * patience..9 * patience / 4;
        assert!(twice.contains(&ticks), "{n} N: {ticks}");
    }
    // One that comes nearer is waited for again.
    for n_per_tick in [0.2, 0.4] {
        let ticks = held(|i, _| 900.0 - n_per_tick * i as f32, 6 * patience);
        let again = 3 * patience..6 * patience;
        assert!(again.contains(&ticks), "{n_per_tick}: {ticks}");
    }
}
