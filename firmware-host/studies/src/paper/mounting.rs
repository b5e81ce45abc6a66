//! Chapter: the ring on a compliant mounting, with whirl at two frequencies at once.

mod spectrum;

use self::spectrum::{Line, Spectrum};
use super::data::*;
use super::limits::{drives, force_kn};
use super::rotors::{footnote_4_at, ring};
use super::runs::{Run, at_the_wall, fastest_hz, watch};
use plant_model::V2;
use plant_model::analysis::black::{Circle, SteadyWhirl};
use plant_model::analysis::course::Sample;
use plant_model::params::{RingParams, StatorParams};

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

/// A ring with the damping ratio of this chapter, that of its reduced mass.
fn damped(mass_kg: f64, reduced_kg: f64, stiffness_n_m: f64) -> RingParams {
    let damping_n_s_m = 2.0 * DAMPING_RATIO * (stiffness_n_m * reduced_kg).sqrt();
    ring(mass_kg, stiffness_n_m, damping_n_s_m)
}

/// The rotor in the ring on its mounting: with its oval mode, or as one rigid mass.
fn mounted(oval: bool) -> PlantParams {
    let rest_kg = RING_KG - MOVING_KG;
    let mounting_n_m = RING_KG * (TAU * MOUNTING_HZ).powi(2);
    let stator = match oval {
        true => StatorParams::TwoMass {
            inner: damped(MOVING_KG, MOVING_KG * rest_kg / RING_KG, OVAL_N_M),
            outer: damped(rest_kg, RING_KG, mounting_n_m),
        },
        false => StatorParams::OneMass(damped(RING_KG, RING_KG, mounting_n_m)),
    };
    PlantParams {
        stator,
        ..footnote_4_at(CONTACT_N_M)
    }
}

/// A motion of the record: its spectrum with the highest lines of the slow and of the fast motion.
struct Motion {
    spectrum: Spectrum,
    slow: Line,
    fast: Line,
}

impl Motion {
    fn of(record: &[Sample], vector: impl Fn(&Sample) -> V2) -> Self {
        let samples: Vec<V2> = record.iter().map(vector).collect();
        let spectrum = Spectrum::of(&samples, SAMPLE_S);
        Self {
            slow: spectrum.highest(|hz| hz.abs() < DIVIDE_HZ),
            fast: spectrum.highest(|hz| hz.abs() > DIVIDE_HZ),
            spectrum,
        }
    }
}

/// What a run leaves while the spin lasts.
struct Record {
    rotor: Motion,
    ring: Motion,
    force: Motion,
    rotor_peak_m: f64,
    ring_peak_m: f64,
    end_s: f64,
    /// Time in contact as a share of what the spectra are of.
    contact_share: f64,
}

fn record(params: &PlantParams) -> Result<Record> {
    let watch = watch(SAMPLE_S, 1.0, f64::INFINITY);
    let start = at_the_wall(params, IMPACT_M_S, SPIN_HZ);
    let samples = Run::of(params, &start, &watch)?.course.samples;
    let over = |s: &Sample| s.t_s >= FIRST_S && s.spin_hz < LAST_SPIN_HZ;
    let end = samples.iter().position(over);
    let end = end.or_missing("the rotor on the mounting did not stop")?;
    let first = samples.partition_point(|s| s.t_s < FIRST_S);
    let record = &samples[first..end];
    let peak_m = |of: fn(&Sample) -> V2| {
        let sizes = samples[..=end].iter().map(|s| of(s).norm());
        sizes.fold(0.0, f64::max)
    };
    let touching = record.iter().filter(|s| s.mode.in_contact()).count();
    Ok(Record {
        rotor: Motion::of(record, |s| s.position_m),
        ring: Motion::of(record, |s| s.inner_ring_m),
        force: Motion::of(record, |s| {
            let apart = s.position_m - s.inner_ring_m;
            s.normal_force_n * apart / apart.norm()
        }),
        rotor_peak_m: peak_m(|s| s.position_m),
        ring_peak_m: peak_m(|s| s.inner_ring_m),
        end_s: samples[end].t_s,
        contact_share: touching as f64 / record.len() as f64,
    })
}

/// Computes the chapter; both extents are the same.
pub(super) fn chapter(_: Extent) -> Result<Chapter> {
    let run = record(&mounted(true))?;
    let [oval, rigid] = [true, false].map(|oval| SteadyWhirl::from_params(&mounted(oval)));
    let (oval, rigid) = (oval.zip(rigid)).or_missing("the mounting is not isotropic")?;
    let above = oval.sliding(DIVIDE_HZ, 5000.0).into_iter();
    let limit = above.into_iter().find(|c| c.attracts && c.exists());
    Ok(Chapter {
        title: "Stator on a compliant mounting",
        story: vec![
            format!("The rotor of footnote 4 in a ring of {RING_KG} kg on a mounting of {MOUNTING_HZ} Hz (the paper's), whose second (oval) mode is a mass of {MOVING_KG} kg on {OVAL_N_M:e} N/m (chosen for 400 Hz), both modes with a damping ratio of {DAMPING_RATIO} (assumed). Impact {IMPACT_M_S} m/s, spin {SPIN_HZ} Hz, no drive; spectra from {:.0} ms to {:.0} ms, where the spin has fallen to {LAST_SPIN_HZ} Hz; in contact for {:.0} % of that time.", 1e3 * FIRST_S, 1e3 * run.end_s, 100.0 * run.contact_share),
            "Rotor and ring swing together on mounting and shaft, wide and slow, and the rotor whirls in the ring at the same time, small and fast. Whirl accelerates as m·ω²: the fast motion carries the force and brakes the spin. A soft mounting does not bring the whirl down to the frequency of the ring on it.".to_owned(),
        ],
        rows: rows(&run, limit)?,
        tables: vec![peaks(&run), steady(&oval, &rigid)],
        figures: vec![figure(&run)],
    })
}

