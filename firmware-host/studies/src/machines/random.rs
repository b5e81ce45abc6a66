//! Machines drawn at random, as scenes in which nothing happens.

use super::draw::Draw;
use super::plants::PlantCase;
use super::tuned_gains::{TunedGains, stored};
use firmware_bench::device::levitation::LevitationParams;
use firmware_bench::scene::Scene;
use firmware_bench::scene::diagnostic::SceneError;
use std::f64::consts::TAU;

/// A machine.
#[derive(Debug, Clone)]
pub struct RandomMachine {
    /// Its number in the draw.
    pub number: u64,
    pub scene: Scene,
    /// As a scene file.
    pub toml: String,
    /// In words.
    pub text: String,
}

/// What is drawn of a machine.
struct Sampled {
    mass_kg: f64,
    clearance_m: f64,
    force_n: f64,
    /// Pull of the magnet at the wall, as a share of the cap.
    pull: f64,
    /// The same as a stiffness.
    negative_n_m: f64,
    friction: f64,
    restitution: f64,
    contact_n_m: f64,
    lag_s: f64,
    rate_hz: f64,
    spin_hz: f64,
    noise_m: f64,
    /// Largest reading of the sensors; `None`: without end.
    range_m: Option<f64>,
    radius_m: f64,
    inertia_kg_m2: f64,
    gravity_m_s2: f64,
    levitation: LevitationParams,
}

impl Sampled {
    fn machine(&self, number: u64, name: &str) -> Result<RandomMachine, SceneError> {
        let Self {
            mass_kg,
            clearance_m,
            force_n,
            pull,
            negative_n_m,
            friction,
            restitution,
            contact_n_m,
            lag_s,
            rate_hz,
            spin_hz,
            noise_m,
            radius_m,
            inertia_kg_m2,
            gravity_m_s2,
            levitation,
            range_m,
        } = self;
        let range = range_m.map_or_else(String::new, |m| format!("range_m = {m}"));
        let LevitationParams {
            proportional_n_m,
            integral_n_m_s,
            derivative_n_s_m,
            derivative_filter_s,
        } = levitation;
        let toml = format!(
            r#"
title = "{name}"
[run]
duration_s = 0.5
sample_rate_hz = {rate_hz}
policies = ["levitation", "supervisor"]
[rotor]
mass_kg = {mass_kg}
contact_radius_m = {radius_m}
gravity_m_s2 = [0.0, {gravity_m_s2}]
[spin]
frequency_hz = {spin_hz}
inertia_kg_m2 = {inertia_kg_m2}
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
[sensor]
noise_rms_m = {noise_m}
{range}
[levitation]
proportional_n_m = {proportional_n_m}
derivative_n_s_m = {derivative_n_s_m}
derivative_filter_s = {derivative_filter_s}
integral_n_m_s = {integral_n_m_s}
feed_forward_weight = true
"#
        );
        let scene = Scene::parse(name, &toml)?;
        let unit_s = (clearance_m * mass_kg / force_n).sqrt();
        let text = format!(
            "{name}: {mass_kg:.1} kg, {:.0} µm, {force_n:.0} N, pull {pull:.2}, t₀ {:.2} ms, {:.0} kHz, spin {spin_hz:.0} Hz, noise {:.1} %",
            1e6 * clearance_m,
            1e3 * unit_s,
            1e-3 * rate_hz,
            100.0 * noise_m / clearance_m,
        );
        Ok(RandomMachine {
            number,
            scene,
            toml,
            text,
        })
    }
}

impl RandomMachine {
    /// Machine of a number. Masses of 0.5 to 300 kg, clearances of 0.1 to 0.4 mm, forces of 2 to 50 times the weight,
    /// magnets that pull at the wall with up to 40 % of them, friction of 0.1 to 0.35, restitution of 0.4 to 0.9, amplifiers
    /// with 50 to 400 µs of lag, loops of 10 to 50 kHz, spins of 40 to 800 Hz either way, noise of 0.2 to 1.4 % of the
    /// clearance, and a levitation controller of ordinary to high stiffness, with or without an integrator.
    ///
    /// # Errors
    /// A machine that is no valid scene: a mistake of this draw.
    pub fn sampled(seed: u64, number: u64) -> Result<Self, SceneError> {
        Self::mounted(seed, number, None)
    }

    /// The same on a mount that gives way: contact stiffness of 5 to 30 caps over the clearance.
    ///
    /// # Errors
    /// As [`Self::sampled`].
    pub(crate) fn resilient(seed: u64, number: u64) -> Result<Self, SceneError> {
        let caps = Draw::new(!seed, number).decades(5.0, 30.0);
        Self::mounted(seed, number, Some(caps))
    }

    /// Machine of a number; its contact stiffness in caps over the clearance, where the mount has it.
    fn mounted(seed: u64, number: u64, mount: Option<f64>) -> Result<Self, SceneError> {
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
        let stiff_n_m = mass_kg * (TAU * draw.decades(600.0, 2000.0)).powi(2);
        let contact_n_m = mount.map_or(stiff_n_m, |caps| caps * per_clearance_n_m);
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
        Sampled {
            mass_kg,
            clearance_m,
            force_n,
            pull,
            negative_n_m,
            friction,
            restitution,
            contact_n_m,
            lag_s,
            rate_hz,
            spin_hz,
            noise_m,
            range_m: Some(4.0 * clearance_m),
            radius_m,
            inertia_kg_m2,
            gravity_m_s2: gravity,
            levitation: LevitationParams {
                proportional_n_m,
                integral_n_m_s,
                derivative_n_s_m,
                derivative_filter_s,
            },
        }
        .machine(number, &format!("machine {number} of {seed}"))
    }

