//! Whether mistakes of who links the supervisor are found before it acts, and right configurations pass.

mod logs;
mod rotors;

use crate::campaign::{
    Block, Chapter, Claim, Extent, Machines, Progress, Report, StudyError, run_all,
};
use crate::machines::draw::Draw;
use crate::machines::random::RandomMachine;
use crate::paired::sensors::Sensors;
use firmware_bench::run::closed_loop::{Keep, run_policy};
use firmware_bench::run::controller::{Supervise, supervised};
use firmware_bench::scene::Scene;
use std::cell::Cell;
use std::rc::Rc;
use supervisor::{Checked, Command, Config, Finding, Sample, Supervisor};

/// Nothing was tuned on the machines of this seed.
const SEED: u64 = 20_261_128;
/// Windows of the check, and of the stimulus alone \[s, t₀\].
const WINDOWS: f64 = 22.0;
const WINDOW: (f64, f64) = (0.2, 63.0);
/// What a machine takes to come to its place \[s\].
const BEFORE_S: f64 = 0.1;
/// Sets the draw of what is beside a machine apart from that of the machine.
const OF_ROTORS: u64 = 0xc0de;

/// A mistake in a configuration.
type Change = fn(&mut Config);

/// What is wrong between firmware and supervisor.
#[derive(Debug, Clone, Copy)]
struct Mistake {
    name: &'static str,
    /// What a position of the machine becomes, and what a force does, by rows.
    position: [[f32; 2]; 2],
    force: [[f32; 2]; 2],
    spin: f32,
    config: Option<Change>,
    /// What it looks like; nothing where levitated data cannot show it.
    shows: &'static [Finding],
    /// Where it has to be found.
    counts: Counts,
}

/// Machines of which something is claimed.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Counts {
    All,
    /// Whose delay is off by more than 0.15 √(m·c/F): less does not matter.
    Late,
    /// Whose sensors have no runout at the spin, which may go round as it likes …
    Round,
    /// … and whose unbalance shows: 1 % of the clearance, beyond 1/√(m·c/F).
    Unbalanced,
}

const AS_IS: [[f32; 2]; 2] = [[1.0, 0.0], [0.0, 1.0]];
const RIGHT: Mistake = Mistake {
    name: "none",
    position: AS_IS,
    force: AS_IS,
    spin: 1.0,
    config: None,
    shows: &[Finding::Passed],
    counts: Counts::Round,
};

const fn times(factor: f32) -> [[f32; 2]; 2] {
    [[factor, 0.0], [0.0, factor]]
}

/// Turned by 20°.
const TURNED: [[f32; 2]; 2] = [[0.939_7, -0.342], [0.342, 0.939_7]];

const fn of_config(
    name: &'static str,
    config: fn(&mut Config),
    shows: &'static [Finding],
) -> Mistake {
    Mistake {
        name,
        config: Some(config),
        shows,
        ..WRONG
    }
}

const WRONG: Mistake = Mistake {
    counts: Counts::All,
    ..RIGHT
};

/// One of the time from a sample to its force.
const fn of_delay(name: &'static str, config: fn(&mut Config)) -> Mistake {
    Mistake {
        counts: Counts::Late,
        ..of_config(name, config, &[Finding::Delay])
    }
}

