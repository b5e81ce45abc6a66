//! How far off the numbers are that `commission` finds in logs of machines with nothing wrong, and whether their intervals hold.

use super::rotors::confirms;
use super::{SENSORS, scene};
use crate::campaign::{Progress, run_all};
use crate::machines::draw::Draw;
use crate::machines::rotors::{Class, RotorCase};
use firmware_bench::commission::log::Log;
use firmware_bench::commission::two_planes::TwoPlanes;
use firmware_bench::commission::{Commissioned, Found};
use firmware_bench::run::closed_loop::{Accuracy, Recorders, record};
use firmware_bench::run::trace::{Recorder, TraceRow};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;

/// The log of a machine with nothing wrong, as `commission` reads one.
#[derive(Debug, Default)]
struct Logged(Log);

impl Recorder for Logged {
    fn row(&mut self, row: &TraceRow) {
        let Some(trace) = row.supervisor.filter(|_| !row.mode_change) else {
            return;
        };
        let Log {
            position_m,
            command_n,
            stimulus_n,
            spin_rad_s,
            ..
        } = &mut self.0;
        position_m.push(row.measured_m.into());
        command_n.push(row.commanded_n.into());
        stimulus_n.push(trace.stimulus_n.map(f64::from));
        spin_rad_s
            .get_or_insert_default()
            .push(row.plant.spin_rad_s);
    }
}

/// The logs of a scene's planes.
fn logged<const PLANES: usize>(scene: &Scene) -> Result<[Log; PLANES], String> {
    let mut rows = [(); PLANES].map(|()| Logged::default());
    let recorders = Recorders::of_planes(&mut rows);
    let (kind, accuracy) = (PolicyKind::Supervisor, Accuracy::default());
    record(scene, kind, recorders, accuracy, &mut |_| {}).map_err(|error| error.to_string())?;
    let period_s = 1.0 / scene.sample_rate_hz;
    Ok(rows.map(|Logged(log)| Log { period_s, ..log }))
}

/// Numbers that are identified, and how far off one may be as a share: of what it is, and of a stiffness of the cap over the clearance.
const IDENTIFIED: [(&str, f64); 3] = [
    ("mass_kg", 0.03),
    ("stiffness_n_m", 0.1),
    ("time_to_force_s", 0.1),
];

/// A number that is found, what it is, and what an error is a share of.
type Identified = (Found, f64, f64);

/// Of each of these what a log says and what it is; nothing of a log that is not long enough.
fn identified(seed: u64, number: u64) -> Result<Option<[Identified; 3]>, String> {
    let sensors = SENSORS[number as usize % SENSORS.len()];
    let (mut scene, _) = scene(seed, number, sensors)?;
    let config = scene.planes[0].supervisor.as_mut().ok_or("no supervisor")?;
    config.check_first = 1.0;
    let truth = [config.mass_kg, config.stiffness_n_m, config.amplifier_lag_s].map(f64::from);
    let stiffness_n_m = f64::from(config.force_max_n / config.clearance_m);
    let [log] = logged(&scene)?;
    let Ok(commissioned) = Commissioned::of(&log) else {
        return Ok(None);
    };
    let found = IDENTIFIED.map(|(name, _)| {
        commissioned
            .parameters
            .iter()
            .find(|f| f.name == name)
            .cloned()
    });
    let [Some(mass), Some(stiffness), Some(late)] = found else {
        return Err("a number is missing".to_owned());
    };
    Ok(Some([
        (mass, truth[0], truth[0]),
        (stiffness, truth[1], stiffness_n_m),
        (late, truth[2], truth[2]),
    ]))
}

