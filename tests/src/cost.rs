//! What a plant of each combination of parts costs, in instructions.
//!
//! One run of the binary `cost` under callgrind does the work of all combinations. It calls `mark`
//! before and after each piece of work, where callgrind writes what it has counted and starts anew; the
//! files are read back by number. Calls and inclusive costs of functions are in them, so nothing of the
//! bench itself is counted.

use plant_model::params::{
    MagnetParams, PlantParams, RotorParams, SpinParams, Start, StatorParams,
};
use plant_model::{ContactMode, Inputs, Method, Options, Plant, V2, build};
use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use crate::plants::footnote_4;

/// Control sample \[s\].
const SAMPLE_S: f64 = 50e-6;
/// Flight samples that are counted, after as many that are not.
const SAMPLES: u32 = 40;
/// Time of contact that is counted \[s\].
const CONTACT_S: f64 = 60e-6;
const CLEARANCE_M: f64 = 2.44e-4;
/// A little beyond the wall; 2^-12, so that its normal is exact and rolling exactly rolling \[m\].
const TOUCHING_M: f64 = 1.0 / 4096.0;
/// What each machine has: the C library would choose its copying and its sine by the processor.
const PLAIN_LIBRARY: &str =
    "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX,-AVX_Fast_Unaligned_Load,-ERMS,-FSRM,-SSSE3";
/// What [`work`] does for each combination, in this order.
const PIECES: [Piece; 3] = [
    Piece::Flight,
    Piece::Contact(ContactMode::SlipPositive),
    Piece::Contact(ContactMode::Roll),
];

#[derive(Debug, Clone, Copy)]
enum Piece {
    Flight,
    Contact(ContactMode),
}

/// A combination of parts. Each is a level, and a higher level has more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Parts(pub [u8; 4]);

/// Names of the levels of each part.
const LEVELS: [&[&str]; 4] = [
    &["rigid", "one mass", "two masses"],
    &["held", "free"],
    &["no", "yes"],
    &["none", "no lag", "lag"],
];
/// Names of the parts.
const PARTS: [&str; 4] = ["stator", "spin", "unbalance", "magnet"];

impl Parts {
    /// No part at all.
    pub const PLAIN: Self = Self([0, 0, 0, 0]);
    /// Every part at its highest level.
    pub const ALL: Self = Self([2, 1, 1, 2]);

    /// All 36 combinations.
    pub fn every() -> Vec<Self> {
        let count = |i: usize| LEVELS[i].len() as u8;
        let mut every = Vec::new();
        for stator in 0..count(0) {
            for spin in 0..count(1) {
                for unbalance in 0..count(2) {
                    every.extend((0..count(3)).map(|m| Self([stator, spin, unbalance, m])));
                }
            }
        }
        every
    }

    /// The combinations that lack exactly one level of one part, with the part's name.
    pub fn without_one(self) -> impl Iterator<Item = (&'static str, Self)> {
        (0..4).filter(move |&i| self.0[i] > 0).map(move |i| {
            let mut less = self;
            less.0[i] -= 1;
            (PARTS[i], less)
        })
    }

    /// Level of each part in words.
    pub fn names(self) -> [&'static str; 4] {
        std::array::from_fn(|i| LEVELS[i][usize::from(self.0[i])])
    }

    /// The paper's rotor of footnote 4 with these parts only.
    fn plant(self) -> PlantParams {
        let full = footnote_4();
        let StatorParams::TwoMass { inner, .. } = full.stator else {
            unreachable!("the paper's stator has two masses")
        };
        PlantParams {
            rotor: RotorParams {
                eccentricity_m: if self.0[2] > 0 { 1e-5 } else { 0.0 },
                ..full.rotor
            },
            spin: match self.0[1] {
                0 => SpinParams::Held,
                _ => SpinParams::Free {
                    inertia_kg_m2: 0.05,
                    drive_torque_n_m: 0.5,
                },
            },
            stator: match self.0[0] {
                0 => StatorParams::Rigid,
                1 => StatorParams::OneMass(inner),
                _ => full.stator,
            },
            magnet: match self.0[3] {
                0 => None,
                level => Some(MagnetParams {
                    force_max_n: 150.0,
                    lag_s: if level > 1 { 2e-4 } else { 0.0 },
                }),
            },
            ..full
        }
    }

    /// Number of scalar states.
    pub fn states(self) -> usize {
        self.build(Piece::Flight).states()
    }