const MISTAKES: &[Mistake] = &[
    Mistake {
        name: "x and y of the position exchanged",
        position: [[0.0, 1.0], [1.0, 0.0]],
        shows: &[Finding::AxesSwapped],
        ..WRONG
    },
    Mistake {
        name: "x and y of the force exchanged",
        force: [[0.0, 1.0], [1.0, 0.0]],
        shows: &[Finding::AxesSwapped],
        ..WRONG
    },
    Mistake {
        name: "x of the position inverted",
        position: [[-1.0, 0.0], [0.0, 1.0]],
        shows: &[Finding::AxisInverted],
        ..WRONG
    },
    Mistake {
        name: "y of the force inverted",
        force: [[1.0, 0.0], [0.0, -1.0]],
        shows: &[Finding::AxisInverted],
        ..WRONG
    },
    Mistake {
        name: "force inverted",
        force: times(-1.0),
        shows: &[Finding::ForceInverted],
        ..WRONG
    },
    Mistake {
        name: "axes turned by 20°",
        position: TURNED,
        shows: &[Finding::AxesTurned],
        ..WRONG
    },
    Mistake {
        name: "force in amperes of 50 N",
        force: times(0.02),
        shows: &[Finding::Gain, Finding::Position],
        ..WRONG
    },
    Mistake {
        name: "position in µm",
        position: times(1e6),
        shows: &[Finding::Position, Finding::Gain],
        ..WRONG
    },
    Mistake {
        name: "x of the position with twice its gain",
        position: [[2.0, 0.0], [0.0, 1.0]],
        shows: &[Finding::Gain, Finding::AxesSkewed],
        ..WRONG
    },
    of_config("mass × 2", |c| c.mass_kg *= 2.0, &[Finding::Gain]),
    of_config("period × 2", |c| c.sample_period_s *= 2.0, &[Finding::Gain]),
    of_config(
        "period × 10",
        |c| c.sample_period_s *= 10.0,
        &[Finding::Gain],
    ),
    of_config(
        "ratio of planes × 2",
        |c| c.retainer_plane_ratio *= 2.0,
        &[Finding::Gain],
    ),
    Mistake {
        name: "spin reversed",
        spin: -1.0,
        shows: &[Finding::SpinReversed],
        counts: Counts::Unbalanced,
        ..RIGHT
    },
    Mistake {
        name: "spin in 1/min",
        spin: 9.549_3,
        shows: &[Finding::SpinUnit],
        counts: Counts::Unbalanced,
        ..RIGHT
    },
    of_delay("delay + 2 samples", |c| c.delay_samples += 2.0),
    of_delay("delay + 3 samples", |c| c.delay_samples += 3.0),
    of_delay("lag × 3", |c| c.amplifier_lag_s *= 3.0),
    of_delay("lag / 3", |c| c.amplifier_lag_s /= 3.0),
    of_config("clearance as diameter", |c| c.clearance_m *= 2.0, &[]),
];

fn mapped([[a, b], [c, d]]: &[[f32; 2]; 2], [x, y]: [f32; 2]) -> [f32; 2] {
    [a * x + b * y, c * x + d * y]
}

fn inverse(&[[a, b], [c, d]]: &[[f32; 2]; 2]) -> [[f32; 2]; 2] {
    let by = 1.0 / (a * d - b * c);
    [[d * by, -b * by], [-c * by, a * by]]
}

/// A supervisor that sees its machine through firmware with a mistake.
#[derive(Debug)]
struct Mistaken {
    supervisor: Supervisor,
    mistake: Mistake,
    found: Rc<Cell<Checked>>,
}

impl Supervise for Mistaken {
    fn tick(&mut self, sample: &Sample) -> Command {
        let Mistake {
            position,
            force,
            spin,
            ..
        } = &self.mistake;
        // What it asks to be added comes to the force as it is reported.
        let mut levitation_n = mapped(force, sample.levitation_n);
        for (sum, more) in levitation_n.iter_mut().zip(self.supervisor.stimulus_n()) {
            *sum += more;
        }
        let seen = Sample {
            position_m: mapped(position, sample.position_m),
            levitation_n,
            applied_n: mapped(force, sample.applied_n),
            spin_rad_s: spin * sample.spin_rad_s,
            ..*sample
        };
        let command = self.supervisor.tick(&seen);
        let checked = self.supervisor.report().checked;
        if self.found.get().finding == Finding::NotYet {
            self.found.set(checked);
        }
        let back = inverse(force);
        Command {
            force_n: mapped(&back, command.force_n),
            own_n: mapped(&back, command.own_n),
            ..command
        }
    }
}

