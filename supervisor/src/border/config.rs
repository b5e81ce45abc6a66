//! The parameters: one table gives the struct, its check, its documentation and its test cases.

use crate::border::parts::{BENDING, CHECK, THERMAL_BUDGET};
use crate::number::scalar::{Order, gain_square, sqrt};

/// One row of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Name of the field of [`Config`].
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Smallest valid value.
    pub low: f32,
    /// Largest valid value.
    pub high: f32,
    /// What it is and how to choose it.
    pub text: &'static str,
    /// What it is of.
    pub group: Group,
    /// What [`Config::for_bearing`] puts there.
    pub default: DefaultRule,
}

/// What a parameter is of: who knows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// Rotor and retainer bearing.
    Machine,
    /// Loop, amplifier and magnet.
    Drive,
    /// Position sensor.
    Sensor,
    /// How the supervisor behaves.
    Tuning,
}

/// Value of a parameter in [`Config::for_bearing`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DefaultRule {
    /// Given by [`crate::Bearing`]: it cannot be guessed.
    Given,
    /// The same for every bearing, and why.
    Constant(f32, &'static str),
    /// Derived from [`crate::Bearing`], and how.
    Derived(&'static str),
}

/// What two parameters, each in its range, have to be to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    /// Whose value is refused: its place in [`PARAMETERS`].
    pub index: usize,
    /// What it does not go with, likewise.
    pub other: usize,
    /// Whether the limit is the least value and not the largest.
    pub at_least: bool,
    /// Why, and what to do.
    pub text: &'static str,
}

impl Rule {
    /// Value over limit, or the other way round where the limit is the largest.
    fn room(&self, value: f32, limit: f32) -> f32 {
        if self.at_least {
            value / limit
        } else {
            limit / value
        }
    }
}

/// A broken rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contradiction {
    /// Which: its place in [`RULES`].
    pub rule: usize,
    /// The largest or least value that the others leave.
    pub limit: f32,
}

/// A parameter outside its range, or one that contradicts another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConfigError {
    /// Which one: its place in [`PARAMETERS`]. No reference to the row, so that firmware that prints no
    /// texts does not carry them.
    pub index: usize,
    /// The refused value.
    pub value: f32,
    /// What it contradicts; none where it is outside its own range.
    pub contradiction: Option<Contradiction>,
}

impl ConfigError {
    /// Outside its range.
    pub(crate) const fn of_range(index: usize, value: f32) -> Self {
        Self {
            index,
            value,
            contradiction: None,
        }
    }

    /// The rule that is broken.
    pub fn rule(&self) -> Option<&'static Rule> {
        RULES.get(self.contradiction?.rule)
    }

    /// The row of the table.
    pub fn parameter(&self) -> &'static Parameter {
        match PARAMETERS.get(self.index) {
            Some(parameter) => parameter,
            None => &PARAMETERS[0],
        }
    }
}

impl core::fmt::Display for ConfigError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Parameter {
            name,
            unit,
            low,
            high,
            ..
        } = self.parameter();
        write!(f, "{name} = {}: expected ", Written(self.value))?;
        if let (Some(Contradiction { limit, .. }), Some(rule)) = (self.contradiction, self.rule()) {
            let bound = if rule.at_least { "at least" } else { "at most" };
            let unit = if *unit == "1" { "" } else { unit };
            let other = PARAMETERS.get(rule.other).map_or("", |other| other.name);
            return write!(
                f,
                "{bound} {} {unit} by {other}: {}",
                Written(limit),
                rule.text
            );
        }
        // In its range, and yet refused: for want of a part.
        if self.value >= *low && self.value <= *high {
            return f.write_str(match self.index {
                At::CONTINUOUS => "at least force_max_n: the feature thermal-budget is left out",
                At::CHECKED => "0: the feature check is left out",
                _ => "0: the feature bending is left out",
            });
        }
        write!(f, "{} to {}", Written(*low), Written(*high))?;
        match *unit {
            "1" => Ok(()),
            unit => write!(f, " {unit}"),
        }
    }
}

/// A number as a person would write it: 0.5, and 1e-6.
struct Written(f32);

impl core::fmt::Display for Written {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self(x) = *self;
        let plain = x == 0.0 || !x.is_finite() || (1e-3..1e6).contains(&x.abs());
        if plain { x.fmt(f) } else { write!(f, "{x:e}") }
    }
}

impl core::error::Error for ConfigError {}

