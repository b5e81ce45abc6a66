//! Cap per axis, slew limit, outages, delay, and the policy `damping`.

use crate::instruments_and_events::{apart, free_rotor, last, near, ridden, samples};
use firmware_bench::device::actuator::{Delivers, Outage};
use firmware_bench::device::axis::Axis;
use firmware_bench::device::sensor_fault::{Fault, FaultKind};
use firmware_bench::run::closed_loop::{Keep, run_policy};
use firmware_bench::run::controller::{Controller, Force, Seen, Supervise, supervised};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use plant_model::{Snapshot, V2};
use std::cell::RefCell;
use std::rc::Rc;
use supervisor::{Command, Sample, Status, Supervisor};
use system_tests::scene;

/// `radial` outside its band pushes with the whole cap all the time: a constant command.
fn pushed(direction: V2) -> Scene {
    let mut scene = free_rotor();
    scene.planes[0].radial_band = 0.0;
    scene.duration_s = 0.004;
    // Far away, so that the direction does not change.
    scene.start.centre_m = -0.9 * direction;
    scene.machine.magnets[0].force_max_n = 1000.0;
    scene
}

/// From a time on, for ever.
fn outage(delivers: Delivers, axis: Axis, start_s: f64) -> Outage {
    Outage {
        start_s,
        duration_s: 1.0,
        delivers,
        axis,
        known: false,
    }
}

fn without_lag(scene: &mut Scene) {
    scene.machine.magnets[0].lag_s = 0.0;
}

#[test]
fn each_axis_has_its_own_cap() {
    let mut scene = pushed(V2::new(0.8, 0.6));
    scene.planes[0].amplifier.axis_force_max_n = Some(700.0);
    without_lag(&mut scene);
    let end = last(&ridden(&scene, PolicyKind::Radial).1).plant;
    near("x", end.delivered_n.x, 700.0, 1e-12);
    near("y", end.delivered_n.y, 600.0, 1e-4);
}

/// A ramp is held over the halves of a quarter of the control period, which ends at five sixths of its own way \[s\].
const BEHIND_S: f64 = 5e-5 / 4.0 / 6.0;

/// 1000 N at 1 MN/s take 1 ms; the momentum of the ramp is F²/(2·slew) less.
#[test]
fn a_slew_limit_makes_a_ramp() {
    let mut scene = pushed(V2::new(1.0, 0.0));
    scene.planes[0].amplifier.slew_n_s = Some(1e6);
    without_lag(&mut scene);
    let trace = ridden(&scene, PolicyKind::Radial).1;
    for row in samples(&trace) {
        // In effect from the second sample on; what is read off is held last, a sixth of a part behind.
        let since = row.plant.t_s - 5e-5;
        let expected = (1e6 * (since - BEHIND_S)).clamp(0.0, 1000.0);
        if since > 0.0 && (since - 1e-3).abs() > 1e-6 {
            assert!((row.plant.delivered_n.x - expected).abs() < 1e-6, "{since}");
        }
    }
    let speed = 1000.0 * (0.004 - 5e-5 - 0.5e-3) / 10.0;
    near("speed", last(&trace).plant.velocity_m_s.x, speed, 1e-12);
    // Behind the lag the ramp arrives τ later.
    let mut lagged = pushed(V2::new(1.0, 0.0));
    lagged.planes[0].amplifier.slew_n_s = Some(1e6);
    let row = samples(&ridden(&lagged, PolicyKind::Radial).1)[20];
    let (since, lag) = (row.plant.t_s - 5e-5, 1.6e-4);
    let expected = 1e6 * (since - lag * (1.0 - (-since / lag).exp()));
    near("behind the lag", row.plant.delivered_n.x, expected, 1e-3);
}