/// What became of a machine with a mistake.
#[derive(Debug, Clone)]
enum Outcome {
    Checked(Checked),
    /// The configuration contradicts itself.
    Refused,
    NoRun(String),
}

impl Outcome {
    fn is_found(&self) -> bool {
        match self {
            Self::Checked(checked) => checked.finding.is_contradiction(),
            Self::Refused => true,
            Self::NoRun(_) => false,
        }
    }

    fn is_named(&self, mistake: &Mistake) -> bool {
        match self {
            Self::Checked(checked) => mistake.shows.contains(&checked.finding),
            Self::Refused => true,
            Self::NoRun(_) => false,
        }
    }
}

/// A machine with a mistake.
#[derive(Debug, Clone)]
struct Tried {
    mistake: &'static str,
    number: u64,
    machine: String,
    sensors: String,
    counts: bool,
    /// The rotor touched, which it does not under levitation alone.
    touched: bool,
    outcome: Outcome,
}

impl Tried {
    fn new(seed: u64, number: u64, mistake: &Mistake) -> Self {
        let sensors = SENSORS[number as usize % SENSORS.len()];
        let made = scene(seed, number, sensors);
        let unbalanced = made.as_ref().is_ok_and(|(_, shows)| *shows);
        let scene = made.map(|(scene, _)| scene);
        let machine = scene
            .as_ref()
            .map_or_else(Clone::clone, |scene| scene.title.clone());
        let config = (scene.as_ref().ok()).and_then(|scene| scene.planes[0].supervisor);
        let at_spin = matches!(sensors, Sensors::Runout(_) | Sensors::EllipticRunout);
        let counts = match mistake.counts {
            Counts::All => true,
            Counts::Round => !at_spin,
            Counts::Unbalanced => !at_spin && unbalanced,
            Counts::Late => config.zip(mistake.config).is_some_and(|(right, change)| {
                let mut wrong = right;
                change(&mut wrong);
                let late_s = |c: &Config| c.delay_samples * c.sample_period_s + c.amplifier_lag_s;
                (late_s(&wrong) - late_s(&right)).abs() > 0.15 * right.scaling().time_s
            }),
        };
        let outcome = scene.and_then(|scene| outcome(&scene, mistake));
        let touched = matches!(outcome, Ok((_, true)));
        let outcome = outcome.map(|(outcome, _)| outcome);
        Self {
            mistake: mistake.name,
            number,
            machine,
            sensors: sensors.name(),
            counts,
            touched,
            outcome: outcome.unwrap_or_else(Outcome::NoRun),
        }
    }

    fn text(&self) -> String {
        let came_to = match &self.outcome {
            Outcome::Checked(Checked { finding, value }) => format!("{finding:?} {value:.3}"),
            Outcome::Refused => "refused".to_owned(),
            Outcome::NoRun(why) => why.clone(),
        };
        format!(
            "{}: {came_to}: machine {}, {}, {}",
            self.mistake, self.number, self.machine, self.sensors
        )
    }
}

/// Sensors of the machines in turn.
const SENSORS: [Sensors; 6] = [
    Sensors::AsConfigured,
    Sensors::Runout(0.5),
    Sensors::EllipticRunout,
    Sensors::Harmonic,
    Sensors::Hum,
    Sensors::Noise(3.0),
];

