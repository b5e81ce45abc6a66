//! Chapter: retainer bearing. The same impact against a bushing and against ball bearings whose race
//! spins up.

mod figures;
mod onset;
mod runs;

use self::runs::{Tried, sustained_hz, sustaining_drag_n_m_s, with_race};
use super::data::*;
use super::rotors::footnote_4_at;
use plant_model::params::SpinParams;

/// Spin at the start \[Hz\].
const SPIN_HZ: f64 = 40.0;
/// Radial speed at the wall \[m/s\].
const IMPACT_M_S: f64 = 0.4;
/// Races from heavy to light \[kg m²\]; the first of a quick run are those of the rows.
const INERTIAS_KG_M2: [f64; 9] = [1e-1, 1e-2, 3e-3, 1e-3, 3e-4, 3e-2, 6e-3, 2e-3, 1e-4];
/// Race of the rows and of the table of drags \[kg m²\].
const LIGHT_KG_M2: f64 = 1e-3;
const SOURCE: &str = "Conclusions and recommendations";

/// Footnote 4.
fn rotor() -> PlantParams {
    footnote_4_at(1e9)
}

/// A bushing, and races from heavy to light.
fn races(extent: Extent) -> Result<Vec<Tried>> {
    let mut inertias = INERTIAS_KG_M2[..extent.pick(5, 9)].to_vec();
    inertias.sort_by(|a, b| b.total_cmp(a));
    let all: Vec<Option<f64>> = [None]
        .into_iter()
        .chain(inertias.into_iter().map(Some))
        .collect();
    each(&all, |inertia| {
        Tried::run(&with_race(&rotor(), *inertia, 0.0), 0.5)
    })
}

/// Computes the chapter. Both extents give the same rows; a quick run has fewer races.
pub(super) fn chapter(extent: Extent) -> Result<Chapter> {
    let mut chapter = Chapter::new(
        "Retainer bearing",
        [
            "The paper recommends ball bearings as retainer bearings, to lower the friction between rotor and stator, and gives no number. Here the ring's surface is a race with an inertia J_i and a viscous drag b: J_i·dΩ_i/dt = −R_i·s − b·Ω_i. Rotor and stator of footnote 4 with k_c = 1e9 N/m, J_r = 0.05 kg m², R_r = 0.1 m; start at the wall with 0.4 m/s outwards, 40 Hz, no drive; race at rest. Constants of races are assumed; balls, cage, preload and load-dependent friction are not modelled.",
            "What it does: friction takes slip away from the race's side, and what has turned the race cannot drive the whirl. An impulse I gives κ·I/m to the whirl (κ = 1 − μ_r/μ) and takes I·(R²/J_r + R_i²/J_i + κ/m) off the slip, so sliding takes the whirl to v = κ·ΩR/(κ + m·(R²/J_r + R_i²/J_i)) at most, whatever the impact. Then the rotor rolls on the race, friction holds only what the drag asks for, and rolling friction and shaft damping end the whirl.",
            "What it does not: a race hardly raises the impact that starts a whirl, unless it is so light that this bound lies near v_t,crit; a race as heavy as the rotor lets the whirl come near the stator's limit, as a bushing does; without shaft stiffness nothing lifts the rotor off and it rolls on; and with a drive that holds the spin, a drag above the torque that μ·N gives at v_t,crit keeps a rolling whirl alive for good.",
        ],
    );
    let all = races(extent)?;
    chapter.rows = whirl_rows(&all)?;
    chapter.tables.push(race_table(&all));
    chapter.figures = figures::all(&all);
    onset::add(&mut chapter, extent)?;
    chapter.rows.extend(without_shaft()?);
    add_drags(&mut chapter, extent)?;
    Ok(chapter)
}

fn whirl_rows(all: &[Tried]) -> Result<Vec<Row>> {
    let race = |inertia: Option<f64>| {
        let found = all.iter().find(|t| t.inertia_kg_m2 == inertia);
        found.or_missing(format!("no race of {inertia:?} kg m²"))
    };
    let (bushing, light) = (race(None)?, race(Some(LIGHT_KG_M2))?);
    let (heavy, middle) = (race(Some(1e-1))?, race(Some(1e-2))?);
    let fastest = |of: &Tried| Some(of.fastest_hz? / bushing.fastest_hz?);
    let force = |of: &Tried| of.force_kn / bushing.force_kn;
    let spin_left = |of: &Tried| of.spin_left_hz.map_or(f64::NAN, |hz| 100.0 * hz / SPIN_HZ);
    let bound_hz = light.bound_hz();
    Ok(rows! {
        "Fastest whirl in a bushing", "Hz", SOURCE, Silent => bushing.fastest_hz, Assumed, "the stator's limit";
        "Race of 1e-3 kg m² over bushing: fastest whirl", "", SOURCE, Silent => fastest(light), Assumed, "paper: ball bearings seem a good way; no number";
        "Race of 1e-3 kg m² over bushing: largest normal force in whirl", "", SOURCE, Silent => force(light), Assumed, "the impact itself is the same";
        "Race of 1e-3 kg m²: fastest whirl over the bound κ·ΩR/(κ + m·(R²/J_r + R_i²/J_i))", "", SOURCE, Silent => light.fastest_hz.map(|hz| hz / bound_hz), Assumed,
            "bound {bound_hz:.0} Hz; shaft, damping and the motion of the stator are left out of it";
        "Race of 1e-2 kg m² over bushing: fastest whirl", "", SOURCE, Silent => fastest(middle), Assumed,
            "the bound, {:.0} Hz, is above the stator's limit; slip ends before the whirl gets there", middle.bound_hz();
        "Race of 1e-2 kg m² over bushing: largest normal force in whirl", "", SOURCE, Silent => force(middle), Assumed, "";
        "Race of 1e-1 kg m² over bushing: fastest whirl", "", SOURCE, Silent => fastest(heavy), Assumed, "twice the rotor's inertia: hardly helps";
        "Bushing: until the rotor lifts off for good", "ms", SOURCE, Silent => bushing.dies_ms, Assumed, "the whirl takes the whole spin of a rotor without drive";
        "Race of 1e-3 kg m²: until sliding ends", "ms", SOURCE, Silent => light.slip_ends_ms, Assumed, "";
        "Race of 1e-3 kg m²: until the whirl dies", "ms", SOURCE, Silent => light.dies_ms, Assumed,
            "rolling, braked by μ_r and shaft damping, at a fraction of the force";
        "Race of 1e-3 kg m²: spin left to the rotor when the whirl dies", "%", SOURCE, Silent => spin_left(light), Assumed, "bushing: {:.0} %", spin_left(bushing);
    })
}

