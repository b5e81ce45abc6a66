//! `init FILE`: a scene of a machine from its numbers.

mod ask;
mod text;

use self::ask::Number;
use crate::cli::error::{CommandError, pretty, print};
use crate::cli::output::OutputError;
use crate::cli::{load, warn};
use firmware_bench::device::levitation::LevitationParams;
use firmware_bench::scene::Scene;
use firmware_bench::scene::schema::json_schema;
use firmware_studies::machines::drawn::rule_of_thumb;
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

/// Numbers of the machine. What is needed and not given is asked for on a terminal.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Numbers of the machine")]
struct NumberArgs {
    /// Control rate.
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    sample_rate_hz: Option<f64>,
    /// Mass of the rotor that this bearing plane carries; with --bearings-m that of the whole rotor.
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    mass_kg: Option<f64>,
    /// Shaft stiffness less the magnets' negative stiffness, e.g. -2e5; with --bearings-m that of each magnet alone.
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    stiffness_n_m: Option<f64>,
    /// Radial clearance of the retainer bearing.
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    clearance_m: Option<f64>,
    /// Stiffness of the contact with the retainer bearing.
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    contact_stiffness_n_m: Option<f64>,
    /// Force cap of a magnet, as the length of the vector.
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    force_max_n: Option<f64>,
    /// Time constant of the amplifier with the magnet.
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    lag_s: Option<f64>,
    /// Coefficient of sliding friction, upper end of what is likely.
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    friction: Option<f64>,
    /// Noise of the position, root mean square.
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    noise_rms_m: Option<f64>,
    /// Spin of the rotor [assumed where not given: 200].
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    spin_hz: Option<f64>,
    /// Radius of the rotor where it touches [assumed where not given: 0.05].
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    contact_radius_m: Option<f64>,
    /// Static load on this plane, such as the weight of a horizontal rotor [default: 0].
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    load_n: Option<f64>,
    /// A whole rotor in two bearings: where they are along the axis, from the centre of mass, as -0.2,0.25. With its inertias or
    /// its length.
    #[arg(
        long,
        allow_hyphen_values = true,
        value_delimiter = ',',
        num_args = 1,
        value_name = "A,B"
    )]
    bearings_m: Option<Vec<f64>>,
    /// Transverse moment of inertia about the centre of mass, with --bearings-m.
    #[arg(
        long,
        allow_hyphen_values = true,
        value_name = "NUMBER",
        requires = "bearings_m"
    )]
    #[arg(requires = "polar_inertia_kg_m2")]
    transverse_inertia_kg_m2: Option<f64>,
    /// Polar moment of inertia, with --bearings-m.
    #[arg(
        long,
        allow_hyphen_values = true,
        requires = "transverse_inertia_kg_m2",
        value_name = "NUMBER"
    )]
    polar_inertia_kg_m2: Option<f64>,
    /// Length, in the place of inertias those of a cylinder of this mass and of the contact radius.
    #[arg(
        long,
        allow_hyphen_values = true,
        value_name = "NUMBER",
        requires = "bearings_m"
    )]
    #[arg(conflicts_with = "polar_inertia_kg_m2")]
    length_m: Option<f64>,
}

/// What two bearings need beside the numbers of one.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bearings {
    positions_m: [f64; 2],
    transverse_inertia_kg_m2: f64,
    polar_inertia_kg_m2: f64,
}

/// A machine.
#[derive(Debug, Clone, Copy, PartialEq)]
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

#[rustfmt::skip]
const SAMPLE_RATE: Number = Number { option: "--sample-rate-hz", question: "control rate in Hz, as 20000", range: RATE };
#[rustfmt::skip]
const MASS: Number = Number { option: "--mass-kg", question: "mass that this bearing plane carries, in kg, as 10", range: POSITIVE };
#[rustfmt::skip]
const STIFFNESS: Number = Number { option: "--stiffness-n-m", question: "shaft stiffness less the magnets' negative stiffness, in N/m, as -2e5", range: FINITE };
#[rustfmt::skip]
const CLEARANCE: Number = Number { option: "--clearance-m", question: "radial clearance of the retainer bearing in m, as 2e-4", range: POSITIVE };
#[rustfmt::skip]
const CONTACT_STIFFNESS: Number = Number { option: "--contact-stiffness-n-m", question: "stiffness of the contact in N/m, as 1e9", range: POSITIVE };
#[rustfmt::skip]
const FORCE: Number = Number { option: "--force-max-n", question: "force cap of the magnet in N, as 1000", range: POSITIVE };
#[rustfmt::skip]
const LAG: Number = Number { option: "--lag-s", question: "time constant of the amplifier with the magnet in s, as 1.6e-4", range: NOT_NEGATIVE };
#[rustfmt::skip]
const FRICTION: Number = Number { option: "--friction", question: "coefficient of sliding friction, as 0.15", range: NOT_NEGATIVE };
#[rustfmt::skip]
const NOISE: Number = Number { option: "--noise-rms-m", question: "noise of the position sensor (root mean square) in m, as 1e-6", range: NOT_NEGATIVE };
#[rustfmt::skip]
const SPIN: Number = Number { option: "--spin-hz", question: "spin in Hz", range: FINITE };
#[rustfmt::skip]
const RADIUS: Number = Number { option: "--contact-radius-m", question: "radius where it touches, in m", range: POSITIVE };
#[rustfmt::skip]
const TRANSVERSE: Number = Number { option: "--transverse-inertia-kg-m2", question: "transverse moment of inertia in kg m²", range: POSITIVE };
#[rustfmt::skip]
const POLAR: Number = Number { option: "--polar-inertia-kg-m2", question: "polar moment of inertia in kg m²", range: NOT_NEGATIVE };
#[rustfmt::skip]
const LENGTH: Number = Number { option: "--length-m", question: "length in m", range: POSITIVE };
#[rustfmt::skip]
const LOAD: Number = Number { option: "--load-n", question: "static load in N", range: NOT_NEGATIVE };

