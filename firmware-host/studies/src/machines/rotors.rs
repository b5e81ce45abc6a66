//! Rotors in two magnetic bearings drawn at random, as scenes in which nothing happens.

use super::draw::Draw;

/// What events on a rotor are measured by; cap and clearance of each end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotorMeasures {
    /// Mass \[kg\].
    pub mass_kg: f64,
    /// Transverse inertia \[kg m²\].
    pub transverse_kg_m2: f64,
    /// Distances of the magnets from the centre of mass \[m\].
    pub ends_m: [f64; 2],
    /// Clearance \[m\].
    pub clearance_m: f64,
    /// Cap \[N\].
    pub force_n: f64,
    /// Spin \[Hz\].
    pub spin_hz: f64,
    /// Proportional gain \[N/m\].
    pub proportional_n_m: f64,
}

/// What kind of rotor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// Rigid, I_p/I_t of 0.05 to 1.8, spins of 50 to 600 Hz.
    Rigid,
    /// Rigid, with nutation of 140 to 1900 Hz behind amplifiers that are quick enough for it.
    Gyroscopic,
    /// As `Rigid`, with a bending mode between 300 Hz and 4 kHz that nobody configures.
    Flexible,
    /// As `Flexible`, sensors and retainer bearings up to 40 mm inboard or outboard of the magnets.
    Bent,
    /// As `Rigid`, with a seal between the bearings that is narrower than they are.
    Sealed,
    /// Those of `Rigid`, whose supervisor ticks one plane in a control sample and the other in the next.
    InTurn,
}

impl Class {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::Gyroscopic => "gyroscopic",
            Self::Flexible => "flexible",
            Self::Bent => "bent shaft",
            Self::Sealed => "with a seal",
            Self::InTurn => "rigid, planes in turn",
        }
    }
}

/// A rotor of a number, without what happens to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotorCase {
    /// Its number in the draw.
    pub number: u64,
    /// What kind.
    pub class: Class,
    mass_kg: f64,
    transverse_kg_m2: f64,
    polar_kg_m2: f64,
    spin_hz: f64,
    clearance_m: f64,
    force_n: f64,
    friction: f64,
    restitution: f64,
    /// Distances of the two ends from the centre of mass, and by how much sensors stand farther out.
    ends_m: [f64; 2],
    beyond_m: f64,
    /// By how much retainer bearings stand farther out than magnets.
    retainer_beyond_m: f64,
    /// Clearance of a seal \[m\].
    seal_m: Option<f64>,
    rate_hz: f64,
    lag_s: f64,
    noise_m: f64,
    negative_n_m: f64,
    proportional_n_m: f64,
    derivative_n_s_m: f64,
    /// Frequency \[Hz\], damping ratio, displacements at the ends.
    bending: Option<(f64, f64, [f64; 2])>,
}

impl RotorCase {
    /// The rotor of a number.
    pub fn new(seed: u64, class: Class, number: u64) -> Self {
        // The first three kinds have the streams of a seed, others those of another one.
        let kind = match class {
            Class::InTurn => Class::Rigid as u64,
            _ => class as u64,
        };
        let mut draw = Draw::new(seed ^ ((kind / 3) << 32), 3 * number + kind % 3);
        let quick = class == Class::Gyroscopic;
        let mass_kg = draw.decades(2.0, 100.0);
        let clearance_m = draw.between(1.5e-4, 3e-4);
        let force_n = 9.81 * mass_kg * draw.decades(2.0, 12.0);
        let ends_m = [draw.between(0.1, 0.4), draw.between(0.1, 0.4)];
        // About r_g² = a·b, where the ends do not feel each other.
        let transverse = mass_kg * ends_m[0] * ends_m[1] * draw.between(0.3, 1.3);
        let (share, fastest) = match quick {
            true => (draw.between(0.7, 1.9), draw.decades(200.0, 1000.0)),
            false => (draw.decades(0.05, 1.8), draw.decades(50.0, 600.0)),
        };
        let sense = draw.one_of(&[1.0, -1.0]);
        let (rate_hz, lag_s) = match quick {
            true => (draw.one_of(&[2e4, 4e4]), draw.between(2e-5, 8e-5)),
            false => (draw.one_of(&[1e4, 2e4, 4e4]), draw.between(5e-5, 2e-4)),
        };
        let negative_n_m = force_n / clearance_m * draw.between(0.0, 0.3);
        let proportional_n_m = negative_n_m + force_n / clearance_m * draw.between(0.6, 2.0);
        let half_kg = 0.5 * mass_kg;
        let critical = 2.0 * (half_kg * (proportional_n_m - negative_n_m)).sqrt();
        let bending = matches!(class, Class::Flexible | Class::Bent).then(|| {
            let displacement = draw.between(0.0, 0.7);
            let other = displacement * draw.one_of(&[1.0, -1.0]);
            let damping_ratio = draw.decades(0.003, 0.03);
            let frequency_hz = draw.decades(300.0, 4000.0);
            (frequency_hz, damping_ratio, [displacement, other])
        });
        let rotor = Self {
            number,
            class,
            mass_kg,
            transverse_kg_m2: transverse,
            polar_kg_m2: share * transverse,
            spin_hz: sense * fastest,
            clearance_m,
            force_n,
            friction: draw.between(0.1, 0.3),
            restitution: draw.between(0.4, 0.8),
            ends_m,
            beyond_m: draw.between(0.0, 0.03),
            retainer_beyond_m: 0.0,
            seal_m: None,
            rate_hz,
            lag_s,
            noise_m: clearance_m * draw.decades(1e-3, 1e-2),
            negative_n_m,
            proportional_n_m,
            derivative_n_s_m: critical * draw.between(0.3, 0.6),
            bending,
        };
        match class {
            Class::Bent => Self {
                beyond_m: draw.between(-0.04, 0.04),
                retainer_beyond_m: draw.between(-0.04, 0.04),
                ..rotor
            },
            Class::Sealed => Self {
                seal_m: Some(clearance_m * draw.between(0.6, 0.95)),
                ..rotor
            },
            _ => rotor,
        }
    }

