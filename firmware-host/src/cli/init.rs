//! `init FILE`: a scene of a machine from its numbers.

mod ask;
mod shaft;
mod text;

use self::ask::Number;
use self::shaft::{Disc, Shaft};
use crate::cli::error::{CommandError, pretty, print};
use crate::cli::load;
use crate::cli::output::OutputError;
use firmware_bench::device::levitation::LevitationParams;
use firmware_bench::scene::Scene;
use firmware_bench::scene::schema::json_schema;
use firmware_studies::machines::random::rule_of_thumb;
use firmware_studies::overloads::tune::acceptable_near;
use std::fs::OpenOptions;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// Arguments of `init`.
#[derive(Debug, Clone, clap::Args)]
pub struct InitArgs {
    /// The scene file that is written; none is overwritten.
    #[arg(default_value = "machine.toml")]
    pub file: PathBuf,
    #[command(flatten)]
    numbers: NumberArgs,
}

/// A number, as an option and as a question.
macro_rules! numbers {
    ($(#[doc = $doc:literal] $(#[arg($($rule:tt)*)])* $name:ident: $range:expr;)*) => {
        /// Numbers of the machine. What is needed and not given is asked for on a terminal.
        #[derive(Debug, Clone, clap::Args)]
        #[command(next_help_heading = "Numbers of the machine")]
        struct NumberArgs {
            $(#[doc = $doc]
            #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
            $(#[arg($($rule)*)])*
            $name: Option<f64>,)*
            /// A whole rotor in two bearings: where they are along the axis, from the centre of mass, as -0.2,0.25. With its
            /// inertias, its length, or length and diameter of its shaft. With --shaft-file from its left end, as 0.1,0.6.
            #[arg(long, allow_hyphen_values = true, value_delimiter = ',', num_args = 1, value_name = "A,B")]
            bearings_m: Option<Vec<f64>>,
            /// A shaft that bends, from CSV: a row a section from left to right, with the columns length_m, outer_diameter_m,
            /// and, where they are not 0 or of steel, inner_diameter_m, density_kg_m3, youngs_modulus_n_m2, poisson_ratio.
            /// A disc in the middle of a section: disc_mass_kg, disc_transverse_inertia_kg_m2, disc_polar_inertia_kg_m2.
            #[arg(long, value_name = "FILE", requires = "bearings_m",
                conflicts_with_all = ["mass_kg", "length_m", "transverse_inertia_kg_m2"])]
            shaft_file: Option<PathBuf>,
        }

        /// What they may be, and how they are asked for.
        struct Numbers { $($name: Number,)* }

        const NUMBERS: Numbers = Numbers { $($name: Number {
            name: stringify!($name),
            question: $doc,
            range: $range,
        },)* };

        impl NumberArgs {
            /// Refuses a number that is out of its range.
            fn check(&self) -> Result<(), CommandError> {
                $(if let Some(value) = self.$name {
                    NUMBERS.$name.check(value)?;
                })*
                Ok(())
            }
        }
    };
}

numbers! {
    /// Control rate in Hz, as 20000
    sample_rate_hz: RATE;
    /// Mass of the rotor that this bearing plane carries, in kg, as 10; with --bearings-m that of the whole rotor
    mass_kg: POSITIVE;
    /// Shaft stiffness less the magnets' negative stiffness, in N/m, as -2e5; with --bearings-m that of each magnet alone
    stiffness_n_m: FINITE;
    /// Negative stiffness k_s of a magnet in N/m, as 2e5, in the place of --stiffness-n-m
    #[arg(conflicts_with = "stiffness_n_m")]
    ks_n_m: NOT_NEGATIVE;
    /// Radial clearance of the retainer bearing in m, as 2e-4
    clearance_m: POSITIVE;
    /// Stiffness of the contact with the retainer bearing in N/m, as 1e9
    contact_stiffness_n_m: POSITIVE;
    /// Force cap of a magnet in N, as the length of the vector, as 1000
    force_max_n: POSITIVE;
    /// Force per current k_i of a magnet in N/A, as 100, in the place of --force-max-n
    #[arg(conflicts_with = "force_max_n", requires = "current_max_a")]
    ki_n_a: POSITIVE;
    /// Largest control current in A, with --ki-n-a
    #[arg(requires = "ki_n_a")]
    current_max_a: POSITIVE;
    /// Time constant of the amplifier with the magnet in s, as 1.6e-4
    lag_s: NOT_NEGATIVE;
    /// Coefficient of sliding friction, upper end of what is likely, as 0.15
    friction: NOT_NEGATIVE;
    /// Noise of the position sensor (root mean square) in m, as 1e-6
    noise_rms_m: NOT_NEGATIVE;
    /// Spin of the rotor in Hz [assumed where not given: 200]
    spin_hz: FINITE;
    /// Radius of the rotor where it touches in m [assumed where not given: that of the shaft, or 0.05]
    contact_radius_m: POSITIVE;
    /// Static load on this plane in N, such as the weight of a horizontal rotor [default: 0]
    load_n: NOT_NEGATIVE;
    /// Gravity across the axis in m/s², as 9.81 of a horizontal rotor, in the place of --load-n
    #[arg(conflicts_with = "load_n")]
    gravity_m_s2: NOT_NEGATIVE;
    /// Transverse moment of inertia about the centre of mass in kg m², with --bearings-m
    #[arg(requires = "bearings_m", requires = "polar_inertia_kg_m2")]
    transverse_inertia_kg_m2: POSITIVE;
    /// Polar moment of inertia in kg m², with --bearings-m
    #[arg(requires = "transverse_inertia_kg_m2")]
    polar_inertia_kg_m2: NOT_NEGATIVE;
    /// Length in m, in the place of inertias those of a cylinder of this mass and of the contact radius
    #[arg(requires = "bearings_m", conflicts_with = "polar_inertia_kg_m2")]
    length_m: POSITIVE;
    /// Diameter in m of a steel shaft of this length, which bends; the rest of the mass is a disc in its middle
    #[arg(requires = "length_m")]
    shaft_diameter_m: POSITIVE;
}