/// The field of a failed axis decays with the lag from the exact beginning of the outage, and comes back
/// with it.
#[test]
fn an_outage_lets_the_force_decay() {
    for (axis, fails) in [
        (Axis::X, [true, false]),
        (Axis::Y, [false, true]),
        (Axis::Both, [true, true]),
    ] {
        let mut scene = pushed(V2::new(0.8, 0.6));
        let (start_s, end_s) = (0.002_013, 0.003_027);
        scene.planes[0].outages = vec![Outage {
            duration_s: end_s - start_s,
            ..outage(Delivers::Nothing, axis, start_s)
        }];
        let lag = 1.6e-4;
        // The direction turns by some 1e-5 on the way.
        for row in samples(&ridden(&scene, PolicyKind::Radial).1) {
            let t = row.plant.t_s;
            let risen = |t: f64| 1.0 - (-(t - 5e-5) / lag).exp();
            for (i, failed) in fails.into_iter().enumerate() {
                let full = [800.0, 600.0][i];
                let share = if t < 5e-5 {
                    0.0
                } else if !failed || t < start_s {
                    risen(t)
                } else if t < end_s {
                    risen(start_s) * (-(t - start_s) / lag).exp()
                } else {
                    let left = risen(start_s) * (-(end_s - start_s) / lag).exp();
                    1.0 + (left - 1.0) * (-(t - end_s) / lag).exp()
                };
                let found = row.plant.delivered_n[i];
                assert!((found - full * share).abs() < 5e-2, "{axis:?} {t}: {found}");
            }
        }
    }
}

/// An inverted amplifier delivers the force with the other sign, a swapped one along the other axis, each from the
/// exact beginning of the fault on; the slew limit goes through all of it, and is not reset.
#[test]
fn a_faulty_amplifier_turns_the_force() {
    for (delivers, axis, turned) in [
        (Delivers::Inverted, Axis::X, [-800.0, 600.0]),
        (Delivers::Inverted, Axis::Y, [800.0, -600.0]),
        (Delivers::Inverted, Axis::Both, [-800.0, -600.0]),
        (Delivers::Swapped, Axis::Both, [600.0, 800.0]),
    ] {
        let mut scene = pushed(V2::new(0.8, 0.6));
        without_lag(&mut scene);
        let start_s = 0.002_013;
        scene.planes[0].outages = vec![outage(delivers, axis, start_s)];
        for row in samples(&ridden(&scene, PolicyKind::Radial).1)
            .iter()
            .skip(2)
        {
            let expected = if row.plant.t_s < start_s {
                [800.0, 600.0]
            } else {
                turned
            };
            for (found, expected) in row.plant.delivered_n.iter().zip(expected) {
                // The direction turns a little as the rotor moves.
                assert!((found - expected).abs() < 1.0, "{delivers:?}: {found}");
            }
        }
        scene.planes[0].amplifier.slew_n_s = Some(1e6);
        let rows = ridden(&scene, PolicyKind::Radial).1;
        let steps = rows.rows.array_windows();
        let fastest = steps.map(|[a, b]| {
            let way = (b.plant.delivered_n - a.plant.delivered_n).amax();
            way / (b.plant.t_s - a.plant.t_s)
        });
        // Where a ramp ends within a period, what was behind is made good.
        let most = 1e6 * (1.0 + BEHIND_S / 5e-5);
        assert!(fastest.fold(0.0, f64::max) < 1.0001 * most);
    }
}

/// An axis that delivers nothing does so whatever else is wrong, in any order, with a slew limit and without.
#[test]
fn a_dead_axis_is_dead_under_every_other_fault() {
    let dead = outage(Delivers::Nothing, Axis::X, 0.0);
    let swapped = outage(Delivers::Swapped, Axis::Both, 0.0);
    for (outages, slew_n_s) in [
        (vec![dead, swapped], None),
        (vec![swapped, dead], None),
        (vec![dead, swapped], Some(2e6)),
        (vec![swapped, dead], Some(2e6)),
    ] {
        let mut scene = pushed(V2::new(0.8, 0.6));
        without_lag(&mut scene);
        scene.planes[0].outages = outages;
        scene.planes[0].amplifier.slew_n_s = slew_n_s;
        let trace = ridden(&scene, PolicyKind::Radial).1;
        assert!(samples(&trace).iter().all(|r| r.plant.delivered_n.x == 0.0));
        // What is meant for x.
        let along_y = last(&trace).plant.delivered_n.y;
        assert!((along_y - 800.0).abs() < 2.0, "{along_y}");
    }
}

/// What reads as infinite has no direction: the policy `radial` gives nothing, and what is fed forward stays.
#[test]
fn an_infinite_reading_does_not_take_what_is_fed_forward() {
    let mut scene = pushed(V2::new(1.0, 0.0));
    without_lag(&mut scene);
    scene.planes[0].feed_forward_n = V2::new(0.0, 98.1);
    scene.planes[0].faults = vec![Fault {
        start_s: 0.0,
        duration_s: 1.0,
        kind: FaultKind::Infinity,
        axis: Axis::Both,
    }];
    let end = last(&ridden(&scene, PolicyKind::Radial).1).plant;
    assert_eq!(end.delivered_n, V2::new(0.0, 98.1));
}

