//! The check of a configuration against the levitated machine.

use supervisor::{Config, Finding, RotorSupervisor, Sample, Shaft, Status, Supervisor};
use test_support::rig::{all_at, length};

const TICK_S: f64 = 50e-6;
const PARTS: u32 = 4;
const SPIN_RAD_S: f64 = 300.0;

/// A rotor in one plane on a levitation controller of proportional and derivative action, with a lag of the force that begins a
/// tick after its sample.
#[derive(Default)]
struct Machine {
    position_m: [f64; 2],
    velocity_m_s: [f64; 2],
    force_n: [f64; 2],
    commanded_n: [f64; 2],
    last_m: [f64; 2],
    angle_rad: f64,
    noise: u32,
}

impl Machine {
    fn new() -> Self {
        Self {
            noise: 1,
            ..Self::default()
        }
    }

    fn read_m(&mut self) -> [f32; 2] {
        self.position_m.map(|x| {
            self.noise = (self.noise.wrapping_mul(1_664_525)).wrapping_add(1_013_904_223);
            // Some half a micrometre.
            (x + 1.5e-6 * (f64::from(self.noise) / f64::from(u32::MAX) - 0.5)) as f32
        })
    }

    fn levitation_n(&mut self, read_m: [f32; 2]) -> [f32; 2] {
        let before = std::mem::replace(&mut self.last_m, read_m.map(f64::from));
        [0, 1].map(|axis| {
            let now = f64::from(read_m[axis]);
            (-2.5e6 * now - 2.5e3 * (now - before[axis]) / TICK_S) as f32
        })
    }

    /// A tick under the last command; then this one.
    fn advance(&mut self, command_n: [f32; 2]) {
        let c = Config::example();
        let part_s = TICK_S / f64::from(PARTS);
        for _ in 0..PARTS {
            self.angle_rad += SPIN_RAD_S * part_s;
            let unbalance_n = 10.0 * 4e-6 * SPIN_RAD_S.powi(2);
            let turning = [self.angle_rad.cos(), self.angle_rad.sin()].map(|x| unbalance_n * x);
            for (axis, turning) in turning.into_iter().enumerate() {
                let to = self.commanded_n[axis] - self.force_n[axis];
                self.force_n[axis] += to * (1.0 - (-part_s / f64::from(c.amplifier_lag_s)).exp());
                let sum = self.force_n[axis] + turning
                    - f64::from(c.stiffness_n_m) * self.position_m[axis];
                self.velocity_m_s[axis] += sum / f64::from(c.mass_kg) * part_s;
                self.position_m[axis] += self.velocity_m_s[axis] * part_s;
            }
        }
        self.commanded_n = command_n.map(f64::from);
    }
}

/// What firmware does between machine and supervisor.
#[derive(Clone, Copy)]
struct Wiring {
    position: fn([f32; 2]) -> [f32; 2],
    force: fn([f32; 2]) -> [f32; 2],
    spin: f32,
    status: Status,
    stimulus: f32,
}

const RIGHT: Wiring = Wiring {
    position: |x| x,
    force: |f| f,
    spin: 1.0,
    status: Status::BEARING_ON.union(Status::SPIN_VALID),
    stimulus: 1.0,
};

/// Right but for a change.
fn wired(change: fn(&mut Wiring)) -> Wiring {
    let mut wiring = RIGHT;
    change(&mut wiring);
    wiring
}

fn asked() -> Config {
    Config {
        check_first: 1.0,
        ..Config::example()
    }
}

/// Two and a half seconds of levitation, or until something is found. Commands go through as they were asked for: nothing acts.
fn levitate(config: &Config, wiring: &Wiring) -> (Supervisor<64>, Finding, u32) {
    let mut supervisor = Supervisor::<64>::new(config).unwrap();
    let mut machine = Machine::new();
    for sequence in 0..60_000 {
        let read_m = machine.read_m();
        let stimulus_n = supervisor.stimulus_n();
        let configured_n = (wiring.force)(machine.levitation_n(read_m));
        let now = Sample {
            sequence,
            status: wiring.status,
            position_m: (wiring.position)(read_m),
            spin_rad_s: wiring.spin * SPIN_RAD_S as f32,
            levitation_n: [0, 1]
                .map(|axis| configured_n[axis] + wiring.stimulus * stimulus_n[axis]),
            ..Sample::default()
        };
        let command = supervisor.tick(&now);
        let finding = supervisor.report().checked.finding;
        if finding != Finding::NotYet {
            return (supervisor, finding, sequence);
        }
        assert_eq!(command.force_n, now.levitation_n);
        // Each of these is its own inverse, but for the amperes.
        let gain = (wiring.force)([1.0, 1.0])[0].abs();
        machine.advance((wiring.force)(command.force_n).map(|n| n / (gain * gain)));
    }
    (supervisor, Finding::NotYet, 60_000)
}

