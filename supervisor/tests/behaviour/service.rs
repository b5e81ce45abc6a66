//! What firmware needs around the tick: live reconfiguration, shadow, late commands, counters, expiry.

use supervisor::{
    CommandWatchdog, Config, Core, Events, IntegratorHint, Mode, Prepared, Status, Supervisor,
};
use test_support::rig::{
    apart, asking, config, config_with, length, new_supervisor, on_circle, sample, sample_with,
    whirl,
};

fn larger_cap() -> Config {
    config_with(|c| (c.force_max_n, c.axis_force_max_n) = (1500.0, 1500.0))
}

/// Outwards and round, onto the wall.
fn spiral(i: u32) -> [f32; 2] {
    on_circle(1.5e-4 + 1.4e-6 * i.min(40) as f32, 0.1 * i as f32)
}

/// What is known of the rotor survives a change of every unit: there and back again, a tick in between, and the
/// supervisor engages at the same tick as without.
/// Requirement: SR-29
#[test]
fn reconfiguration_keeps_what_is_known_of_the_rotor() {
    let mut other = larger_cap();
    (other.mass_kg, other.clearance_m) = (12.0, 2.5e-4);
    let engaged_after = |change: bool| {
        let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
        let mut first = None;
        for i in 0..400_u32 {
            match i {
                60 if change => supervisor.reconfigure(&other).unwrap(),
                61 if change => supervisor.reconfigure(&config()).unwrap(),
                _ => {}
            }
            // Outwards with 4 m/s²: a load that the estimate has learnt by then.
            let t = 50e-6 * i as f32;
            let command = supervisor.tick(&sample(i, [2.0 * t * t, 1e-6 * (i % 3) as f32]));
            let changed = change && (i == 60 || i == 61);
            assert_eq!(command.events.contains(Events::RECONFIGURED), changed);
            let engaged = command.mode != Mode::Levitated;
            first = first.or(engaged.then_some(i));
        }
        first.expect("it is on its way to the wall")
    };
    let (without, with) = (engaged_after(false), engaged_after(true));
    assert!(with.abs_diff(without) <= 1, "{with} {without}");
}

/// A whirl is braked across the change without a tick of rest, and the force stays within the old and
/// the new cap.
/// Requirement: SR-29
#[test]
fn reconfiguration_in_a_whirl_goes_on_braking() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let before = whirl(&mut supervisor, 0..400, Status::empty())[399];
    assert_eq!(before.mode, Mode::BackwardWhirl);
    supervisor.reconfigure(&larger_cap()).unwrap();
    let after = whirl(&mut supervisor, 400..410, Status::empty());
    assert!(after[0].events.contains(Events::RECONFIGURED));
    for command in after {
        assert_eq!(command.mode, Mode::BackwardWhirl);
        let force_n = length(command.force_n);
        let caps = 990.0..=1500.0 * (1.0 + 2e-7);
        assert!(caps.contains(&force_n), "{command:?}");
    }
}

/// In shadow the machine sees its levitation controller, bit for bit; what the supervisor would have done is
/// what it does without the bit.
/// Requirement: SR-09
#[test]
fn shadow_computes_and_does_not_act() {
    let (mut acting, mut shadow) = (new_supervisor(), new_supervisor());
    let mut modes = Vec::new();
    for i in 0..400_u32 {
        let levitation_n = [0.25 * i as f32, -3.0];
        let mut s = asking(i, spiral(i), levitation_n);
        let live = acting.tick(&s);
        s.status |= Status::SHADOW;
        let seen = shadow.tick(&s);
        let bits = [seen.force_n, levitation_n].map(|n| n.map(f32::to_bits));
        assert_eq!(bits[0], bits[1]);
        assert_eq!(seen.integrator, IntegratorHint::Run);
        assert_eq!(live.own_n, live.force_n);
        modes.push(seen.mode);
        // The estimate differs by the force that acts, which a contact does not wait for.
        if i > 200 {
            assert_eq!(seen.mode, live.mode);
            assert!(apart(seen.own_n, live.own_n) < 150.0, "{seen:?} {live:?}");
        }
    }
    assert!(modes.contains(&Mode::BackwardWhirl));
    assert!(shadow.record().is_some() || shadow.next_event().is_some());
}

