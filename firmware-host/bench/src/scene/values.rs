//! Values of scene files with their own way to be written.

use crate::device::actuator::Delivers;
use crate::device::axis::Axis;
use crate::scene::keys::Kind;
use crate::scene::read::{self, KeyType, Refusal};
use crate::words::words;
use plant_model::{Method, V2};
use toml::Value;

/// Two numbers [x, y]; fewer or more are refused.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pair(pub(crate) [f64; 2]);

impl KeyType for Pair {
    const KIND: Kind = Kind::Pair;

    fn read(value: &Value) -> Result<Self, Refusal> {
        let numbers = read::each(value)?;
        let both = numbers.try_into().map(Self);
        both.map_err(|_| Refusal::expected(value, "two numbers: [x, y]"))
    }

    fn write(&self) -> Option<Value> {
        self.0.to_vec().write()
    }
}

impl Pair {
    /// Length of the vector.
    pub(crate) fn length(self) -> f64 {
        self.0[0].hypot(self.0[1])
    }
}

impl From<Pair> for V2 {
    fn from(pair: Pair) -> Self {
        pair.0.into()
    }
}

/// One number for both axes, or one for each.
#[derive(Debug, Clone, Copy)]
pub(crate) enum PerAxis {
    /// One number for both axes.
    Both(f64),
    /// One for x, one for y.
    Each(Pair),
}

impl KeyType for PerAxis {
    const KIND: Kind = Kind::PerAxis;

    fn read(value: &Value) -> Result<Self, Refusal> {
        let both = f64::read(value).map(Self::Both);
        (both.or_else(|_| Pair::read(value).map(Self::Each)))
            .map_err(|_| Refusal::expected(value, "a number, or two numbers [x, y]"))
    }

    fn write(&self) -> Option<Value> {
        match self {
            Self::Both(x) => x.write(),
            Self::Each(pair) => pair.write(),
        }
    }
}

impl From<PerAxis> for V2 {
    fn from(per_axis: PerAxis) -> Self {
        match per_axis {
            PerAxis::Both(x) => Self::repeat(x),
            PerAxis::Each(xy) => xy.into(),
        }
    }
}

/// Any number of numbers.
#[derive(Debug, Clone, Default)]
pub(crate) struct Numbers(pub(crate) Vec<f64>);

/// Names of policies, not yet known to be such.
#[derive(Debug, Clone)]
pub(crate) struct PolicyNames(pub(crate) Vec<String>);

/// Lists, of which [`KeyType::KIND`] says more than that.
macro_rules! lists {
    ($($type:ident => $kind:ident;)*) => {
        $(impl KeyType for $type {
            const KIND: Kind = Kind::$kind;

            fn read(value: &Value) -> Result<Self, Refusal> {
                read::each(value).map(Self)
            }

            fn write(&self) -> Option<Value> {
                self.0.write()
            }
        })*
    };
}
lists! {
    Numbers => Numbers;
    PolicyNames => Policies;
}

words! {
    /// How contact is integrated.
    pub(crate) enum MethodName {
        /// As the tolerance asks for.
        Auto = "auto",
        /// Power series.
        Series = "series",
        /// Implicit, in eight points.
        Collocation = "collocation",
    }
}

impl From<MethodName> for Method {
    fn from(name: MethodName) -> Self {
        match name {
            MethodName::Auto => Self::Auto,
            MethodName::Series => Self::Series,
            MethodName::Collocation => Self::Collocation,
        }
    }
}

words! {
    /// Course of a load over its interval.
    pub(crate) enum ShapeName {
        /// The amplitude all the time.
        Constant = "constant",
        /// Half a sine over the interval.
        HalfSine = "half_sine",
        /// A sine with frequency and phase.
        Sine = "sine",
    }
}

words! {
    /// Kinds of sensor faults: [`crate::device::sensor_fault::FaultKind`] without what belongs to them.
    pub(crate) enum FaultName {
        /// Not a number.
        Nan = "nan",
        Infinity = "infinity",
        Zero = "zero",
        /// Upper end of the range.
        Rail = "rail",
        /// The last value again.
        Stuck = "stuck",
        /// A length too much.
        Offset = "offset",
        /// A multiple.
        Gain = "gain",
        /// The other sign.
        Inverted = "inverted",
        /// y for x.
        Swapped = "swapped",
        /// A multiple of the noise.
        Noise = "noise",
        /// Jumps.
        Spikes = "spikes",
        /// No new samples.
        Dropout = "dropout",
        /// Old samples.
        Delay = "delay",
        /// A coarser converter.
        Bits = "bits",
        /// A sine on top.
        Oscillation = "oscillation",
    }
}

/// Enumerations that are written as words.
macro_rules! written_as_words {
    ($($type:ident)*) => {
        $(impl KeyType for $type {
            const KIND: Kind = Kind::Word(Self::WORDS);

            fn read(value: &Value) -> Result<Self, Refusal> {
                read::word(value, Self::WORDS).map(|place| Self::ALL[place])
            }

            fn write(&self) -> Option<Value> {
                Some(Value::String(Self::WORDS[*self as usize].to_owned()))
            }
        })*
    };
}
pub(crate) use written_as_words;
written_as_words! { MethodName ShapeName FaultName Axis Delivers }
