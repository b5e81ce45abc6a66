//! How well the supervisor has to know its machine: a scene run again and again, each time with something of the
//! machine configured wrong.

pub mod study;

use firmware_bench::run::closed_loop::{Accuracy, Recorders, record};
use firmware_bench::run::figures::Figures;
use firmware_bench::run::supervision::SupervisionCount;
use firmware_bench::scene::nominal::{Override, replaced};
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_bench::scene::suggest::{Nominal, suggested};
use firmware_bench::scene::{PlaneScene, Scene};
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use serde::Serialize;
use supervisor::{Config, ConfigError, PARAMETERS};

/// How far a datum usually is off, either way.
#[derive(Debug, Clone, Copy)]
enum Usual {
    /// It is assumed this many times too large, or too small.
    Factor(f64),
    /// It is assumed so many ticks too long, or too short.
    Ticks(f64),
}

use Usual::{Factor, Ticks};

/// What firmware assumes of the machine.
struct AssumedMachine {
    nominal: Nominal,
    spin_gain: f64,
}

/// A datum of the machine.
struct Datum {
    name: &'static str,
    /// The parameter that is this datum: where a scene has set it itself, that is what is off.
    parameter: Option<&'static str>,
    usual: Usual,
    /// Puts it off by a factor, or by ticks.
    put_off: fn(&mut AssumedMachine, f64),
}

const fn datum(
    name: &'static str,
    parameter: &'static str,
    usual: Usual,
    put_off: fn(&mut AssumedMachine, f64),
) -> Datum {
    Datum {
        name,
        parameter: Some(parameter),
        usual,
        put_off,
    }
}

/// The data that somebody has to measure or look up, and how well they commonly are known.
const DATA: &[Datum] = &[
    datum("mass", "mass_kg", Factor(1.25), |assumed, by| {
        assumed.nominal.mass_kg *= by;
    }),
    datum("stiffness", "stiffness_n_m", Factor(1.4), |assumed, by| {
        assumed.nominal.stiffness_n_m *= by;
    }),
    datum("clearance", "clearance_m", Factor(1.1), |assumed, by| {
        assumed.nominal.clearance_m *= by;
    }),
    datum("force cap", "force_max_n", Factor(1.25), |assumed, by| {
        assumed.nominal.force_max_n *= by;
    }),
    datum(
        "amplifier lag",
        "amplifier_lag_s",
        Factor(2.0),
        |assumed, by| {
            assumed.nominal.lag_s *= by;
        },
    ),
    datum("delay", "delay_samples", Ticks(1.0), |assumed, by| {
        let ticks = f64::from(assumed.nominal.delay_samples) + by;
        assumed.nominal.delay_samples = ticks as u32;
    }),
    datum(
        "friction",
        "friction_coefficient",
        Factor(2.0),
        |assumed, by| {
            assumed.nominal.friction_coefficient *= by;
        },
    ),
    datum("restitution", "restitution", Factor(1.25), |assumed, by| {
        let restitution = suggested(&assumed.nominal).config.restitution;
        assumed.nominal.restitution = Some(f64::from(restitution) * by);
    }),
    datum(
        "contact stiffness",
        "contact_stiffness_n_m",
        Factor(10.0),
        |assumed, by| assumed.nominal.contact_stiffness_n_m *= by,
    ),
    datum(
        "sensor noise",
        "sensor_step_m",
        Factor(3.0),
        |assumed, by| {
            assumed.nominal.noise_rms_m *= by;
            assumed.nominal.quantum_m *= by;
        },
    ),
    Datum {
        name: "spin",
        // It comes with every sample.
        parameter: None,
        usual: Factor(1.03),
        put_off: |assumed, by| assumed.spin_gain *= by,
    },
];

/// Data configured wrong together, and in words.
#[derive(Debug, Clone, PartialEq)]
pub struct Misjudged {
    /// What is configured wrong.
    pub text: String,
    /// Places in [`DATA`], and by what each is off.
    off: Vec<(usize, f64)>,
}

/// What there is to be configured wrong: each datum alone, too large and too small, and `draws` times all of them at once,
/// drawn between the two. `width` is the exponent of the factors and a factor of the ticks.
pub fn misjudged(width: f64, draws: u32, seed: u64) -> Vec<Misjudged> {
    let at = |datum: &Datum, share: f64| match datum.usual {
        Factor(by) => by.powf(share * width),
        Ticks(by) => (share * width * by).round(),
    };
    let alone = |(place, datum): (usize, &Datum)| {
        [-1.0, 1.0].map(|share| {
            let by = at(datum, share);
            let text = match datum.usual {
                Factor(_) => format!("{} × {}", datum.name, digits(by)),
                Ticks(_) => format!("{} {by:+} ticks", datum.name),
            };
            let off = vec![(place, by)];
            Misjudged { text, off }
        })
    };
    let mut all: Vec<Misjudged> = DATA.iter().enumerate().flat_map(alone).collect();
    let mut draw = ChaCha8Rng::seed_from_u64(seed);
    for number in 1..=draws {
        let mut share = || 2.0 * f64::from(draw.next_u32()) / f64::from(u32::MAX) - 1.0;
        let off = (DATA.iter().enumerate()).map(|(place, datum)| (place, at(datum, share())));
        all.push(Misjudged {
            text: format!("all at once, draw {number}"),
            off: off.collect(),
        });
    }
    all
}