/// A coefficient that the chosen number cannot hold.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct NotRepresentable {
    /// What it is, per unit (see [`crate::Scaling`]).
    pub coefficient: &'static str,
    /// Its value.
    pub value: f32,
}

/// Why there is no core for a configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CoreError {
    /// A parameter is outside its range.
    Range(ConfigError),
    /// A coefficient, or the inverse of one that is divided by, is outside what the number holds.
    NotRepresentable(NotRepresentable),
}

impl core::fmt::Display for CoreError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Range(error) => error.fmt(f),
            Self::NotRepresentable(NotRepresentable { coefficient, value }) => write!(
                f,
                "{coefficient} comes to {value:e} per unit, which the chosen number cannot hold; use another tick or f32"
            ),
        }
    }
}

impl core::error::Error for CoreError {}

macro_rules! default_rule {
    ([given]) => {
        DefaultRule::Given
    };
    ([= $value:literal, $reason:literal]) => {
        DefaultRule::Constant($value, $reason)
    };
    ([by $rule:literal]) => {
        DefaultRule::Derived($rule)
    };
}

macro_rules! default_text {
    ([given]) => {
        "given by [`crate::Bearing`]"
    };
    ([= $value:literal, $reason:literal]) => {
        concat!(stringify!($value), ", ", $reason)
    };
    ([by $rule:literal]) => {
        $rule
    };
}

macro_rules! default_value {
    ([= $value:literal, $reason:literal]) => {
        $value
    };
    ($other:tt) => {
        f32::NAN
    };
}

macro_rules! parameters {
    ($($name:ident, $group:ident, $unit:literal, $low:literal ..= $high:literal, $default:tt, $text:literal;)*) => {
        /// Everything the supervisor must be told about its bearing, SI units; [`Config::for_bearing`] makes it of nine numbers.
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[repr(C)]
        pub struct Config {
            $(#[doc = $text] #[doc = concat!("\nUnit: ", $unit, "; ", stringify!($low), " to ", stringify!($high), ".")]
            #[doc = concat!("\nOf [`Config::for_bearing`]: ", default_text!($default), ".")]
            pub $name: f32,)*
        }

        /// The table: one row a field of [`Config`], in its order.
        pub const PARAMETERS: &[Parameter] = &[
            $(Parameter {
                name: stringify!($name),
                unit: $unit,
                low: $low,
                high: $high,
                text: $text,
                group: Group::$group,
                default: default_rule!($default),
            },)*
        ];

        /// Places in the table.
        #[expect(non_camel_case_types, reason = "names of fields")]
        #[derive(Clone, Copy)]
        #[expect(dead_code, reason = "not all are part of a rule, or refused for more than their range")]
        enum At {
            $($name),*
        }

        impl At {
            const CONTINUOUS: usize = Self::continuous_force_n as usize;
            const CHECKED: usize = Self::check_first as usize;
        }

        const RANGES: [[f32; 2]; PARAMETERS.len()] = [$([$low, $high]),*];

        impl Config {
            /// What is the same for every bearing. All else is no number, which [`Config::validate`] refuses.
            pub(crate) const CONSTANTS: Self = Self { $($name: default_value!($default)),* };

            /// Values in the order of [`PARAMETERS`].
            pub const fn values(&self) -> [f32; PARAMETERS.len()] {
                [$(self.$name),*]
            }

            /// A configuration from values in the order of [`PARAMETERS`].
            pub const fn from_values([$($name),*]: [f32; PARAMETERS.len()]) -> Self {
                Self { $($name),* }
            }
        }
    };
}