/// How far off what logs say is, by number, and whether their intervals hold.
pub(super) fn identification(seed: u64, machines: u64, progress: &dyn Progress) -> OfMachines {
    let numbers: Vec<u64> = (0..machines).collect();
    let all = run_all(&numbers, progress, |number| identified(seed, *number));
    let (mut odd, mut parameters) = (Vec::new(), Vec::new());
    for (number, one) in numbers.iter().zip(all) {
        let sensors = SENSORS[*number as usize % SENSORS.len()].name();
        match one {
            Ok(Some(one)) => {
                let wrong = one
                    .iter()
                    .filter(|(f, is, _)| !(f.low..=f.high).contains(is));
                odd.extend(wrong.map(|(f, is, _)| {
                    format!(
                        "log of machine {number}, {sensors}: {} is {is:.4e}: {}",
                        f.name,
                        with_interval(f)
                    )
                }));
                parameters.push(one);
            }
            Ok(None) => odd.push(format!("log of machine {number}, {sensors}: refused")),
            Err(why) => odd.push(format!("log of machine {number}, {sensors}: {why}")),
        }
    }
    let all = parameters;
    let mut rows = Vec::new();
    for (place, (name, wanted)) in IDENTIFIED.into_iter().enumerate() {
        let of = || all.iter().map(|one| &one[place]);
        let held = of()
            .filter(|(found, is, _)| (found.low..=found.high).contains(is))
            .count();
        let mut off: Vec<f64> = of()
            .map(|(found, is, of)| (found.value - is).abs() / of)
            .collect();
        off.sort_by(f64::total_cmp);
        let at = |share: f64| {
            off.get((share * off.len() as f64) as usize)
                .copied()
                .unwrap_or(f64::NAN)
        };
        let within = off.iter().filter(|off| **off <= wanted).count();
        let share = |count: usize| count as f64 / all.len().max(1) as f64;
        rows.push([
            name.to_owned(),
            all.len().to_string(),
            format!("{:.1} %", 100.0 * share(held)),
            format!("{:.1} %", 100.0 * at(0.5)),
            format!("{:.1} %", 100.0 * at(0.95)),
            format!("{:.1} %", 100.0 * share(within)),
        ]);
    }
    OfMachines { rows, odd }
}

fn with_interval(f: &Found) -> String {
    format!("{:.4e}, {:.4e} to {:.4e}", f.value, f.low, f.high)
}

/// Numbers of machines in one plane as rows of a table, and what is not as it is.
pub(super) struct OfMachines {
    pub(super) rows: Vec<[String; 6]>,
    pub(super) odd: Vec<String>,
}

/// Columns of a table of numbers.
pub(super) const COLUMNS: [&str; 7] = [
    "rotor, number",
    "logs",
    "intervals that hold",
    "median error",
    "95th percentile",
    "within",
    "of",
];

/// Classes of rotors, and sets the draw of their unbalance apart.
const CLASSES: [Class; 3] = [Class::Rigid, Class::Gyroscopic, Class::Flexible];
const OF_UNBALANCE: u64 = 0xba1a;

/// Numbers of a rotor, and how far off one may be as a share of its scale; those that are most asked for first.
const MOST_ASKED: usize = 4;
const OF_ROTOR: [(&str, f64); 8] = [
    ("mass_kg", 0.03),
    ("transverse_inertia_kg_m2", 0.03),
    ("polar_inertia_kg_m2", 0.03),
    ("A.magnet_stiffness_n_m", 0.1),
    ("force_factor_ratio", 0.03),
    ("A.time_to_force_s", 0.1),
    ("centre_of_mass_m", 0.01),
    ("sensors_turned_rad", 0.03),
];

/// A number of a log that holds it, what it is, and what an error is a share of.
struct Parameter {
    found: Option<Found>,
    is: f64,
    scale: f64,
}

/// Numbers of rotors as rows of a table, and in words how many logs there are.
pub(super) struct OfRotors {
    pub(super) rows: Vec<[String; 7]>,
    pub(super) summary: String,
    pub(super) odd: Vec<String>,
}

/// What the log of a rotor says; an error where it is refused.
fn of_rotor(seed: u64, class: Class, number: u64) -> Result<Vec<Parameter>, String> {
    let case = RotorCase::new(seed, class, number);
    let measures = case.measures();
    let mut draw = Draw::new(seed ^ OF_UNBALANCE, 3 * number + class as u64);
    let eccentricity_m = measures.clearance_m * draw.decades(2e-3, 0.03);
    let text = format!("eccentricity_m = {eccentricity_m}\npolar_inertia_kg_m2 =");
    let text = case.toml().replacen("polar_inertia_kg_m2 =", &text, 1);
    let mut scene = Scene::parse(&case.text(), &text).map_err(|error| error.to_string())?;
    confirms(&mut scene, None);
    let logs = logged(&scene)?;
    let shaft = scene.shaft().ok_or("no shaft")?;
    let names = ["A", "B"].map(str::to_owned);
    let machine = TwoPlanes {
        names,
        places: shaft.places,
        mass_kg: measures.mass_kg,
    };
    let found = Commissioned::of_rotor(&logs, &machine).map_err(|error| error.message)?;
    let apart_m = measures.ends_m[0] + measures.ends_m[1];
    let late_s = scene.planes[0]
        .supervisor
        .map_or(0.0, |c| c.amplifier_lag_s.into());
    let stiffness_n_m = measures.force_n / measures.clearance_m;
    let truth = [
        (measures.mass_kg, measures.mass_kg),
        (measures.transverse_kg_m2, measures.transverse_kg_m2),
        (case.polar_kg_m2(), case.polar_kg_m2()),
        (-case.negative_n_m(), stiffness_n_m),
        (1.0, 1.0),
        (late_s, late_s),
        (0.0, apart_m),
        (0.0, 1.0),
    ];
    let parameters = OF_ROTOR
        .iter()
        .zip(truth)
        .map(|((name, _), (is, scale))| Parameter {
            found: found.parameters.iter().find(|f| f.name == *name).cloned(),
            is,
            scale,
        });
    Ok(parameters.collect())
}