fn rows(run: &Record, limit: Option<Circle>) -> Result<Vec<Row>> {
    let (slow_hz, fast_hz) = (run.rotor.slow.frequency_hz, run.rotor.fast.frequency_hz);
    let sense = |hz: f64| if hz < 0.0 { "backward" } else { "forward" };
    let growth = limit.map_or(f64::NAN, |circle| circle.growth_rate_s);
    let stability = match growth < 0.0 {
        true => "stable",
        false => "unstable, the whirl wanders about it",
    };
    let force = &run.force;
    let above = force.spectrum.power_share(|hz| hz.abs() > DIVIDE_HZ);
    let rigid_hz = fastest_hz(&mounted(false), SPIN_HZ, 0.1)?;
    Ok(rows! {
        "Stiffness of the oval mode", "N/m", "not in the paper", Silent => OVAL_N_M, Fitted, "fitted to the 400 Hz alone";
        "Slow motion of the rotor", "Hz", SOURCE, 50.0 => slow_hz.abs(), Predicted,
            "{}; free vibration of rotor and ring together from the impact. Resolution {:.0} Hz", sense(slow_hz), run.rotor.spectrum.resolution_hz;
        "Fast whirl of the rotor", "Hz", SOURCE, 400.0 => fast_hz.abs(), Fitted, "{}; by the oval mode's stiffness", sense(fast_hz);
        "Upper whirl limit by Black's condition", "Hz", SOURCE, 400.0 => limit.map(|c| c.frequency_hz()), Fitted,
            "growth rate of small disturbances {growth:.0} 1/s: {stability}";
        "Largest displacement of the rotor", "mm", SOURCE, AtLeast(1.0) => 1e3 * run.rotor_peak_m, Assumed,
            "paper: more than 1 mm; hangs on the impact, here 0.8 m/s";
        "Largest displacement of the ring", "mm", SOURCE, AtLeast(1.0) => 1e3 * run.ring_peak_m, Assumed, "paper: more than 1 mm; no bending of rods in the model";
        "Share of the contact force's power above 150 Hz", "", SOURCE, Silent => above, Assumed,
            "paper: the fast motion governs force and torque, and alone the deceleration";
        "Force amplitude, fast over slow", "", SOURCE, AtLeast(1.0) => force.fast.amplitude / force.slow.amplitude, Assumed, "paper: fast dominates";
        "Fastest whirl with the ring as one rigid mass", "Hz", "Results, on Black's theory", 400.0 => rigid_hz, Assumed,
            "misses, as it must: without the oval mode nothing holds the whirl but k_c";
    })
}

fn peaks(run: &Record) -> Table {
    let cell = |line: Line, unit: f64| {
        let (size, hz) = (unit * line.amplitude, line.frequency_hz);
        format!("{size:.3} at {hz:+.0} Hz")
    };
    let motions = [
        ("Rotor [mm]", &run.rotor, 1e3),
        ("Ring [mm]", &run.ring, 1e3),
        ("Normal force [kN]", &run.force, 1e-3),
    ];
    table! {
        "Highest lines of the full spectra (Hann window); negative frequencies are backward";
        for (name, motion, unit) in motions;
        "" => "{name}";
        "Below 150 Hz" => "{}", cell(motion.slow, unit);
        "Above 150 Hz" => "{}", cell(motion.fast, unit);
    }
}

/// Steady sliding whirl in both models of the ring.
fn steady(oval: &SteadyWhirl, rigid: &SteadyWhirl) -> Table {
    let circles = [("with oval mode", oval), ("one mass", rigid)]
        .into_iter()
        .flat_map(|(name, whirl)| {
            whirl
                .sliding(1.0, 5000.0)
                .into_iter()
                .map(move |c| (name, c))
        });
    table! {
        "Steady sliding whirl, k_c = 1e9 N/m";
        for (name, circle) in circles;
        "Ring" => "{name}";
        "Whirl [Hz]" => "{:.1}", circle.frequency_hz();
        "N [kN]" => "{}", force_kn(&circle).map_or("needs a pull".to_owned(), |kn| format!("{kn:.4}"));
        "Friction drives" => "{}", drives(&circle);
        "Growth rate [1/s]" => "{}", if circle.exists() { format!("{:+.1}", circle.growth_rate_s) } else { or_dash(None, 1) };
    }
}

fn figure(run: &Record) -> Figure {
    let over_highest = |motion: &Motion| -> Vec<(f64, f64)> {
        let shown = |hz: f64| hz.abs() <= 800.0;
        let highest = motion.spectrum.highest(shown).amplitude;
        let lines = motion.spectrum.lines.iter();
        (lines.filter(|line| shown(line.frequency_hz)))
            .map(|line| (line.frequency_hz, line.amplitude / highest))
            .collect()
    };
    chart! {
        "mounting-spectrum", "Full spectrum of rotor displacement and contact force",
        "Full spectrum of x + iy while the spin lasts: the slow motion is large in the displacement, the fast backward whirl in the force.";
        Axis::linear("Frequency, backward negative [Hz]", (-800.0, 800.0)), Axis::linear("Amplitude over the highest", (0.0, 1.05));
        curves! {
            "rotor displacement, over its highest line", Line, 0 => over_highest(&run.rotor);
            "contact force, over its highest line", Line, 1 => over_highest(&run.force);
        }
    }
}
