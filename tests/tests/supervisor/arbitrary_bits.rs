//! Whatever bits come in, for as long as you like, and whatever configuration comes between two ticks: no panic,
//! finite, within every limit, in every mode and in every number.

use supervisor::{
    Config, Core, CoreCommand, CoreSample, Events, Mode, Prepared, Q, Report, Sample, Scaling,
    Supervisor,
};
use system_tests::storm::{AnyBits, Bounds, Chance, Storm, any_config};

/// Ticks of one supervisor.
const TICKS_PER_CONFIG: u64 = 20_000;
/// Another configuration comes once in so many ticks.
const CONFIG_EVERY: u64 = 3_000;
/// Ticks of one test.
const TICKS: u64 = 10_000_000;
/// The long ones.
const MANY_TICKS: u64 = 1_000_000_000;

/// What can be driven through a storm.
trait Driven: Sized {
    type Number: AnyBits;

    /// `None` where the numbers do not hold this bearing.
    fn new(config: &Config) -> Option<Self>;
    fn reconfigure(&mut self, config: &Config) -> bool;
    fn bounds(config: &Config) -> Bounds;
    fn tick(&mut self, sample: &CoreSample<Self::Number>) -> CoreCommand<Self::Number>;
    fn report(&self) -> Report;
    fn rearm(&mut self);
}

impl<S: AnyBits> Driven for Core<S, 64> {
    type Number = S;

    fn new(config: &Config) -> Option<Self> {
        Some(Core::new(&Prepared::new(config).ok()?))
    }
    fn reconfigure(&mut self, config: &Config) -> bool {
        let prepared = Prepared::new(config);
        if let Ok(prepared) = &prepared {
            Core::reconfigure(self, prepared);
        }
        prepared.is_ok()
    }
    fn bounds(config: &Config) -> Bounds {
        Bounds::new::<S>(config)
    }
    fn tick(&mut self, sample: &CoreSample<S>) -> CoreCommand<S> {
        Core::tick(self, sample)
    }
    fn report(&self) -> Report {
        Core::report(self)
    }
    fn rearm(&mut self) {
        Core::rearm(self);
    }
}

/// The supervisor as it is linked, from SI to SI.
struct InNewtons {
    supervisor: Supervisor<64>,
    scaling: Scaling,
}

impl Driven for InNewtons {
    type Number = f32;

    fn new(config: &Config) -> Option<Self> {
        Some(Self {
            supervisor: Supervisor::new(config).ok()?,
            scaling: config.scaling(),
        })
    }
    fn reconfigure(&mut self, config: &Config) -> bool {
        self.scaling = config.scaling();
        self.supervisor.reconfigure(config).is_ok()
    }
    fn bounds(config: &Config) -> Bounds {
        Bounds::in_newtons(config)
    }
    fn tick(&mut self, sample: &CoreSample<f32>) -> CoreCommand<f32> {
        let s = &self.scaling;
        let newtons = |v: [f32; 2]| v.map(|x| x * s.force_n);
        let command = self.supervisor.tick(&Sample {
            sequence: sample.sequence,
            status: sample.status,
            position_m: sample.position.map(|x| x / s.position_per_m),
            spin_rad_s: sample.spin / s.time_s,
            levitation_n: newtons(sample.levitation),
            applied_n: newtons(sample.applied),
        });
        CoreCommand {
            force: command.force_n.map(|x| x / s.force_n),
            own: command.own_n.map(|x| x / s.force_n),
            mode: command.mode,
            limits: command.limits,
            events: command.events,
            integrator: command.integrator,
            severity: command.severity,
        }
    }
    fn report(&self) -> Report {
        self.supervisor.report()
    }
    fn rearm(&mut self) {
        self.supervisor.rearm();
    }
}

/// Drives supervisors of any valid configurations; counts ticks in each mode.
fn drive<D: Driven>(ticks: u64) -> [u64; 8] {
    let mut modes = [0; 8];
    let mut chance = Chance::new(1);
    let (mut done, mut changes) = (0, 0);
    while done < ticks {
        let mut config = any_config(&mut chance);
        let seed = chance.bits();
        // Not every number holds every bearing.
        let Some(mut driven) = D::new(&config) else {
            continue;
        };
        let mut bounds = D::bounds(&config);
        let mut storm = Storm::new(seed);
        for i in 0..TICKS_PER_CONFIG {
            if chance.once_in(CONFIG_EVERY) {
                let other = any_config(&mut chance);
                if driven.reconfigure(&other) {
                    bounds = bounds.reconfigured(D::bounds(&other));
                    config = other;
                    changes += 1;
                }
            }
            let sample = storm.next_sample::<D::Number>();
            let command = driven.tick(&sample);
            if let Err(broken) = bounds.check(&command, sample.status) {
                panic!("tick {i} of seed {seed} with {config:?}: {sample:?}: {broken}");
            }
            modes[command.mode as usize] += 1;
            if command.events.contains(Events::RECORD_FROZEN) {
                driven.rearm();
            }
        }
        check(&driven.report(), &config, D::Number::LAST_PLACE);
        done += TICKS_PER_CONFIG;
    }
    assert!(changes > ticks / CONFIG_EVERY / 4, "{changes} changes");
    modes
}

fn check(report: &Report, config: &Config, last_place: f64) {
    assert!(report.severity_index.is_finite(), "{config:?}: {report:?}");
    let cap_n = f64::from(config.force_max_n) * (1.0 + last_place);
    assert!(
        (0.0..=cap_n).contains(&f64::from(report.force_cap_n)),
        "{config:?}: {report:?}"
    );
    // Of a continuous force so small fixed point keeps no square.
    if config.continuous_force_n > 1e-3 * config.force_max_n {
        assert!(report.thermal_state.is_finite(), "{config:?}: {report:?}");
    }
}

/// Each mode is gone through for at least a two hundredth of the time.
fn keeps_every_limit<D: Driven>(ticks: u64) {
    let modes = drive::<D>(ticks);
    assert!(modes.iter().all(|count| *count > ticks / 200), "{modes:?}");
    assert!(
        modes[Mode::BackwardWhirl as usize] > ticks / 20,
        "{modes:?}"
    );
}

/// Requirements: SR-01, SR-02, SR-03
#[test]
fn f32_keeps_every_limit() {
    keeps_every_limit::<Core<f32, 64>>(TICKS);
}

/// Requirements: SR-01, SR-02, SR-03
#[test]
fn the_supervisor_in_newtons_keeps_every_limit() {
    keeps_every_limit::<InNewtons>(TICKS);
}

/// Requirements: SR-01, SR-02, SR-03
#[test]
fn fixed_point_keeps_every_limit() {
    keeps_every_limit::<Core<Q, 64>>(TICKS);
}

/// Requirements: SR-01, SR-02
#[test]
fn f64_keeps_every_limit() {
    keeps_every_limit::<Core<f64, 64>>(TICKS);
}

#[test]
#[ignore = "takes some minutes"]
fn the_supervisor_in_newtons_keeps_every_limit_for_long() {
    keeps_every_limit::<InNewtons>(MANY_TICKS);
}

#[test]
#[ignore = "takes some minutes"]
fn fixed_point_keeps_every_limit_for_long() {
    keeps_every_limit::<Core<Q, 64>>(MANY_TICKS);
}