parameters! {
    sample_period_s, Drive, "s", 1e-6 ..= 1e-2, [given],
        "Period of the tick.";
    mass_kg, Machine, "kg", 1e-4 ..= 1e6, [given],
        "Mass of the rotor that this bearing plane carries.";
    stiffness_n_m, Machine, "N/m", -1e10 ..= 1e10, [given],
        "Shaft stiffness plus the magnets' negative stiffness, either sign.";
    damping_n_s_m, Machine, "N s/m", 0.0 ..= 1e8, [= 0.0, "on the safe side"],
        "Passive damping of the rotor in flight.";
    clearance_m, Machine, "m", 1e-6 ..= 0.1, [given],
        "Radial clearance of the retainer bearing.";
    force_max_n, Drive, "N", 1e-3 ..= 1e7, [given],
        "Force cap of the magnet, as the length of the vector.";
    amplifier_lag_s, Drive, "s", 0.0 ..= 0.1, [given],
        "Time constant of the amplifier with the magnet.";
    delay_samples, Drive, "ticks", 0.0 ..= 7.0, [= 1.0, "a command computed from a sample holds from the next one on"],
        "Ticks between a sample and the start of the force computed from it; rounded to whole ticks.";
    friction_coefficient, Machine, "1", 0.0 ..= 2.0, [given],
        "Coefficient of friction on the retainer bearing; choose the upper end of what is likely.";
    restitution, Machine, "1", 0.0 ..= 0.99, [= 0.7, "steel on steel"],
        "Restitution of a radial impact on the retainer bearing.";
    observer_pole_flight, Tuning, "1", 0.0 ..= 0.98, [by "quickest from 0.5 to 0.97 whose speed noise is at most 4 % of √(F·c/m)"],
        "Pole of the observer in flight: nearer to 1 smooths sensor noise more and follows later.";
    observer_pole_contact, Tuning, "1", 0.0 ..= 0.98, [by "quickest from 0.2 to 0.97 whose speed noise is at most 4 % of √(F·c/m)"],
        "Pole of the observer in contact, where the model knows nothing of the contact force.";
    contact_band, Tuning, "clearance", 0.001 ..= 0.3, [by "4 times noise or step over clearance, at least 0.01"],
        "The rotor counts as touching within this band below the clearance; at least the retainer's offset and three times the sensor noise.";
    position_limit, Sensor, "clearance", 1.1 ..= 20.0, [= 20.0, "the sensor's range is not known: no machine measures so far out"],
        "A measured radius beyond this is refused as implausible.";
    whirl_time_s, Tuning, "s", 1e-5 ..= 0.1, [by "a period on the contact, 2π·√(m/k_c), at least 1 ms and at most 0.1 s"],
        "Contact that lasts this long is whirl or rest, not a bounce: some periods of the rotor on the contact stiffness.";
    hold_share, Tuning, "1", 0.1 ..= 0.95, [= 0.8, "rule of thumb: gentle at first"],
        "Share of the cap that pushes inwards on the bearing: at most in an impact, and at first at rest, where it grows.";
    handover_dwell_s, Tuning, "s", 0.0 ..= 1.0, [= 5e-4, "rule of thumb: some samples without doubt"],
        "Contact must be avoidable for this long before hand-over begins.";
    handover_blend_s, Tuning, "s", 0.0 ..= 1.0, [= 2e-3, "rule of thumb: shorter than a levitation loop settles"],
        "Time of the blend to the levitation controller.";
    fault_blend_s, Tuning, "s", 0.0 ..= 1.0, [= 2e-2, "rule of thumb: longer than most interruptions; a force that stands still holds the rotor to one side, none lets it whirl"],
        "Time in which the force goes to zero when the position cannot be trusted; of a levitated rotor, or along one coordinate alone, no longer than handover_blend_s.";
    fault_ticks, Tuning, "ticks", 2.0 ..= 10000.0, [= 5.0, "rule of thumb: longer than a burst of interference, and little against the time to cross the clearance"],
        "Good samples in a row that end a sensor fault, and refused ones that make it; jumps, dropouts and a stuck sensor make it sooner.";
    axis_force_max_n, Drive, "N", 1e-3 ..= 1e7, [by "the cap: no limit of an axis was given"],
        "Force cap of each axis; none where it is at least force_max_n.";
    force_slew_n_s, Drive, "N/s", 1.0 ..= 1e12, [by "a thousand caps per sample: no limit was given"],
        "Fastest change of the commanded force, as the length of the vector.";
    continuous_force_n, Drive, "N", 1e-3 ..= 1e7, [by "the cap: no thermal budget"],
        "Force that the magnet bears for ever; at least force_max_n means no budget.";
    thermal_time_s, Drive, "s", 0.01 ..= 1e5, [= 5.0, "without effect while there is no thermal budget"],
        "Time constant of the force-time budget.";
    contact_stiffness_n_m, Machine, "N/m", 1e3 ..= 1e13, [given],
        "Stiffness of the contact with the retainer bearing.";
    coast_down_s, Tuning, "s", 0.0 ..= 100.0, [= 5e-3, "rule of thumb: several periods of the whirl"],
        "Whirl beyond what the cap can arrest for this long asks for coasting down.";
    severity_limit, Tuning, "1", 1e-3 ..= 1e8, [= 20.0, "rule of thumb, until a landing has been measured"],
        "Severity index that asks for coasting down.";
    retainer_plane_ratio, Machine, "1", 0.2 ..= 5.0, [= 1.0, "one plane: sensor and retainer bearing move alike"],
        "Position at the retainer bearing over position at the sensor.";
    magnet_plane_ratio, Machine, "1", 0.2 ..= 5.0, [= 1.0, "one plane: magnet and retainer bearing move alike"],
        "Position at the magnet over position at the retainer bearing: the leverage of its force.";
    speed_max_m_s, Sensor, "m/s", 1e-3 ..= 1000.0, [by "1.5·c·√(k_c/m), at least 2 m/s and at most 1000 m/s"],
        "No rotor is faster than this at the retainer bearing: a sample that would need it is refused.";
    sensor_step_m, Sensor, "m", 1e-9 ..= 1e-3, [by "noise or step, at least 1/2000 of the clearance"],
        "Step of the sensor's converter or its noise (root mean square), whichever is larger, at the sensor.";
    bending_first_hz, Machine, "Hz", 0.0 ..= 1e5, [= 0.0, "a rigid rotor"],
        "Natural frequency of a bending mode that the force would drive, the lower end of what is likely; 0 where there is none.";
    bending_second_hz, Machine, "Hz", 0.0 ..= 1e5, [= 0.0, "a rigid rotor"],
        "The same of a second mode; 0 where there is none.";
    acts_in_flight, Tuning, "1", 0.0 ..= 1.0, [= 1.0, "the rotor is rigid, or the force damps its bending"],
        "1: the supervisor acts from the approach on; 0: levitation keeps the rotor in the air, and the supervisor acts on evident backward whirl alone, for shafts whose bending its force would drive.";
    check_first, Tuning, "1", 0.0 ..= 1.0, [= 1.0, "no number is trusted that the machine has not confirmed"],
        "1: the supervisor only watches, as with `SHADOW`, until the machine has confirmed its configuration by levitating with the stimulus; 0: it acts unchecked, for firmware that knows better.";
}

