//! Numbers that are asked for.

use crate::cli::error::CommandError;
use std::io::{BufRead, Write};

/// A number.
#[derive(Debug, Clone, Copy)]
pub(super) struct Number {
    /// The option that gives it, as a field.
    pub(super) name: &'static str,
    /// What it is, its unit, and an example: the text of the option.
    pub(super) question: &'static str,
    /// Which it may be, and in words.
    pub(super) range: (fn(f64) -> bool, &'static str),
}

impl Number {
    pub(super) fn option(&self) -> String {
        format!("--{}", self.name.replace('_', "-"))
    }

    pub(super) fn check(&self, value: f64) -> Result<(), CommandError> {
        let (may_be, expected) = self.range;
        match may_be(value) {
            true => Ok(()),
            false => Err(CommandError::Numbers {
                message: format!("{} is {value}, expected {expected}", self.option()),
                help: format!("give {expected}"),
            }),
        }
    }

    /// Asks until the answer may be the number.
    ///
    /// # Errors
    /// Where nobody answers any more.
    pub(super) fn ask(
        &self,
        from: &mut impl BufRead,
        to: &mut impl Write,
    ) -> Result<f64, CommandError> {
        let broken = |error: std::io::Error| CommandError::other("asking", error);
        loop {
            write!(to, "{}: ", self.question.trim())
                .and_then(|()| to.flush())
                .map_err(broken)?;
            let mut line = String::new();
            if from.read_line(&mut line).map_err(broken)? == 0 {
                return Err(CommandError::Numbers {
                    message: format!("{} is missing", self.option()),
                    help: format!("give it as an option, or answer: {}", self.question.trim()),
                });
            }
            let (may_be, expected) = self.range;
            match line.trim().parse::<f64>() {
                Ok(value) if may_be(value) => return Ok(value),
                _ => writeln!(to, "expected {expected}, with a point for decimals")
                    .map_err(broken)?,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_asks_until_the_answer_is_a_number_in_range() {
        let range: (fn(f64) -> bool, _) = (|x| x > 0.0, "a number greater than 0");
        let mass = Number {
            name: "mass_kg",
            question: "mass in kg",
            range,
        };
        let mut out = Vec::new();
        let answer = mass.ask(&mut "ten\n-1\n 1e1 \n".as_bytes(), &mut out);
        assert_eq!(answer.unwrap(), 10.0);
        let out = String::from_utf8(out).unwrap();
        assert_eq!(out.matches("mass in kg: ").count(), 3);
        assert_eq!(out.matches("expected a number greater than 0").count(), 2);
        let nobody = mass.ask(&mut "".as_bytes(), &mut Vec::new()).unwrap_err();
        assert_eq!(
            (nobody.exit_code(), nobody.to_string().as_str()),
            (2, "--mass-kg is missing")
        );
    }
}
