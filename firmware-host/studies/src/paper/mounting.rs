//! Chapter: the ring on a compliant mounting, with whirl at two frequencies at once.

mod spectrum;

use self::spectrum::Spectrum;
use super::whirl_runs::{at_the_wall, fastest_hz, footnote_4, ring};
use super::{
    Axis, Chapter, Chart, Curve, Drawing, Extent, Figure, Kind, Mark, PaperError, Row, Stated,
    Table,
};
use plant_model::analysis::black::SteadyWhirl;
use plant_model::params::{PlantParams, StatorParams};
use plant_model::{Inputs, Options, V2, build};
use std::f64::consts::TAU;

/// The ring \[kg\] and its natural frequency on the mounting \[Hz\]: the paper's.
const RING_KG: f64 = 10.0;
const MOUNTING_HZ: f64 = 60.0;
/// What of the ring moves with the contact point in its second (oval) mode \[kg\], and the stiffness against the
/// rest \[N/m\]: chosen, so that the upper whirl limit is near the 400 Hz measured.
const MOVING_KG: f64 = 2.0;
const OVAL_N_M: f64 = 3.5e7;
/// Damping ratio of both modes of the ring: assumed.
const DAMPING_RATIO: f64 = 0.02;
const SPIN_HZ: f64 = 80.0;
const IMPACT_M_S: f64 = 0.8;
const CONTACT_N_M: f64 = 1e9;
/// Between samples \[s\].
const SAMPLE_S: f64 = 50e-6;
/// Whirl counts as over at this spin \[Hz\].
const LAST_SPIN_HZ: f64 = 2.0;
/// The spectrum begins here \[s\]: contact has become continuous.
const FIRST_S: f64 = 0.02;
/// Between the slow and the fast motion \[Hz\].
const DIVIDE_HZ: f64 = 150.0;
const SOURCE: &str = "Results, test with a compliant stator";

fn mounted() -> PlantParams {
    let mounting_rate = TAU * MOUNTING_HZ;
    let rest_kg = RING_KG - MOVING_KG;
    let reduced_kg = MOVING_KG * rest_kg / RING_KG;
    let stator = StatorParams::TwoMass {
        inner: ring(
            MOVING_KG,
            OVAL_N_M,
            2.0 * DAMPING_RATIO * (OVAL_N_M * reduced_kg).sqrt(),
        ),
        outer: ring(
            rest_kg,
            RING_KG * mounting_rate * mounting_rate,
            2.0 * DAMPING_RATIO * RING_KG * mounting_rate,
        ),
    };
    PlantParams {
        stator,
        ..footnote_4(CONTACT_N_M)
    }
}

/// The same ring as one rigid mass on its mounting.
fn rigid_ring() -> PlantParams {
    let rate = TAU * MOUNTING_HZ;
    PlantParams {
        stator: StatorParams::OneMass(ring(
            RING_KG,
            RING_KG * rate * rate,
            2.0 * DAMPING_RATIO * RING_KG * rate,
        )),
        ..footnote_4(CONTACT_N_M)
    }
}

/// What a run leaves for the spectra, sampled while the spin lasts.
#[derive(Debug, Default)]
struct Record {
    rotor_m: Vec<V2>,
    ring_m: Vec<V2>,
    force_n: Vec<V2>,
    rotor_peak_m: f64,
    ring_peak_m: f64,
    end_s: f64,
    /// Time in contact as a share of the record.
    contact_share: f64,
}

fn record(params: &PlantParams) -> Result<Record, PaperError> {
    let start = at_the_wall(params, IMPACT_M_S, SPIN_HZ);
    let mut plant = build(params, &start, Options::default())?;
    let mut record = Record::default();
    let mut touching = 0_u32;
    for i in 1..=20_000 {
        let t = f64::from(i) * SAMPLE_S;
        plant.advance(t, &Inputs::default(), &mut |_| {})?;
        let now = plant.snapshot();
        let ring_m = now.inner_ring.position;
        record.rotor_peak_m = record.rotor_peak_m.max(now.position_m.norm());
        record.ring_peak_m = record.ring_peak_m.max(ring_m.norm());
        if t < FIRST_S {
            continue;
        }
        if now.spin_rad_s < LAST_SPIN_HZ * TAU {
            record.end_s = t;
            record.contact_share = f64::from(touching) / record.force_n.len() as f64;
            return Ok(record);
        }
        let apart = now.position_m - ring_m;
        record.rotor_m.push(now.position_m);
        record.ring_m.push(ring_m);
        record
            .force_n
            .push(now.normal_force_n * apart / apart.norm());
        touching += u32::from(now.mode.in_contact());
    }
    Err(PaperError::Missing(
        "the rotor on the mounting did not stop".to_owned(),
    ))
}

