//! Forward rub: unbalance drives the rotor round the retainer bearing with the spin and at its rate. It is recognised,
//! no other motion is taken for it, and the supervisor's force never drives it.

use crate::common::{RATE_HZ, contend, plant, ran};
use firmware_bench::run::closed_loop::Keep;
use firmware_bench::run::controller::supervised;
use firmware_bench::scene::Scene;
use firmware_studies::machines::tuned_gains::stored;
use firmware_studies::overloads::contenders::Contender;
use plant_model::params::SpinParams;
use std::f64::consts::TAU;
use supervisor::{Command, Events, Mode, Sample, Status, Supervisor};
use system_tests::recording::recording;
use system_tests::rig::{close, config, sample, ticks_of, whirl_by};

/// Commands to a rotor that slides on the wall at a multiple of the spin, for 30 ms.
fn commands_at(rate: f32) -> Vec<Command> {
    let config = config();
    let angle = rate * sample(0, [0.0; 2]).spin_rad_s * config.sample_period_s;
    let mut supervisor = Supervisor::<64>::new(&config).unwrap();
    // The rig counts angles backward.
    whirl_by(-angle, &mut supervisor, 0..600, Status::empty())
}

fn rubs(commands: &[Command]) -> Vec<usize> {
    ticks_of(commands, Events::FORWARD_RUB)
}

/// Said once, soon after contact is known to last, at the spin's rate and no other.
#[test]
fn said_once_and_only_of_the_spins_rate() {
    let at_the_spins_rate = [1.0, 0.82, 1.18].map(|rate| (rate, 1));
    let at_others = [0.65, 1.35, -1.0].map(|rate| (rate, 0));
    for (rate, said) in at_the_spins_rate.into_iter().chain(at_others) {
        assert_eq!(rubs(&commands_at(rate)).len(), said, "{rate} ×");
    }
    let commands = commands_at(1.0);
    let at = rubs(&commands)[0];
    // whirl_time_s is 20 ticks: 0.6 of the way take 18.
    assert!((15..25).contains(&at), "after {at} ticks");
    // It is no whirl against the spin, and not rest.
    assert!(commands.iter().skip(30).all(|c| c.mode == Mode::Bounce));
}

/// A plant whose mass centre is so far off that neither levitation nor the cap keeps it from the wall.
fn unbalanced(name: &str, eccentricity_m: f64) -> Scene {
    let mut scene = plant(name).scene;
    scene.duration_s = 0.12;
    scene.machine.eccentricity_m = eccentricity_m;
    scene.machine.spin = SpinParams::Held;
    scene.levitated_before = true;
    scene
}

/// Work of the commanded force on the way of the rotor in each tick \[J\], and the turns of the rotor about the
/// centre, counter-clockwise.
fn work_and_turns(ticks: &[(Sample, Command)]) -> (Vec<f64>, f64) {
    let of_tick = |((before, _), (now, command)): (&(Sample, Command), &(Sample, Command))| {
        let [[ax, ay], [bx, by]] = [before, now].map(|s| s.position_m.map(f64::from));
        let [fx, fy] = command.force_n.map(f64::from);
        let angle = (ax * by - ay * bx) / (ax * ax + ay * ay);
        (fx * (bx - ax) + fy * (by - ay), angle / TAU)
    };
    let (work_j, turns): (Vec<f64>, Vec<f64>) = ticks.iter().zip(&ticks[1..]).map(of_tick).unzip();
    (work_j, turns.iter().sum())
}

/// In the closed loop, below and above the first critical speed: recognised, taken for nothing else, braked and never
/// driven, and no harder on the bearing than under levitation alone.
#[test]
fn unbalance_that_no_force_holds_is_recognised_and_not_driven() {
    for (plant, eccentricity_m, force_ratio) in [("P1 150 N", 3e-4, 0.4), ("P2", 2e-4, 0.97)] {
        let scene = unbalanced(plant, eccentricity_m);
        let found = stored(plant, RATE_HZ).unwrap();
        let (supervisor, log) = recording(&scene.planes[0].supervisor.unwrap()).unwrap();
        let mut with_levitation = scene.clone();
        with_levitation.planes[0].levitation = Some(found.tuned);
        let supervised = supervised(&with_levitation, supervisor).unwrap();
        let (own, _) = ran(&scene, supervised, Keep::Verdict);
        let (alone, _) = contend(Contender::Tuned, &found, &scene, Keep::Verdict);

        let ticks = log.take();
        let commands: Vec<Command> = ticks.iter().map(|(_, command)| *command).collect();
        let all = (commands.iter()).fold(Events::empty(), |all, c| all | c.events);
        let rubs = rubs(&commands);
        assert!((1..=3).contains(&rubs.len()), "{plant}");
        let other = all.intersects(Events::WHIRL | Events::PINNED);
        assert!(!other, "{plant}: {all:?}");
        let rub = &ticks[rubs[0]..];
        assert!(rub.iter().all(|(_, c)| c.mode == Mode::Bounce), "{plant}");

        let (work_j, turns) = work_and_turns(rub);
        let turns_of_spin = scene.start.spin_rad_s / TAU * rub.len() as f64 / RATE_HZ;
        close(turns, turns_of_spin, 0.02);
        let sum_j: f64 = work_j.iter().sum();
        let driving_j: f64 = work_j.iter().map(|w| w.max(0.0)).sum();
        // In single ticks noise turns the estimate of a slow rub.
        let braked = sum_j < 0.0 && driving_j < -0.02 * sum_j;
        assert!(braked, "{plant}: {sum_j} J, {driving_j} J of it driving");
        let ratio = own.peak_contact_force_n / alone.peak_contact_force_n;
        println!(
            "{plant}: force over levitation alone {ratio:.3}, contact {} of {} s",
            own.contact_time_s, alone.contact_time_s
        );
        assert!(ratio < force_ratio, "{plant}: {ratio}");
    }
}
