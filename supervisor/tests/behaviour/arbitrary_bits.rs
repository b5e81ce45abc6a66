//! Whatever bits come in, for as long as you like, and whatever configuration comes between two ticks: no panic,
//! finite, within every limit, in every mode and in every number.

use supervisor::{
    Config, Core, CoreCommand, CoreSample, Events, Mode, PlanePositions, Prepared, Q, Report,
    RotorSupervisor, Sample, Scaling, Shaft, Status, Supervisor,
};
use test_support::bounds::{Bounds, per_unit};
use test_support::rig::config;
use test_support::storm::{AnyBits, Chance, Storm, any_config};

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
    /// `None` where it is refused.
    fn reconfigure(&mut self, config: &Config) -> Option<()>;
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
    fn reconfigure(&mut self, config: &Config) -> Option<()> {
        Core::reconfigure(self, &Prepared::new(config).ok()?);
        Some(())
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

fn in_si(scaling: &Scaling, sample: &CoreSample<f32>) -> Sample {
    let newtons = |v: [f32; 2]| v.map(|x| x * scaling.force_n);
    Sample {
        sequence: sample.sequence,
        status: sample.status,
        position_m: sample.position.map(|x| x / scaling.position_per_m),
        spin_rad_s: sample.spin / scaling.time_s,
        levitation_n: newtons(sample.levitation),
        applied_n: newtons(sample.applied),
    }
}

impl Driven for InNewtons {
    type Number = f32;

    fn new(config: &Config) -> Option<Self> {
        Some(Self {
            supervisor: Supervisor::new(config).ok()?,
            scaling: config.scaling(),
        })
    }
    fn reconfigure(&mut self, config: &Config) -> Option<()> {
        self.scaling = config.scaling();
        self.supervisor.reconfigure(config).ok()
    }
    fn bounds(config: &Config) -> Bounds {
        Bounds::in_newtons(config)
    }
    fn tick(&mut self, sample: &CoreSample<f32>) -> CoreCommand<f32> {
        let command = self.supervisor.tick(&in_si(&self.scaling, sample));
        let stimulus_n = self.supervisor.stimulus_n();
        let most_n = 0.051 * self.scaling.force_n;
        let small = stimulus_n.iter().all(|n| n.abs() <= most_n);
        assert!(small, "{stimulus_n:?}");
        per_unit(&self.scaling, &command)
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
                if driven.reconfigure(&other).is_some() {
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
    let cap_holds = (0.0..=cap_n).contains(&f64::from(report.force_cap_n));
    assert!(cap_holds, "{config:?}: {report:?}");
    // Of a continuous force so small fixed point keeps no square.
    if config.continuous_force_n > 1e-3 * config.force_max_n {
        assert!(report.thermal_state.is_finite(), "{config:?}: {report:?}");
    }
}

/// Each mode is gone through for at least a two hundredth of the time.
fn keeps_every_limit<D: Driven>(ticks: u64) {
    let modes = drive::<D>(ticks);
    let whirls = modes[Mode::BackwardWhirl as usize] > ticks / 20;
    let each = modes.iter().all(|count| *count > ticks / 200);
    assert!(whirls && each, "{modes:?}");
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

/// Whatever shaft a data sheet may hold.
/// Requirements: SR-01, SR-02, SR-03
#[test]
fn a_rotor_of_any_shaft_keeps_every_limit() {
    let mut chance = Chance::new(1);
    let (config, scaling) = (config(), config().scaling());
    let mut ran = 0;
    for extent in 0..60 {
        let mut spread = || 10_f32.powi((chance.bits() >> 33) as i32 % 9 - 4);
        let transverse = spread();
        let mut end = |sign: f32| PlanePositions {
            retainer_m: sign * spread(),
            sensor_m: sign * spread(),
            magnet_m: sign * spread(),
        };
        let shaft = Shaft {
            mass_kg: 20.0,
            transverse_inertia_kg_m2: transverse,
            polar_inertia_kg_m2: 1.9 * transverse,
            places: [end(-1.0), end(1.0)],
        };
        // One whose ends throw each other about is refused.
        let Ok(mut rotor) = RotorSupervisor::<64>::from_planes(&shaft, &[config; 2]) else {
            continue;
        };
        ran += 1;
        let mut storms = [2 * extent, 2 * extent + 1].map(Storm::new);
        let mut bounds = [Bounds::in_newtons(&config); 2];
        for i in 0..5000 {
            let samples = storms.each_mut().map(Storm::next_sample::<f32>);
            let commands = rotor.tick(&samples.map(|sample| in_si(&scaling, &sample)));
            for ((bounds, command), sample) in bounds.iter_mut().zip(commands.planes).zip(&samples)
            {
                let checked = bounds.check(&per_unit(&scaling, &command), sample.status);
                checked.unwrap_or_else(|broken| panic!("shaft {extent}, tick {i}: {broken}"));
            }
        }
    }
    assert!(ran >= 10, "{ran}");
}

/// Mirrored samples give mirrored commands, to the bit.
#[test]
fn mirrored_samples_give_mirrored_commands() {
    for seed in 0..100 {
        let config = any_config(&mut Chance::new(seed));
        let prepared = Prepared::<f32>::new(&config).unwrap();
        let (mut left, mut right) = (Core::<_, 16>::new(&prepared), Core::<_, 16>::new(&prepared));
        let mut storm = Storm::new(seed);
        for i in 0..2000 {
            let here = storm.next_sample::<f32>();
            // Without spin and without whirl there is no direction to mirror.
            let known = here.status.contains(Status::SPIN_VALID) && here.spin.is_finite();
            if !known || here.spin == 0.0 {
                continue;
            }
            let there = CoreSample {
                position: [-here.position[0], here.position[1]],
                levitation: [-here.levitation[0], here.levitation[1]],
                applied: [-here.applied[0], here.applied[1]],
                spin: -here.spin,
                ..here
            };
            let (a, b) = (left.tick(&here), right.tick(&there));
            let mirrored = (a.mode, [-a.force[0], a.force[1]]);
            assert_eq!(mirrored, (b.mode, b.force), "tick {i} of {seed}");
        }
    }
}