/// Computes the chapter; both extents are the same.
pub(super) fn chapter(_: Extent) -> Result<Chapter, PaperError> {
    let params = mounted();
    let run = record(&params)?;
    let [rotor, ring, force] =
        [&run.rotor_m, &run.ring_m, &run.force_n].map(|s| Spectrum::of(s, SAMPLE_S));
    let slow = rotor.highest(|hz| hz.abs() < DIVIDE_HZ);
    let fast = rotor.highest(|hz| hz.abs() > DIVIDE_HZ);
    let ring_slow = ring.highest(|hz| hz.abs() < DIVIDE_HZ);
    let ring_fast = ring.highest(|hz| hz.abs() > DIVIDE_HZ);
    let force_slow = force.highest(|hz| hz.abs() < DIVIDE_HZ);
    let force_fast = force.highest(|hz| hz.abs() > DIVIDE_HZ);
    let force_share = force.power_share(|hz| hz.abs() > DIVIDE_HZ);
    let one_mass = rigid_ring();
    let one_mass_hz = fastest_hz(&one_mass, SPIN_HZ, 0.1)?;
    let system = |params| {
        SteadyWhirl::from_params(params)
            .ok_or_else(|| PaperError::Missing("the mounting is not isotropic".to_owned()))
    };
    let (two_mass, one_mass) = (system(&params)?, system(&one_mass)?);
    let limit =
        (two_mass.sliding(DIVIDE_HZ, 5000.0).into_iter()).find(|c| c.attracts && c.exists());
    let rows = vec![
        Row::new(
            ("Stiffness of the oval mode", "N/m"),
            "not in the paper",
            (None, Some(OVAL_N_M)),
            Kind::Fitted,
            "fitted to the 400 Hz alone",
        ),
        Row::new(
            ("Slow motion of the rotor", "Hz"),
            SOURCE,
            (Some(50.0), Some(slow.frequency_hz.abs())),
            Kind::Predicted,
            format!(
                "{}; free vibration of rotor and ring together from the impact. Resolution {:.0} Hz",
                sense(slow.frequency_hz),
                rotor.resolution_hz
            ),
        ),
        Row::new(
            ("Fast whirl of the rotor", "Hz"),
            SOURCE,
            (Some(400.0), Some(fast.frequency_hz.abs())),
            Kind::Fitted,
            format!("{}; by the oval mode's stiffness", sense(fast.frequency_hz)),
        ),
        Row::new(
            ("Upper whirl limit by Black's condition", "Hz"),
            SOURCE,
            (Some(400.0), limit.map(|c| c.frequency_hz())),
            Kind::Fitted,
            format!(
                "growth rate of small disturbances {:.0} 1/s: {}",
                limit.map_or(f64::NAN, |c| c.growth_rate_s),
                if limit.is_some_and(|c| c.growth_rate_s < 0.0) {
                    "stable"
                } else {
                    "unstable, the whirl wanders about it"
                }
            ),
        ),
        Row::new(
            ("Largest displacement of the rotor", "mm"),
            SOURCE,
            (Some(1.0), Some(1e3 * run.rotor_peak_m)),
            Kind::Assumed,
            "paper: more than 1 mm; hangs on the impact, here 0.8 m/s",
        )
        .stated(Stated::AtLeast(1.0)),
        Row::new(
            ("Largest displacement of the ring", "mm"),
            SOURCE,
            (Some(1.0), Some(1e3 * run.ring_peak_m)),
            Kind::Assumed,
            "paper: more than 1 mm; no bending of rods in the model",
        )
        .stated(Stated::AtLeast(1.0)),
        Row::new(
            ("Share of the contact force's power above 150 Hz", ""),
            SOURCE,
            (None, Some(force_share)),
            Kind::Assumed,
            "paper: the fast motion governs force and torque, and alone the deceleration",
        ),
        Row::new(
            ("Force amplitude, fast over slow", ""),
            SOURCE,
            (None, Some(force_fast.amplitude / force_slow.amplitude)),
            Kind::Assumed,
            "paper: fast dominates",
        )
        .stated(Stated::AtLeast(1.0)),
        Row::new(
            ("Fastest whirl with the ring as one rigid mass", "Hz"),
            "Results, on Black's theory",
            (Some(400.0), Some(one_mass_hz)),
            Kind::Assumed,
            "misses, as it must: without the oval mode nothing holds the whirl but k_c",
        ),
    ];
    let peak_row = |name: &str, unit: f64, slow: spectrum::Peak, fast: spectrum::Peak| {
        let cell = |peak: spectrum::Peak| {
            format!(
                "{:.3} at {:+.0} Hz",
                unit * peak.amplitude,
                peak.frequency_hz
            )
        };
        vec![name.to_owned(), cell(slow), cell(fast)]
    };
    Ok(Chapter {
        title: "Stator on a compliant mounting",
        story: vec![
            format!("The rotor of footnote 4 in a ring of {RING_KG} kg on a mounting of {MOUNTING_HZ} Hz (the paper's), whose second (oval) mode is a mass of {MOVING_KG} kg on {OVAL_N_M:e} N/m (chosen for 400 Hz), both modes with a damping ratio of {DAMPING_RATIO} (assumed). Impact {IMPACT_M_S} m/s, spin {SPIN_HZ} Hz, no drive; spectra from {:.0} ms to {:.0} ms, where the spin has fallen to {LAST_SPIN_HZ} Hz; in contact for {:.0} % of that time.", 1e3 * FIRST_S, 1e3 * run.end_s, 100.0 * run.contact_share),
            "Rotor and ring swing together on mounting and shaft, wide and slow, and the rotor whirls in the ring at the same time, small and fast. Whirl accelerates as m·ω²: the fast motion carries the force and brakes the spin. A soft mounting does not bring the whirl down to the frequency of the ring on it.".to_owned(),
        ],
        rows,
        tables: vec![
            Table {
                caption: "Highest lines of the full spectra (Hann window); negative frequencies are backward".to_owned(),
                columns: ["", "Below 150 Hz", "Above 150 Hz"].map(str::to_owned).to_vec(),
                rows: vec![
                    peak_row("Rotor [mm]", 1e3, slow, fast),
                    peak_row("Ring [mm]", 1e3, ring_slow, ring_fast),
                    peak_row("Normal force [kN]", 1e-3, force_slow, force_fast),
                ],
            },
            steady(&two_mass, &one_mass),
        ],
        figures: vec![figure(&rotor, &force)],
    })
}

