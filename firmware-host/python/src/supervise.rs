//! The supervisor itself, tick by tick.

use crate::config::Config;
use crate::errors::ConfigError;
use crate::values::{pair, pair_array};
use firmware_bench::run::controller::written;
use pyo3::prelude::{Bound, PyAny, PyResult, Python, pyclass, pymethods};
use pyo3::types::{PyBytes, PyDict, PyDictMethods};
use supervisor::{IntegratorHint, Sample, Stamp, Status, Supervisor as Product};

/// What to do until the next tick.
#[pyclass(frozen, module = "ambwhirl")]
pub(crate) struct Command {
    of: supervisor::Command,
}

fn names(of: impl Iterator<Item = &'static str>) -> Vec<&'static str> {
    of.collect()
}

fn wide(v: [f32; 2]) -> [f64; 2] {
    v.map(f64::from)
}

#[pymethods]
impl Command {
    #[getter]
    fn force_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        pair_array(py, wide(self.of.force_n)).into_any()
    }

    #[getter]
    fn own_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        pair_array(py, wide(self.of.own_n)).into_any()
    }

    #[getter]
    fn mode(&self) -> &'static str {
        self.of.mode.name()
    }

    #[getter]
    fn limits(&self) -> Vec<&'static str> {
        names(self.of.limits.iter_names().map(|(name, _)| name))
    }

    #[getter]
    fn events(&self) -> Vec<&'static str> {
        names(self.of.events.iter_names().map(|(name, _)| name))
    }

    #[getter]
    fn hold(&self) -> bool {
        self.of.integrator == IntegratorHint::Hold
    }

    #[getter]
    fn severity(&self) -> f64 {
        f64::from(self.of.severity)
    }

    fn __repr__(&self) -> String {
        let [x, y] = self.of.force_n;
        format!("<ambwhirl.Command {x} N, {y} N: {}>", self.of.mode.name())
    }
}

/// The supervisor of one bearing plane, as firmware links it, with a flight record of 512 ticks.
#[pyclass(module = "ambwhirl")]
pub(crate) struct Supervisor {
    of: Product<512>,
    /// Number of the next sample that is given none.
    next: u32,
}

#[pymethods]
impl Supervisor {
    #[new]
    fn new(config: &Config) -> PyResult<Self> {
        let of = Product::new(&config.parameters);
        Ok(Self {
            of: of.map_err(|error| ConfigError::new_err(error.to_string()))?,
            next: 0,
        })
    }

    /// One tick. Any number is allowed, as from a sensor: what cannot be is for the supervisor to judge.
    #[pyo3(signature = (position_m, levitation_n=None, *, spin_rad_s=None, applied_n=None, sequence=None, bearing_on=true, axis_x_lost=false, axis_y_lost=false, late=false, shadow=false, set_down=false, levitated_before=false))]
    #[allow(
        clippy::too_many_arguments,
        reason = "keyword arguments of Python, each named where it is called"
    )]
    fn tick(
        &mut self,
        position_m: &Bound<'_, PyAny>,
        levitation_n: Option<&Bound<'_, PyAny>>,
        spin_rad_s: Option<f64>,
        applied_n: Option<&Bound<'_, PyAny>>,
        sequence: Option<u32>,
        bearing_on: bool,
        axis_x_lost: bool,
        axis_y_lost: bool,
        late: bool,
        shadow: bool,
        set_down: bool,
        levitated_before: bool,
    ) -> PyResult<Command> {
        let single = |name: &str, given: Option<&Bound<'_, PyAny>>| {
            let given = given.map(|given| pair(name, given)).transpose()?;
            PyResult::Ok(given.unwrap_or_default().map(|x| x as f32))
        };
        let mut status = Status::empty();
        status.set(Status::SPIN_VALID, spin_rad_s.is_some());
        status.set(Status::APPLIED_VALID, applied_n.is_some());
        status.set(Status::BEARING_ON, bearing_on);
        status.set(Status::AXIS_X_LOST, axis_x_lost);
        status.set(Status::AXIS_Y_LOST, axis_y_lost);
        status.set(Status::LATE, late);
        status.set(Status::SHADOW, shadow);
        status.set(Status::SET_DOWN, set_down);
        status.set(Status::LEVITATED_BEFORE, levitated_before);
        let sample = Sample {
            sequence: sequence.unwrap_or(self.next),
            status,
            position_m: single("position_m", Some(position_m))?,
            spin_rad_s: spin_rad_s.unwrap_or_default() as f32,
            levitation_n: single("levitation_n", levitation_n)?,
            applied_n: single("applied_n", applied_n)?,
        };
        self.next = sample.sequence.wrapping_add(1);
        Ok(Command {
            of: self.of.tick(&sample),
        })
    }

    #[getter]
    fn mode(&self) -> &'static str {
        self.of.mode().name()
    }

    /// Events that nobody has taken yet: (sequence, mode, names).
    fn take_events(&mut self) -> Vec<(u32, &'static str, Vec<&'static str>)> {
        let mut all = Vec::new();
        while let Some(event) = self.of.next_event() {
            let names = names(event.events.iter_names().map(|(name, _)| name));
            all.push((event.sequence, event.mode.name(), names));
        }
        all
    }

    /// Another configuration, from the next tick on.
    fn reconfigure(&mut self, config: &Config) -> PyResult<()> {
        let done = self.of.reconfigure(&config.parameters);
        done.map_err(|error| ConfigError::new_err(error.to_string()))
    }

    /// The flight record as firmware would write it, where one is frozen.
    fn record<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyBytes>> {
        let record = self.of.record()?;
        Some(PyBytes::new(py, &written(&record, &Stamp::default())))
    }

    /// Discards a frozen record.
    fn rearm(&mut self) {
        self.of.rearm();
    }

    /// What to add to the force of the next tick, so that the machine confirms its configuration.
    #[getter]
    fn stimulus_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        pair_array(py, wide(self.of.stimulus_n())).into_any()
    }

    /// What has happened since it was made.
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let of = self.of.report();
        let dict = PyDict::new(py);
        let counts = [
            ("landings", of.landings),
            ("nuisance_engagements", of.nuisance_engagements),
            ("handed_back", of.handed_back),
            ("impacts", of.impacts),
            ("contact_ticks", of.contact_ticks),
            ("missed_ticks", of.missed_ticks),
            ("repeated_ticks", of.repeated_ticks),
            ("late_ticks", of.late_ticks),
        ];
        for (name, count) in counts {
            dict.set_item(name, count)?;
        }
        let numbers = [
            ("impact_speed_max_m_s", of.impact_speed_max_m_s),
            ("backward_speed_max_m_s", of.backward_speed_max_m_s),
            ("whirl_limit_m_s", of.whirl_limit_m_s),
            ("severity_index", of.severity_index),
            ("thermal_state", of.thermal_state),
            ("force_cap_n", of.force_cap_n),
        ];
        for (name, number) in numbers {
            dict.set_item(name, f64::from(number))?;
        }
        dict.set_item("coast_down", of.coast_down)?;
        dict.set_item("refusal", format!("{:?}", of.refusal))?;
        dict.set_item("fault", format!("{:?}", of.fault))?;
        dict.set_item("finding", of.checked.finding.name())?;
        dict.set_item("finding_value", f64::from(of.checked.value))?;
        Ok(dict)
    }
}
