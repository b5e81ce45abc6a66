//! A unit at work: what may be called when, and what comes of it, whatever the version of the interface.

use crate::model::{Model, Set};
use crate::unit::Unit;
use crate::variable::{Role, Value, Variable};

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// Nothing is wrong.
    Ok,
    /// To be known.
    Warning,
    /// This call has no result, and the instance goes on.
    Discard,
    /// The instance has ended.
    Error,
    /// So has the library.
    Fatal,
}

/// Why a call has no result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// How bad it is.
    pub level: Level,
    /// For the log.
    pub text: String,
}

impl Fault {
    /// An error of this text.
    pub fn error(text: impl Into<String>) -> Self {
        Self {
            level: Level::Error,
            text: text.into(),
        }
    }
}

/// Where an instance stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Instantiated,
    Initializing,
    Stepping,
    Terminated,
    Failed,
}

/// How far a step came.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stepped {
    /// Time that was reached \[s\].
    pub to_s: f64,
    /// Whether it stopped before its end, as something began.
    pub early: bool,
}

/// A unit at work.
pub struct Instance {
    unit: Unit,
    variables: Vec<Variable>,
    /// Of each variable.
    values: Vec<Value>,
    state: State,
    /// What failed.
    failed: String,
    model: Option<Box<dyn Model>>,
    /// Whether steps may end early.
    early: bool,
    /// When the importer's time began \[s\]; that of the scene counts from there.
    start_s: f64,
    /// Samples since.
    tick: u64,
    /// Outputs of the model, before they are put among the values.
    outputs: Vec<Value>,
}

/// So far may the importer's time lie from that of the sample, in parts of a control period.
const TIME_TOLERANCE: f64 = 0.01;

impl Instance {
    /// A unit that waits for its parameters. `early`: steps of several samples may end where something begins.
    pub fn new(unit: Unit, early: bool) -> Self {
        let variables = unit.variables();
        Self {
            values: variables.iter().map(|v| v.start).collect(),
            outputs: Vec::with_capacity(variables.len()),
            variables,
            unit,
            state: State::Instantiated,
            failed: String::new(),
            model: None,
            early,
            start_s: 0.0,
            tick: 0,
        }
    }

    /// The variable of a reference.
    ///
    /// # Errors
    /// [`Fault`] where there is none.
    pub fn variable(&self, reference: u32) -> Result<&Variable, Fault> {
        let variable = self.variables.get(reference as usize);
        variable.ok_or_else(|| Fault::error(format!("there is no variable {reference}")))
    }

    /// The value of a variable.
    ///
    /// # Errors
    /// [`Fault`] where there is none, or the model cannot be started.
    pub fn get(&mut self, reference: u32) -> Result<Value, Fault> {
        if self.variable(reference)?.role == Role::Output && self.state == State::Initializing {
            self.start()?;
        }
        let value = self.values.get(reference as usize);
        value.copied().ok_or_else(|| Fault::error("no value"))
    }

    /// Sets a variable.
    ///
    /// # Errors
    /// [`Fault`] where that is not allowed now, or at all, or not to this value.
    pub fn set(&mut self, reference: u32, value: Value) -> Result<(), Fault> {
        self.not_failed()?;
        self.variable(reference)?;
        let place = reference as usize;
        let variable = &self.variables[place];
        let name = &variable.name;
        if !value.is_of(variable.kind) {
            let text = format!("{name}: {value:?} is none of its values");
            return Err(Fault::error(text));
        }
        let before = matches!(self.state, State::Instantiated | State::Initializing);
        match variable.role {
            Role::Input => {}
            Role::Fixed | Role::Tunable if before => self.model = None,
            Role::Tunable if self.state == State::Stepping => {
                if let Some(model) = &mut self.model {
                    model.tune(name, value.number()).map_err(Fault::error)?;
                }
            }
            Role::Fixed | Role::Tunable => {
                let text = format!("{name}: is set before the first step, and not then");
                return Err(Fault::error(text));
            }
            Role::Time | Role::Output => {
                return Err(Fault::error(format!("{name}: is for reading")));
            }
        }
        self.values[place] = value;
        Ok(())
    }

    /// When the importer's time begins; 0 unless it is said.
    ///
    /// # Errors
    /// [`Fault`] out of order, or where the time is no number.
    pub fn begin_at(&mut self, start_s: f64) -> Result<(), Fault> {
        self.expect(State::Instantiated, "the time begins before initialization")?;
        if !start_s.is_finite() {
            return Err(Fault::error(format!("a start time of {start_s} s")));
        }
        self.start_s = start_s;
        self.values[0] = Value::Float64(start_s);
        Ok(())
    }

    /// Initialization begins.
    ///
    /// # Errors
    /// [`Fault`] out of order.
    pub fn enter_initialization(&mut self) -> Result<(), Fault> {
        self.expect(State::Instantiated, "initialization begins once")?;
        (self.tick, self.state) = (0, State::Initializing);
        Ok(())
    }

