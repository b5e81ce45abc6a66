//! What it is worth to tell the supervisor of a bending mode, and what it costs to tell it wrong.

use super::compared::{COLUMNS, HOLDS_S, Ran, Run, Sum, is_held, run};
use super::plants::P5;
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError, run_all};
use firmware_bench::scene::diagnostic::SceneError;
use firmware_bench::scene::machine::MachineScene;
use firmware_bench::scene::policy_kind::PolicyKind;

/// Frequencies of the mode, evenly by their logarithm \[Hz\].
const FROM_HZ: f64 = 300.0;
const TO_HZ: f64 = 4000.0;
const DAMPING_RATIO: f64 = 0.003;
/// Speeds of a blow at the centre \[m/s\].
const BLOWS_M_S: [f64; 6] = [0.2, 0.3, 0.4, 0.5, 0.6, 0.65];
/// What is told, over what is.
const TOLD: [Option<f64>; 8] = [
    None,
    Some(1.0),
    Some(0.8),
    Some(0.9),
    Some(0.95),
    Some(1.05),
    Some(1.1),
    Some(1.2),
];

/// Displacements of a mode over the rigid rotor's: at the magnets, at the sensors 30 mm outside them, and the sense of the second
/// end.
#[derive(Debug, Clone, Copy)]
struct Shape {
    name: &'static str,
    at_magnets: f64,
    at_sensors: f64,
    second: f64,
}

const SHAPES: [Shape; 4] = [
    Shape {
        name: "0.5 at magnets, 0.6 at sensors, both ends alike",
        at_magnets: 0.5,
        at_sensors: 0.6,
        second: 1.0,
    },
    Shape {
        name: "0.7 and 0.7, alike",
        at_magnets: 0.7,
        at_sensors: 0.7,
        second: 1.0,
    },
    Shape {
        name: "0.7 and 0.7, opposite",
        at_magnets: 0.7,
        at_sensors: 0.7,
        second: -1.0,
    },
    Shape {
        name: "0.3 and -0.3, alike: a node between",
        at_magnets: 0.3,
        at_sensors: -0.3,
        second: 1.0,
    },
];

#[derive(Debug, Clone, Copy)]
struct Case {
    hz: f64,
    shape: usize,
    blow_m_s: f64,
}

impl Case {
    fn text(&self, told: Option<f64>) -> String {
        let Self {
            hz,
            shape,
            blow_m_s,
        } = *self;
        let Shape {
            at_magnets: m,
            at_sensors: s,
            second,
            ..
        } = SHAPES[shape];
        let (m2, s2, middle) = (second * m, second * s, -0.4 * (1.0 + second) * m);
        let before_spin = format!(
            "[[rotor.bending]]\nfrequency_hz = {hz}\ndamping_ratio = {DAMPING_RATIO}\npositions_m = [-0.25, -0.23, -0.2, 0.0, 0.2, 0.23, 0.25]\ndisplacements = [{s}, {s}, {m}, {middle}, {m2}, {s2}, {s2}]\n\n[start]\nvelocity_m_s = [{blow_m_s}, {}]\n\n[spin]",
            0.1 * blow_m_s
        );
        let sensor = |side: &str| {
            format!("position_m = {side}0.2\nsensor = {{ position_m = {side}0.23 }}\n")
        };
        let mut text = P5
            .replacen("[spin]", &before_spin, 1)
            .replacen("position_m = -0.2\n", &sensor("-"), 1)
            .replacen("position_m = 0.2\n", &sensor(""), 1);
        // What is compared is set, and not decided by the scene; 0 configures none.
        text.push_str(&format!(
            "\n[supervisor]\nbending_first_hz = {}\nacts_in_flight = 1\n",
            told.map_or(0.0, |ratio| ratio * hz)
        ));
        text
    }

    fn scene(&self, told: Option<f64>) -> Result<MachineScene, SceneError> {
        MachineScene::parse("P5 that bends", &self.text(told))
    }

    /// Whether levitation alone recovers, and holds the rotor long after.
    fn is_held(&self) -> bool {
        let duration = format!("duration_s = {HOLDS_S}");
        let text = self.text(None).replacen("duration_s = 0.5", &duration, 1);
        is_held(MachineScene::parse("P5 that bends", &text))
    }

    /// Levitation alone, and the supervisor told each of [`TOLD`].
    fn ran(&self) -> (Result<Run, String>, Vec<Result<Run, String>>) {
        let of = |told: Option<f64>, kind: PolicyKind| {
            run(&self.scene(told).map_err(|error| error.to_string())?, kind)
        };
        let own = TOLD.map(|told| of(told, PolicyKind::Supervisor));
        (of(None, PolicyKind::Levitation), own.to_vec())
    }
}

