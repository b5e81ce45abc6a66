//! How sets of bits and errors are logged with defmt: by names. Everything else derives it.

use crate::border::config::{ConfigError, Parameter};
use crate::border::signal::{Events, Limits, Status};
use defmt::{Format, Formatter, write};

macro_rules! by_names {
    ($($set:ty),*) => {$(
        impl Format for $set {
            fn format(&self, f: Formatter<'_>) {
                if self.is_empty() {
                    write!(f, "–");
                }
                for (number, (name, _)) in self.iter_names().enumerate() {
                    let between = if number > 0 { " | " } else { "" };
                    write!(f, "{=str}{=str}", between, name);
                }
            }
        }
    )*};
}

by_names!(Events, Limits, Status);

impl Format for ConfigError {
    fn format(&self, f: Formatter<'_>) {
        let Parameter {
            name,
            unit,
            low,
            high,
            ..
        } = self.parameter();
        if let (Some(broken), Some(rule)) = (self.contradiction, self.rule()) {
            let other = crate::border::config::PARAMETERS
                .get(rule.other)
                .map_or("", |other| other.name);
            write!(
                f,
                "{=str} = {=f32}: its limit is {=f32} by {=str}",
                name, self.value, broken.limit, other
            );
            return;
        }
        write!(
            f,
            "{=str} = {=f32}: expected {=f32} to {=f32}, unit {=str}",
            name, self.value, low, high, unit
        );
    }
}