    /// Machine of a number of a wider draw. Masses of 0.3 to 100 kg, clearances of 0.1 to 0.5 mm, forces of 3 to 60 times the
    /// weight, magnets that pull at the wall with 2 to 50 % of them, friction of 0.06 to 0.35, restitution of 0.3 to 0.8,
    /// amplifiers of 300 Hz to 3 kHz, spins of 20 Hz to 1 kHz either way, no weight.
    ///
    /// # Errors
    /// A machine that is no valid scene: a mistake of this draw.
    pub fn unseen(number: u64) -> Result<Self, SceneError> {
        let mut draw = Draw::new(number, 0);
        let mass_kg = draw.decades(0.3, 100.0);
        let clearance_m = draw.decades(1e-4, 5e-4);
        let force_n = mass_kg * draw.decades(30.0, 600.0);
        let pull = draw.decades(0.02, 0.5);
        let negative_n_m = pull * force_n / clearance_m;
        let friction = draw.between(0.06, 0.35);
        let restitution = draw.between(0.3, 0.8);
        let contact_n_m = mass_kg * (TAU * draw.decades(600.0, 3000.0)).powi(2);
        let lag_s = 1.0 / (TAU * draw.decades(300.0, 3000.0));
        let rate_hz = draw.one_of(&[1e4, 2e4]);
        let sense = draw.one_of(&[1.0, -1.0]);
        let spin_hz = sense * draw.decades(20.0, 1000.0);
        let noise_m = draw.decades(2e-7, 2e-6);
        let radius_m = draw.decades(0.02, 0.1);
        Sampled {
            mass_kg,
            clearance_m,
            force_n,
            pull,
            negative_n_m,
            friction,
            restitution,
            contact_n_m,
            lag_s,
            rate_hz,
            spin_hz,
            noise_m,
            range_m: None,
            radius_m,
            inertia_kg_m2: 0.75 * mass_kg * radius_m * radius_m,
            gravity_m_s2: 0.0,
            levitation: rule_of_thumb(mass_kg, negative_n_m, negative_n_m),
        }
        .machine(number, &format!("machine {number}"))
    }

    /// As the catalogue has its plants.
    pub fn plant(&self) -> PlantCase {
        PlantCase {
            name: self.scene.title.clone(),
            rate_hz: self.scene.sample_rate_hz,
            scene: self.scene.clone(),
        }
    }

    /// Its levitation controller in the place of a tuned one; the rest of the gains is of another plant and needed by no
    /// policy that runs on it. `None` without a controller.
    pub fn gains(&self) -> Option<TunedGains> {
        Some(TunedGains {
            tuned: self.scene.planes[0].levitation?,
            ..stored("P2", 20_000.0)?
        })
    }

    /// The same with a levitation controller that carries loads: at least 0.78 of the cap at the wall, and an integrator.
    pub fn gains_with_integrator(&self) -> Option<TunedGains> {
        let rotor = self.scene.plant(0).rotor;
        let pull_n_m = -rotor.stiffness_n_m;
        let carried_n_m = 0.3 * self.force_n() / self.clearance_m();
        let overcome_n_m = pull_n_m.max(carried_n_m);
        Some(TunedGains {
            tuned: LevitationParams {
                integral_n_m_s: 26.0 * overcome_n_m,
                ..rule_of_thumb(rotor.mass_kg, pull_n_m, overcome_n_m)
            },
            ..self.gains()?
        })
    }

    /// From a sample to the middle of its force, in units of √(m·c/F).
    pub fn lateness(&self) -> f64 {
        let lag_s = self.scene.plant(0).magnet.map_or(0.0, |m| m.lag_s);
        (lag_s + 1.5 / self.scene.sample_rate_hz) / self.unit_s()
    }

    /// Clearance \[m\].
    pub fn clearance_m(&self) -> f64 {
        self.scene.clearance_m(0)
    }

    /// Cap \[N\].
    pub fn force_n(&self) -> f64 {
        self.scene.force_max_n(0)
    }

    /// √(F·c/m) \[m/s\].
    pub fn unit_m_s(&self) -> f64 {
        self.scene.planes[0].nominal.force_speed_m_s()
    }

    /// √(m·c/F) \[s\].
    pub fn unit_s(&self) -> f64 {
        self.clearance_m() / self.unit_m_s()
    }
}

/// A levitation controller with two and a half times the stiffness that it has to overcome, and a little more than critical
/// damping.
pub fn rule_of_thumb(mass_kg: f64, pull_n_m: f64, overcome_n_m: f64) -> LevitationParams {
    let proportional_n_m = 2.6 * overcome_n_m;
    LevitationParams {
        proportional_n_m,
        integral_n_m_s: 0.0,
        derivative_n_s_m: 2.2 * ((proportional_n_m - pull_n_m) * mass_kg).sqrt(),
        derivative_filter_s: 1e-4,
    }
}