/// A machine that levitates for as long as the check takes; and whether its unbalance shows.
fn scene(seed: u64, number: u64, sensors: Sensors) -> Result<(Scene, bool), String> {
    let machine = RandomMachine::sampled(seed, number).map_err(|error| error.to_string())?;
    let mut draw = Draw::new(seed ^ OF_ROTORS, number);
    let eccentricity_m = machine.clearance_m() * draw.decades(2e-3, 0.05);
    let text = machine.toml.replacen(
        "[spin]",
        &format!("eccentricity_m = {eccentricity_m}\n[spin]"),
        1,
    );
    let mut scene = Scene::parse(&machine.text, &text).map_err(|error| error.to_string())?;
    let config = scene.planes[0].supervisor.ok_or("no supervisor")?;
    let unit_s = f64::from(config.scaling().time_s);
    scene.duration_s = BEFORE_S + WINDOWS * WINDOW.0.max(WINDOW.1 * unit_s);
    scene.planes[0].seed = draw.number();
    sensors.apply(&mut draw, &mut scene, 0);
    let turns = scene.start.spin_rad_s.abs() * unit_s;
    let shows = turns > 1.0 && eccentricity_m > 0.01 * machine.clearance_m();
    scene.title = machine.text;
    Ok((scene, shows))
}

/// What is found, and whether the rotor touched.
fn outcome(scene: &Scene, mistake: &Mistake) -> Result<(Outcome, bool), String> {
    let mut config = scene.planes[0].supervisor.ok_or("no supervisor")?;
    config.check_first = 1.0;
    if let Some(change) = mistake.config {
        change(&mut config);
    }
    let Ok(supervisor) = Supervisor::new(&config) else {
        return Ok((Outcome::Refused, false));
    };
    let found = Rc::new(Cell::new(Checked {
        finding: Finding::NotYet,
        value: 0.0,
    }));
    let mistaken = Mistaken {
        supervisor,
        mistake: *mistake,
        found: Rc::clone(&found),
    };
    let controller = supervised(scene, Box::new(mistaken)).ok_or("no levitation")?;
    match run_policy(
        scene,
        (controller, "supervisor"),
        Keep::Verdict,
        &mut |_| {},
    ) {
        Ok((figures, _)) => Ok((Outcome::Checked(found.get()), figures.impacts > 0)),
        Err(error) => Err(error.to_string()),
    }
}

/// Every mistake on a hundred machines and none on a thousand, or on a few.
///
/// # Errors
/// None.
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    drawn(Machines::default(), extent, progress)
}