/// What is commanded, and of its own, once the rotor is thrown at the wall, in the ticks after this one.
fn thrown(supervisor: &mut Supervisor<64>, ticks: u32, spin_rad_s: f32) -> [f64; 2] {
    let commands = (0..12).map(|n| {
        supervisor.tick(&Sample {
            sequence: ticks + 1 + n,
            status: RIGHT.status | Status::LEVITATED_BEFORE,
            position_m: [2e-5 * n as f32, 0.0],
            spin_rad_s,
            ..Sample::default()
        })
    });
    let last = commands.last().unwrap();
    [last.force_n, last.own_n].map(length)
}

/// Requirement: SR-42
#[test]
fn a_machine_that_is_as_configured_passes_and_is_left_alone() {
    let (mut supervisor, finding, ticks) = levitate(&asked(), &RIGHT);
    assert_eq!(finding, Finding::Passed);
    // One window without stimulus, nine with it and three of the orbit, 0.2 s each.
    assert!((51_000..54_000).contains(&ticks), "{ticks}");
    assert_eq!(supervisor.stimulus_n(), [0.0; 2]);
    assert!(thrown(&mut supervisor, ticks, 300.0)[0] > 900.0);
    // The same of one that has not been asked yet: it says what it would do, and does not.
    let mut waits = Supervisor::<64>::new(&asked()).unwrap();
    let [acts_n, own_n] = thrown(&mut waits, 0, 300.0);
    assert!(acts_n == 0.0 && own_n > 900.0, "{acts_n} {own_n}");
    assert_eq!(waits.report().checked.finding, Finding::NotYet);
}

/// Requirement: SR-42
#[test]
fn mistakes_are_found_and_named() {
    let swapped_position = wired(|w| w.position = |[x, y]| [y, x]);
    let swapped_force = wired(|w| w.force = |[x, y]| [y, x]);
    let mistakes: [(Wiring, Finding); 8] = [
        (swapped_position, Finding::AxesSwapped),
        (swapped_force, Finding::AxesSwapped),
        (
            wired(|w| w.position = |[x, y]| [x, -y]),
            Finding::AxisInverted,
        ),
        (
            wired(|w| w.force = |[x, y]| [-x, -y]),
            Finding::ForceInverted,
        ),
        // Amperes, micrometres, turns per minute.
        (wired(|w| w.force = |f| f.map(|f| f / 40.0)), Finding::Gain),
        (
            wired(|w| w.position = |x| x.map(|x| 1e6 * x)),
            Finding::Position,
        ),
        (wired(|w| w.spin = 9.549_297), Finding::SpinUnit),
        (wired(|w| w.spin = -1.0), Finding::SpinReversed),
    ];
    for (i, (wiring, finding)) in mistakes.into_iter().enumerate() {
        assert_eq!(levitate(&asked(), &wiring).1, finding, "{i}");
    }
    type Change = fn(&mut Config);
    let configs: [(Change, Finding); 5] = [
        (|c| c.mass_kg = 20.0, Finding::Gain),
        (|c| c.sample_period_s = 1e-4, Finding::Gain),
        (|c| c.retainer_plane_ratio = 2.0, Finding::Gain),
        (|c| c.delay_samples = 5.0, Finding::Delay),
        (|c| c.amplifier_lag_s = 6e-4, Finding::Delay),
    ];
    for (change, finding) in configs {
        let mut config = asked();
        change(&mut config);
        let found = levitate(&config, &RIGHT);
        assert_eq!(found.1, finding, "{config:?}");
        let by = found.0.report().checked.value;
        assert!(by.is_finite());
        // Mass by how much, as the finding says.
        let as_said = config.mass_kg < 20.0 || (by / 2.0 - 1.0).abs() < 0.1;
        assert!(as_said, "{by}");
    }
}

