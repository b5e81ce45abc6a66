//! What is fitted, what is predicted, and how far that is off.

use super::record::{Record, RecordError};
use super::rig::{Flight, Impact, Ran, Rig, TRANSDUCER_N_M, Touch, rms_m};
use crate::campaign::{
    Block, Chapter, Claim, Drawing, Extent, Figure, Progress, Report, StudyError,
};
use firmware_bench::report::plot::chart::{Axis, Chart, Curve, Mark};
use firmware_bench::report::plot::text::figures;
use plant_model::V2;
use std::path::Path;

/// Ends of what is compared \[s\]: of the flight before the impact, to which seven numbers are fitted; behind it; of the record.
const ENDS_S: [f64; 3] = [0.066, 0.0875, 0.143];
/// What tells of the first impact, and of the second one: with flight on both sides \[s\].
const ABOUT_S: [(f64, f64); 2] = [(0.056, 0.080), (0.106, 0.130)];
/// Lengths of the first impact that are tried \[ms\].
const LENGTHS_MS: [f64; 6] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
/// Fits beside those.
const FITS: u64 = 8;

/// Says what it needs.
///
/// # Errors
/// Always: there is no record.
pub fn study(_: Extent, _: &dyn Progress) -> Result<Report, StudyError> {
    Err(Box::new(RecordError::new(
        "a measured record is compared, and none is given",
        "give its file by --record FILE.csv; docs/src/measured/validation.md says where it comes from",
    )))
}

/// A record with the flight that is nearest to its beginning.
struct Compared<'a> {
    record: &'a Record,
    rig: Rig,
    flight: Flight,
    progress: &'a dyn Progress,
}

impl Compared<'_> {
    /// What there is of a record about an impact: its part, the rig with the force of that, and how a flight begins there.
    fn about(
        &self,
        of: &Record,
        (from_s, to_s): (f64, f64),
    ) -> Result<(Record, Rig, Flight), StudyError> {
        let samples = of.samples_to(from_s)..of.samples_to(to_s);
        let begin = self.rig.later(&self.flight, samples.start)?;
        let part = of.part(samples);
        let rig = Rig::new(&part)?;
        self.progress.add(1);
        Ok((part, rig, begin))
    }

    /// An impact as a record tells it.
    fn impact(
        &self,
        of: &Record,
        about_s: (f64, f64),
        long_s: Option<f64>,
    ) -> Result<Impact, StudyError> {
        let (part, rig, begin) = self.about(of, about_s)?;
        let mut impact = rig.impact(&part, &begin, long_s)?;
        impact.at_s += of.samples_to(about_s.0) as f64 * of.period_s;
        Ok(impact)
    }

    /// Both.
    fn impacts(&self, of: &Record) -> Result<[Impact; 2], StudyError> {
        let [first, second] = ABOUT_S.map(|about_s| self.impact(of, about_s, None));
        Ok([first?, second?])
    }

    /// What a run is off at the ends \[mm\].
    fn off_mm(&self, ran: &Ran) -> [f64; 3] {
        ENDS_S.map(|end_s| {
            let samples = self.record.samples_to(end_s);
            1e3 * rms_m(&ran.disc_m, &self.record.disc_m, samples)
        })
    }
}

