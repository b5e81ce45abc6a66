//! Rotors in two magnetic bearings drawn at random, and what happens to them.

use crate::machines::draw::Draw;
use firmware_bench::scene::diagnostic::SceneError;
use firmware_bench::scene::machine::MachineScene;

/// What kind of rotor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// Rigid, I_p/I_t of 0.05 to 1.8, spins of 50 to 600 Hz.
    Rigid,
    /// Rigid, with nutation of 140 to 1900 Hz behind amplifiers that are quick enough for it.
    Gyroscopic,
    /// As `Rigid`, with a bending mode between 300 Hz and 4 kHz that nobody is told of.
    Flexible,
}

impl Class {
    /// All.
    pub const ALL: [Self; 3] = [Self::Rigid, Self::Gyroscopic, Self::Flexible];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::Gyroscopic => "gyroscopic",
            Self::Flexible => "flexible",
        }
    }
}

/// What happens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// A velocity of both ends alike, in percent of the lift-off speed of half the rotor.
    Centre(u32),
    /// Of both ends against each other.
    Conical(u32),
    /// Of one end.
    OneEnd(u32),
    /// A load in the middle for 20 ms, in percent of a magnet's cap.
    OverloadInTheMiddle(u32),
    /// The same at an end.
    OverloadAtOneEnd(u32),
    /// Both magnets off for so many ms, which the firmware knows.
    Outage(u32),
    /// Nothing.
    Idle,
}

impl Event {
    /// All that a rotor goes through.
    pub const ALL: [Self; 10] = [
        Self::Centre(70),
        Self::Centre(130),
        Self::Conical(70),
        Self::Conical(130),
        Self::OneEnd(70),
        Self::OneEnd(130),
        Self::OverloadInTheMiddle(260),
        Self::OverloadAtOneEnd(160),
        Self::Outage(30),
        Self::Idle,
    ];

    /// In words.
    pub fn name(self) -> String {
        match self {
            Self::Centre(percent) => format!("blow at the centre, {percent} %"),
            Self::Conical(percent) => format!("conical blow, {percent} %"),
            Self::OneEnd(percent) => format!("blow at one end, {percent} %"),
            Self::OverloadInTheMiddle(percent) => format!("load of {percent} % in the middle"),
            Self::OverloadAtOneEnd(percent) => format!("load of {percent} % at one end"),
            Self::Outage(ms) => format!("power gone for {ms} ms"),
            Self::Idle => "nothing".to_owned(),
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
        let mut draw = Draw::new(seed, 3 * number + class as u64);
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
        let bending = (class == Class::Flexible).then(|| {
            let displacement = draw.between(0.0, 0.7);
            let other = displacement * draw.one_of(&[1.0, -1.0]);
            let damping_ratio = draw.decades(0.003, 0.03);
            let frequency_hz = draw.decades(300.0, 4000.0);
            (frequency_hz, damping_ratio, [displacement, other])
        });
        Self {
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
            rate_hz,
            lag_s,
            noise_m: clearance_m * draw.decades(1e-3, 1e-2),
            negative_n_m,
            proportional_n_m,
            derivative_n_s_m: critical * draw.between(0.3, 0.6),
            bending,
        }
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

    /// The scene of what happens to it.
    ///
    /// # Errors
    /// None that a draw should cause.
    pub fn scene(&self, event: Event) -> Result<MachineScene, SceneError> {
        self.scene_for(event, 0.6)
    }

    /// The same of another duration \[s\].
    pub(super) fn scene_for(
        &self,
        event: Event,
        duration_s: f64,
    ) -> Result<MachineScene, SceneError> {
        let [a, b] = self.ends_m;
        let arm_m = 0.5 * (a + b);
        let lift_off_m_s = (2.0 * self.force_n / self.mass_kg * self.clearance_m).sqrt();
        let of = |percent: u32| 0.01 * f64::from(percent);
        let start = |centre: f64, tilt: f64| {
            format!(
                "velocity_m_s = [{centre}, {}]\ntilt_rate_rad_s = [{tilt}, 0.0]",
                0.1 * centre
            )
        };
        let load = |percent: u32, place_m: f64| {
            let force_n = of(percent) * self.force_n;
            format!(
                "[[disturbance]]\nstart_s = 0.02\nduration_s = 0.02\nforce_n = [{force_n}, 0.0]\nposition_m = {place_m}\n"
            )
        };
        let (start, happens) = match event {
            Event::Centre(percent) => (start(of(percent) * lift_off_m_s, 0.0), String::new()),
            Event::Conical(percent) => (
                start(0.0, of(percent) * lift_off_m_s / arm_m),
                String::new(),
            ),
            Event::OneEnd(percent) => {
                let half = 0.5 * of(percent) * lift_off_m_s;
                (start(half, half / arm_m), String::new())
            }
            Event::OverloadInTheMiddle(percent) => (String::new(), load(percent, 0.0)),
            Event::OverloadAtOneEnd(percent) => (String::new(), load(percent, b)),
            Event::Outage(ms) => {
                let duration_s = 1e-3 * f64::from(ms);
                let outage = format!(
                    "[[outage]]\nstart_s = 0.02\nduration_s = {duration_s}\nknown = true\n"
                );
                (String::new(), outage)
            }
            Event::Idle => (String::new(), String::new()),
        };
        let text = self.written(duration_s, &start, &happens);
        MachineScene::parse(&self.text(), &text)
    }

    fn written(&self, duration_s: f64, start: &str, happens: &str) -> String {
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
        let (sensor_a, sensor_b) = (a + self.beyond_m, b + self.beyond_m);
        let bending = self.bending.map_or_else(String::new, |(hz, ratio, [at_a, at_b])| {
            let (from, to) = (a + 0.05, b + 0.05);
            let (past_a, past_b, within) = (1.4 * at_a, 1.4 * at_b, -0.8 * at_a);
            format!("[[rotor.bending]]\nfrequency_hz = {hz}\ndamping_ratio = {ratio}\npositions_m = [-{from}, -{a}, 0.0, {b}, {to}]\ndisplacements = [{past_a}, {at_a}, {within}, {at_b}, {past_b}]\n\n[supervisor]\nbending_first_hz = 0\nacts_in_flight = 1\n")
        });
        format!(
            r#"
title = "A rotor drawn at random"
[run]
duration_s = {duration_s}
sample_rate_hz = {rate_hz}
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
[start]
{start}
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
position_m = -{a}
contact_radius_m = 0.03
sensor = {{ position_m = -{sensor_a}, noise_rms_m = {noise_m} }}
[[plane]]
name = "B"
position_m = {b}
contact_radius_m = 0.03
sensor = {{ position_m = {sensor_b}, noise_rms_m = {noise_m} }}
{happens}
"#,
            self.number,
            1.0 / rate_hz,
        )
    }
}