    /// What events are measured by.
    pub fn measures(&self) -> RotorMeasures {
        RotorMeasures {
            mass_kg: self.mass_kg,
            transverse_kg_m2: self.transverse_kg_m2,
            ends_m: self.ends_m,
            clearance_m: self.clearance_m,
            force_n: self.force_n,
            spin_hz: self.spin_hz,
            proportional_n_m: self.proportional_n_m,
        }
    }

    /// Polar inertia \[kg m²\].
    pub(crate) fn polar_kg_m2(&self) -> f64 {
        self.polar_kg_m2
    }

    /// With what each magnet pulls the rotor out of the middle \[N/m\].
    pub(crate) fn negative_n_m(&self) -> f64 {
        self.negative_n_m
    }

    /// Natural frequency of the bending mode \[Hz\].
    pub fn bending_hz(&self) -> Option<f64> {
        self.bending.map(|(hz, ..)| hz)
    }

    /// Frequency with which the free tilt turns \[Hz\], with the sense of the spin.
    pub fn nutation_hz(&self) -> f64 {
        self.polar_kg_m2 / self.transverse_kg_m2 * self.spin_hz
    }

    /// In a line.
    pub fn text(&self) -> String {
        let bends = self
            .bending
            .map_or_else(String::new, |(hz, ratio, [a, b])| {
                format!(", bends at {hz:.0} Hz ({ratio:.3}), {a:.2} and {b:.2} at the ends")
            });
        format!(
            "{} {}: {:.1} kg, {:.1} weights, nutation {:.0} Hz, {:.0} kHz, lag {:.0} µs{bends}",
            self.class.name(),
            self.number,
            self.mass_kg,
            self.force_n / self.mass_kg / 9.81,
            self.nutation_hz(),
            1e-3 * self.rate_hz,
            1e6 * self.lag_s,
        )
    }

    /// Its scene file, in which nothing happens.
    pub fn toml(&self) -> String {
        let Self {
            mass_kg,
            transverse_kg_m2,
            polar_kg_m2,
            spin_hz,
            clearance_m,
            force_n,
            friction,
            restitution,
            ends_m: [a, b],
            rate_hz,
            lag_s,
            noise_m,
            negative_n_m,
            proportional_n_m,
            derivative_n_s_m,
            ..
        } = self;
        let [sensor_a, sensor_b] = self.ends_m.map(|end| end + self.beyond_m);
        let [retainer_a, retainer_b] = self.ends_m.map(|end| end + self.retainer_beyond_m);
        let magnet = format!(
            "force_max_n = {force_n}, lag_s = {lag_s}, negative_stiffness_n_m = {negative_n_m}"
        );
        let seal = self.seal_m.map_or_else(String::new, |seal_m| {
            format!("[[plane]]\nname = \"seal\"\nseal = true\nposition_m = {}\ncontact_radius_m = 0.03\ncontact = {{ clearance_m = {seal_m}, stiffness_n_m = 2e8, restitution = {restitution} }}\n", 0.3 * (b - a))
        });
        let bending = self.bending.map_or_else(String::new, |(hz, ratio, [at_a, at_b])| {
            let (from, to) = (a + 0.05, b + 0.05);
            let (past_a, past_b, within) = (1.4 * at_a, 1.4 * at_b, -0.8 * at_a);
            format!("[[rotor.bending]]\nfrequency_hz = {hz}\ndamping_ratio = {ratio}\npositions_m = [-{from}, -{a}, 0.0, {b}, {to}]\ndisplacements = [{past_a}, {at_a}, {within}, {at_b}, {past_b}]\n\n[supervisor]\nbending_first_hz = 0\nacts_in_flight = 1\n")
        });
        format!(
            r#"
title = "A rotor drawn at random"
[run]
duration_s = 1.0
sample_rate_hz = {rate_hz}
planes_in_turn = {}
policies = ["levitation", "supervisor"]
rtol = 1e-7
seed = {}
[rotor]
mass_kg = {mass_kg}
transverse_inertia_kg_m2 = {transverse_kg_m2}
polar_inertia_kg_m2 = {polar_kg_m2}
{bending}
[spin]
frequency_hz = {spin_hz}
[contact]
clearance_m = {clearance_m}
stiffness_n_m = 2e8
restitution = {restitution}
[friction]
coefficient = {friction}
rolling_coefficient = 0.002
[magnet]
force_max_n = {force_n}
lag_s = {lag_s}
negative_stiffness_n_m = {negative_n_m}
[levitation]
proportional_n_m = {proportional_n_m}
derivative_n_s_m = {derivative_n_s_m}
derivative_filter_s = {}
[verdict]
whirl_speed_m_s = 0.6
[[plane]]
name = "A"
position_m = -{retainer_a}
contact_radius_m = 0.03
magnet = {{ position_m = -{a}, {magnet} }}
sensor = {{ position_m = -{sensor_a}, noise_rms_m = {noise_m} }}
[[plane]]
name = "B"
position_m = {retainer_b}
contact_radius_m = 0.03
magnet = {{ position_m = {b}, {magnet} }}
sensor = {{ position_m = {sensor_b}, noise_rms_m = {noise_m} }}
{seal}
"#,
            self.class == Class::InTurn,
            self.number,
            1.0 / rate_hz,
        )
    }
}