fn name(told: Option<f64>) -> String {
    match told {
        None => "not told".to_owned(),
        Some(1.0) => "told as it is".to_owned(),
        Some(ratio) => format!("told {ratio} of it"),
    }
}

/// A mode of every frequency and shape, on 18 frequencies or 4.
///
/// # Errors
/// None.
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let steps = extent.pick(4, 18);
    let mut rotors = Vec::new();
    for i in 0..steps {
        let share = i as f64 / (steps - 1) as f64;
        let hz = FROM_HZ * (TO_HZ / FROM_HZ).powf(share);
        rotors.extend((0..SHAPES.len()).map(|shape| Case {
            hz,
            shape,
            blow_m_s: BLOWS_M_S[0],
        }));
    }
    let held = run_all(&rotors, progress, Case::is_held);
    let (mut cases, mut not_held) = (Vec::new(), Vec::new());
    for (rotor, held) in rotors.iter().zip(held) {
        if !held {
            not_held.push(format!("{:.0} Hz, {}", rotor.hz, SHAPES[rotor.shape].name));
            continue;
        }
        cases.extend(BLOWS_M_S.map(|blow_m_s| Case { blow_m_s, ..*rotor }));
    }
    let ran = run_all(&cases, progress, |case| {
        let (alone, own) = case.ran();
        let pair = |own: Result<Run, String>| {
            Ok(Ran {
                alone: alone.clone()?,
                own: own?,
            })
        };
        own.into_iter().map(pair).collect::<Vec<_>>()
    });
    let sum = |told: usize, counts: &dyn Fn(&Case) -> bool| {
        let of = cases.iter().zip(&ran).filter(|(case, _)| counts(case));
        Sum::of(of.map(|(_, ran)| &ran[told]))
    };
    let all: Vec<Sum> = (0..TOLD.len()).map(|told| sum(told, &|_| true)).collect();
    let mut claims = Vec::new();
    for (told, sum) in TOLD.iter().zip(&all) {
        if matches!(told, Some(0.8..=1.05)) {
            claims.push(Claim::at_most(
                format!("{}: recoveries lost", name(*told)),
                0.0,
                sum.lost as f64,
            ));
        }
    }
    claims.push(Claim::at_most(
        "told as it is: touches over those when not told",
        1.0,
        all[1].touched() / all[0].touched(),
    ));
    let untrusted: u64 = all.iter().map(|sum| sum.untrusted).sum();
    claims.push(Claim::at_most(
        "pairs that cannot be trusted",
        0.0,
        untrusted as f64,
    ));
    let rows: Vec<_> = TOLD
        .iter()
        .zip(&all)
        .map(|(told, sum)| sum.cells(name(*told)))
        .collect();
    let by_shape = |told: usize| {
        let rows: Vec<_> = (SHAPES.iter().enumerate())
            .map(|(i, shape)| sum(told, &|case| case.shape == i).cells(shape.name.to_owned()))
            .collect();
        Block::table(COLUMNS, rows)
    };
    let mut of_hz: Vec<f64> = cases.iter().map(|case| case.hz).collect();
    of_hz.dedup();
    let by_hz: Vec<[String; 5]> = (of_hz.iter())
        .map(|hz| {
            let [untold, told] = [0, 1].map(|told| sum(told, &|case| case.hz == *hz));
            let touched = |sum: &Sum| format!("{:.2}", sum.touched());
            [
                format!("{hz:.0}"),
                untold.lost.to_string(),
                told.lost.to_string(),
                touched(&untold),
                touched(&told),
            ]
        })
        .collect();
    let story = format!(
        "P5 with one bending mode of {DAMPING_RATIO} of critical damping and {FROM_HZ} to {TO_HZ} Hz, sensors 30 mm outside the magnets, after six blows of {} to {} m/s at the centre. Touches and impulse are over those of levitation alone, where both recover. Struck on and on: twice the touches of levitation alone, and ten more. Levitation alone does not hold these for {HOLDS_S} s, and they do not count:",
        BLOWS_M_S[0], BLOWS_M_S[5]
    );
    Ok(Report {
        title: "Bending that is told".to_owned(),
        claims,
        cases: (cases.len() * TOLD.len()) as u64,
        chapters: vec![
            Chapter::new(
                "What was run",
                vec![Block::text(story), Block::List(not_held)],
            ),
            Chapter::new("What is told", vec![Block::table(COLUMNS, rows)]),
            Chapter::new("Not told, by shape", vec![by_shape(0)]),
            Chapter::new("Told as it is, by shape", vec![by_shape(1)]),
            Chapter::new(
                "By frequency",
                vec![Block::table(
                    [
                        "frequency [Hz]",
                        "lost, not told",
                        "lost, told",
                        "touches, not told",
                        "touches, told",
                    ],
                    by_hz,
                )],
            ),
        ],
    })
}