/// Before the first lift the controller must not wind up, in shadow neither.
#[test]
fn in_shadow_of_a_bearing_that_is_off_the_integrator_holds() {
    for (status, hint) in [
        (Status::SHADOW, IntegratorHint::Hold),
        (Status::SHADOW | Status::BEARING_ON, IntegratorHint::Run),
    ] {
        let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
        for i in 0..20 {
            let off = sample_with(i, [0.0, -2e-4], |s| s.status = status);
            let command = supervisor.tick(&off);
            assert_eq!(command.integrator, hint, "{status:?}");
        }
    }
}

/// The core per unit does what the supervisor in SI does.
#[test]
fn the_core_is_the_supervisor_per_unit() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let mut core = Core::<f32, 64>::new(&Prepared::new(&config()).unwrap());
    let scaling = config().scaling();
    for i in 0..600_u32 {
        let s = sample(i, spiral(i));
        let own = core.tick(&scaling.sample(&s));
        assert_eq!(supervisor.tick(&s), scaling.command(&own), "tick {i}");
    }
}

/// A command holds for its time and no longer.
/// Requirement: SR-21
#[test]
fn commands_expire() {
    let mut watch = CommandWatchdog::<f32>::new(3);
    assert!(watch.expired() && watch.force() == [0.0; 2]);
    watch.renew([1.0, -2.0]);
    let forces: Vec<_> = (0..5).map(|_| watch.force()[0]).collect();
    assert_eq!(forces, [1.0, 1.0, 1.0, 0.0, 0.0]);
    assert!(watch.expired());
    watch.renew([5.0, 0.0]);
    assert!(!watch.expired());
    // What is no number is no force.
    watch.renew([f32::NAN, 7.0]);
    assert_eq!(watch.force(), [0.0, 7.0]);
    watch.renew([-2.0, f32::INFINITY]);
    assert_eq!(watch.force(), [-2.0, 0.0]);
}

/// Events that nobody takes out: the first sixteen wait, in order and untouched, later ones are lost, and the first one for
/// which there is room again says so.
#[test]
fn a_full_queue_of_events_keeps_the_first_and_tells_of_the_loss() {
    let mut supervisor = Supervisor::<64>::new(&config()).unwrap();
    let late = |i: u32| {
        let position_m = [1e-7 * (i % 3) as f32, 2e-7 * (i % 5) as f32];
        sample_with(i, position_m, |now| now.status |= Status::LATE)
    };
    for i in 0..40 {
        assert_eq!(supervisor.tick(&late(i)).events, Events::LATE);
    }
    let queued = |supervisor: &mut Supervisor<64>| {
        let events = std::iter::from_fn(|| supervisor.next_event());
        events.map(|e| (e.sequence, e.events)).collect::<Vec<_>>()
    };
    let first: Vec<_> = (0..16).map(|i| (i, Events::LATE)).collect();
    assert_eq!(queued(&mut supervisor), first);
    supervisor.tick(&late(40));
    supervisor.tick(&late(41));
    let next = [(40, Events::LATE | Events::QUEUE_FULL), (41, Events::LATE)];
    assert_eq!(queued(&mut supervisor), next);
}

/// A command that came a tick late is taken to have left its tick to the one before: the same estimate, and
/// with it the same force, as if that had been commanded.
/// Requirement: SR-20
#[test]
fn a_late_command_leaves_its_tick_to_the_one_before() {
    let levitation = |i: u32| [10.0 * (i % 7) as f32, -20.0 * (i % 5) as f32];
    let [mut informed, mut uninformed, mut commanded] = [(); 3].map(|()| new_supervisor());
    let mut differs = false;
    for i in 0..400_u32 {
        // In shadow the commands are the levitation controller's.
        let seen = |asked: u32, status: Status| {
            sample_with(i, spiral(i), |s| {
                s.status |= Status::SHADOW | status;
                s.levitation_n = levitation(asked);
            })
        };
        let late = i % 10 == 9;
        let without = uninformed.tick(&seen(i, Status::empty()));
        let as_if = if i % 10 == 8 { i - 1 } else { i };
        let b = commanded.tick(&seen(as_if, Status::empty()));
        let status = if late { Status::LATE } else { Status::empty() };
        let a = informed.tick(&seen(i, status));
        assert_eq!(a.events.contains(Events::LATE), late);
        assert_eq!(a.own_n, b.own_n, "tick {i}");
        assert_eq!(a.mode, b.mode);
        differs |= a.own_n != without.own_n;
    }
    assert!(differs, "being informed changes something");
    assert_eq!(informed.report().late_ticks, 40);
}