/// A spin that is contradicted is not believed, and all else goes on.
///
/// Requirement: SR-42
#[test]
fn a_spin_that_is_contradicted_is_not_believed() {
    let (mut supervisor, finding, ticks) = levitate(&asked(), &wired(|w| w.spin = -1.0));
    assert_eq!(finding, Finding::SpinReversed);
    // It acts.
    assert!(thrown(&mut supervisor, ticks, -300.0)[0] > 900.0);
}

/// Without a stimulus, or without the bearing, nothing is known and nothing acts.
///
/// Requirement: SR-42
#[test]
fn what_was_not_seen_is_not_trusted() {
    let (supervisor, finding, _) = levitate(&asked(), &wired(|w| w.status = Status::SPIN_VALID));
    assert_eq!(finding, Finding::NotYet);
    assert_eq!(supervisor.stimulus_n(), [0.0; 2]);
    let (_, finding, _) = levitate(&asked(), &wired(|w| w.stimulus = 0.0));
    assert_eq!(finding, Finding::NotYet);
}

/// A rotor that lies at half of the clearance: it is a diameter. Where it lies as it should, nothing is said.
#[test]
fn a_clearance_that_is_a_diameter_shows_at_rest() {
    for (clearance_m, finding) in [(4e-4, Finding::Clearance), (2e-4, Finding::NotYet)] {
        let config = Config {
            clearance_m,
            ..asked()
        };
        let mut supervisor = Supervisor::<64>::new(&config).unwrap();
        for sequence in 0..8_000 {
            supervisor.tick(&Sample {
                sequence,
                position_m: [1.2e-4, -1.6e-4],
                ..Sample::default()
            });
        }
        let found = supervisor.report().checked.finding;
        assert_eq!(found, finding, "{clearance_m}");
    }
}

/// After a change of the configuration the machine is asked again.
#[test]
fn another_configuration_is_checked_anew() {
    let (mut supervisor, finding, _) = levitate(&asked(), &RIGHT);
    assert_eq!(finding, Finding::Passed);
    supervisor.reconfigure(&asked()).unwrap();
    assert_eq!(supervisor.report().checked.finding, Finding::NotYet);
    supervisor.reconfigure(&Config::example()).unwrap();
    assert_eq!(supervisor.report().checked.finding, Finding::Unchecked);
}

/// The halves say the same, and a self-test in between changes nothing.
#[test]
fn a_self_test_leaves_the_check_where_it_was() {
    let mut supervisor = Supervisor::<64>::new(&asked()).unwrap();
    assert!(supervisor.self_test().passed);
    assert_eq!(supervisor.report().checked.finding, Finding::NotYet);
    let (mut ticker, reader) = supervisor.split();
    ticker.tick(&Sample::default());
    let published = reader.published().report().unwrap();
    assert_eq!(published.checked.finding, Finding::NotYet);
    assert_eq!(ticker.stimulus_n(), [0.0; 2]);
}

/// Two ends that move alike: one after the other is asked, and both have to pass.
#[test]
fn a_rotor_acts_once_both_planes_have_passed() {
    // Ends that know nothing of each other: I_t = m·z², so that each carries half of the mass.
    let shaft = Shaft {
        mass_kg: 20.0,
        transverse_inertia_kg_m2: 0.8,
        polar_inertia_kg_m2: 0.01,
        places: [all_at(-0.2), all_at(0.2)],
    };
    let mut rotor = RotorSupervisor::<64>::new(&shaft, &[asked(); 2]).unwrap();
    let mut ends = [Machine::new(), Machine::new()];
    let (mut sequence, mut passed) = (0, [false; 2]);
    while passed != [true; 2] && sequence < 110_000 {
        let stimuli_n = rotor.stimulus_n();
        assert!(stimuli_n.contains(&[0.0; 2]));
        let samples = [0, 1].map(|end| {
            let position_m = ends[end].read_m();
            let asked_n = ends[end].levitation_n(position_m);
            Sample {
                sequence,
                status: RIGHT.status,
                position_m,
                spin_rad_s: SPIN_RAD_S as f32,
                levitation_n: [0, 1].map(|axis| asked_n[axis] + stimuli_n[end][axis]),
                ..Sample::default()
            }
        });
        let commands = rotor.tick(&samples).planes;
        for (end, command) in ends.iter_mut().zip(commands) {
            end.advance(command.force_n);
        }
        passed = [0, 1].map(|end| rotor.plane(end).report().checked.finding == Finding::Passed);
        sequence += 1;
    }
    assert_eq!(passed, [true; 2]);
    assert!((102_000..108_000).contains(&sequence), "{sequence}");
}
