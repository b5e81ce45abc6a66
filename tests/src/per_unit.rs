//! The supervisor's core with any of its numbers: behind the SI border, so that it can stand in a closed loop, and
//! on streams that were recorded from one.

use crate::recording::recording;
use firmware_bench::run::closed_loop::{Keep, run_policy};
use firmware_bench::run::controller::{Supervise, supervised};
use firmware_studies::machines::plants::{PlantCase, plants};
use firmware_studies::machines::tuned_gains::stored;
use firmware_studies::overloads::case::Case;
use firmware_studies::overloads::catalogue::cases;
use supervisor::{
    Command, Config, Core, CoreCommand, CoreError, CoreSample, Prepared, Sample, Scalar, Scaling,
};
use test_support::in_numbers;

/// A core of any number that takes SI and answers SI, as firmware without floating point would around it.
#[derive(Debug)]
pub struct Behind<S: Scalar> {
    scaling: Scaling,
    core: Core<S, 64>,
}

impl<S: Scalar> Behind<S> {
    /// For a configuration.
    ///
    /// # Errors
    /// As [`Prepared::new`].
    pub fn new(config: &Config) -> Result<Self, CoreError> {
        Ok(Self {
            scaling: config.scaling(),
            core: Core::new(&Prepared::new(config)?),
        })
    }
}

impl<S: Scalar> Supervise for Behind<S> {
    fn tick(&mut self, sample: &Sample) -> Command {
        let command = (self.core).tick(&in_numbers(&self.scaling.sample(sample)));
        self.scaling.command(&command)
    }
}

/// Inputs of a supervisor in a closed loop.
#[derive(Debug, Clone)]
pub struct Stream {
    /// Plant, control rate and case.
    pub name: String,
    /// Kind of overload.
    pub group: &'static str,
    /// Configuration.
    pub config: Config,
    /// Samples per unit.
    pub samples: Vec<CoreSample<f32>>,
}

impl Stream {
    /// Commands of a new core of this number to the samples.
    ///
    /// # Errors
    /// As [`Prepared::new`].
    pub fn commands<S: Scalar>(&self) -> Result<Vec<CoreCommand<S>>, CoreError> {
        let mut core = Core::<S, 64>::new(&Prepared::new(&self.config)?);
        let commands = self.samples.iter().map(|s| core.tick(&in_numbers(s)));
        Ok(commands.collect())
    }
}

/// Records the cases of the catalogue that are wanted, with the `f32` supervisor in the loop, for `longest_s`
/// at most.
///
/// # Panics
/// If the catalogue is not valid.
pub fn record(
    rate_hz: f64,
    longest_s: f64,
    wanted: impl Fn(&PlantCase, &Case) -> bool,
) -> Vec<Stream> {
    let mut streams = Vec::new();
    for plant in plants(rate_hz).unwrap_or_else(|e| panic!("{e}")) {
        let tuned = stored(&plant.name, rate_hz).expect("kept for all").tuned;
        for mut case in cases(&plant, tuned) {
            if !wanted(&plant, &case) {
                continue;
            }
            case.scene.planes[0].levitation = Some(tuned);
            case.scene.duration_s = case.scene.duration_s.min(longest_s);
            let config = case.scene.planes[0].supervisor.expect("plants have one");
            let (supervisor, log) = recording(&config).expect("valid");
            let policy = supervised(&case.scene, supervisor).expect("complete");
            // For the stream a run is good up to where it cannot be trusted any further.
            let _ended = run_policy(
                &case.scene,
                (policy, "recording"),
                Keep::Verdict,
                &mut |_| {},
            );
            let scaling = config.scaling();
            let log = log.take();
            streams.push(Stream {
                name: format!("{}, {:.0} kHz, {}", plant.name, 1e-3 * rate_hz, case.name),
                group: case.group,
                config,
                samples: log.iter().map(|(s, _)| scaling.sample(s)).collect(),
            });
        }
    }
    streams
}
