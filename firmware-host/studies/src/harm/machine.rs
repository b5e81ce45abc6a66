//! A machine drawn at random, as a scene in which nothing happens.

use super::draw::Draw;
use firmware_bench::scene::Scene;
use firmware_bench::scene::diagnostic::SceneError;
use std::f64::consts::TAU;

/// A machine.
#[derive(Debug, Clone)]
pub struct Machine {
    /// Its number in the draw.
    pub number: u64,
    /// As a scene.
    pub scene: Scene,
    /// In words.
    pub text: String,
}

impl Machine {
    /// Machine of a number. Masses of 0.5 to 300 kg, clearances of 0.1 to 0.4 mm, forces of 2 to 50 times the weight,
    /// magnets that pull at the wall with up to 40 % of them, friction of 0.1 to 0.35, restitution of 0.4 to 0.9, amplifiers
    /// with 50 to 400 µs of lag, loops of 10 to 50 kHz, spins of 40 to 800 Hz either way, noise of 0.2 to 1.4 % of the
    /// clearance, and a levitation controller of ordinary to high stiffness, with or without an integrator.
    ///
    /// # Errors
    /// A machine that is no valid scene: a mistake of this draw.
    pub fn drawn(seed: u64, number: u64) -> Result<Self, SceneError> {
        let mut draw = Draw::new(seed, number);
        let mass_kg = draw.decades(0.5, 300.0);
        let clearance_m = draw.decades(1e-4, 4e-4);
        let force_n = mass_kg * draw.decades(20.0, 500.0);
        let per_clearance_n_m = force_n / clearance_m;
        let pulls = draw.share() < 0.67;
        let pull = if pulls { draw.between(0.05, 0.4) } else { 0.0 };
        let negative_n_m = pull * per_clearance_n_m;
        let friction = draw.between(0.1, 0.35);
        let restitution = draw.between(0.4, 0.9);
        let contact_n_m = mass_kg * (TAU * draw.decades(600.0, 2000.0)).powi(2);
        // A lag that is much of the time to cross the clearance makes any loop unstable.
        let unit_s = (clearance_m * mass_kg / force_n).sqrt();
        let lag_s = draw.decades(5e-5, 4e-4).min(0.2 * unit_s);
        let rate_hz = draw.one_of(&[1e4, 1e4, 2e4, 2e4, 2e4, 5e4]);
        let sense = draw.one_of(&[1.0, -1.0]);
        let spin_hz = sense * draw.decades(40.0, 800.0);
        let noise_m = clearance_m * draw.decades(0.002, 0.014);
        let radius_m = draw.decades(0.012, 0.15);
        let inertia_kg_m2 = 0.5 * mass_kg * radius_m * radius_m;
        let proportional_n_m = per_clearance_n_m * (pull + draw.decades(0.4, 1.8));
        let derivative_n_s_m = 1.4 * ((proportional_n_m - negative_n_m) * mass_kg).sqrt();
        let derivative_filter_s = lag_s * draw.between(0.5, 2.0);
        let integral_n_m_s = if draw.share() < 0.5 {
            8.0 * proportional_n_m
        } else {
            0.0
        };
        let vertical = draw.share() < 0.4;
        let gravity = if vertical { 0.0 } else { -9.81 };
        let text = format!(
            r#"
title = "machine {number} of {seed}"
[run]
duration_s = 0.5
sample_rate_hz = {rate_hz}
policies = ["levitation", "supervisor"]
[rotor]
mass_kg = {mass_kg}
contact_radius_m = {radius_m}
gravity_m_s2 = [0.0, {gravity}]
[spin]
frequency_hz = {spin_hz}
inertia_kg_m2 = {inertia_kg_m2}
[start]
position_m = [0.0, 0.0]
velocity_m_s = [0.0, 0.0]
[contact]
clearance_m = {clearance_m}
stiffness_n_m = {contact_n_m}
restitution = {restitution}
[friction]
coefficient = {friction}
[magnet]
force_max_n = {force_n}
lag_s = {lag_s}
negative_stiffness_n_m = {negative_n_m}
delay_samples = 1
[sensor]
noise_rms_m = {noise_m}
range_m = {range_m}
[levitation]
proportional_n_m = {proportional_n_m}
derivative_n_s_m = {derivative_n_s_m}
derivative_filter_s = {derivative_filter_s}
integral_n_m_s = {integral_n_m_s}
feed_forward_weight = true
"#,
            range_m = 4.0 * clearance_m,
        );
        let name = format!("machine {number} of {seed}");
        let scene = Scene::parse(&name, &text)?;
        let text = format!(
            "{name}: {mass_kg:.1} kg, {:.0} µm, {force_n:.0} N, pull {pull:.2}, t₀ {:.2} ms, {:.0} kHz, spin {spin_hz:.0} Hz, noise {:.1} %",
            1e6 * clearance_m,
            1e3 * unit_s,
            1e-3 * rate_hz,
            100.0 * noise_m / clearance_m,
        );
        Ok(Self {
            number,
            scene,
            text,
        })
    }

    /// Clearance \[m\].
    pub fn clearance_m(&self) -> f64 {
        self.scene.plant.contact.clearance_m
    }

    /// Cap \[N\].
    pub fn force_n(&self) -> f64 {
        self.scene.plant.magnet.map_or(0.0, |m| m.force_max_n)
    }

    /// √(F·c/m) \[m/s\].
    pub fn unit_m_s(&self) -> f64 {
        self.scene.nominal.force_speed_m_s()
    }

    /// √(m·c/F) \[s\].
    pub fn unit_s(&self) -> f64 {
        self.clearance_m() / self.unit_m_s()
    }
}
