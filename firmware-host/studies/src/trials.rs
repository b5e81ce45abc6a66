//! The catalogue's scenes with sound sensors and drives on a machine, with levitation alone and with the supervisor.

use crate::machines::plants::PlantCase;
use crate::machines::tuned_gains::TunedGains;
use crate::overloads::case::Case;
use crate::overloads::catalogue::cases;
use crate::overloads::contenders::Contender;
use crate::overloads::fault_matrix::{DRIVE_FAULTS, SENSOR_FAULTS};
use crate::overloads::results::{ResultRow, run_case};
use firmware_bench::scene::Scene;

/// A scene on a machine with its levitation controller.
#[derive(Debug, Clone)]
pub struct Trial {
    /// The machine.
    pub plant: PlantCase,
    /// Its controllers.
    pub gains: TunedGains,
    /// The scene.
    pub case: Case,
}

impl Trial {
    /// All on a machine in which the supervisor takes part.
    pub fn on(plant: &PlantCase, gains: &TunedGains) -> Vec<Self> {
        let sound = |case: &Case| ![SENSOR_FAULTS, DRIVE_FAULTS].contains(&case.group);
        (cases(plant, gains.tuned).into_iter())
            .filter(|case| sound(case) && case.contenders.contains(&Contender::Supervisor))
            .map(|case| Self {
                plant: plant.clone(),
                gains: *gains,
                case,
            })
            .collect()
    }

    /// Runs it with one seed.
    pub fn run(&self, contender: Contender) -> ResultRow {
        let at = (self.plant.name.as_str(), self.plant.rate_hz);
        run_case(&self.case, at, (contender, 1), &self.gains)
    }

    /// The same machine and name, another scene.
    #[must_use]
    pub fn with(&self, scene: Scene) -> Self {
        let mut trial = self.clone();
        trial.case.scene = scene;
        trial
    }
}

/// Outcome of scenes with levitation alone, and with the supervisor.
#[derive(Debug, Clone, Default)]
pub struct Compared {
    /// Machines that they were run on.
    pub machines: usize,
    /// Scenes.
    pub runs: usize,
    /// Recovered with levitation alone.
    pub alone: usize,
    /// Recovered with the supervisor.
    pub own: usize,
    /// Scenes that only levitation alone recovered from, by the machine's and their own name.
    pub lost: Vec<String>,
}

impl Compared {
    /// Every scene on a machine. `text` says which machine.
    pub fn on(plant: &PlantCase, gains: &TunedGains, text: &str) -> Self {
        let mut compared = Self {
            machines: 1,
            ..Self::default()
        };
        for trial in Trial::on(plant, gains) {
            let [alone, own] = [Contender::Tuned, Contender::Supervisor]
                .map(|contender| trial.run(contender).recovered());
            compared.runs += 1;
            compared.alone += usize::from(alone);
            compared.own += usize::from(own);
            if alone && !own {
                compared.lost.push(format!("{text}: {}", trial.case.name));
            }
        }
        compared
    }

    /// With the outcome of others.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.machines += other.machines;
        self.runs += other.runs;
        self.alone += other.alone;
        self.own += other.own;
        self.lost.extend(other.lost);
        self
    }
}
