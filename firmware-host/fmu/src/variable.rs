//! Variables of a unit: what each is called, of which type it is, who sets it.

/// A type of whole numbers with names.
#[derive(Debug, PartialEq, Eq)]
pub struct Enumeration {
    pub name: &'static str,
    /// What it is of.
    pub about: &'static str,
    /// Names; numbers count from 0.
    pub items: &'static [&'static str],
}

/// Of which type a variable is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Float64,
    /// A whole number.
    Int64,
    /// Bits, or a count that wraps; an `Integer` of the same 32 bits in version 2.0.
    UInt32,
    /// True or false.
    Boolean,
    /// One of some names.
    Enumeration(&'static Enumeration),
}

/// A value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// Of a number.
    Float64(f64),
    /// Of a whole number, and of an enumeration.
    Int64(i64),
    /// Of bits.
    UInt32(u32),
    /// Of what is true or false.
    Boolean(bool),
}

/// An output and how it is read off something: name, unit, what it is, type, value.
pub(crate) type Output<T> = (
    &'static str,
    &'static str,
    &'static str,
    Kind,
    fn(&T) -> Value,
);

impl Value {
    /// Whether both are the same to the last bit.
    pub fn same(self, other: Self) -> bool {
        match (self, other) {
            (Self::Float64(a), Self::Float64(b)) => a.to_bits() == b.to_bits(),
            (a, b) => a == b,
        }
    }

    /// As a number; whole numbers too.
    pub fn number(self) -> f64 {
        match self {
            Self::Float64(x) => x,
            Self::Int64(x) => x as f64,
            Self::UInt32(x) => f64::from(x),
            Self::Boolean(x) => f64::from(u8::from(x)),
        }
    }

    /// Whether it may be one of a kind.
    pub fn is_of(self, kind: Kind) -> bool {
        match (self, kind) {
            (Self::Float64(_), Kind::Float64)
            | (Self::Int64(_), Kind::Int64)
            | (Self::UInt32(_), Kind::UInt32)
            | (Self::Boolean(_), Kind::Boolean) => true,
            (Self::Int64(x), Kind::Enumeration(of)) => {
                usize::try_from(x).is_ok_and(|x| x < of.items.len())
            }
            _ => false,
        }
    }
}

impl Kind {
    /// What an output of it is before there is anything.
    pub fn zero(self) -> Value {
        match self {
            Self::Float64 => Value::Float64(0.0),
            Self::Int64 | Self::Enumeration(_) => Value::Int64(0),
            Self::UInt32 => Value::UInt32(0),
            Self::Boolean => Value::Boolean(false),
        }
    }
}

/// Who sets a variable, and when.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    Time,
    /// The importer, before the first step.
    Fixed,
    /// The importer, also between steps.
    Tunable,
    /// The importer, before each step.
    Input,
    /// The unit.
    Output,
}

/// A variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Its name; of parameters the path of the scene's key.
    pub name: String,
    /// What it is.
    pub about: String,
    /// Its unit; "" and "1" of a plain number.
    pub unit: &'static str,
    /// Its type.
    pub kind: Kind,
    /// Who sets it.
    pub role: Role,
    /// What it is until it is set.
    pub start: Value,
}

impl Variable {
    /// An input or output, zero at the start.
    pub fn signal(role: Role, name: String, about: &str, unit: &'static str, kind: Kind) -> Self {
        Self {
            name,
            about: about.to_owned(),
            unit,
            kind,
            role,
            start: kind.zero(),
        }
    }
}