/// The command of the first sample is in effect so many samples later, and not before.
#[test]
fn commands_take_effect_after_their_delay() {
    for delay in 1..=7 {
        let mut scene = pushed(V2::new(1.0, 0.0));
        scene.planes[0].amplifier.delay_samples = delay;
        without_lag(&mut scene);
        let trace = ridden(&scene, PolicyKind::Radial).1;
        let rows = samples(&trace);
        let first = rows.iter().position(|r| r.commanded_n.x != 0.0).unwrap();
        assert_eq!(first, delay);
        let speed = 1000.0 * (0.004 - 5e-5 * delay as f64) / 10.0;
        near("speed", last(&trace).plant.velocity_m_s.x, speed, 1e-12);
    }
}

/// Asks for as many newtons as it has been asked.
#[derive(Debug, Default)]
struct Counting(f64);

impl Controller for Counting {
    fn command(&mut self, _seen: &Seen, _truth: &Snapshot) -> Force {
        self.0 += 1.0;
        Force::Computed(V2::new(self.0, 0.0))
    }
}

/// Each is late by 0 to 3 samples more than the delay, none comes after a newer one, and the seed decides.
#[test]
fn commands_may_be_late_by_chance() {
    let mut scene = pushed(V2::new(1.0, 0.0));
    scene.duration_s = 0.1;
    (
        scene.planes[0].amplifier.delay_samples,
        scene.planes[0].amplifier.jitter_samples,
    ) = (2, 3);
    let in_effect = |scene: &Scene| -> Vec<f64> {
        let counting: Box<dyn Controller> = Box::<Counting>::default();
        let trace = run_policy(scene, (counting, "counting"), Keep::Trace, &mut |_| {})
            .unwrap()
            .1;
        samples(&trace)
            .iter()
            .map(|row| row.commanded_n.x)
            .collect()
    };
    let first = in_effect(&scene);
    let mut seen = [0; 4];
    for (i, pair) in first.windows(2).enumerate().skip(8) {
        assert!(pair[1] >= pair[0], "{pair:?}");
        // The command of sample i has the number i + 1.
        let age = (i + 2) as f64 - pair[1];
        assert!((2.0..=5.0).contains(&age), "{age}");
        seen[age as usize - 2] += 1;
    }
    assert!(seen[..3].iter().all(|count| *count > 100), "{seen:?}");
    assert_eq!(in_effect(&scene), first);
    scene.planes[0].seed += 1;
    assert_ne!(in_effect(&scene), first);
    scene.planes[0].amplifier.jitter_samples = 0;
    let plain = in_effect(&scene);
    // The last row is that of the end, at which nothing takes effect any more.
    let ticks = plain[..plain.len() - 1].iter().enumerate();
    assert!(ticks.skip(2).all(|(i, x)| *x == i as f64 - 1.0));
}

/// Firmware that knows of an outage of both axes switches the supervisor to watching; of one, it tells it
/// which.
#[test]
fn a_known_outage_is_told() {
    let mut scene = scene("overload_then_release");
    scene.duration_s = 0.04;
    let mut modes = |outages: &[(Axis, bool)]| -> Vec<_> {
        let outage = |&(axis, known): &(Axis, bool)| Outage {
            known,
            ..outage(Delivers::Nothing, axis, 0.0)
        };
        scene.planes[0].outages = outages.iter().map(outage).collect();
        let rows = samples(&ridden(&scene, PolicyKind::Supervisor).1).into_iter();
        rows.map(|r| (r.supervisor_mode(), r.commanded_n)).collect()
    };
    let known = modes(&[(Axis::Both, true)]);
    assert!(modes(&[(Axis::Both, false)]) != known);
    let both = modes(&[(Axis::X, true), (Axis::Y, true)]);
    assert!(both == known, "one after the other");
    let told = modes(&[(Axis::X, true), (Axis::Y, false)]);
    assert!(told.iter().all(|(_, force_n)| force_n.x == 0.0));
    assert!(told.iter().any(|(_, force_n)| force_n.y != 0.0));
}

