//! How hard an impact any force within the cap could take, and how much of that the supervisor does.

use crate::campaign::{Block, Chapter, Claim, Extent, Progress, Report, StudyError, run_all};
use crate::machines::plants::{PlantCase, RATES_HZ, plants};
use crate::machines::tuned_gains::stored;
use crate::overloads::case::seeded;
use crate::overloads::contenders::{Contender, Task};
use crate::overloads::impact::recoverable_m_s;
use crate::overloads::plan::CatalogueError;
use crate::overloads::sweeps::median_of;
use firmware_bench::run::clairvoyant::restitution;
use firmware_bench::scene::Scene;
use plant_model::analysis::best_force::{BestForce, RigidWall};

/// Plants whose stiffness is next to nothing beside the force cap over the clearance.
const FREE: [&str; 3] = ["P2", "P3", "P4"];
/// Who takes part, in this order.
const CONTENDERS: [Contender; 3] = [
    Contender::Tuned,
    Contender::Supervisor,
    Contender::Clairvoyant,
];
/// A new force of the optimum's own flight, in lift-off times.
const PERIOD: f64 = 0.02;

/// Hardest impacts on a plant, of each contender \[m/s\].
fn hardest_m_s(case: &PlantCase, seeds: u64) -> Result<[f64; CONTENDERS.len()], CatalogueError> {
    let found = stored(&case.name, case.rate_hz).ok_or_else(|| CatalogueError::NotFound {
        plant: case.name.clone(),
        rate_hz: case.rate_hz,
    })?;
    let mut hardest = [0.0; CONTENDERS.len()];
    for (contender, hardest) in CONTENDERS.iter().zip(&mut hardest) {
        let make = |scene: &Scene| contender.controller(Task::Impact, &found, scene);
        let all = (1..=seeds)
            .map(|seed| recoverable_m_s(&seeded(&case.scene, seed), contender.name(), &make))
            .collect::<Result<Vec<f64>, _>>();
        let all = all.map_err(|reason| CatalogueError::Run {
            plant: case.name.clone(),
            policy: contender.name(),
            reason,
        })?;
        *hardest = median_of(all.into_iter());
    }
    Ok(hardest)
}

/// Lift-off speed of the whole cap \[m/s\].
fn lift_off_m_s(scene: &Scene) -> f64 {
    let plant = scene.plant(0);
    let cap_n = plant.magnet.map_or(0.0, |magnet| magnet.force_max_n);
    (cap_n * plant.contact.clearance_m / plant.rotor.mass_kg).sqrt()
}

/// Plants of one wall share its values; a grid is checked by a coarser one.
///
/// # Errors
/// [`CatalogueError`].
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    let cases: Vec<PlantCase> = (plants(RATES_HZ[1])?.into_iter())
        .filter(|case| FREE.contains(&case.name.as_str()))
        .collect();
    let nodes = extent.pick([[7, 25, 37], [9, 33, 49]], [[9, 33, 49], [17, 65, 97]]);
    let seeds = extent.pick(1, 3);
    let measured = run_all(&cases, progress, |case| hardest_m_s(case, seeds));
    let measured = measured.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut walls: Vec<(RigidWall, [f64; 3])> = Vec::new();
    let (mut claims, mut rows) = (Vec::new(), Vec::new());
    for (case, [tuned, own, clairvoyant]) in cases.iter().zip(measured) {
        let plant = case.scene.plant(0);
        let wall = RigidWall {
            friction: plant.friction.sliding.coefficient(0.0),
            restitution: restitution(&plant),
        };
        let [coarse, fine, flown] = match walls.iter().find(|(of, _)| *of == wall) {
            Some((_, known)) => *known,
            None => {
                let [coarse, fine] = nodes.map(|nodes| BestForce::new(wall, nodes));
                let flown = fine.hardest_impact_flown(PERIOD);
                let known = [coarse.hardest_impact(), fine.hardest_impact(), flown];
                walls.push((wall, known));
                known
            }
        };
        let unit_m_s = lift_off_m_s(&case.scene);
        let name = &case.name;
        let apart = (coarse / fine - 1.0).abs();
        claims.push(Claim::at_most(
            format!("{name}: two grids apart"),
            0.03,
            apart,
        ));
        let reached = format!("{name}: flown by its own forces, over the value");
        claims.push(Claim::at_least(reached, 0.95, flown / fine));
        let over = format!("{name}: the supervisor's hardest impact, over the value");
        claims.push(Claim::at_least(over, 0.85, own / (unit_m_s * fine)));
        let in_m_s = [coarse, fine, flown].map(|speed| speed * unit_m_s);
        let [a, b, c] = in_m_s.map(|speed| format!("{speed:.3}"));
        let [d, e, f] = [tuned, own, clairvoyant].map(|speed| format!("{speed:.3}"));
        rows.push([
            name.clone(),
            a,
            b,
            c,
            d,
            e,
            f,
            format!("{:.3}", own / in_m_s[1]),
        ]);
    }
    let text = format!(
        "Hardest radial impact from the middle [m/s]; closed loops at {:.0} kHz, medians of {seeds} seeds on a grid of 5 %; flown on one of 1.25 %, values on one of 0.1 %.",
        1e-3 * RATES_HZ[1]
    );
    let columns = [
        "plant",
        "value, coarse grid",
        "value",
        "flown",
        "tuned levitation",
        "supervisor",
        "clairvoyant",
        "supervisor over value",
    ];
    Ok(Report {
        title: "What any force could do".to_owned(),
        claims,
        cases: (cases.len() * CONTENDERS.len()) as u64 * seeds,
        classes: Vec::new(),
        chapters: vec![Chapter::new(
            "Hardest impacts",
            vec![Block::text(text), Block::table(columns, rows)],
        )],
    })
}