    /// Initialization ends: the model stands at its first sample.
    ///
    /// # Errors
    /// [`Fault`] with what is wrong with the parameters.
    pub fn exit_initialization(&mut self) -> Result<(), Fault> {
        self.expect(State::Initializing, "initialization has to begin before")?;
        self.start()?;
        self.state = State::Stepping;
        Ok(())
    }

    /// A step from a time on.
    ///
    /// # Errors
    /// [`Fault`] where the step is not one of whole control periods from where the unit stands, and why the model cannot be
    /// trusted any further.
    pub fn step(&mut self, from_s: f64, step_s: f64) -> Result<Stepped, Fault> {
        self.expect(State::Stepping, "steps come after initialization")?;
        let period_s = self.unit.period_s();
        let here_s = self.at_s(self.tick);
        // Written so that NaN is refused.
        let is_here = (from_s - here_s).abs() <= TIME_TOLERANCE * period_s;
        if !is_here {
            let text = format!("a step from {from_s} s, and the unit stands at {here_s} s");
            return Err(Fault::error(text));
        }
        let samples = (step_s / period_s).round();
        let whole = (step_s - samples * period_s).abs() <= TIME_TOLERANCE * period_s;
        let most = match self.unit.takes_several_samples() {
            true => 1e9,
            false => 1.0,
        };
        if !(whole && (1.0..=most).contains(&samples)) {
            let number = match self.unit.takes_several_samples() {
                true => "a whole number of control periods",
                false => "one control period",
            };
            return Err(Fault::error(format!(
                "a step of {step_s} s, and it has to be {number} of {period_s} s"
            )));
        }
        let samples = samples as u64;
        for done in 1..=samples {
            let began = self.next_sample()?;
            if began && self.early && done < samples {
                return Ok(Stepped {
                    to_s: self.at_s(self.tick),
                    early: true,
                });
            }
        }
        Ok(Stepped {
            to_s: self.at_s(self.tick),
            early: false,
        })
    }

    /// The end.
    ///
    /// # Errors
    /// [`Fault`] where what has come out cannot be trusted.
    pub fn terminate(&mut self) -> Result<(), Fault> {
        let trusted = match (&self.model, self.state) {
            (Some(model), State::Stepping) => model.trusted(),
            _ => Ok(()),
        };
        if self.state != State::Failed {
            self.state = State::Terminated;
        }
        trusted.map_err(|text| self.fail(text))
    }

    /// Back to where it waits for its parameters, with those that it started with.
    pub fn reset(&mut self) {
        self.values = self.variables.iter().map(|v| v.start).collect();
        self.model = None;
        (self.start_s, self.tick) = (0.0, 0);
        self.failed.clear();
        self.state = State::Instantiated;
    }

    /// Nothing that is asked of it any more has a result but [`Self::reset`].
    pub fn fail(&mut self, text: String) -> Fault {
        self.state = State::Failed;
        self.failed.clone_from(&text);
        Fault::error(text)
    }

    fn at_s(&self, tick: u64) -> f64 {
        self.start_s + tick as f64 * self.unit.period_s()
    }

    fn not_failed(&self) -> Result<(), Fault> {
        match self.state {
            State::Failed => Err(Fault::error(format!("it failed before: {}", self.failed))),
            _ => Ok(()),
        }
    }

    fn expect(&self, state: State, otherwise: &str) -> Result<(), Fault> {
        self.not_failed()?;
        match self.state == state {
            true => Ok(()),
            false => Err(Fault::error(otherwise)),
        }
    }

    /// The model with the parameters as they are, where there is none yet.
    fn start(&mut self) -> Result<(), Fault> {
        if self.model.is_some() {
            return Ok(());
        }
        let with_values = self.variables.iter().zip(&self.values);
        let set: Vec<Set<'_>> = with_values
            .filter(|(v, value)| {
                matches!(v.role, Role::Fixed | Role::Tunable) && !v.start.same(**value)
            })
            .map(|(v, value)| Set {
                name: &v.name,
                value: *value,
            })
            .collect();
        match self.unit.start(&set) {
            Ok(model) => {
                self.model = Some(model);
                self.read();
                Ok(())
            }
            Err(text) => Err(self.fail(text)),
        }
    }

    fn next_sample(&mut self) -> Result<bool, Fault> {
        let inputs: Vec<Value> = (self.variables.iter().zip(&self.values))
            .filter(|(v, _)| v.role == Role::Input)
            .map(|(_, value)| *value)
            .collect();
        let Some(model) = &mut self.model else {
            return Err(Fault::error("there is no model"));
        };
        match model.step(&inputs) {
            Ok(began) => {
                self.tick += 1;
                self.values[0] = Value::Float64(self.at_s(self.tick));
                self.read();
                Ok(began)
            }
            Err(text) => Err(self.fail(text)),
        }
    }

    /// Puts the outputs of the model among the values: they are the last of the variables.
    fn read(&mut self) {
        let Some(model) = &self.model else { return };
        self.outputs.clear();
        model.outputs(&mut self.outputs);
        let first = self.values.len() - self.outputs.len().min(self.values.len());
        self.values[first..].copy_from_slice(&self.outputs);
    }
}