/// The same on other machines.
///
/// # Errors
/// None.
pub fn drawn(of: Machines, extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let seed = of.seed.unwrap_or(SEED);
    let wrong = of.number.unwrap_or(extent.pick(6, 100));
    let right = 10 * wrong;
    let mut jobs: Vec<(&Mistake, u64)> = (0..right).map(|number| (&RIGHT, number)).collect();
    for mistake in MISTAKES {
        jobs.extend((0..wrong).map(|number| (mistake, number)));
    }
    let tried = run_all(&jobs, progress, |(mistake, number)| {
        Tried::new(seed, *number, mistake)
    });
    let (mut rows, mut claims, mut odd) = (Vec::new(), Vec::new(), Vec::new());
    let mut touches = 0;
    for mistake in std::iter::once(&RIGHT).chain(MISTAKES) {
        let of_it = |t: &&Tried| t.mistake == mistake.name;
        for counts in [true, false] {
            let own: Vec<&Tried> = (tried.iter().filter(of_it))
                .filter(|t| t.counts == counts)
                .collect();
            if own.is_empty() {
                continue;
            }
            let count =
                |is: &dyn Fn(&Outcome) -> bool| own.iter().filter(|t| is(&t.outcome)).count();
            let found = count(&Outcome::is_found);
            let named = count(&|o| o.is_named(mistake));
            let passed =
                count(&|o| matches!(o, Outcome::Checked(c) if c.finding == Finding::Passed));
            let not_yet =
                count(&|o| matches!(o, Outcome::Checked(c) if c.finding == Finding::NotYet));
            let no_run = count(&|o| matches!(o, Outcome::NoRun(_)));
            let beside = match (counts, mistake.counts) {
                (true, _) => "",
                (false, Counts::Late) => ", by less than matters",
                (false, Counts::Unbalanced) => ", runout at the spin or little unbalance",
                (false, _) => ", sensors with runout at the spin",
            };
            let name = format!("{}{beside}", mistake.name);
            let touched = own.iter().filter(|t| t.touched).count();
            touches += touched;
            let cells = [own.len(), found, named, passed, not_yet, touched].map(|n| n.to_string());
            let [all, found_cell, named, passed_cell, not_yet, touched] = cells;
            rows.push([
                name.clone(),
                all,
                found_cell,
                named,
                passed_cell,
                not_yet,
                touched,
            ]);
            let ran = (own.len() - no_run).max(1) as f64;
            if counts && mistake.name == RIGHT.name {
                claims.push(Claim::at_most(
                    "nothing wrong: contradicted",
                    0.0,
                    found as f64,
                ));
                claims.push(Claim::at_least(
                    "nothing wrong: passed, share",
                    0.95,
                    passed as f64 / ran,
                ));
            } else if counts && !mistake.shows.is_empty() {
                claims.push(Claim::at_most(
                    format!("{name}: passed, share"),
                    0.01,
                    passed as f64 / ran,
                ));
            }
            if no_run > 0 {
                let name = format!("{name}: runs that cannot be trusted");
                claims.push(Claim::at_most(name, 0.0, no_run as f64));
            }
            odd.extend(
                own.iter()
                    .filter(|t| !t.outcome.is_named(mistake))
                    .map(|t| t.text()),
            );
        }
    }
    claims.push(Claim::at_most(
        "machines that touch while they are checked",
        0.0,
        touches as f64,
    ));
    let of_logs = logs::identification(seed, 5 * wrong, progress);
    let of_rotor_logs = logs::of_rotors(seed, (wrong / 2).max(4), progress);
    let (of_rotors, odd_rotors) = rotors::rotors(seed, wrong / 2, progress);
    odd.extend(odd_rotors);
    odd.extend(of_logs.odd);
    odd.extend(of_rotor_logs.odd);
    let columns = [
        "mistake",
        "machines",
        "contradicted",
        "named as it is",
        "passed",
        "not yet",
        "touched",
    ];
    let story = format!(
        "{right} machines of seed {seed} with nothing wrong and {wrong} with each mistake, levitated for {WINDOWS} windows: masses of 0.5 to 300 kg, 10 to 50 kHz, gravity or none, an unbalance of 0.2 to 5 % of the clearance, and one in six with each of: sensors as configured, runout of one axis, elliptic runout, runout at twice or three times the spin, hum, three times the noise. Positions, forces and spin pass through the mistake on their way to the supervisor and back; levitation is right. A configuration that is refused counts as found."
    );
    Ok(Report {
        title: "Commissioning".to_owned(),
        claims,
        cases: tried.len() as u64,
        classes: Vec::new(),
        chapters: vec![
            Chapter::new(
                "What is found",
                vec![Block::text(story), Block::table(columns, rows)],
            ),
            Chapter::new(
                "What logs tell",
                vec![
                    Block::text(
                        "Numbers that `commission` finds in the logs of the same machines with nothing wrong: intervals that hold, errors as shares of what is, of a stiffness of the cap over the clearance, and the share of machines within 3 %, 10 % and 10 % of that.",
                    ),
                    Block::table(
                        [
                            "number",
                            "machines",
                            "intervals that hold",
                            "median error",
                            "95th percentile",
                            "within",
                        ],
                        of_logs.rows,
                    ),
                ],
            ),
            Chapter::new(
                "What logs of rotors in two planes tell",
                vec![
                    Block::text(of_rotor_logs.summary),
                    Block::table(logs::COLUMNS, of_rotor_logs.rows),
                ],
            ),
            Chapter::new(
                "Rotors in two bearings",
                vec![Block::table(
                    [
                        "rotor, mistake",
                        "rotors",
                        "contradicted",
                        "passed",
                        "not yet",
                        "no run",
                    ],
                    of_rotors,
                )],
            ),
            Chapter::folded("Not named as they are", vec![Block::List(odd)]),
        ],
    })
}