/// v̇ = −d/m·v, but for the delay; saturated it brakes with the cap.
#[test]
fn damping_brakes_and_does_not_centre() {
    let mut scene = free_rotor();
    without_lag(&mut scene);
    scene.planes[0].levitation = None;
    scene.planes[0].damping_n_s_m = 100.0;
    scene.start.centre_velocity_m_s = V2::new(0.3, 0.4);
    scene.start.centre_m = V2::new(1e-3, 0.0);
    scene.duration_s = 0.2;
    let end = last(&ridden(&scene, PolicyKind::Damping).1).plant;
    // The first command is zero, the others come one sample late from a speed half a sample old.
    let left = (-(0.2f64 - 2e-4) / 0.1).exp();
    near("speed", end.velocity_m_s.norm(), 0.5 * left, 5e-3);
    scene.planes[0].damping_n_s_m = 1e6;
    scene.duration_s = 2e-3;
    let end = last(&ridden(&scene, PolicyKind::Damping).1).plant;
    near(
        "saturated",
        end.velocity_m_s.norm(),
        0.5 - 100.0 * (2e-3 - 1e-4),
        1e-9,
    );
    assert!(apart(end.delivered_n, V2::new(-600.0, -800.0)) < 1e-6);
}

/// With a slew limit, too, an outage may begin and end anywhere against the samples, also a rounding away from one.
#[test]
fn outages_begin_at_any_time_under_a_slew_limit() {
    let mut scene = pushed(V2::new(0.8, 0.6));
    scene.duration_s = 0.02;
    scene.planes[0].amplifier.slew_n_s = Some(2e6);
    for tenth_ms in 20..120 {
        scene.planes[0].outages = vec![Outage {
            duration_s: 3e-3,
            ..outage(Delivers::Nothing, Axis::X, 1e-4 * f64::from(tenth_ms))
        }];
        let rows = samples(&ridden(&scene, PolicyKind::Radial).1);
        let out = rows
            .iter()
            .find(|row| row.plant.t_s > scene.planes[0].outages[0].end_s() - 1e-4);
        // The field has decayed for eighteen time constants on the one axis, and stands on the other.
        let left_n = out.unwrap().plant.delivered_n;
        assert!(
            left_n.x.abs() < 1e-3 && left_n.y > 599.0,
            "{tenth_ms}: {left_n}"
        );
    }
}

/// Whether the force is measured, and what it is [N], tick by tick.
type Told = Rc<RefCell<Vec<(bool, [f32; 2])>>>;

/// Keeps what the supervisor behind it is told of the force.
#[derive(Debug)]
struct Listening {
    supervisor: Supervisor,
    told: Told,
}

impl Supervise for Listening {
    fn tick(&mut self, sample: &Sample) -> Command {
        let valid = sample.status.contains(Status::APPLIED_VALID);
        self.told.borrow_mut().push((valid, sample.applied_n));
        self.supervisor.tick(sample)
    }
}

/// A measured force is the one that the magnet delivers at the sample, without what is fed forward; a scene in which
/// nobody measures it says so.
#[test]
fn a_measured_force_is_told() {
    for measured in [false, true] {
        let mut scene = scene("shock_15_g_on_amb");
        scene.planes[0].amplifier.force_measured = measured;
        scene.planes[0].feed_forward_n = V2::new(0.0, 98.1);
        let told = Told::default();
        let supervisor = Listening {
            supervisor: Supervisor::new(&scene.planes[0].supervisor.unwrap()).unwrap(),
            told: Rc::clone(&told),
        };
        let policy = supervised(&scene, Box::new(supervisor)).unwrap();
        let acting = (policy, "supervisor");
        let (_, trace) = run_policy(&scene, acting, Keep::Trace, &mut |_| {}).unwrap();
        let told = told.borrow();
        let mut most = 0.0_f64;
        for (row, (valid, applied_n)) in samples(&trace).iter().zip(told.iter()) {
            let expected = row.plant.delivered_n - scene.planes[0].feed_forward_n;
            assert_eq!(*valid, measured);
            let expected = if measured { expected } else { V2::zeros() };
            assert_eq!(*applied_n, [expected.x as f32, expected.y as f32]);
            most = most.max(expected.norm());
        }
        assert!(!measured || most > 500.0, "{most}");
    }
}