fn sense(frequency_hz: f64) -> &'static str {
    if frequency_hz < 0.0 {
        "backward"
    } else {
        "forward"
    }
}

/// Steady sliding whirl in both models of the ring.
fn steady(two: &SteadyWhirl, one: &SteadyWhirl) -> Table {
    let mut rows = Vec::new();
    for (name, whirl) in [("with oval mode", two), ("one mass", one)] {
        for circle in whirl.sliding(1.0, 5000.0) {
            rows.push(vec![
                name.to_owned(),
                format!("{:.1}", circle.frequency_hz()),
                if circle.exists() {
                    format!("{:.4}", circle.normal_force_n / 1e3)
                } else {
                    "needs a pull".to_owned()
                },
                if circle.attracts { "below" } else { "above" }.to_owned(),
                if circle.exists() {
                    format!("{:+.1}", circle.growth_rate_s)
                } else {
                    "–".to_owned()
                },
            ]);
        }
    }
    Table {
        caption: "Steady sliding whirl, k_c = 1e9 N/m".to_owned(),
        columns: [
            "Ring",
            "Whirl [Hz]",
            "N [kN]",
            "Friction drives",
            "Growth rate [1/s]",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows,
    }
}

fn figure(rotor: &Spectrum, force: &Spectrum) -> Figure {
    let curve = |name: &str, spectrum: &Spectrum, colour| {
        let shown = || spectrum.lines.iter().filter(|(hz, _)| hz.abs() <= 800.0);
        let highest = shown().map(|line| line.1).fold(f64::MIN_POSITIVE, f64::max);
        Curve {
            name: format!("{name}, over its highest line"),
            points: shown()
                .map(|(hz, amplitude)| (*hz, amplitude / highest))
                .collect(),
            mark: Mark::Line,
            colour,
        }
    };
    Figure {
        file: "mounting-spectrum",
        caption: "Full spectrum of x + iy while the spin lasts: the slow motion is large in the displacement, the fast backward whirl in the force.".to_owned(),
        drawing: Drawing::Chart(Chart {
            label: "Full spectrum of rotor displacement and contact force".to_owned(),
            x: Axis {
                name: "Frequency, backward negative [Hz]".to_owned(),
                range: (-800.0, 800.0),
                log: false,
            },
            y: Axis {
                name: "Amplitude over the highest".to_owned(),
                range: (0.0, 1.05),
                log: false,
            },
            curves: vec![
                curve("rotor displacement", rotor, 0),
                curve("contact force", force, 1),
            ],
        }),
    }
}
