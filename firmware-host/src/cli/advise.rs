//! `advise`: what can be known of a bearing before the supervisor goes in, and a suggested configuration.

use crate::cli::error::{CommandError, pretty, print, say};
use crate::cli::load;
use crate::cli::screen::print_wrapped;
use firmware_bench::advise::{self, Advice, Language, OutOfRange, RotorAdvice, Warning};
use firmware_bench::modes::Coupling;
use firmware_bench::report::campbell;
use firmware_bench::scene::suggest::Nominal;
use firmware_bench::scene::{PlaneScene, Scene};
use serde::Serialize;
use std::path::{Path, PathBuf};
use supervisor::Config;

/// As what the configuration is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// The table of a scene.
    Toml,
    /// The struct of a firmware in Rust.
    Rust,
    /// The array of a firmware in C or C++.
    C,
}

impl From<Format> for Language {
    fn from(format: Format) -> Self {
        match format {
            Format::Toml => Self::Toml,
            Format::Rust => Self::Rust,
            Format::C => Self::C,
        }
    }
}

/// Arguments of `advise`.
#[derive(Debug, Clone, clap::Args)]
pub struct AdviseArgs {
    /// Scene file with a magnet; or give the numbers below.
    pub scene: Option<PathBuf>,
    /// Print JSON instead of text.
    #[arg(long)]
    pub json: bool,
    /// Print the configuration alone, as it is written there. What the scene's own [supervisor] sets is in it.
    #[arg(long, value_enum, conflicts_with = "json")]
    pub format: Option<Format>,
    /// With --format: the nine numbers that cannot be guessed, and only what does not follow from them.
    #[arg(long, requires = "format")]
    pub short: bool,
    /// Amplitude of the runout of the reading on one axis, as measured at slow roll; also beside a scene.
    #[arg(long, allow_hyphen_values = true, value_name = "NUMBER")]
    pub runout_m: Option<f64>,
    /// Of several planes, the one of this name alone.
    #[arg(long, value_name = "NAME", requires = "scene")]
    pub plane: Option<String>,
    #[command(flatten)]
    numbers: NumberArgs,
}