/// What two bearings need beside the numbers of one.
#[derive(Debug, Clone, PartialEq)]
struct Bearings {
    /// As the scene counts them: from the centre of mass, or from the left end of a shaft.
    positions_m: [f64; 2],
    body: Body,
}

/// The rotor in them.
#[derive(Debug, Clone, PartialEq)]
enum Body {
    Rigid {
        transverse_inertia_kg_m2: f64,
        polar_inertia_kg_m2: f64,
    },
    Shaft(Shaft),
}

impl Bearings {
    /// Radius of the shaft in one of them, where there is one.
    fn radius_m(&self, bearing: usize) -> Option<f64> {
        match &self.body {
            Body::Rigid { .. } => None,
            Body::Shaft(shaft) => shaft.radius_at_m(*self.positions_m.get(bearing)?),
        }
    }
}

/// A machine.
#[derive(Debug, Clone, PartialEq)]
struct Machine {
    sample_rate_hz: f64,
    mass_kg: f64,
    stiffness_n_m: f64,
    clearance_m: f64,
    contact_stiffness_n_m: f64,
    force_max_n: f64,
    lag_s: f64,
    friction: f64,
    noise_rms_m: f64,
    load_n: f64,
    spin_hz: Option<f64>,
    contact_radius_m: Option<f64>,
    bearings: Option<Bearings>,
}

/// A spring that would carry this share of the cap at the wall is stiff enough for a rotor that nothing pulls.
const CARRIED_SHARE: f64 = 0.3;

/// Rotors in two bearings are shorter.
const LONGEST_M: f64 = 30.0;

/// Of a disc of which only the mass is known, in those of its shaft.
const DISC_DIAMETERS: f64 = 3.0;

const POSITIVE: (fn(f64) -> bool, &str) = (
    |x| x > 0.0 && x.is_finite(),
    "a finite number greater than 0",
);
const NOT_NEGATIVE: (fn(f64) -> bool, &str) = (
    |x| x >= 0.0 && x.is_finite(),
    "a finite number, 0 or greater",
);
const FINITE: (fn(f64) -> bool, &str) = (f64::is_finite, "a finite number");
const RATE: (fn(f64) -> bool, &str) = (|x| (1.0..=1e6).contains(&x), "a number from 1 to 1e6");

impl NumberArgs {
    /// Every number, checked; `ask` is asked for those that are needed and not given.
    fn machine(
        &self,
        mut ask: impl FnMut(&Number) -> Result<f64, CommandError>,
    ) -> Result<Machine, CommandError> {
        self.check()?;
        let shaft = self.shaft_file.as_deref().map(Shaft::read).transpose()?;
        let mut needed =
            |number: &Number, value: Option<f64>| value.map_or_else(|| ask(number), Ok);
        let by_current = self.ki_n_a.zip(self.current_max_a);
        let machine = Machine {
            sample_rate_hz: needed(&NUMBERS.sample_rate_hz, self.sample_rate_hz)?,
            mass_kg: needed(
                &NUMBERS.mass_kg,
                shaft.as_ref().map(Shaft::mass_kg).or(self.mass_kg),
            )?,
            stiffness_n_m: needed(
                &NUMBERS.stiffness_n_m,
                self.ks_n_m.map(|ks| -ks).or(self.stiffness_n_m),
            )?,
            clearance_m: needed(&NUMBERS.clearance_m, self.clearance_m)?,
            contact_stiffness_n_m: needed(
                &NUMBERS.contact_stiffness_n_m,
                self.contact_stiffness_n_m,
            )?,
            force_max_n: needed(
                &NUMBERS.force_max_n,
                by_current
                    .map(|(ki, current)| ki * current)
                    .or(self.force_max_n),
            )?,
            lag_s: needed(&NUMBERS.lag_s, self.lag_s)?,
            friction: needed(&NUMBERS.friction, self.friction)?,
            noise_rms_m: needed(&NUMBERS.noise_rms_m, self.noise_rms_m)?,
            load_n: self.load_n.unwrap_or(0.0),
            spin_hz: self.spin_hz,
            contact_radius_m: self.contact_radius_m,
            bearings: None,
        };
        let bearings = self.bearings(&machine, shaft)?;
        let by_gravity = self.gravity_m_s2.map(|g| g * machine.mass_kg);
        let radius_m = bearings.as_ref().and_then(|of| of.radius_m(0));
        Ok(Machine {
            load_n: by_gravity.unwrap_or(machine.load_n),
            contact_radius_m: machine.contact_radius_m.or(radius_m),
            bearings,
            ..machine
        })
    }

