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
    /// Mass of the rotor that this bearing plane carries.
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    mass_kg: Option<f64>,
    /// Shaft stiffness less the magnets' negative stiffness, e.g. -2e5.
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    stiffness_n_m: Option<f64>,
    /// Radial clearance of the retainer bearing.
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    clearance_m: Option<f64>,
    /// Stiffness of the contact with the retainer bearing.
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    contact_stiffness_n_m: Option<f64>,
    /// Force cap, as the length of the vector.
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
        ];
        for (number, value) in given {
            value.map_or(Ok(()), |value| number.check(value))?;
        }
        let mut needed =
            |number: Number, value: Option<f64>| value.map_or_else(|| ask(&number), Ok);
        Ok(Machine {
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
        })
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
    let bare = Scene::parse(name, &text::scene(machine, None))?;
    let pull_n_m = (-machine.stiffness_n_m).max(0.0);
    let carried_n_m = CARRIED_SHARE * machine.force_max_n / machine.clearance_m;
    let aim = rule_of_thumb(machine.mass_kg, pull_n_m, pull_n_m.max(carried_n_m));
    let levitation = acceptable_near(&bare, aim.proportional_n_m).ok_or_else(|| CommandError::Numbers {
        message: "no levitation controller of proportional and derivative gain holds this rotor well (peak sensitivity below 3, \
                  noise below 5 % of the cap)"
            .to_owned(),
        help: "look at --stiffness-n-m, --lag-s, --sample-rate-hz and --noise-rms-m: it pulls too hard for so late a force, or \
               the sensor is too noisy for so small a one"
            .to_owned(),
    })?;
    let rounded = LevitationParams {
        proportional_n_m: rounded(levitation.proportional_n_m),
        derivative_n_s_m: rounded(levitation.derivative_n_s_m),
        ..levitation
    };
    Ok(text::scene(machine, Some(&rounded)))
}

/// To three digits: it is made up, and should not look as if it were not.
fn rounded(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}