    fn build(self, piece: Piece) -> Plant {
        let mut params = self.plant();
        params.contact.clearance_m = CLEARANCE_M;
        let mut start = Start {
            position_m: V2::new(TOUCHING_M, 0.0),
            velocity_m_s: V2::new(0.4, -0.4),
            spin_rad_s: 250.0,
            spin_phase_rad: 0.3,
        };
        let mut options = Options::default();
        match piece {
            Piece::Flight => {
                params.contact.clearance_m = 5.0 * CLEARANCE_M;
                start.position_m = V2::new(5e-5, 2e-5);
                start.velocity_m_s = V2::new(0.01, 0.02);
            }
            Piece::Contact(mode) => {
                options.method = Method::Series;
                if mode == ContactMode::Roll {
                    // v_w + Ω·R = 0, slow enough for friction to hold it there.
                    start.velocity_m_s.y = -0.02;
                    start.spin_rad_s = 0.2;
                }
            }
        }
        build(&params, &start, options).expect("the parameters are in range")
    }
}

/// Where callgrind writes what it has counted.
#[inline(never)]
fn mark() {
    std::hint::black_box(());
}

/// Flies through samples with a changing command; the calls from here are what is counted.
#[inline(never)]
fn fly_samples(plant: &mut Plant, samples: std::ops::Range<u32>) {
    for i in samples {
        let command_n = V2::new(40.0 + f64::from(i % 7), -30.0 + f64::from(i % 5));
        let inputs = Inputs {
            command_n,
            external_n: V2::new(0.0, -98.1),
        };
        let end_s = f64::from(i + 1) * SAMPLE_S;
        (plant.advance(end_s, &inputs, &mut |_| {})).expect("flight of a good plant");
    }
}

/// The work of all combinations: what runs under callgrind. On a thread of its own, whose stack begins at
/// a page: how many instructions a copy takes depends on its alignment, and that of the main stack on the
/// environment.
///
/// # Panics
/// If a run leaves the mode that is to be counted.
pub fn work() {
    let worker = std::thread::spawn(work_here);
    worker.join().expect("each run stays in its mode");
}

fn work_here() {
    for parts in Parts::every() {
        for piece in PIECES {
            let mut plant = parts.build(piece);
            let expected = match piece {
                Piece::Flight => {
                    fly_samples(&mut plant, 0..SAMPLES);
                    mark();
                    fly_samples(&mut plant, SAMPLES..2 * SAMPLES);
                    mark();
                    ContactMode::Flight
                }
                Piece::Contact(mode) => {
                    let inputs = Inputs {
                        command_n: V2::new(40.0, -30.0),
                        external_n: V2::new(0.0, -98.1),
                    };
                    assert_eq!(plant.mode(), mode, "{parts:?}");
                    let mut changes = 0;
                    mark();
                    let run = plant.advance(CONTACT_S, &inputs, &mut |_| changes += 1);
                    mark();
                    run.expect("contact of a good plant");
                    assert_eq!(changes, 0, "{parts:?} {piece:?}");
                    mode
                }
            };
            assert_eq!(plant.mode(), expected, "{parts:?} {piece:?}");
        }
    }
}

/// Names of the counted quantities, in the order of [`Cost::instructions`].
pub const QUANTITIES: [&str; 3] = ["flight_sample", "series_slip", "series_roll"];

/// What one combination costs.
#[derive(Debug, Clone, Copy)]
pub struct Cost {
    /// The combination.
    pub parts: Parts,
    /// Number of scalar states.
    pub states: usize,
    /// Mean instructions per quantity of [`QUANTITIES`].
    pub instructions: [f64; 3],
}

/// Why there is no count.
#[derive(Debug)]
pub enum CostError {
    /// There is no valgrind on this machine.
    NoValgrind,
    /// Anything else, in words.
    Other(String),
}

impl std::fmt::Display for CostError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::NoValgrind => "valgrind is not installed; tests/run installs it",
            Self::Other(text) => text,
        })
    }
}

/// Counts with callgrind; `binary` is the built program `cost`.
///
/// # Errors
/// Without valgrind, or if its output is not as expected.
pub fn measure(binary: &Path) -> Result<Vec<Cost>, CostError> {
    let other = |e: &dyn std::fmt::Display| CostError::Other(e.to_string());
    let folder = tempfile::tempdir().map_err(|e| other(&e))?;
    let file = folder.path().join("counts");
    let run = Command::new("valgrind")
        .args(["--tool=callgrind", "--dump-before=*cost::mark*"])
        .args(["--compress-strings=no", "--compress-pos=no"])
        .arg(format!("--callgrind-out-file={}", file.display()))
        .arg(binary)
        .arg("work")
        .env("GLIBC_TUNABLES", PLAIN_LIBRARY)
        .output();
    let output = match run {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Err(CostError::NoValgrind),
        run => run.map_err(|e| other(&e))?,
    };
    if !output.status.success() {
        return Err(other(&String::from_utf8_lossy(&output.stderr)));
    }
    let mut costs = Vec::new();
    for (i, parts) in Parts::every().into_iter().enumerate() {
        // Files count from 1, and each second one ends a piece of work.
        let read = |piece: usize| {
            let number = 2 * (i * PIECES.len() + piece + 1);
            let path = folder.path().join(format!("counts.{number}"));
            std::fs::read_to_string(&path).map_err(|e| other(&format!("{}: {e}", path.display())))
        };
        let mean = |piece: usize, select: Select<'_>| -> Result<f64, CostError> {
            let (calls, instructions) = calls(&read(piece)?, select);
            if calls == 0 {
                let text = format!("{parts:?}: no {select:?}; has it been inlined?");
                return Err(CostError::Other(text));
            }
            Ok(instructions as f64 / calls as f64)
        };
        costs.push(Cost {
            parts,
            states: parts.states(),
            instructions: [
                mean(0, Select::From("::fly_samples"))?,
                mean(1, Select::To("::MachineSeries::fill"))?,
                mean(2, Select::To("::MachineSeries::fill"))?,
            ],
        });
    }
    Ok(costs)
}