impl NumberArgs {
    /// Every number, checked; `ask` is asked for those that are needed and not given.
    fn machine(
        &self,
        mut ask: impl FnMut(&Number) -> Result<f64, CommandError>,
    ) -> Result<Machine, CommandError> {
        let given = [
            (SAMPLE_RATE, self.sample_rate_hz),
            (MASS, self.mass_kg),
            (STIFFNESS, self.stiffness_n_m),
            (CLEARANCE, self.clearance_m),
            (CONTACT_STIFFNESS, self.contact_stiffness_n_m),
            (FORCE, self.force_max_n),
            (LAG, self.lag_s),
            (FRICTION, self.friction),
            (NOISE, self.noise_rms_m),
            (SPIN, self.spin_hz),
            (RADIUS, self.contact_radius_m),
            (LOAD, self.load_n),
            (TRANSVERSE, self.transverse_inertia_kg_m2),
            (POLAR, self.polar_inertia_kg_m2),
            (LENGTH, self.length_m),
        ];
        for (number, value) in given {
            value.map_or(Ok(()), |value| number.check(value))?;
        }
        let mut needed =
            |number: Number, value: Option<f64>| value.map_or_else(|| ask(&number), Ok);
        let machine = Machine {
            sample_rate_hz: needed(SAMPLE_RATE, self.sample_rate_hz)?,
            mass_kg: needed(MASS, self.mass_kg)?,
            stiffness_n_m: needed(STIFFNESS, self.stiffness_n_m)?,
            clearance_m: needed(CLEARANCE, self.clearance_m)?,
            contact_stiffness_n_m: needed(CONTACT_STIFFNESS, self.contact_stiffness_n_m)?,
            force_max_n: needed(FORCE, self.force_max_n)?,
            lag_s: needed(LAG, self.lag_s)?,
            friction: needed(FRICTION, self.friction)?,
            noise_rms_m: needed(NOISE, self.noise_rms_m)?,
            load_n: self.load_n.unwrap_or(0.0),
            spin_hz: self.spin_hz,
            contact_radius_m: self.contact_radius_m,
            bearings: None,
        };
        Ok(Machine {
            bearings: self.bearings(&machine)?,
            ..machine
        })
    }

    /// The two bearings, where they are given.
    fn bearings(&self, machine: &Machine) -> Result<Option<Bearings>, CommandError> {
        let refused = |message: String, help: &str| {
            Err(CommandError::Numbers {
                message,
                help: help.to_owned(),
            })
        };
        let Some(places) = &self.bearings_m else {
            return Ok(None);
        };
        let positions_m = match places[..] {
            [a, b] if a < 0.0 && b > 0.0 && a.is_finite() && b.is_finite() => [a, b],
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
        let cylinder = |length_m: f64| {
            let square = machine
                .contact_radius_m
                .unwrap_or(text::CONTACT_RADIUS_M)
                .powi(2);
            let mass_kg = machine.mass_kg;
            let transverse = mass_kg * (3.0 * square + length_m * length_m) / 12.0;
            [transverse, 0.5 * mass_kg * square]
        };
        let given = self.transverse_inertia_kg_m2.zip(self.polar_inertia_kg_m2);
        let inertias = given.map(|(transverse, polar)| [transverse, polar]);
        let Some([transverse_inertia_kg_m2, polar_inertia_kg_m2]) =
            inertias.or_else(|| self.length_m.map(cylinder))
        else {
            let message = "--bearings-m without inertias".to_owned();
            let help = "give --transverse-inertia-kg-m2 and --polar-inertia-kg-m2, or --length-m";
            return refused(message, help);
        };
        Ok(Some(Bearings {
            positions_m,
            transverse_inertia_kg_m2,
            polar_inertia_kg_m2,
        }))
    }

    /// Options that are needed and not given.
    fn missing(&self) -> Vec<&'static str> {
        let mut missing = Vec::new();
        // What is asked for, with any answer.
        let _asked = self.machine(|number| {
            missing.push(number.option);
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
    warn(&Scene::parse(&name, &scene)?.warnings);
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
    write().map_err(|reason| OutputError::at(path)(reason).into())
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
        help: "look at --stiffness-n-m, --lag-s, --sample-rate-hz and --noise-rms-m: it pulls too hard for so late a force, or \
               the sensor is too noisy for so small a one"
            .to_owned(),
    })?;
    let rounded = levitation.iter().map(|gains| LevitationParams {
        proportional_n_m: rounded(gains.proportional_n_m),
        derivative_n_s_m: rounded(gains.derivative_n_s_m),
        ..*gains
    });
    Ok(text::scene(machine, &rounded.collect::<Vec<_>>()))
}

/// To three digits: it is made up, and should not look as if it were not.
fn rounded(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}
