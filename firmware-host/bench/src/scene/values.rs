//! Values of scene files with their own way to be written.

use crate::device::actuator::Delivers;
use crate::device::axis::Axis;
use crate::scene::keys::{KeyType, Kind, key_types};
use crate::words::words;
use plant_model::{Method, V2};
use serde::{Deserialize, Serialize};

/// Two numbers [x, y]; fewer or more are refused.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
#[serde(try_from = "Vec<f64>")]
pub(crate) struct Pair(pub(crate) [f64; 2]);

impl TryFrom<Vec<f64>> for Pair {
    type Error = String;

    fn try_from(numbers: Vec<f64>) -> Result<Self, String> {
        let found = numbers.len();
        <[f64; 2]>::try_from(numbers)
            .map(Self)
            .map_err(|_| format!("{found} numbers, expected two: [x, y]"))
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
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(untagged, expecting = "a number, or two numbers [x, y]")]
pub(crate) enum PerAxis {
    /// One number for both axes.
    Both(f64),
    /// One for x, one for y.
    Each(Pair),
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
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct Numbers(pub(crate) Vec<f64>);

/// Names of policies, not yet known to be such.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct PolicyNames(pub(crate) Vec<String>);

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
        /// Infinity.
        Infinity = "infinity",
        /// Zero.
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

key_types! {
    Pair => Kind::Pair;
    PerAxis => Kind::PerAxis;
    Numbers => Kind::Numbers;
    PolicyNames => Kind::Policies;
    MethodName => Kind::Word(Self::WORDS);
    ShapeName => Kind::Word(Self::WORDS);
    FaultName => Kind::Word(Self::WORDS);
    Axis => Kind::Word(Self::WORDS);
    Delivers => Kind::Word(Self::WORDS);
}