/// Puts the plant beside the record in a file.
///
/// # Errors
/// [`RecordError`]; a run that cannot be trusted.
pub fn on_record(path: &Path, _: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let record = Record::read(path)?;
    let [flown, behind, all] = ENDS_S.map(|end_s| record.samples_to(end_s));
    if (all as f64 + 1.0) * record.period_s < ENDS_S[2] {
        let message = format!("{}: ends before {} s", path.display(), ENDS_S[2]);
        let help = "give a record of flight up to 66 ms and impacts about 68 and 118 ms";
        return Err(Box::new(RecordError::new(message, help)));
    }
    progress.begin(FITS + LENGTHS_MS.len() as u64, "fits");
    let rig = Rig::new(&record)?;
    let compared = Compared {
        record: &record,
        flight: rig.fit_flight(&record, flown)?,
        rig,
        progress,
    };
    let Compared { rig, flight, .. } = &compared;
    progress.add(1);
    let impacts = compared.impacts(&record)?;
    let (part, near, begin) = compared.about(&record, ABOUT_S[0])?;
    let touch = near.touch(&part, &begin, &impacts[0])?;
    let fitted = near.fit_touch(&part, &begin, &touch)?;
    let level = rig.clone().without_gyroscopics();
    let level_flight = level.fit_flight(&record, flown)?;
    progress.add(1);

    let of_the_thesis = Touch::of_the_thesis(impacts[0].normal_m_s[0]);
    let at_wall = |other: Touch| Touch {
        clearance_m: touch.clearance_m,
        ..other
    };
    let rough = Touch {
        friction: of_the_thesis.friction,
        ..touch
    };
    let housed = rig.clone().with_house();
    let all_fitted = format!(
        "all three fitted at once: {} N/m, restitution {:.3}, {:.3} mm",
        figures(fitted.stiffness_n_m),
        fitted.restitution,
        1e3 * fitted.clearance_m
    );
    let variants = [
        ("as read off", rig, flight, touch),
        ("the same, friction 0.2", rig, flight, rough),
        (
            "the same, no gyroscopic moment",
            &level,
            &level_flight,
            touch,
        ),
        (&all_fitted, rig, flight, fitted),
        ("of the thesis, 2.0 mm", rig, flight, of_the_thesis),
        (
            "of the thesis, clearance as read off",
            rig,
            flight,
            at_wall(of_the_thesis),
        ),
        (
            "the same, its bearing in its house",
            &housed,
            flight,
            at_wall(of_the_thesis),
        ),
        (
            "2e8 N/m, restitution 0.5, friction 0.2, 2.0 mm",
            rig,
            flight,
            Touch::STIFF,
        ),
        (
            "the same, clearance as read off",
            rig,
            flight,
            at_wall(Touch::STIFF),
        ),
        ("none", rig, flight, Touch::NONE),
    ];
    let mut rows = Vec::new();
    for (name, rig, flight, touch) in &variants {
        let ran = rig.run(flight, touch, all)?;
        let first = rig.run(flight, touch, behind)?;
        let [a, b, c] = compared.off_mm(&ran).map(|mm| format!("{mm:.4}"));
        let impulse = format!("{:.4}", first.normal_impulse_n_s);
        rows.push([
            (*name).to_owned(),
            ran.touches.to_string(),
            impulse,
            a,
            b,
            c,
        ]);
    }
    let ran = rig.run(flight, &touch, all)?;
    let impulse_n_s = rig.run(flight, &touch, behind)?.normal_impulse_n_s;
    let own = compared.impacts(&Record {
        disc_m: ran.disc_m.clone(),
        exciter_n: record.exciter_n[..all].to_vec(),
        ..record
    })?;
    let mut lengths = Vec::new();
    for long_ms in LENGTHS_MS {
        let tried = compared.impact(&record, ABOUT_S[0], Some(1e-3 * long_ms))?;
        let stiffness_n_m = rig.stiffness_n_m(&tried);
        lengths.push([
            format!("{long_ms}"),
            figures(stiffness_n_m),
            format!("{:.1}", 1e6 * tried.rms_m),
        ]);
    }
    let off_mm = compared.off_mm(&ran);
    let off_impulse = (impulse_n_s / impacts[0].normal_n_s - 1.0).abs();
    let claims = vec![
        Claim::at_most("flight to 66 ms: off, mm", 0.02, off_mm[0]),
        Claim::at_most("with the impact, to 87.5 ms: off, mm", 0.025, off_mm[1]),
        Claim::at_most("to the end, 143 ms: off, mm", 0.08, off_mm[2]),
        Claim::at_most(
            "normal impulse of the impact: off, share",
            0.05,
            off_impulse,
        ),
    ];
    Ok(Report {
        title: "Beside a measurement".to_owned(),
        claims,
        cases: (variants.len() + LENGTHS_MS.len()) as u64,
        classes: Vec::new(),
        chapters: vec![
            fitted_numbers(flight, &touch),
            impact_table((&impacts, &own), impulse_n_s, course(&record, &ran)),
            Chapter::new(
                "Other contacts",
                vec![
                    Block::text(
                        "The same flight with other contacts: root mean squares of the distance at the disc from the start, in mm.",
                    ),
                    Block::table(
                        [
                            "contact",
                            "touches",
                            "N s to 87.5 ms",
                            "66 ms",
                            "87.5 ms",
                            "143 ms",
                        ],
                        rows,
                    ),
                ],
            ),
            Chapter::new(
                "How long the impact lasts",
                vec![
                    Block::text(format!(
                        "Half a sine of this length in the place of the wall, everything else fitted to 56 to 80 ms. One force transducer has {} N/m.",
                        figures(TRANSDUCER_N_M)
                    )),
                    Block::table(["ms", "stiffness, N/m", "off, µm"], lengths),
                ],
            ),
        ],
    })
}

