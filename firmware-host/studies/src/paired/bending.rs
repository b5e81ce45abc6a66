//! What it is worth to configure the supervisor for a bending mode, and what it costs to do so wrong.

use super::pair::{Engaged, HOLDS_S, NoPair, Outcome, Pair, Tried, run_rotor};
use super::row::{COLUMNS, ClassName, Row, values};
use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError, run_all};
use firmware_bench::scene::Scene;
use firmware_bench::scene::diagnostic::SceneError;
use firmware_bench::scene::policy_kind::PolicyKind;

/// The rotor.
const P5: &str = include_str!("../../scenes/rotors/p5.toml");
/// Frequencies of the mode, evenly by their logarithm \[Hz\].
const FROM_HZ: f64 = 300.0;
const TO_HZ: f64 = 4000.0;
const DAMPING_RATIO: f64 = 0.003;
/// Speeds of a blow at the centre \[m/s\].
const BLOWS_M_S: [f64; 6] = [0.2, 0.3, 0.4, 0.5, 0.6, 0.65];
/// Frequency that the supervisor is configured with, over what it is.
const CONFIGURED: [Option<f64>; 8] = [
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
    fn text(&self, configured: Option<f64>) -> String {
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
            "[[rotor.bending]]\nfrequency_hz = {hz}\ndamping_ratio = {DAMPING_RATIO}\npositions_m = [-0.25, -0.23, -0.2, 0.0, 0.2, 0.23, 0.25]\ndisplacements = [{s}, {s}, {m}, {middle}, {m2}, {s2}, {s2}]\n\n[start]\nlevitated_before = true\nvelocity_m_s = [{blow_m_s}, {}]\n\n[spin]",
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
            configured.map_or(0.0, |ratio| ratio * hz)
        ));
        text
    }

    fn scene(&self, configured: Option<f64>) -> Result<Scene, SceneError> {
        Scene::parse("P5 that bends", &self.text(configured))
    }

    /// Whether levitation alone recovers, and holds the rotor long after.
    fn is_held(&self) -> bool {
        let duration = format!("duration_s = {HOLDS_S}");
        let text = self.text(None).replacen("duration_s = 0.5", &duration, 1);
        Scene::parse("P5 that bends", &text).is_ok_and(|scene| {
            run_rotor(&scene, PolicyKind::Levitation).is_ok_and(|outcome| outcome.recovered)
        })
    }

    /// Levitation alone beside the supervisor with each of [`CONFIGURED`].
    fn pairs(&self) -> Vec<Tried> {
        let run = |configured: Option<f64>, kind: PolicyKind| -> Result<Outcome, NoPair> {
            let scene = (self.scene(configured)).map_err(|e| NoPair::Untrusted(e.to_string()))?;
            run_rotor(&scene, kind).map_err(NoPair::Untrusted)
        };
        let alone = run(None, PolicyKind::Levitation);
        let pair = |configured: &Option<f64>| {
            Ok(Pair {
                levitation: alone.clone()?,
                supervisor: run(*configured, PolicyKind::Supervisor)?,
                engaged: Engaged::default(),
            })
        };
        CONFIGURED.iter().map(pair).collect()
    }
}

fn name(configured: Option<f64>) -> String {
    match configured {
        None => "not configured".to_owned(),
        Some(1.0) => "configured as it is".to_owned(),
        Some(ratio) => format!("configured with {ratio} of it"),
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
    let ran = run_all(&cases, progress, Case::pairs);
    let sum = |configured: usize, counts: &dyn Fn(&Case) -> bool| {
        let of = cases.iter().zip(&ran).filter(|(case, _)| counts(case));
        let class = ClassName {
            configuration: name(CONFIGURED[configured]),
            ..ClassName::default()
        };
        Row::new(class, of.map(|(_, ran)| (0, &ran[configured])))
    };
    let all: Vec<Row> = (0..CONFIGURED.len())
        .map(|configured| sum(configured, &|_| true))
        .collect();
    let mut claims = Vec::new();
    for (configured, sum) in CONFIGURED.iter().zip(&all) {
        if matches!(configured, Some(0.8..=1.05)) {
            claims.push(Claim::at_most(
                format!("{}: recoveries lost", name(*configured)),
                0.0,
                sum.lost as f64,
            ));
        }
    }
    claims.push(Claim::at_most(
        "configured as it is: touches over those when not configured",
        1.0,
        all[1].touch_ratio() / all[0].touch_ratio(),
    ));
    let untrusted: u64 = all.iter().map(|sum| sum.untrusted).sum();
    claims.push(Claim::at_most(
        "pairs that cannot be trusted",
        0.0,
        untrusted as f64,
    ));
    let rows: Vec<_> = CONFIGURED
        .iter()
        .zip(&all)
        .map(|(configured, sum)| sum.cells(name(*configured)))
        .collect();
    let by_shape = |configured: usize| {
        let rows: Vec<_> = (SHAPES.iter().enumerate())
            .map(|(i, shape)| sum(configured, &|case| case.shape == i).cells(shape.name.to_owned()))
            .collect();
        Block::table(COLUMNS, rows)
    };
    let mut of_hz: Vec<f64> = cases.iter().map(|case| case.hz).collect();
    of_hz.dedup();
    let by_hz: Vec<[String; 5]> = (of_hz.iter())
        .map(|hz| {
            let [without, configured] =
                [0, 1].map(|configured| sum(configured, &|case| case.hz == *hz));
            let touched = |sum: &Row| format!("{:.2}", sum.touch_ratio());
            [
                format!("{hz:.0}"),
                without.lost.to_string(),
                configured.lost.to_string(),
                touched(&without),
                touched(&configured),
            ]
        })
        .collect();
    let story = format!(
        "P5 with one bending mode of {DAMPING_RATIO} of critical damping and {FROM_HZ} to {TO_HZ} Hz, sensors 30 mm outside the magnets, after six blows of {} to {} m/s at the centre. Touches and impulse are over those of levitation alone, where both recover. Struck on and on: twice the touches of levitation alone, and ten more. Levitation alone does not hold these for {HOLDS_S} s, and they do not count:",
        BLOWS_M_S[0], BLOWS_M_S[5]
    );
    Ok(Report {
        classes: values(&all),
        title: "Bending that is configured".to_owned(),
        claims,
        cases: (cases.len() * CONFIGURED.len()) as u64,
        chapters: vec![
            Chapter::new(
                "What was run",
                vec![Block::text(story), Block::List(not_held)],
            ),
            Chapter::new("What is configured", vec![Block::table(COLUMNS, rows)]),
            Chapter::folded("Not configured, by shape", vec![by_shape(0)]),
            Chapter::folded("Configured as it is, by shape", vec![by_shape(1)]),
            Chapter::folded(
                "By frequency",
                vec![Block::table(
                    [
                        "frequency [Hz]",
                        "lost, not configured",
                        "lost, configured",
                        "touches, not configured",
                        "touches, configured",
                    ],
                    by_hz,
                )],
            ),
        ],
    })
}