/// Least ticks per t₀ = √(m·c/F): with fewer the rotor crosses half the clearance before a force has answered.
const LEAST_TICKS: f32 = 3.5;
/// Least cap of an axis over the cap, and the longest rise to the cap \[t₀\]: less may be meant, and costs force.
const LEAST_AXIS_SHARE: f32 = 0.2;
const SLOWEST_RISE: f32 = 8.0;
/// Most noise of the estimated speed over the lift-off speed √(F·c/m). [`Config::for_bearing`] aims at 0.04; from a third on
/// noise alone is an approach three times a second or more often.
const MOST_SPEED_NOISE: f32 = 0.3;
/// What rounding may add.
const HAIR: f32 = 1e-5;

/// Rules between parameters, in the order in which they are checked.
pub const RULES: &[Rule] = &[
    Rule {
        index: At::sample_period_s as usize,
        other: At::force_max_n as usize,
        at_least: false,
        text: "3.5 ticks at least in sqrt(mass_kg*clearance_m/force_max_n); check these four, or tick faster",
    },
    Rule {
        index: At::sensor_step_m as usize,
        other: At::observer_pole_flight as usize,
        at_least: false,
        text: "noise of the speed would be more than 30 % of the lift-off speed; raise the pole, or correct the step",
    },
    Rule {
        index: At::sensor_step_m as usize,
        other: At::observer_pole_contact as usize,
        at_least: false,
        text: "noise of the speed would be more than 30 % of the lift-off speed; raise the pole, or correct the step",
    },
    Rule {
        index: At::axis_force_max_n as usize,
        other: At::force_max_n as usize,
        at_least: true,
        text: "a fifth of the cap at least: a bearing whose axes have less has another cap; lower force_max_n, or correct the cap of the axes",
    },
    Rule {
        index: At::force_slew_n_s as usize,
        other: At::force_max_n as usize,
        at_least: true,
        text: "the cap is not reached within eight times sqrt(mass_kg*clearance_m/force_max_n); lower force_max_n, or correct the slew limit",
    },
    Rule {
        index: At::contact_band as usize,
        other: At::sensor_step_m as usize,
        at_least: true,
        text: "a step of the sensor alone would be a touch; widen the band, or correct the step",
    },
];