    /// The two bearings, where they are given.
    fn bearings(
        &self,
        machine: &Machine,
        shaft: Option<Shaft>,
    ) -> Result<Option<Bearings>, CommandError> {
        let refused = |message: String, help: &str| {
            Err(CommandError::Numbers {
                message,
                help: help.to_owned(),
            })
        };
        let Some(places) = &self.bearings_m else {
            return Ok(None);
        };
        let length_m = shaft.as_ref().map(Shaft::length_m).or(self.length_m);
        if let Some(length_m) = length_m.filter(|length_m| *length_m > LONGEST_M) {
            let message = match &self.shaft_file {
                Some(file) => format!(
                    "--shaft-file {}: length_m adds up to {length_m} m",
                    file.display()
                ),
                None => format!("--length-m is {length_m} m"),
            };
            let help =
                "no rotor in two bearings is so long: is it in mm? give it in m, and diameters too";
            return refused(message, help);
        }
        let positions_m = match (&places[..], &shaft) {
            (&[a, b], Some(shaft)) if 0.0 <= a && a < b && b <= shaft.length_m() => [a, b],
            (_, Some(shaft)) => {
                let message = format!(
                    "--bearings-m is not of two places on the shaft of {} m",
                    shaft.length_m()
                );
                let help =
                    "give two from the left end of the shaft, the first nearer to it, as 0.1,0.6";
                return refused(message, help);
            }
            (&[a, b], None) if a < 0.0 && b > 0.0 && a.is_finite() && b.is_finite() => [a, b],
            _ => {
                let message = "--bearings-m is not of two places on both sides".to_owned();
                let help = "give two from the centre of mass, the first negative, as -0.2,0.25";
                return refused(message, help);
            }
        };
        if machine.stiffness_n_m > 0.0 {
            let message = format!("--stiffness-n-m is {}", machine.stiffness_n_m);
            let help = "with --bearings-m it is that of each magnet, 0 or negative";
            return refused(message, help);
        }
        if let Some(shaft) = shaft {
            let body = Body::Shaft(shaft);
            return Ok(Some(Bearings { positions_m, body }));
        }
        let given = self.transverse_inertia_kg_m2.zip(self.polar_inertia_kg_m2);
        let body = match (given, self.length_m, self.shaft_diameter_m) {
            (Some((transverse_inertia_kg_m2, polar_inertia_kg_m2)), _, _) => Body::Rigid {
                transverse_inertia_kg_m2,
                polar_inertia_kg_m2,
            },
            (None, Some(length_m), Some(diameter_m)) => {
                let mut shaft = Shaft::uniform(length_m, diameter_m);
                let shaft_kg = shaft.mass_kg();
                if shaft_kg > machine.mass_kg
                    || positions_m.iter().any(|z| z.abs() > 0.5 * length_m)
                {
                    let message = format!(
                        "the shaft weighs {shaft_kg:.3} kg and ends {} m from its middle",
                        0.5 * length_m
                    );
                    let help =
                        "give --mass-kg of shaft and disc together, and bearings on the shaft";
                    return refused(message, help);
                }
                let mass_kg = machine.mass_kg - shaft_kg;
                if mass_kg > 0.0 {
                    let polar = 0.5 * mass_kg * (0.5 * DISC_DIAMETERS * diameter_m).powi(2);
                    shaft.discs.push(Disc {
                        position_m: 0.5 * length_m,
                        mass_kg: rounded(mass_kg, 4),
                        transverse_inertia_kg_m2: rounded(0.5 * polar, 4),
                        polar_inertia_kg_m2: rounded(polar, 4),
                        assumed: true,
                    });
                }
                return Ok(Some(Bearings {
                    positions_m: positions_m.map(|z| 0.5 * length_m + z),
                    body: Body::Shaft(shaft),
                }));
            }
            (None, Some(length_m), None) => {
                let square = machine
                    .contact_radius_m
                    .unwrap_or(text::CONTACT_RADIUS_M)
                    .powi(2);
                Body::Rigid {
                    transverse_inertia_kg_m2: machine.mass_kg
                        * (3.0 * square + length_m * length_m)
                        / 12.0,
                    polar_inertia_kg_m2: 0.5 * machine.mass_kg * square,
                }
            }
            (None, None, _) => {
                let message = "--bearings-m without inertias".to_owned();
                let help =
                    "give --transverse-inertia-kg-m2 and --polar-inertia-kg-m2, or --length-m";
                return refused(message, help);
            }
        };
        Ok(Some(Bearings { positions_m, body }))
    }

