//! The check of a configuration against the levitated machine.

use supervisor::{
    Command, Config, Finding, PlanePositions, RotorSupervisor, Sample, Shaft, Status, Supervisor,
};
use test_support::rig::length;

const TICK_S: f64 = 50e-6;
const PARTS: u32 = 4;

/// A rotor in one plane on a levitation controller of proportional and derivative action, with a lag of the force that begins a
/// tick after its sample.
#[derive(Clone)]
struct Machine {
    position_m: [f64; 2],
    velocity_m_s: [f64; 2],
    force_n: [f64; 2],
    commanded_n: [f64; 2],
    last_m: [f64; 2],
    angle_rad: f64,
    spin_rad_s: f64,
    noise: u32,
}

impl Machine {
    fn new(spin_rad_s: f64) -> Self {
        Self {
            position_m: [0.0; 2],
            velocity_m_s: [0.0; 2],
            force_n: [0.0; 2],
            commanded_n: [0.0; 2],
            last_m: [0.0; 2],
            angle_rad: 0.0,
            spin_rad_s,
            noise: 1,
        }
    }

    fn read_m(&mut self) -> [f32; 2] {
        self.position_m.map(|x| {
            self.noise = self
                .noise
                .wrapping_mul(1_664_525)
                .wrapping_add(1_013_904_223);
            // Some half a micrometre.
            (x + 1.5e-6 * (f64::from(self.noise) / f64::from(u32::MAX) - 0.5)) as f32
        })
    }

    fn levitation_n(&mut self, read_m: [f32; 2]) -> [f32; 2] {
        let before = std::mem::replace(&mut self.last_m, read_m.map(f64::from));
        let mut force = [0.0; 2];
        for ((force, now), before) in force.iter_mut().zip(read_m).zip(before) {
            let speed = (f64::from(now) - before) / TICK_S;
            *force = (-2.5e6 * f64::from(now) - 2.5e3 * speed) as f32;
        }
        force
    }

