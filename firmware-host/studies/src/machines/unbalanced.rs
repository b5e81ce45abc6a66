//! Machines with unbalance drawn at random, left alone or driven on to the wall.

use super::draw::Draw;
use std::f64::consts::TAU;

/// How the rotor goes round.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// A point mass in one plane.
    OnePlane,
    /// Two planes, both ends alike.
    Cylindrical,
    /// Two planes, the ends opposite.
    Conical,
}

impl Motion {
    pub const ALL: [Self; 3] = [Self::OnePlane, Self::Cylindrical, Self::Conical];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::OnePlane => "one plane",
            Self::Cylindrical => "two planes, cylindrical",
            Self::Conical => "two planes, conical",
        }
    }
}

/// Turns before something drives the rotor on to the wall.
const BEFORE: f64 = 40.0;
/// Turns for which it does.
pub(crate) const DRIVEN: f64 = 15.0;
/// Turns after it.
pub const TURNS: f64 = 150.0;

/// A machine with unbalance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RubCase {
    /// Its number in the draw.
    pub number: u64,
    /// How it goes round.
    pub motion: Motion,
    /// What a circle of a plane at the spin's rate moves \[kg\].
    moved_kg: f64,
    /// Transverse and polar inertia over m·a², with two planes.
    shares: [f64; 2],
    /// Largest backward turn of a synchronous force by delay and lag \[rad\].
    late_rad: f64,
    clearance_m: f64,
    force_n: f64,
    friction: f64,
    restitution: f64,
    spin_rad_s: f64,
    eccentricity_m: f64,
    phase_rad: f64,
    rate_hz: f64,
    lag_s: f64,
    negative_n_m: f64,
    proportional_n_m: f64,
    derivative_n_s_m: f64,
}

/// Distance of a plane from the centre of mass \[m\].
const ARM_M: f64 = 0.2;

impl RubCase {
    /// The machine of a number.
    pub fn new(seed: u64, motion: Motion, number: u64) -> Self {
        let mut draw = Draw::new(seed, 3 * number + motion as u64);
        let clearance_m = draw.between(1e-4, 3e-4);
        let plane_kg = draw.decades(1.0, 50.0);
        let force_n = 9.81 * plane_kg * draw.decades(2.0, 30.0);
        let transverse = draw.between(0.3, 1.3);
        let shares = [transverse, transverse * draw.between(0.05, 0.7)];
        let moved_kg = match motion {
            Motion::Conical => plane_kg * (shares[0] - shares[1]),
            _ => plane_kg,
        };
        let negative_n_m = force_n / clearance_m * draw.between(0.0, 0.3);
        let proportional_n_m = negative_n_m + force_n / clearance_m * draw.between(0.5, 2.0);
        let free_rad_s = ((proportional_n_m - negative_n_m) / moved_kg).sqrt();
        let spin_rad_s = free_rad_s * draw.decades(1.3, 5.0);
        // As a user would choose it: twenty samples a turn.
        let least_hz = 20.0 * spin_rad_s / TAU;
        let rates_hz: [f64; 3] = [1e4, 2e4, 4e4];
        let rate_hz = draw.one_of(&rates_hz).max(least_hz.min(4e4));
        let rate_hz = (rates_hz.into_iter().find(|rate| *rate >= rate_hz)).unwrap_or(4e4);
        let lag_s = draw.between(3e-5, 1.5e-4);
        Self {
            number,
            motion,
            moved_kg,
            shares,
            late_rad: spin_rad_s * (lag_s + 1.5 / rate_hz),
            clearance_m,
            force_n,
            friction: draw.between(0.03, 0.25),
            restitution: draw.between(0.4, 0.8),
            spin_rad_s,
            eccentricity_m: clearance_m * draw.decades(0.06, 0.5),
            phase_rad: draw.angle_rad(),
            rate_hz,
            lag_s,
            negative_n_m,
            proportional_n_m,
            derivative_n_s_m: 2.0 * draw.between(0.1, 0.6) * moved_kg * free_rad_s,
        }
    }

    /// What friction and the whole cap brake at most, over what unbalance drives at most: (4.18). Below 1 no force within
    /// the cap that goes round with the rotor ends a rub.
    pub fn reserve(&self) -> f64 {
        let square = self.spin_rad_s * self.spin_rad_s;
        let mu = self.friction;
        let inertial_n = (self.moved_kg * square + self.negative_n_m) * self.clearance_m;
        let brakes_n = self.force_n + mu * inertial_n / (1.0 + mu * mu).sqrt();
        brakes_n / (self.moved_kg * self.eccentricity_m * square)
    }

    /// In a line.
    pub fn text(&self) -> String {
        format!(
            "{} {}: {:.1} kg at {:.0} Hz, {:.1} weights, mass centre {:.2} clearances off, reserve {:.2}, force {:.2} rad late",
            self.motion.name(),
            self.number,
            self.moved_kg,
            self.spin_rad_s / TAU,
            self.force_n / self.moved_kg / 9.81,
            self.eccentricity_m / self.clearance_m,
            self.reserve(),
            self.late_rad,
        )
    }