    /// Options that are needed and not given.
    fn missing(&self) -> Vec<String> {
        let mut missing = Vec::new();
        // What is asked for, with any answer.
        let _asked = self.machine(|number| {
            missing.push(number.option());
            Ok(1.0)
        });
        missing
    }
}

/// Writes the scene, with the schema for editors beside it.
///
/// # Errors
/// [`CommandError`]; nothing is written then.
pub fn execute(args: &InitArgs) -> Result<(), CommandError> {
    let file = &args.file;
    if file.exists() {
        return Err(CommandError::Numbers {
            message: format!("{} is there already", file.display()),
            help: "give another name, or remove it first: nothing is overwritten".to_owned(),
        });
    }
    let missing = args.numbers.missing();
    let machine = match io::stdin().is_terminal() || missing.is_empty() {
        true => (args.numbers)
            .machine(|number| number.ask(&mut io::stdin().lock(), &mut io::stderr()))?,
        false => {
            args.numbers.machine(|_| Ok(1.0))?;
            return Err(CommandError::Numbers {
                message: format!("{} missing", missing.join(", ")),
                help: "give them as options; on a terminal they are asked for".to_owned(),
            });
        }
    };
    let name = file.display().to_string();
    let scene = scene_text(&machine, &name)?;
    Scene::parse(&name, &scene)?;
    let schema = file.with_file_name(text::SCHEMA);
    if !schema.exists() {
        create(
            &schema,
            &(pretty(&json_schema(), "formatting the schema")? + "\n"),
        )?;
    }
    create(file, &scene)?;
    load(file)?;
    print(&format!(
        "{} is written; run it: firmware-host run {}\nwhat its bearing can do: firmware-host advise {}\n",
        file.display(),
        file.display(),
        file.display()
    ))
}

/// Writes a file that is not there.
fn create(path: &Path, content: &str) -> Result<(), CommandError> {
    let write = || {
        let mut file = OpenOptions::new().write(true).create_new(true).open(path)?;
        file.write_all(content.as_bytes())
    };
    write().map_err(|reason| {
        let mut error = OutputError::at(path)(reason);
        error.option = None;
        error.into()
    })
}

/// The scene, with a levitation controller that holds the rotor.
fn scene_text(machine: &Machine, name: &str) -> Result<String, CommandError> {
    let bare = Scene::parse(name, &text::scene(machine, &[]))?;
    let pull_n_m = (-machine.stiffness_n_m).max(0.0);
    let carried_n_m = CARRIED_SHARE * machine.force_max_n / machine.clearance_m;
    let mass_kg = bare.plant(0).rotor.mass_kg;
    let aim = rule_of_thumb(mass_kg, pull_n_m, pull_n_m.max(carried_n_m));
    let levitation = acceptable_near(&bare, aim.proportional_n_m).ok_or_else(|| CommandError::Numbers {
        message: "no levitation controller of proportional and derivative gain holds this rotor well (peak sensitivity below 3, \
                  noise below 5 % of the cap)"
            .to_owned(),
        help: "look at --stiffness-n-m, --lag-s, --sample-rate-hz and --noise-rms-m: it pulls too hard for so late a force, the \
               sensor is too noisy for so small a one, or the shaft bends too easily; a scene without [levitation] takes a design of \
               your own, see export --plant"
            .to_owned(),
    })?;
    let rounded = levitation.iter().map(|gains| LevitationParams {
        proportional_n_m: rounded(gains.proportional_n_m, 2),
        derivative_n_s_m: rounded(gains.derivative_n_s_m, 2),
        ..*gains
    });
    Ok(text::scene(machine, &rounded.collect::<Vec<_>>()))
}

/// To so many decimals of its power of ten: it is made up, and should not look as if it were not.
fn rounded(x: f64, decimals: usize) -> f64 {
    format!("{x:.decimals$e}").parse().unwrap_or(x)
}