impl Config {
    /// An example, and no default for any machine: a rotor of 10 kg in a clearance of 0.2 mm, with a cap of 1 kN and a tick of
    /// 50 µs, as `advise` of the command line suggests it for 1 µm of sensor noise; slew limit and thermal budget are the
    /// drive's own. Tests and documentation start from it, and name what they have otherwise; so does the self-test, whose
    /// known answers change with it.
    pub const fn example() -> Self {
        Config {
            sample_period_s: 50e-6,
            mass_kg: 10.0,
            stiffness_n_m: -2e5,
            clearance_m: 2e-4,
            force_max_n: 1000.0,
            amplifier_lag_s: 1.6e-4,
            friction_coefficient: 0.15,
            observer_pole_flight: 0.69,
            observer_pole_contact: 0.5,
            contact_band: 0.02,
            whirl_time_s: 1e-3,
            axis_force_max_n: 1000.0, // no cap of the axes
            force_slew_n_s: 1e7,
            continuous_force_n: if THERMAL_BUDGET { 400.0 } else { 1000.0 },
            contact_stiffness_n_m: 1e9,
            speed_max_m_s: 3.0,
            sensor_step_m: 1e-6,
            check_first: 0.0, // no machine is there to ask
            ..Self::CONSTANTS
        }
    }

    /// Checks every value against the table, and against others by [`RULES`].
    ///
    /// # Errors
    /// The first value outside its range, or else the first that contradicts another; NaN is outside every range. Where the feature `thermal-budget` is left out, a continuous
    /// force below the cap is as well, without `bending` every natural frequency but 0, and without `check` a check.
    pub fn validate(&self) -> Result<(), ConfigError> {
        for (index, ([low, high], value)) in RANGES.into_iter().zip(self.values()).enumerate() {
            if !(value >= low && value <= high) {
                return Err(ConfigError::of_range(index, value));
            }
        }
        if !THERMAL_BUDGET && self.continuous_force_n < self.force_max_n {
            let value = self.continuous_force_n;
            let index = At::continuous_force_n as usize;
            return Err(ConfigError::of_range(index, value));
        }
        if !BENDING {
            for (at, value) in [
                (At::bending_first_hz, self.bending_first_hz),
                (At::bending_second_hz, self.bending_second_hz),
            ] {
                if value != 0.0 {
                    return Err(ConfigError::of_range(at as usize, value));
                }
            }
        }
        if !CHECK && self.check_first != 0.0 {
            return Err(ConfigError::of_range(
                At::check_first as usize,
                self.check_first,
            ));
        }
        self.check_together()
    }

    /// Checks values against each other.
    fn check_together(&self) -> Result<(), ConfigError> {
        let checked = RULES.iter().zip(self.limits());
        for (number, (rule, (value, limit))) in checked.enumerate() {
            if rule.room(value, limit) < 1.0 - HAIR {
                return Err(ConfigError {
                    index: rule.index,
                    value,
                    contradiction: Some(Contradiction {
                        rule: number,
                        limit,
                    }),
                });
            }
        }
        Ok(())
    }

    /// How far it is from breaking each of [`RULES`]: over 1 where the rule is kept, and at 1 just so.
    pub fn room(&self) -> [f32; RULES.len()] {
        let mut limits = RULES.iter().zip(self.limits());
        [(); RULES.len()].map(|()| {
            let next = limits.next();
            next.map_or(1.0, |(rule, (value, limit))| rule.room(value, limit))
        })
    }

    /// Values that the rules are about, and their limits.
    fn limits(&self) -> [(f32, f32); RULES.len()] {
        let scaling = self.scaling();
        let unit_s = scaling.time_s;
        let step_m = |pole: f32, order: Order| {
            let per_speed = self.sample_period_s / self.retainer_plane_ratio;
            MOST_SPEED_NOISE * scaling.speed_m_s() * per_speed / sqrt(gain_square(pole, order))
        };
        [
            (self.sample_period_s, unit_s / LEAST_TICKS),
            (
                self.sensor_step_m,
                step_m(self.observer_pole_flight, Order::Second),
            ),
            (
                self.sensor_step_m,
                step_m(self.observer_pole_contact, Order::First),
            ),
            (self.axis_force_max_n, LEAST_AXIS_SHARE * self.force_max_n),
            (
                self.force_slew_n_s,
                self.force_max_n / (SLOWEST_RISE * unit_s),
            ),
            (
                self.contact_band,
                self.sensor_step_m * self.retainer_plane_ratio / self.clearance_m,
            ),
        ]
    }
}