/// Which calls are summed: by the end of the path of the caller or of the called.
#[derive(Debug, Clone, Copy)]
enum Select<'a> {
    From(&'a str),
    To(&'a str),
}

/// Number of calls in one of callgrind's files, and their instructions with all that they call.
fn calls(text: &str, select: Select<'_>) -> (u64, u64) {
    let (mut from, mut to) = (String::new(), String::new());
    let (mut calls, mut instructions) = (0, 0);
    let number = |word: Option<&str>| word.and_then(|w| w.parse::<u64>().ok()).unwrap_or(0);
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if let Some(name) = line.strip_prefix("fn=") {
            path(name).clone_into(&mut from);
        } else if let Some(name) = line.strip_prefix("cfn=") {
            path(name).clone_into(&mut to);
        } else if let Some(count) = line.strip_prefix("calls=") {
            let wanted = match select {
                Select::From(end) => from.ends_with(end),
                Select::To(end) => to.ends_with(end),
            };
            // The next line is "position instructions".
            let cost = number(lines.next().and_then(|l| l.split_whitespace().nth(1)));
            if wanted {
                calls += number(count.split_whitespace().next());
                instructions += cost;
            }
        }
    }
    (calls, instructions)
}

/// Path of a function without the hash that the compiler adds.
fn path(name: &str) -> &str {
    match name.rsplit_once("::h") {
        Some((path, hash)) if hash.len() == 16 => path,
        _ => name,
    }
}

/// Every pair of combinations that shows a cost of a missing part, in words: the one without it needs
/// more, or needs the same instructions although the part has terms of its own.
pub fn violations(costs: &[Cost]) -> Vec<String> {
    let mut violations = Vec::new();
    for more in costs {
        for (part, parts) in more.parts.without_one() {
            let Some(less) = costs.iter().find(|c| c.parts == parts) else {
                violations.push(format!("{:?} was not counted", parts.names()));
                continue;
            };
            // A magnet without lag is a force like any other.
            let has_terms = (part, more.parts.0[3]) != ("magnet", 1);
            let mut check = |quantity: &str, (a, b): (f64, f64), saves: bool| {
                if a > b || (saves && a == b) {
                    violations.push(format!(
                        "{quantity}: {a:.1} for {:?}, {b:.1} with more {part}",
                        parts.names()
                    ));
                }
            };
            check("states", (less.states as f64, more.states as f64), false);
            for (i, quantity) in QUANTITIES.iter().enumerate() {
                let pair = (less.instructions[i], more.instructions[i]);
                check(quantity, pair, has_terms);
            }
        }
    }
    violations
}

/// A table of combinations in Markdown.
pub fn table(costs: &[Cost]) -> String {
    let mut table = String::from(
        "| stator | spin | unbalance | magnet | states | flight sample | series, slip | roll |\n\
         |---|---|---|---|--:|--:|--:|--:|\n",
    );
    for cost in costs {
        let [stator, spin, unbalance, magnet] = cost.parts.names();
        let _ = write!(
            table,
            "| {stator} | {spin} | {unbalance} | {magnet} | {} |",
            cost.states
        );
        for n in cost.instructions {
            let _ = write!(table, " {n:.0} |");
        }
        table.push('\n');
    }
    table
}

/// What is compared with `tests/golden/cost_of_parts.txt`: nothing, one part at a time, everything.
pub fn golden_rows(costs: &[Cost]) -> Vec<(String, f64)> {
    let chosen = [
        ("plain", Parts::PLAIN),
        ("lag", Parts([0, 0, 0, 2])),
        ("unbalance", Parts([0, 0, 1, 0])),
        ("free_spin", Parts([0, 1, 0, 0])),
        ("two_masses", Parts([2, 0, 0, 0])),
        ("all", Parts::ALL),
    ];
    let mut rows = Vec::new();
    for (name, parts) in chosen {
        for cost in costs.iter().filter(|c| c.parts == parts) {
            for (quantity, n) in QUANTITIES.iter().zip(cost.instructions) {
                rows.push((format!("{quantity}_{name}"), n));
            }
        }
    }
    rows
}