    /// Time of a turn \[s\].
    pub(crate) fn turn_s(&self) -> f64 {
        TAU / self.spin_rad_s
    }

    /// What drives it: forces that turn with the unbalance, those of a clearance's unbalance and the cap besides.
    fn loads(&self, per_turn_s: f64) -> String {
        let driven_n = self.moved_kg * self.clearance_m * self.spin_rad_s.powi(2);
        let force_n = driven_n + self.force_n;
        let places: &[(f64, f64)] = match self.motion {
            Motion::OnePlane => &[(0.0, 0.0)],
            Motion::Cylindrical => &[(-ARM_M, 0.0), (ARM_M, 0.0)],
            Motion::Conical => &[(-ARM_M, 0.5 * TAU), (ARM_M, 0.0)],
        };
        let mut text = String::new();
        for (position_m, angle_rad) in places {
            let place = match self.motion {
                Motion::OnePlane => String::new(),
                _ => format!("position_m = {position_m}\n"),
            };
            // Whole turns have passed before: the phase is that of the start. A cosine along x, a sine along y.
            for (direction, quarter) in [([force_n, 0.0], 0.25 * TAU), ([0.0, force_n], 0.0)] {
                text += &format!(
                    "[[disturbance]]\nstart_s = {}\nduration_s = {}\nforce_n = {direction:?}\nshape = \"sine\"\nfrequency_hz = {}\nphase_rad = {}\n{place}",
                    BEFORE * per_turn_s,
                    DRIVEN * per_turn_s,
                    1.0 / per_turn_s,
                    self.phase_rad + angle_rad + quarter,
                );
            }
        }
        text
    }

    /// Its scene: levitated, or driven on to the wall.
    pub fn scene(&self, driven: bool) -> String {
        let Self {
            clearance_m: c,
            force_n,
            friction,
            restitution,
            spin_rad_s,
            eccentricity_m,
            phase_rad,
            rate_hz,
            lag_s,
            negative_n_m,
            proportional_n_m,
            derivative_n_s_m,
            ..
        } = self;
        let two = self.motion != Motion::OnePlane;
        let [transverse, polar] = self.shares;
        let plane_kg = match self.motion {
            Motion::Conical => self.moved_kg / (transverse - polar),
            _ => self.moved_kg,
        };
        let rotor = match two {
            false => format!(
                "mass_kg = {plane_kg}\neccentricity_m = {eccentricity_m}\ncontact_radius_m = 0.03"
            ),
            true => {
                let of = |share: f64| 2.0 * plane_kg * ARM_M * ARM_M * share;
                format!(
                    "mass_kg = {}\ntransverse_inertia_kg_m2 = {}\npolar_inertia_kg_m2 = {}",
                    2.0 * plane_kg,
                    of(transverse),
                    of(polar)
                )
            }
        };
        let per_turn_s = TAU / spin_rad_s;
        let loads = if driven {
            self.loads(per_turn_s)
        } else {
            String::new()
        };
        let planes = if two {
            let moment = self.moved_kg * eccentricity_m;
            let other = match self.motion {
                Motion::Conical => 0.5 * TAU,
                _ => 0.0,
            };
            format!(
                "[[plane]]\nname = \"A\"\nposition_m = -{ARM_M}\ncontact_radius_m = 0.03\n\
                 [[plane]]\nname = \"B\"\nposition_m = {ARM_M}\ncontact_radius_m = 0.03\n\
                 [[unbalance]]\nposition_m = -{ARM_M}\nmoment_kg_m = {moment}\nangle_rad = {other}\n\
                 [[unbalance]]\nposition_m = {ARM_M}\nmoment_kg_m = {moment}\n"
            )
        } else {
            String::new()
        };
        format!(
            r#"
title = "Unbalance drawn at random"
[run]
duration_s = {}
sample_rate_hz = {rate_hz}
policies = ["levitation", "supervisor"]
rtol = 1e-7
seed = {}
[rotor]
{rotor}
[spin]
frequency_hz = {}
[start]
spin_phase_rad = {phase_rad}
[contact]
clearance_m = {c}
stiffness_n_m = {}
restitution = {restitution}
[friction]
coefficient = {friction}
[magnet]
force_max_n = {force_n}
lag_s = {lag_s}
negative_stiffness_n_m = {negative_n_m}
[sensor]
noise_rms_m = {}
[levitation]
proportional_n_m = {proportional_n_m}
derivative_n_s_m = {derivative_n_s_m}
derivative_filter_s = {}
[verdict]
whirl_speed_m_s = {}
{planes}
{loads}
"#,
            (BEFORE + DRIVEN + TURNS) * per_turn_s,
            self.number,
            spin_rad_s / TAU,
            1e8 * plane_kg,
            2e-3 * c,
            1.0 / rate_hz,
            // A circle on the wall three times as fast as a rub's.
            3.0 * spin_rad_s * c,
        )
    }
}