/// A number instead of a scene.
macro_rules! numbers {
    ($($(#[doc = $doc:literal])* $name:ident: $ty:ty, $default:expr, $ok:expr, $expected:literal;)*) => {
        /// Nominal data on the command line, one option a field of [`Nominal`].
        #[derive(Debug, Clone, clap::Args)]
        #[command(next_help_heading = "Numbers instead of a scene")]
        struct NumberArgs {
            $($(#[doc = $doc])*
            #[arg(long, conflicts_with = "scene", allow_hyphen_values = true, value_name = "NUMBER")]
            $name: Option<$ty>,)*
        }

        impl NumberArgs {
            /// Checks every number.
            fn nominal(&self) -> Result<Numbers, CommandError> {
                Ok(Numbers { $($name: {
                    let default: Option<$ty> = $default;
                    let value = self.$name.or(default);
                    let ok: fn($ty) -> bool = $ok;
                    if let Some(value) = value && !ok(value) {
                        return Err(refused(stringify!($name), &format!("is {value}"), $expected));
                    }
                    value
                },)* })
            }
        }

        /// The numbers, checked; none where there is neither number nor default.
        struct Numbers { $($name: Option<$ty>,)* }
    };
}

fn positive(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

fn not_negative(value: f64) -> bool {
    value >= 0.0 && value.is_finite()
}

numbers! {
    /// Mass of the rotor that this bearing plane carries.
    mass_kg: f64, None, positive, "a finite number greater than 0";
    /// Radial clearance of the retainer bearing.
    clearance_m: f64, None, positive, "a finite number greater than 0";
    /// Coefficient of sliding friction, upper end of what is likely.
    friction: f64, None, not_negative, "a finite number, 0 or greater";
    /// Shaft stiffness less the magnets' negative stiffness, e.g. -2e5.
    stiffness_n_m: f64, None, f64::is_finite, "a finite number";
    /// Stiffness of the contact with the retainer bearing.
    contact_stiffness_n_m: f64, None, positive, "a finite number greater than 0";
    /// Force cap, as the length of the vector.
    force_max_n: f64, None, positive, "a finite number greater than 0";
    /// Control rate.
    sample_rate_hz: f64, None, |v| (1.0..=1e6).contains(&v), "a number from 1 to 1e6";
    /// Passive damping [default: 0].
    damping_n_s_m: f64, Some(0.0), not_negative, "a finite number, 0 or greater";
    /// Restitution of a radial impact [default: 0.7].
    restitution: f64, None, |v| v > 0.0 && v <= 1.0, "a number greater than 0, at most 1";
    /// Coefficient of rolling friction [default: 0].
    rolling_friction: f64, Some(0.0), not_negative, "a finite number, 0 or greater";
    /// Reduced mass of rotor and the ring it touches [default: the rotor's].
    contact_mass_kg: f64, None, positive, "a finite number greater than 0";
    /// Time constant of the amplifier with the magnet [default: 0].
    lag_s: f64, Some(0.0), not_negative, "a finite number, 0 or greater";
    /// Ticks from a sample to the start of its force [default: 1].
    delay_samples: u32, Some(1), |v| v <= 7, "a whole number from 0 to 7";
    /// Noise of the position, root mean square [default: 0].
    noise_rms_m: f64, Some(0.0), not_negative, "a finite number, 0 or greater";
    /// Step of the converter of the position [default: 0].
    quantum_m: f64, Some(0.0), not_negative, "a finite number, 0 or greater";
    /// Largest reading of the position to either side [default: not known].
    range_m: f64, None, positive, "a finite number greater than 0";
    /// Force cap of each axis [default: none].
    axis_force_max_n: f64, None, positive, "a finite number greater than 0";
    /// Fastest change of the force [default: not limited].
    slew_n_s: f64, None, positive, "a finite number greater than 0";
    /// Static load on this plane, such as the weight of a horizontal rotor [default: 0].
    load_n: f64, Some(0.0), not_negative, "a finite number, 0 or greater";
    /// How far the retainer bearing's centre lies off that of the sensors [default: 0].
    centre_offset_m: f64, Some(0.0), not_negative, "a finite number, 0 or greater";
    /// Spin of the rotor [default: not known].
    spin_hz: f64, None, f64::is_finite, "a finite number";
}

/// Option of a field of [`Nominal`] or [`NumberArgs`].
fn option(field: &str) -> String {
    let name = match field {
        "friction_coefficient" => "friction",
        "rolling_coefficient" => "rolling_friction",
        name => name,
    };
    format!("--{}", name.replace('_', "-"))
}

fn refused(field: &str, what: &str, expected: &str) -> CommandError {
    CommandError::Numbers {
        message: format!("{} {what}, expected {expected}", option(field)),
        help: format!("give {expected}"),
    }
}

impl Numbers {
    fn nominal(&self) -> Result<Nominal, CommandError> {
        let needed = |name: &str, value: Option<f64>| {
            value.ok_or_else(|| CommandError::Numbers {
                message: format!("{} is missing", option(name)),
                help: "give a scene file, or at least --mass-kg, --clearance-m, --friction, --stiffness-n-m, \
                       --contact-stiffness-n-m, --force-max-n and --sample-rate-hz"
                    .to_owned(),
            })
        };
        let mass_kg = needed("mass_kg", self.mass_kg)?;
        let clearance_m = needed("clearance_m", self.clearance_m)?;
        let contact_mass_kg = self.contact_mass_kg.unwrap_or(mass_kg);
        if contact_mass_kg > mass_kg {
            let is = format!("is {contact_mass_kg}");
            let expected = "at most the rotor's mass: a reduced mass is smaller than both";
            return Err(refused("contact_mass_kg", &is, expected));
        }
        if let Some(offset_m) = self.centre_offset_m
            && offset_m >= clearance_m
        {
            let is = format!("is {offset_m}");
            let expected = "a length below --clearance-m, so that the rotor can be levitated";
            return Err(refused("centre_offset_m", &is, expected));
        }
        Ok(Nominal {
            mass_kg,
            clearance_m,
            friction_coefficient: needed("friction", self.friction)?,
            stiffness_n_m: needed("stiffness_n_m", self.stiffness_n_m)?,
            contact_stiffness_n_m: needed("contact_stiffness_n_m", self.contact_stiffness_n_m)?,
            force_max_n: needed("force_max_n", self.force_max_n)?,
            sample_rate_hz: needed("sample_rate_hz", self.sample_rate_hz)?,
            restitution: self.restitution,
            contact_hardens: false,
            contact_mass_kg,
            axis_force_max_n: self.axis_force_max_n,
            slew_n_s: self.slew_n_s,
            damping_n_s_m: self.damping_n_s_m.unwrap_or_default(),
            rolling_coefficient: self.rolling_friction.unwrap_or_default(),
            lag_s: self.lag_s.unwrap_or_default(),
            delay_samples: self.delay_samples.unwrap_or_default(),
            noise_rms_m: self.noise_rms_m.unwrap_or_default(),
            quantum_m: self.quantum_m.unwrap_or_default(),
            range_m: self.range_m,
            load_n: self.load_n.unwrap_or_default(),
            centre_offset_m: self.centre_offset_m.unwrap_or_default(),
            spin_hz: self.spin_hz,
            runout_m: None,
            retainer_plane_ratio: 1.0,
            magnet_plane_ratio: 1.0,
        })
    }
}

/// Prints the advice.
///
/// # Errors
/// [`CommandError`] for a scene or numbers that there is no advice for.
pub fn execute(args: &AdviseArgs) -> Result<(), CommandError> {
    if let Some(runout_m) = args.runout_m
        && !not_negative(runout_m)
    {
        let is = format!("is {runout_m}");
        return Err(refused("runout_m", &is, "a finite number, 0 or greater"));
    }
    let advice = match &args.scene {
        Some(path) => {
            let scene = load(path)?;
            match &scene.planes[..] {
                [only] if only.name.is_empty() && args.plane.is_some() => {
                    return Err(CommandError::Numbers {
                        message: format!(
                            "--plane: {} has one plane without a name",
                            path.display()
                        ),
                        help: "leave the option out".to_owned(),
                    });
                }
                [only] if args.plane.is_none() && (args.format.is_some() || !scene.has_axis()) => {
                    of_plane(args, path, only, &scene.title)?
                }
                _ => match of_machine(args, path, &scene)? {
                    Some(advice) => advice,
                    None => return Ok(()),
                },
            }
        }
        None => {
            let nominal = with_runout(args, args.numbers.nominal()?.nominal()?);
            if nominal.runout_m.is_some() && nominal.spin_hz.is_none() {
                return Err(CommandError::Numbers {
                    message: "--runout-m is given without --spin-hz".to_owned(),
                    help: "give --spin-hz: how fast a runout reads is a matter of the spin"
                        .to_owned(),
                });
            }
            Advice::new("Plain numbers", &nominal, &[]).map_err(|e| out_of_range(&e, option))?
        }
    };
    if args.json {
        return print(&(pretty(&advice, "formatting the advice")? + "\n"));
    }
    let listing = args.format.map(|format| listing(args, &advice, format));
    match listing.transpose()? {
        Some(listing) => {
            say_warnings(&advice.warnings);
            print(&listing)
        }
        None => print_wrapped(&advise::text(&advice)),
    }
}

/// A listing goes into a file; these are for whoever puts it there.
fn say_warnings(warnings: &[Warning]) {
    for w in warnings {
        say(format_args!(
            "warning: {}: {}\n  do: {}",
            w.key, w.text, w.remedy
        ));
    }
}

/// The configuration alone.
fn listing(args: &AdviseArgs, advice: &Advice, format: Format) -> Result<String, CommandError> {
    if !args.short {
        return Ok(advise::listing(&advice.parameters, format.into()));
    }
    advise::short(advice, format.into()).ok_or_else(|| CommandError::Numbers {
        message: "--short is given with --format toml".to_owned(),
        help: "take --format rust or c: a scene has the nine numbers in its other tables"
            .to_owned(),
    })
}

/// With the runout of the command line.
fn with_runout(args: &AdviseArgs, nominal: Nominal) -> Nominal {
    Nominal {
        runout_m: args.runout_m.or(nominal.runout_m),
        ..nominal
    }
}

fn of_plane(
    args: &AdviseArgs,
    path: &Path,
    plane: &PlaneScene,
    title: &str,
) -> Result<Advice, CommandError> {
    if plane.magnet.is_none() {
        return Err(CommandError::Numbers {
            message: format!("{} has no magnet", path.display()),
            help: "add [magnet]: without one there is nothing to configure".to_owned(),
        });
    }
    Advice::of_plane(
        title,
        &with_runout(args, plane.nominal),
        &plane.decided,
        &plane.overrides,
    )
    .map_err(|e| out_of_range(&e, |field| plane.nominal_keys.key(field).to_owned()))
}

/// Advice for all planes of a rotor.
#[derive(Serialize)]
struct MachineAdvice<'a> {
    scene: &'a str,
    coupling: Coupling,
    rotor: Option<RotorAdvice>,
    planes: Vec<Advice>,
}

/// Advice for the plane that is asked for; without one that for all of them is printed, and how they feel each other.
fn of_machine(
    args: &AdviseArgs,
    path: &Path,
    scene: &Scene,
) -> Result<Option<Advice>, CommandError> {
    let names = || {
        let names: Vec<&str> = scene.planes.iter().map(|p| p.name.as_str()).collect();
        format!("planes are {}", names.join(", "))
    };
    let refused = |message: String| CommandError::Numbers {
        message,
        help: names(),
    };
    let title = &scene.title;
    if let Some(name) = &args.plane {
        let plane = (scene.planes.iter().find(|plane| plane.name == *name))
            .ok_or_else(|| refused(format!("--plane: there is no plane \"{name}\"")))?;
        return of_plane(args, path, plane, &format!("{title}: {name}")).map(Some);
    }
    let of_both = (scene.shaft()).filter(|_| matches!(args.format, Some(Format::C)) && !args.short);
    if args.format.is_some() && of_both.is_none() {
        let message = "--format is of one plane, or --format c of both of a rotor: give --plane";
        return Err(refused(message.to_owned()));
    }
    let with_magnet = scene.planes.iter().filter(|plane| plane.magnet.is_some());
    let all: Vec<Advice> = with_magnet
        .map(|plane| of_plane(args, path, plane, plane.shown()))
        .collect::<Result<_, _>>()?;
    if let (Some(shaft), [first, second]) = (of_both, &all[..]) {
        all.iter().for_each(|plane| say_warnings(&plane.warnings));
        let both = [first, second].map(|plane| (plane.title.as_str(), &plane.parameters[..]));
        print(&advise::rotor_in_c(&shaft, both))?;
        return Ok(None);
    }
    let coupling =
        Coupling::new(scene).map_err(|e| CommandError::other("reading the machine", e))?;
    // As suggested, but for what the scene replaces.
    let in_use: Vec<Config> = all.iter().map(Advice::in_use).collect();
    let rotor = RotorAdvice::new(scene, &in_use);
    if args.json {
        let all = MachineAdvice {
            scene: title,
            coupling,
            rotor,
            planes: all,
        };
        print(&(pretty(&all, "formatting the advice")? + "\n"))?;
    } else {
        let texts: Vec<String> = all.iter().map(advise::text).collect();
        let rotor = rotor.map_or_else(String::new, |rotor| rotor.text() + "\n");
        print_wrapped(&format!(
            "{title}\n{}\n\n{rotor}{}",
            campbell::coupling(&coupling),
            texts.join("\n")
        ))?;
    }
    Ok(None)
}

/// A suggested value that the supervisor would refuse is a number that does not fit.
fn out_of_range(e: &OutOfRange, name: impl Fn(&str) -> String) -> CommandError {
    let source = e.source.map_or(String::new(), name);
    CommandError::Numbers {
        message: format!("{source}: the supervisor derives {} from this", e.error),
        help: e.error.parameter().text.to_owned(),
    }
}
