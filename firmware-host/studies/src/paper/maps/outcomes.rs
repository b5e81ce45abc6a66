//! Outcome over impact speed and one more parameter: sharp for the balanced rotor, with unbalance not monotone over the
//! impact speed.

use super::{Case, FRICTION, INCLINATION, Varied, linear};
use crate::impacts::{Grid, run_impacts};
use crate::paper::data::*;
use crate::paper::onset::impact;
use crate::paper::rotors::OnsetRig;
use plant_model::analysis::impact::{Criterion, Impact, ImpactOutcome, Outcome};

const SOURCE: &str = "Results, onset phase";

/// Outcomes over impact speed (columns) and something else (rows).
struct Outcomes {
    speeds_m_s: (f64, f64),
    grid: Grid,
    /// Number of impacts until v_t,crit for whirl; not a number otherwise.
    cells: Vec<Vec<f64>>,
    /// Runs that stayed undecided.
    undecided: usize,
}

impl Outcomes {
    /// Of a rig and an impact for each speed \[m/s\] and each place along the rows, as a share.
    fn run(
        speeds_m_s: (f64, f64),
        grid: Grid,
        case: impl Fn(f64, f64) -> (OnsetRig, Impact) + Sync + Send,
    ) -> Result<Self> {
        let of = |(across, up): &(f64, f64)| {
            let (rig, impact) = case(linear(speeds_m_s, *across), *up);
            Ok((rig.params()?, impact))
        };
        let cases = grid.places().iter().map(of).collect::<Result<Vec<_>>>()?;
        let runs = grid.rows(&run_impacts(&cases, &Criterion::default())?);
        let undecided = |run: &&ImpactOutcome| run.outcome == Outcome::Undecided;
        let shade = |run: &ImpactOutcome| match run.outcome {
            Outcome::Whirl => run.impacts_to_threshold.map_or(f64::NAN, f64::from),
            Outcome::Free | Outcome::Undecided => f64::NAN,
        };
        Ok(Self {
            speeds_m_s,
            grid,
            undecided: runs.iter().flatten().filter(undecided).count(),
            cells: (runs.iter().map(|row| row.iter().map(shade).collect())).collect(),
        })
    }

    /// How often the outcome changes between whirl and not whirl along a row, at most.
    fn most_changes(&self) -> usize {
        let change = |pair: &&[f64]| pair[0].is_nan() != pair[1].is_nan();
        let changes = |row: &Vec<f64>| row.windows(2).filter(change).count();
        self.cells.iter().map(changes).max().unwrap_or(0)
    }

    /// Impact speeds \[m/s\] with which some run whirls, or some does not.
    fn speeds_m_s(&self, whirls: bool) -> impl DoubleEndedIterator<Item = f64> {
        let any = move |i: &usize| self.cells.iter().any(|row| row[*i].is_nan() != whirls);
        let speed_m_s = |i| linear(self.speeds_m_s, Grid::middle(i, self.grid.columns));
        (0..self.grid.columns).filter(any).map(speed_m_s)
    }

    fn figure(&self, file: &'static str, caption: String, y: Axis) -> Figure {
        // The darkest colour is ten impacts.
        let scale = "impacts until whirl (10: or more; white: no whirl)";
        let map = HeatMap {
            label: caption.clone(),
            x: Axis::linear("impact speed [m/s]", self.speeds_m_s),
            y,
            names: Default::default(),
            cells: self.cells.clone(),
            scale: (1.0, 10.0, scale.to_owned()),
        };
        Figure {
            file: file.into(),
            caption,
            drawing: Drawing::Map(map),
        }
    }
}

fn most(all: &[Outcomes]) -> f64 {
    let changes = all.iter().map(|of| of.most_changes() as f64);
    changes.fold(0.0, f64::max)
}