/// The impact of footnote 4 against every race.
fn race_table(all: &[Tried]) -> Table {
    let named = |inertia: Option<f64>| inertia.map_or("bushing".to_owned(), |i| format!("{i:.0e}"));
    let dies = |ms: Option<f64>| ms.map_or("not in 500".to_owned(), |ms| format!("{ms:.0}"));
    table! {
        "Footnote 4 from 40 Hz, 0.4 m/s at the wall, no drive, no drag: one race after another";
        for t in all;
        "J_i [kg m²]" => "{}", named(t.inertia_kg_m2);
        "Bound of the whirl [Hz]" => "{:.0}", t.bound_hz();
        "Fastest whirl [Hz]" => "{}", or_dash(t.fastest_hz, 0);
        "Force in whirl [kN]" => "{:.2}", t.force_kn;
        "Sliding ends [ms]" => "{}", or_dash(t.slip_ends_ms, 2);
        "Whirl dies [ms]" => "{}", dies(t.dies_ms);
        "Rotor's spin then [Hz]" => "{}", or_dash(t.spin_left_hz, 1);
        "Race's spin then [Hz]" => "{}", or_dash(t.race_spin_hz, 1);
    }
}

/// Without shaft stiffness nothing lifts the rotor off: 1/v grows by μ_r·t/c.
fn without_shaft() -> Result<Vec<Row>> {
    let mut params = with_race(&rotor(), Some(LIGHT_KG_M2), 0.0);
    params.rotor.stiffness_n_m = 0.0;
    let light = Tried::run(&params, 0.5)?;
    Ok(rows! {
        "No shaft stiffness, race of 1e-3 kg m²: fastest whirl", "Hz", SOURCE, Silent => light.fastest_hz, Assumed, "as with a shaft: the bound does not know it";
        "No shaft stiffness, race of 1e-3 kg m²: whirl left after 0.5 s", "Hz", SOURCE, Silent => light.last_hz, Assumed,
            "not over: rolling friction brakes as 1/t only, and nothing lifts the rotor off";
    })
}

/// Adds the light race with drag, spin held: which drag keeps the whirl alive.
fn add_drags(chapter: &mut Chapter, extent: Extent) -> Result<()> {
    let mut held = rotor();
    held.spin = SpinParams::Held;
    let with = |drag| with_race(&held, Some(LIGHT_KG_M2), drag);
    let least = sustaining_drag_n_m_s(&with(0.0)).or_missing("no threshold")?;
    let mut drags = vec![0.0, 0.8 * least, 1.25 * least, 1e-2];
    if extent == Extent::Full {
        drags.extend([2e-3, 5e-3, 2e-2, 5e-2]);
        drags.sort_by(f64::total_cmp);
    }
    let all = each(&drags, |drag| Tried::run(&with(*drag), 0.8))?;
    let lasting = all.iter().zip(&drags).find(|(_, drag)| **drag == 1e-2);
    let (lasting, _) = lasting.or_missing("no drag")?;
    let closed_hz = sustained_hz(&lasting.params).unwrap_or(f64::NAN);
    chapter.rows.extend(rows! {
        "Held spin: drag torque at 40 Hz above which rolling whirl lives on", "N m", SOURCE, Silent => least * SPIN_HZ * TAU, Assumed,
            "closed form, b = {least:.2e} N m s; runs at 0.8 and 1.25 times that: table. Bore of {:.0} mm", 2e3 * lasting.params.bore_radius_m();
        "Held spin, race of 1e-3 kg m² with b = 1e-2 N m s: whirl that lives on", "Hz", SOURCE, Silent => lasting.last_hz, Assumed,
            "closed form on a rigid stator {closed_hz:.1} Hz; a bushing stays at the stator's limit";
    });
    let dies = |ms: Option<f64>| ms.map_or("lives on".to_owned(), |ms| format!("{ms:.0}"));
    chapter.tables.push(table! {
        "Race of 1e-3 kg m² with drag, spin held at 40 Hz, 0.4 m/s at the wall (a bushing whirls on at the stator's limit)";
        for (drag, t) in drags.iter().zip(&all);
        "b [N m s]" => "{drag:.2e}";
        "Fastest whirl [Hz]" => "{}", or_dash(t.fastest_hz, 0);
        "Force in whirl [kN]" => "{:.2}", t.force_kn;
        "Whirl dies [ms]" => "{}", dies(t.dies_ms);
        "Whirl after 0.8 s [Hz]" => "{}", or_dash(t.last_hz, 1);
        "closed form, rigid stator [Hz]" => "{}", or_dash(sustained_hz(&t.params), 1);
    });
    Ok(())
}
