//! What runs in a unit.

use crate::variable::Value;

/// A model from its start on. Errors are texts for people: they go to the importer's log.
pub trait Model {
    /// To the next control sample under these inputs; `true` where something began on the way that an importer may want to
    /// stop for.
    ///
    /// # Errors
    /// Why the model cannot be trusted any further.
    fn step(&mut self, inputs: &[Value]) -> Result<bool, String>;

    /// The outputs now, in the order of the variables.
    fn outputs(&self, into: &mut Vec<Value>);

    /// Another value of a tunable parameter from now on.
    ///
    /// # Errors
    /// What is wrong with it.
    fn tune(&mut self, name: &str, value: f64) -> Result<(), String>;

    /// Whether what has come out can be trusted.
    ///
    /// # Errors
    /// Why not.
    fn trusted(&self) -> Result<(), String>;
}

/// A parameter as the importer leaves it.
#[derive(Debug, Clone, Copy)]
pub struct Set<'a> {
    pub name: &'a str,
    /// Its value, another than at the start.
    pub value: Value,
}
