//! Machines that nothing in the project was tuned on: drawn at random, with the configuration that their data
//! suggest and a levitation controller by a rule of thumb.

use firmware_bench::device::levitation::LevitationParams;
use firmware_bench::scene::Scene;
use firmware_studies::harm::draw::Draw;
use firmware_studies::overloads::case::Case;
use firmware_studies::overloads::catalogue::cases;
use firmware_studies::overloads::fault_matrix::{DRIVE_FAULTS, SENSOR_FAULTS};
use firmware_studies::overloads::found::{Found, kept};
use firmware_studies::overloads::plants::PlantCase;
use firmware_studies::overloads::results::run_case;
use firmware_studies::overloads::seats::Seat;
use std::f64::consts::TAU;

/// A machine, and what it is.
#[derive(Debug, Clone)]
pub struct Unseen {
    /// As the catalogue has its plants.
    pub plant: PlantCase,
    /// From a sample to the middle of its force, in units of √(m·c/F).
    pub lateness: f64,
    /// In words.
    pub text: String,
}

impl Unseen {
    /// Its levitation controller in the place of a tuned one; the rest of what was found is of another plant and needed
    /// by no policy that runs on it.
    ///
    /// # Panics
    /// If the catalogue has no P2.
    pub fn found(&self) -> Found {
        let mut found = kept("P2", 20_000.0).expect("the catalogue has it");
        found.tuned = self.plant.scene.levitation.expect("all have one");
        found
    }

    /// The same with a levitation controller that carries loads: at least 0.78 of the cap at the wall, and an integrator.
    ///
    /// # Panics
    /// If the catalogue has no P2.
    pub fn found_with_integrator(&self) -> Found {
        let plant = &self.plant.scene.plant;
        let force_max_n = plant.magnet.expect("all have one").force_max_n;
        let pull_n_m = -plant.rotor.stiffness_n_m;
        let carried_n_m = 0.3 * force_max_n / plant.contact.clearance_m;
        let mut found = self.found();
        found.tuned = LevitationParams {
            integral_n_m_s: 26.0 * pull_n_m.max(carried_n_m),
            ..levitation(plant.rotor.mass_kg, pull_n_m, pull_n_m.max(carried_n_m))
        };
        found
    }
}

/// Two and a half times the stiffness that it has to overcome, and a little more than critical damping.
fn levitation(mass_kg: f64, pull_n_m: f64, overcome_n_m: f64) -> LevitationParams {
    let proportional_n_m = 2.6 * overcome_n_m;
    LevitationParams {
        proportional_n_m,
        integral_n_m_s: 0.0,
        derivative_n_s_m: 2.2 * ((proportional_n_m - pull_n_m) * mass_kg).sqrt(),
        derivative_filter_s: 1e-4,
    }
}

/// The catalogue's scenes on a plant with this loop in which the supervisor takes part, and sensors and
/// drives are sound.
pub fn sound_cases(plant: &PlantCase, levitation: LevitationParams) -> Vec<Case> {
    let sound = |case: &Case| ![SENSOR_FAULTS, DRIVE_FAULTS].contains(&case.group);
    (cases(plant, levitation).into_iter())
        .filter(|case| sound(case) && case.seats.contains(&Seat::Supervisor))
        .collect()
}

/// What came of scenes with levitation alone, and with the supervisor.
#[derive(Debug, Default)]
pub struct Compared {
    /// Plants that they were run on.
    pub plants: usize,
    /// Scenes.
    pub runs: usize,
    /// Recovered with levitation alone.
    pub alone: usize,
    /// Recovered with the supervisor.
    pub own: usize,
    /// Scenes that only levitation alone recovered from, by the plant's and their own name.
    pub lost: Vec<String>,
}

impl Compared {
    /// The [`sound_cases`] on a plant, with one seed. `text` says which plant.
    pub fn on(plant: &PlantCase, found: &Found, text: &str) -> Self {
        let at = (plant.name.as_str(), plant.rate_hz);
        let mut compared = Self {
            plants: 1,
            ..Self::default()
        };
        for case in sound_cases(plant, found.tuned) {
            let [alone, own] = [Seat::Tuned, Seat::Supervisor]
                .map(|seat| run_case(&case, at, (seat, 1), found).recovered());
            compared.runs += 1;
            compared.alone += usize::from(alone);
            compared.own += usize::from(own);
            if alone && !own {
                compared.lost.push(format!("{text}: {}", case.name));
            }
        }
        compared
    }

    /// With what came of others.
    #[must_use]
    pub fn with(mut self, other: Self) -> Self {
        self.plants += other.plants;
        self.runs += other.runs;
        self.alone += other.alone;
        self.own += other.own;
        self.lost.extend(other.lost);
        self
    }
}

/// Machine of a number. Masses of 0.3 to 100 kg, clearances of 0.1 to 0.5 mm, forces of 3 to 60 times the weight,
/// magnets that pull at the wall with 2 to 50 % of them, friction of 0.06 to 0.35, restitution of 0.3 to 0.8,
/// amplifiers of 300 Hz to 3 kHz, spins of 20 Hz to 1 kHz either way.
///
/// # Panics
/// If a scene of them is not valid.
pub fn machine(number: u64) -> Unseen {
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
    let inertia_kg_m2 = 0.75 * mass_kg * radius_m * radius_m;
    let LevitationParams {
        proportional_n_m,
        derivative_n_s_m,
        derivative_filter_s,
        ..
    } = levitation(mass_kg, negative_n_m, negative_n_m);
    let text = format!(
        r#"
title = "machine {number}"
story = "drawn at random"
[run]
duration_s = 0.5
sample_rate_hz = {rate_hz}
policies = ["levitation", "supervisor"]
[rotor]
mass_kg = {mass_kg}
contact_radius_m = {radius_m}
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
[levitation]
proportional_n_m = {proportional_n_m}
derivative_n_s_m = {derivative_n_s_m}
derivative_filter_s = {derivative_filter_s}
"#
    );
    let name = format!("machine {number}");
    let scene = Scene::parse(&name, &text).expect("all that is drawn is valid");
    let unit_s = (mass_kg * clearance_m / force_n).sqrt();
    let lateness = (lag_s + 1.5 / rate_hz) / unit_s;
    let text = format!(
        "{name}: {mass_kg:.1} kg, {:.0} µm, {:.0} N, pull {pull:.2}, lateness {lateness:.2}, spin {spin_hz:.0} Hz",
        1e6 * clearance_m,
        force_n,
    );
    Unseen {
        plant: PlantCase {
            name,
            rate_hz,
            scene,
        },
        lateness,
        text,
    }
}
