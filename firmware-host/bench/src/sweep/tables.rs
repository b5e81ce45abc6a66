//! The keys of sweep files: every row is a key. What values mean is decided where they are used.

use crate::scene::keys::{Absent, Key, Kind, absent, empty, key_tables};
use crate::scene::read::{self, KeyType, Refusal};
use crate::scene::tables::ANY;
use crate::scene::values::{Pair, PolicyNames, written_as_words};
use crate::sweep::design::Design;
use toml::Value;

key_tables! {
    /// A sweep file as written.
    SweepTables {
        scene: String [required "give the scene that is varied: scene = \"…\", by its path from this file"], "", ANY, "the scene that is varied";
        design: Design [required "give design = \"grid\", \"latin_hypercube\", \"sobol\" or \"monte_carlo\""], "", ANY, "how runs are spread";
        runs: Option<u64> [or "those of the grid"], "1", ANY, "how many";
        repeats: Option<u64> [or "1"], "1", ANY, "of each combination of a grid";
        seed: u64 [= 0], "1", ANY, "what all draws follow from";
        policies: Option<PolicyNames> [or "those of the scene"], "", ANY, "who controls";
        worst: u32 [= 3], "1", ANY, "how many runs are kept as scenes";
        worst_by: Option<String> [or "peak_contact_force_n"], "", ANY, "figure that they are chosen by";
        worst_policy: Option<String> [or "the supervisor, or the last"], "", ANY, "policy that they are of";
        maps: Vec<Vec<String>> [= Vec::new()], "", ANY, "pairs of keys over which outcomes are shown";
        vary: Vec<VaryTable> [= Vec::new()], "", ANY, "keys that vary";
    }
}

written_as_words! { Design }

/// Values of any kind.
#[derive(Debug, Clone)]
pub(crate) struct AnyValues(pub(crate) Vec<Value>);

impl KeyType for AnyValues {
    const KIND: Kind = Kind::Text;

    fn read(value: &Value) -> Result<Self, Refusal> {
        let list = value.as_array().cloned().map(Self);
        list.ok_or_else(|| Refusal::expected(value, "a list in square brackets"))
    }

    fn write(&self) -> Option<Value> {
        Some(Value::Array(self.0.clone()))
    }
}

key_tables! {
    /// A key of scenes, and what it varies over, as a sweep file has it: exactly one of the others.
    VaryTable {
        key: String [required "give the key of the scene that varies: key = \"friction.coefficient\""], "", ANY, "the key that varies";
        values: Option<AnyValues> [or "another"], "", ANY, "these, each as likely";
        linspace: Option<SpacedTable> [or "another"], "", ANY, "numbers with equal differences";
        logspace: Option<SpacedTable> [or "another"], "", ANY, "numbers with equal ratios";
        uniform: Option<Pair> [or "another"], "", ANY, "every number between two as likely";
        log_uniform: Option<Pair> [or "another"], "", ANY, "every ratio as likely";
        normal: Option<NormalTable> [or "another"], "", ANY, "normal between limits";
    }

    /// Numbers from one to another.
    SpacedTable {
        from: f64 [required "give { from = 1.0, to = 2.0, count = 11 }"], "", ANY, "the first";
        to: f64 [required "give { from = 1.0, to = 2.0, count = 11 }"], "", ANY, "the last";
        count: u32 [required "give { from = 1.0, to = 2.0, count = 11 }"], "", ANY, "how many";
    }

    /// A normal distribution that is cut off.
    NormalTable {
        mean: f64 [required "give { mean = 1.0, standard_deviation = 0.1, low = 0.8, high = 1.2 }"], "", ANY, "without limits";
        standard_deviation: f64 [required "give { mean = 1.0, standard_deviation = 0.1, low = 0.8, high = 1.2 }"], "", ANY, "without limits";
        low: f64 [required "give { mean = 1.0, standard_deviation = 0.1, low = 0.8, high = 1.2 }"], "", ANY, "the least";
        high: f64 [required "give { mean = 1.0, standard_deviation = 0.1, low = 0.8, high = 1.2 }"], "", ANY, "the largest";
    }
}