/// Three digits at most.
fn digits(x: f64) -> String {
    let places = if x < 1.0 { 3 } else { 2 };
    let text = format!("{x:.places$}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

impl Misjudged {
    /// The scene with the supervisor configured so; `None` where that makes no difference.
    ///
    /// # Errors
    /// The parameter that the supervisor would refuse.
    pub fn applied_to(&self, scene: &Scene) -> Result<Option<Scene>, ConfigError> {
        let right = configured_right(scene)?;
        let mut wrong = right.clone();
        let spin = scene.spin_sensor;
        for plane in wrong.planes.iter_mut().filter(is_supervised) {
            let mut assumed = AssumedMachine {
                nominal: plane.nominal,
                spin_gain: spin.gain,
            };
            let mut overrides = plane.overrides.clone();
            for (place, by) in &self.off {
                let datum = &DATA[*place];
                (datum.put_off)(&mut assumed, *by);
                for (index, value) in &mut overrides {
                    if datum.parameter == Some(PARAMETERS[*index].name) {
                        *value = match datum.usual {
                            Factor(_) => *value * *by as f32,
                            Ticks(_) => (*value + *by as f32).max(0.0),
                        };
                    }
                }
            }
            plane.supervisor = Some(configured(plane, &assumed.nominal, &overrides)?);
            wrong.spin_sensor.gain = assumed.spin_gain;
        }
        let other_spin = spin.valid && wrong.spin_sensor.gain != spin.gain;
        let other = (wrong.planes.iter().zip(&right.planes))
            .any(|(wrong, right)| wrong.supervisor != right.supervisor);
        Ok((other || other_spin).then_some(wrong))
    }
}

fn is_supervised(plane: &&mut PlaneScene) -> bool {
    plane.magnet.is_some()
}

/// What the supervisor of a plane is configured with when it assumes this, beside what the rotor decides.
fn configured(
    plane: &PlaneScene,
    nominal: &Nominal,
    overrides: &[Override],
) -> Result<Config, ConfigError> {
    let decided = plane.decided.iter().map(|of| (of.index, of.value));
    let settled: Vec<Override> = decided.chain(overrides.iter().copied()).collect();
    let config = replaced(&suggested(nominal).config, &settled);
    config.validate()?;
    Ok(config)
}

/// The scene with the supervisor configured with what is, whether or not the scene runs it.
///
/// # Errors
/// The parameter that the supervisor would refuse.
pub fn configured_right(scene: &Scene) -> Result<Scene, ConfigError> {
    let mut scene = scene.clone();
    for plane in scene.planes.iter_mut().filter(is_supervised) {
        plane.supervisor = Some(configured(plane, &plane.nominal, &plane.overrides)?);
    }
    Ok(scene)
}

/// Outcome of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// What it was configured with, or that there was none.
    pub configured: String,
    /// Times that it took over, of all planes together.
    pub engagements: u64,
    /// What was measured; `None` where there is no run that can be trusted.
    #[serde(flatten)]
    pub metrics: Option<Figures>,
    /// Why not.
    pub error: Option<String>,
}

impl Row {
    /// Runs a scene.
    pub fn of(configured: &str, scene: &Scene, kind: PolicyKind) -> Self {
        let mut counts = vec![SupervisionCount::default(); scene.planes.len()];
        let recorders = Recorders::of_planes(&mut counts);
        let ran = record(scene, kind, recorders, Accuracy::default(), &mut |_| {});
        let (engagements, metrics, error) = match ran {
            Ok(ended) => {
                let planes: Vec<Figures> = ended.into_iter().map(|(figures, _)| figures).collect();
                let counted = counts.iter().filter_map(|count| count.ended(None));
                let engagements = counted.map(|supervision| supervision.engagements).sum();
                (engagements, Figures::of_machine(&planes), None)
            }
            Err(error) => (0, None, Some(error.to_string())),
        };
        Self {
            configured: configured.to_owned(),
            engagements,
            metrics,
            error,
        }
    }

    /// Runs a scene with something configured wrong; `None` where that makes no difference. What the supervisor would refuse
    /// is a row that says so.
    pub fn of_misjudged(misjudged: &Misjudged, scene: &Scene) -> Option<Self> {
        match misjudged.applied_to(scene) {
            Ok(Some(wrong)) => Some(Self::of(&misjudged.text, &wrong, PolicyKind::Supervisor)),
            Ok(None) => None,
            Err(refused) => Some(Self {
                configured: misjudged.text.clone(),
                engagements: 0,
                metrics: None,
                error: Some(format!("refused: {refused}")),
            }),
        }
    }

    /// Whether the rotor came back.
    pub fn recovered(&self) -> bool {
        self.metrics.as_ref().is_some_and(|m| m.recovered)
    }
}