fn fitted_numbers(flight: &Flight, touch: &Touch) -> Chapter {
    let pair = |v: V2, per: f64| format!("{:.3}, {:.3}", per * v.x, per * v.y);
    let row = |name: &str, value: String, by: &str| [name.to_owned(), value, by.to_owned()];
    let (flown, behind) = ("flight to 66 ms", "56 to 80 ms");
    let rows = [
        row("tilt at the start, mrad", pair(flight.tilt_rad, 1e3), flown),
        row("its rate, rad/s", pair(flight.tilt_rate_rad_s, 1.0), flown),
        row(
            "unbalance, 1e-5 kg m",
            pair(flight.unbalance_kg_m, 1e5),
            flown,
        ),
        row("spin, Hz", format!("{:.2}", flight.spin_hz), flown),
        row(
            "contact stiffness, N/m",
            figures(touch.stiffness_n_m),
            behind,
        ),
        row("restitution", format!("{:.3}", touch.restitution), behind),
        row(
            "clearance, mm",
            format!("{:.3}", 1e3 * touch.clearance_m),
            behind,
        ),
    ];
    Chapter::new(
        "Fitted",
        vec![Block::table(["number", "value", "to"], rows)],
    )
}

/// Impacts by the record and by a run of the plant, read in the same way.
fn impact_table(
    (record, plant): (&[Impact; 2], &[Impact; 2]),
    impulse_n_s: f64,
    course: Block,
) -> Chapter {
    let all = [&record[0], &plant[0], &record[1], &plant[1]];
    let row = |name: &str, cell: fn(&Impact) -> String| {
        let [a, b, c, d] = all.map(cell);
        [name.to_owned(), a, b, c, d]
    };
    let rows = [
        row("middle, ms", |i| format!("{:.2}", 1e3 * i.at_s)),
        row("length, ms", |i| format!("{:.1}", 1e3 * i.long_s)),
        row("direction, °", |i| {
            format!("{:.1}", i.angle_rad.to_degrees())
        }),
        row("speed before, mm/s", |i| {
            format!("{:.1}", 1e3 * i.normal_m_s[0])
        }),
        row("speed after, mm/s", |i| {
            format!("{:.1}", 1e3 * i.normal_m_s[1])
        }),
        row("normal impulse, N s", |i| format!("{:.4}", i.normal_n_s)),
        row("tangential over normal", |i| {
            format!("{:.3}", i.tangential_n_s / i.normal_n_s)
        }),
        row("off, µm", |i| format!("{:.1}", 1e6 * i.rms_m)),
    ];
    let columns = [
        "",
        "first, record",
        "first, plant",
        "second, record",
        "second, plant",
    ];
    let story = format!(
        "Read from record and plant in the same way: the push that, without a wall, makes the flight about it nearest. The plant's own wall gave {impulse_n_s:.4} N s in the first."
    );
    let blocks = vec![Block::text(story), Block::table(columns, rows), course];
    Chapter::new("Impacts", blocks)
}

fn course(record: &Record, ran: &Ran) -> Block {
    let curve = |name: &str, of: &[V2], axis: usize, mark: Mark, colour: usize| {
        let points = of.iter().enumerate();
        let points = points.map(|(i, at)| (1e3 * record.period_s * i as f64, 1e3 * at[axis]));
        Curve {
            name: name.to_owned(),
            points: points.collect(),
            mark,
            colour,
        }
    };
    let curves = vec![
        curve("x, plant", &ran.disc_m, 0, Mark::Line, 0),
        curve("x, record", &record.disc_m, 0, Mark::Dashed, 1),
        curve("y, plant", &ran.disc_m, 1, Mark::Line, 2),
        curve("y, record", &record.disc_m, 1, Mark::Dashed, 3),
    ];
    let text = "Disc, record and plant; the wall is touched about 68 and 118 ms.";
    Block::Figures(vec![Figure {
        file: "course".into(),
        caption: text.to_owned(),
        drawing: Drawing::Chart(Chart {
            label: text.to_owned(),
            x: Axis::linear("time, ms", (0.0, 1e3 * ENDS_S[2])),
            y: Axis::linear("disc, mm", (-0.8, 1.2)),
            curves,
        }),
    }])
}