    /// A tick under the last command; then this one.
    fn advance(&mut self, command_n: [f32; 2]) {
        let c = Config::example();
        let part_s = TICK_S / f64::from(PARTS);
        for _ in 0..PARTS {
            self.angle_rad += self.spin_rad_s * part_s;
            let unbalance_n = 10.0 * 4e-6 * self.spin_rad_s.powi(2);
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
struct Wiring {
    position: fn([f32; 2]) -> [f32; 2],
    force: fn([f32; 2]) -> [f32; 2],
    spin: f32,
    status: Status,
}

const RIGHT: Wiring = Wiring {
    position: |x| x,
    force: |f| f,
    spin: 1.0,
    status: Status::BEARING_ON.union(Status::SPIN_VALID),
};

fn asked() -> Config {
    Config {
        check_first: 1.0,
        ..Config::example()
    }
}

/// Two and a half seconds of levitation, or until something is found. Commands go through as they were asked for: nothing acts.
fn levitate(config: &Config, wiring: &Wiring) -> (Supervisor<64>, Finding, u32) {
    let mut supervisor = Supervisor::<64>::new(config).unwrap();
    let mut machine = Machine::new(300.0);
    for sequence in 0..60_000 {
        let read_m = machine.read_m();
        let levitation_n = machine.levitation_n(read_m);
        let command = tick(
            &mut supervisor,
            wiring,
            (sequence, read_m, levitation_n),
            300.0,
        );
        machine.advance(command);
        let finding = supervisor.report().checked.finding;
        if finding != Finding::NotYet {
            return (supervisor, finding, sequence);
        }
    }
    (supervisor, Finding::NotYet, 60_000)
}

fn tick(
    supervisor: &mut Supervisor<64>,
    wiring: &Wiring,
    (sequence, read_m, levitation_n): (u32, [f32; 2], [f32; 2]),
    spin_rad_s: f32,
) -> [f32; 2] {
    let stimulus_n = supervisor.stimulus_n();
    let told_n = (wiring.force)(levitation_n);
    let sample = Sample {
        sequence,
        status: wiring.status,
        position_m: (wiring.position)(read_m),
        spin_rad_s: wiring.spin * spin_rad_s,
        levitation_n: [told_n[0] + stimulus_n[0], told_n[1] + stimulus_n[1]],
        ..Sample::default()
    };
    let command = supervisor.tick(&sample);
    // Each of these is its own inverse, but for the amperes.
    let [x, y] = (wiring.force)(command.force_n);
    let gain = (wiring.force)([1.0, 1.0])[0].abs();
    [x / (gain * gain), y / (gain * gain)]
}

/// Requirement: SR-42
#[test]
fn a_machine_that_is_as_configured_passes_and_is_left_alone() {
    let (mut supervisor, finding, ticks) = levitate(&asked(), &RIGHT);
    assert_eq!(finding, Finding::Passed);
    // One window without stimulus, nine with it and three of the orbit, 0.2 s each.
    assert!((51_000..54_000).contains(&ticks), "{ticks}");
    assert_eq!(supervisor.stimulus_n(), [0.0; 2]);
    let sample = |sequence: u32, x_m: f32| Sample {
        sequence,
        status: RIGHT.status | Status::LEVITATED_BEFORE,
        position_m: [x_m, 0.0],
        spin_rad_s: 300.0,
        ..Sample::default()
    };
    let thrown = |supervisor: &mut Supervisor<64>| -> Command {
        let ticks = (0..12).map(|n| supervisor.tick(&sample(ticks + 1 + n, 2e-5 * n as f32)));
        ticks.last().unwrap()
    };
    let command = thrown(&mut supervisor);
    assert!(length(command.force_n) > 900.0, "{command:?}");
    // The same of one that has not been asked yet: it says what it would do, and does not.
    let mut waits = Supervisor::<64>::new(&asked()).unwrap();
    let command = thrown(&mut waits);
    assert_eq!(command.force_n, [0.0; 2]);
    assert!(length(command.own_n) > 900.0);
    assert_eq!(waits.report().checked.finding, Finding::NotYet);
}

/// Requirement: SR-42
#[test]
fn mistakes_are_found_and_named() {
    let swapped = |[x, y]: [f32; 2]| [y, x];
    let inverted = |[x, y]: [f32; 2]| [x, -y];
    let other_way = |[x, y]: [f32; 2]| [-x, -y];
    let amperes = |f: [f32; 2]| f.map(|f| f / 40.0);
    let micrometres = |x: [f32; 2]| x.map(|x| 1e6 * x);
    let cases: [(&str, Wiring, Finding); 8] = [
        (
            "position exchanged",
            Wiring {
                position: swapped,
                ..RIGHT
            },
            Finding::AxesSwapped,
        ),
        (
            "force exchanged",
            Wiring {
                force: swapped,
                ..RIGHT
            },
            Finding::AxesSwapped,
        ),
        (
            "y inverted",
            Wiring {
                position: inverted,
                ..RIGHT
            },
            Finding::AxisInverted,
        ),
        (
            "force inverted",
            Wiring {
                force: other_way,
                ..RIGHT
            },
            Finding::ForceInverted,
        ),
        (
            "amperes",
            Wiring {
                force: amperes,
                ..RIGHT
            },
            Finding::Gain,
        ),
        (
            "micrometres",
            Wiring {
                position: micrometres,
                ..RIGHT
            },
            Finding::Position,
        ),
        (
            "spin reversed",
            Wiring {
                spin: -1.0,
                ..RIGHT
            },
            Finding::SpinReversed,
        ),
        (
            "spin in 1/min",
            Wiring {
                spin: 9.549_297,
                ..RIGHT
            },
            Finding::SpinUnit,
        ),
    ];
    for (name, wiring, finding) in cases {
        assert_eq!(levitate(&asked(), &wiring).1, finding, "{name}");
    }
    let right = asked();
    let configs = [
        (
            Config {
                mass_kg: 20.0,
                ..right
            },
            Finding::Gain,
        ),
        (
            Config {
                sample_period_s: 1e-4,
                ..right
            },
            Finding::Gain,
        ),
        (
            Config {
                retainer_plane_ratio: 2.0,
                ..right
            },
            Finding::Gain,
        ),
        (
            Config {
                delay_samples: 5.0,
                ..right
            },
            Finding::Delay,
        ),
        (
            Config {
                amplifier_lag_s: 6e-4,
                ..right
            },
            Finding::Delay,
        ),
    ];
    for (config, finding) in configs {
        let found = levitate(&config, &RIGHT);
        assert_eq!(found.1, finding, "{config:?}");
        assert!(found.0.report().checked.value.is_finite());
    }
}

/// Mass and gain by how much, as the finding says.
#[test]
fn a_finding_says_by_how_much() {
    let (supervisor, ..) = levitate(
        &Config {
            mass_kg: 20.0,
            ..asked()
        },
        &RIGHT,
    );
    let checked = supervisor.report().checked;
    assert!((checked.value / 2.0 - 1.0).abs() < 0.1, "{checked:?}");
}

/// A spin that is contradicted is not believed, and all else goes on.
///
/// Requirement: SR-42
#[test]
fn a_spin_that_is_contradicted_is_not_believed() {
    let reversed = Wiring {
        spin: -1.0,
        ..RIGHT
    };
    let (mut supervisor, finding, ticks) = levitate(&asked(), &reversed);
    assert_eq!(finding, Finding::SpinReversed);
    // It acts.
    let mut last = Command::default();
    for n in 0..12 {
        last = supervisor.tick(&Sample {
            sequence: ticks + 1 + n,
            status: RIGHT.status | Status::LEVITATED_BEFORE,
            position_m: [2e-5 * n as f32, 0.0],
            spin_rad_s: -300.0,
            ..Sample::default()
        });
    }
    assert!(length(last.force_n) > 900.0, "{last:?}");
}

/// Without a stimulus, or without the bearing, nothing is known and nothing acts.
///
/// Requirement: SR-42
#[test]
fn what_was_not_seen_is_not_trusted() {
    let off = Wiring {
        status: Status::SPIN_VALID,
        ..RIGHT
    };
    let (supervisor, finding, _) = levitate(&asked(), &off);
    assert_eq!(
        (finding, supervisor.stimulus_n()),
        (Finding::NotYet, [0.0; 2])
    );
    let mut supervisor = Supervisor::<64>::new(&asked()).unwrap();
    let mut machine = Machine::new(300.0);
    for sequence in 0..60_000 {
        let read_m = machine.read_m();
        let levitation_n = machine.levitation_n(read_m);
        let command = supervisor.tick(&Sample {
            sequence,
            status: RIGHT.status,
            position_m: read_m,
            spin_rad_s: 300.0,
            levitation_n,
            ..Sample::default()
        });
        assert_eq!(command.force_n, levitation_n);
        machine.advance(command.force_n);
    }
    assert_eq!(supervisor.report().checked.finding, Finding::NotYet);
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
        assert_eq!(
            supervisor.report().checked.finding,
            finding,
            "{clearance_m}"
        );
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
    assert_eq!(
        reader.published().report().unwrap().checked.finding,
        Finding::NotYet
    );
    assert_eq!(ticker.stimulus_n(), [0.0; 2]);
}

/// Two ends that move alike: one after the other is asked, and both have to pass.
#[test]
fn a_rotor_acts_once_both_planes_have_passed() {
    let end = |z_m: f32| PlanePositions {
        retainer_m: z_m,
        sensor_m: z_m,
        magnet_m: z_m,
    };
    // Ends that know nothing of each other: I_t = m·z², so that each carries half of the mass.
    let shaft = Shaft {
        mass_kg: 20.0,
        transverse_inertia_kg_m2: 0.8,
        polar_inertia_kg_m2: 0.01,
        places: [end(-0.2), end(0.2)],
    };
    let mut rotor = RotorSupervisor::<64>::new(&shaft, &[asked(); 2]).unwrap();
    let mut ends = [Machine::new(300.0), Machine::new(300.0)];
    let mut sequence = 0;
    let mut seconds = [false; 2];
    while sequence < 110_000 {
        let stimuli_n = rotor.stimulus_n();
        assert!(stimuli_n[0] == [0.0; 2] || stimuli_n[1] == [0.0; 2]);
        let mut samples = [Sample::default(); 2];
        for ((sample, end), stimulus_n) in samples.iter_mut().zip(&mut ends).zip(stimuli_n) {
            let read_m = end.read_m();
            let [x, y] = end.levitation_n(read_m);
            *sample = Sample {
                sequence,
                status: RIGHT.status,
                position_m: read_m,
                spin_rad_s: 300.0,
                levitation_n: [x + stimulus_n[0], y + stimulus_n[1]],
                ..Sample::default()
            };
        }
        let commands = rotor.tick(&samples).planes;
        for (end, command) in ends.iter_mut().zip(commands) {
            end.advance(command.force_n);
        }
        seconds = [0, 1].map(|end| rotor.plane(end).report().checked.finding == Finding::Passed);
        if seconds == [true; 2] {
            break;
        }
        sequence += 1;
    }
    assert_eq!(seconds, [true; 2]);
    assert!((102_000..108_000).contains(&sequence), "{sequence}");
}