/// Adds what the balanced rotor does over two parameters.
pub(super) fn balanced(chapter: &mut Chapter, case: &Case, extent: Extent) -> Result<()> {
    let (columns, rows) = extent.pick((50, 24), (150, 90));
    let of = |varied: Varied, speeds_m_s| {
        Outcomes::run(speeds_m_s, Grid { columns, rows }, |speed_m_s, up| {
            let case = case.with(varied, linear(varied.range, up));
            (case.rig, impact(speed_m_s, case.inclination_rad))
        })
    };
    let all = [of(INCLINATION, (0.02, 0.25))?, of(FRICTION, (0.02, 0.3))?];
    let files = ["maps_outcome_inclination", "maps_outcome_friction"];
    for ((outcomes, file), varied) in all.iter().zip(files).zip([INCLINATION, FRICTION]) {
        let caption = format!(
            "Outcome over impact speed and {}: colour is whirl and the impacts until v_t,crit, white is no whirl.",
            varied.name
        );
        chapter
            .figures
            .push(outcomes.figure(file, caption, varied.axis()));
    }
    chapter.rows.extend(rows! {
        "Changes of the outcome over impact speed, balanced: most", "", SOURCE, 1.0 => most(&all), Predicted,
            "both maps of outcomes; the paper: unambiguous and reproducible";
    });
    Ok(())
}

/// Adds what unbalance does: unbalance and spin of each line of the table, and two maps over the phase of the unbalance
/// at the touch.
pub(super) fn unbalanced(chapter: &mut Chapter, rig: &OnsetRig, extent: Extent) -> Result<()> {
    const UNBALANCE_UM: [f64; 8] = [0.0, 2.0, 5.0, 10.0, 20.0, 10.0, 10.0, 2.0];
    const SPIN_HZ: [f64; 8] = [40.0, 40.0, 40.0, 40.0, 40.0, 20.0, 100.0, 100.0];
    let (columns, rows) = extent.pick((50, 12), (150, 72));
    let of = |unbalance_um: f64, spin_hz: f64| {
        Outcomes::run((0.04, 0.14), Grid { columns, rows }, |speed_m_s, up| {
            let (mut rig, mut impact) = (*rig, impact(speed_m_s, 0.0));
            rig.eccentricity_m = 1e-6 * unbalance_um;
            impact.spin_rad_s = TAU * spin_hz;
            impact.spin_phase_rad = TAU * up;
            (rig, impact)
        })
    };
    let all = UNBALANCE_UM.iter().zip(SPIN_HZ).map(|(um, hz)| of(*um, hz));
    let all: Vec<Outcomes> = all.collect::<Result<_>>()?;
    for (i, file) in [
        (4, "maps_outcome_unbalance_40_hz"),
        (6, "maps_outcome_unbalance_100_hz"),
    ] {
        let (um, hz) = (UNBALANCE_UM[i], SPIN_HZ[i]);
        let caption = format!(
            "Outcome with an unbalance of {um} µm at {hz} Hz over impact speed and phase of the unbalance at the touch: whirl and no whirl alternate. Colour is the number of impacts until v_t,crit; white is no whirl within 3 s."
        );
        let phase = Axis::linear("phase of the unbalance [°]", (0.0, 360.0));
        chapter.figures.push(all[i].figure(file, caption, phase));
    }
    chapter.rows.extend(rows! {
        "Changes of the outcome over impact speed, unbalanced: most", "", SOURCE, 1.0 => most(&all), Assumed,
            "unbalance assumed, up to 20 µm; the paper leaves it out of its onset and reports a sharp limit";
    });
    chapter.tables.push(table! {
        "Outcome over {columns} impact speeds and {rows} phases of the unbalance, radial impact";
        for (i, of) in all.iter().enumerate();
        "Unbalance ε [µm]" => "{}", UNBALANCE_UM[i];
        "Spin [Hz]" => "{}", SPIN_HZ[i];
        "Lowest speed with whirl [m/s]" => "{}", or_dash(of.speeds_m_s(true).next(), 4);
        "Highest speed without [m/s]" => "{}", or_dash(of.speeds_m_s(false).next_back(), 4);
        "Changes over speed at one phase: most" => "{}", of.most_changes();
        "Undecided runs" => "{}", of.undecided;
    });
    Ok(())
}