/// How far off a number is in all logs of a class.
fn row(class: Class, place: usize, parameters: &[&Vec<Parameter>]) -> [String; 7] {
    let (name, wanted) = OF_ROTOR[place];
    let found: Vec<(&Parameter, &Found)> = (parameters.iter())
        .filter_map(|all| Some((&all[place], all[place].found.as_ref()?)))
        .collect();
    let held = |(p, f): &&(&Parameter, &Found)| (f.low..=f.high).contains(&p.is);
    let held = found.iter().filter(held).count();
    let mut off: Vec<f64> = (found.iter())
        .map(|(p, f)| (f.value - p.is).abs() / p.scale)
        .collect();
    off.sort_by(f64::total_cmp);
    let at = |share: f64| off.get((share * off.len() as f64) as usize);
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let at = |share: f64| at(share).copied().map_or("–".to_owned(), percent);
    let within = off.iter().filter(|off| **off <= wanted).count();
    let share = |count: usize| percent(count as f64 / off.len().max(1) as f64);
    [
        format!("{}, {name}", class.name()),
        off.len().to_string(),
        share(held),
        at(0.5),
        at(0.95),
        share(within),
        percent(wanted),
    ]
}

/// Rotors by class: how far off what their logs say is, and whether the intervals hold.
pub(super) fn of_rotors(seed: u64, number: u64, progress: &dyn Progress) -> OfRotors {
    let jobs: Vec<(Class, u64)> = (CLASSES.into_iter())
        .flat_map(|class| (0..number).map(move |number| (class, number)))
        .collect();
    let all = run_all(&jobs, progress, |(class, number)| {
        of_rotor(seed, *class, *number)
    });
    let (mut rows, mut refused, mut odd) = (Vec::new(), Vec::new(), Vec::new());
    for ((class, number), parameters) in jobs.iter().zip(&all) {
        let of = format!("log of a {} rotor {number}", class.name());
        match parameters {
            Ok(parameters) => odd.extend((parameters.iter()).filter_map(
                |Parameter { found, is, .. }| {
                    let f = found.as_ref()?;
                    let held = (f.low..=f.high).contains(is);
                    (!held).then(|| format!("{of}: {} is {is:.4e}: {}", f.name, with_interval(f)))
                },
            )),
            Err(why) => odd.push(format!("{of}: {why}")),
        }
    }
    for class in CLASSES {
        let own = jobs.iter().zip(&all).filter(|((c, _), _)| *c == class);
        let none = own.filter(|(_, parameters)| parameters.is_err()).count();
        refused.push(format!("{none} {}", class.name()));
    }
    // What counts most of all classes first.
    for places in [0..MOST_ASKED, MOST_ASKED..OF_ROTOR.len()] {
        for class in CLASSES {
            let own = jobs.iter().zip(&all).filter(|((c, _), _)| *c == class);
            let parameters: Vec<&Vec<Parameter>> =
                own.filter_map(|(_, p)| p.as_ref().ok()).collect();
            let own = places.clone().map(|place| row(class, place, &parameters));
            rows.extend(own);
        }
    }
    OfRotors {
        rows,
        odd,
        summary: format!(
            "{number} rotors of each class with an unbalance of 0.2 to 3 % of the clearance; errors as shares of what is, of the cap over the clearance, of the way between the bearings. Logs that are refused: {}.",
            refused.join(", ")
        ),
    }
}
