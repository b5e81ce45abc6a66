//! The project's own integrators: one run, and many at once by lanes.

use crate::problem::Problem;
use crate::ride::Ending;
use plant_model::lanes::{self, LaneParams, Launch};
use plant_model::params::*;
use plant_model::{Inputs, Method, Options, V2, build};

pub fn run(problem: &Problem, method: Method, rtol: f64) -> Result<Ending, String> {
    run_under(problem, &[V2::zeros()], method, rtol)
}

/// All of them by lanes; what those give up, one by one by the series. Work is not counted.
pub fn by_lanes(problems: &[Problem], rtol: f64) -> Result<Vec<Ending>, String> {
    let launch = |p| Launch::new(LaneParams::of(&params(p))?, &start(p), p.t_end);
    let launches = problems.iter().map(launch).collect::<Option<Vec<_>>>();
    let launches = launches.ok_or("lanes do not know this plant")?;
    let mut endings = vec![None; problems.len()];
    lanes::run(rtol, launches.into_iter().zip(0..), |i: usize, ended| {
        endings[i] = (ended.ending == lanes::Ending::Time).then(|| Ending {
            x: ended.position_m.x,
            y: ended.position_m.y,
            changes: ended.events.into(),
            ..Ending::default()
        });
        None
    });
    let one_by_one =
        |(e, p): (Option<Ending>, _)| e.map_or_else(|| run(p, Method::Series, rtol), Ok);
    endings.into_iter().zip(problems).map(one_by_one).collect()
}

fn params(p: &Problem) -> PlantParams {
    let stator = if p.m_s > 0.0 {
        StatorParams::OneMass(RingParams {
            mass_kg: p.m_s,
            stiffness_n_m: V2::repeat(p.k_s),
            damping_n_s_m: V2::repeat(p.d_s),
        })
    } else {
        StatorParams::Rigid
    };
    PlantParams {
        rotor: RotorParams {
            mass_kg: p.m,
            stiffness_n_m: p.k,
            damping_n_s_m: p.d,
            eccentricity_m: p.eccentricity,
            contact_radius_m: p.radius,
        },
        spin: SpinParams::Held,
        stator,
        contact: ContactParams {
            clearance_m: p.clearance,
            law: LinearContact {
                stiffness_n_m: p.k_c,
                damping_n_s_m: p.d_c,
            }
            .into(),
        },
        friction: FrictionParams {
            sliding: SlidingFriction::Constant { coefficient: p.mu },
            rolling_coefficient: 0.0,
        },
        magnet: None,
        race: None,
    }
}

fn start(p: &Problem) -> Start {
    Start {
        position_m: V2::zeros(),
        velocity_m_s: V2::new(p.start_speed, 0.0),
        spin_rad_s: p.spin,
        spin_phase_rad: 0.0,
    }
}

/// The same as [`run`] under external forces, each held for an equal part of the run.
pub fn run_under(
    problem: &Problem,
    forces_n: &[V2],
    method: Method,
    rtol: f64,
) -> Result<Ending, String> {
    // Samples are long here: leave no limit but that of the whole run.
    let options = Options {
        rtol,
        method,
        steps_per_sample: Options::default().steps,
        ..Options::default()
    };
    let mut plant = build(&params(problem), &start(problem), options).map_err(|e| e.to_string())?;
    let mut changes = 0;
    for (i, force) in forces_n.iter().enumerate() {
        let inputs = Inputs {
            command_n: V2::zeros(),
            external_n: *force,
        };
        let t = problem.t_end * (i + 1) as f64 / forces_n.len() as f64;
        plant
            .advance(t, &inputs, &mut |_| changes += 1)
            .map_err(|e| e.to_string())?;
    }
    let position = plant.snapshot().position_m;
    let work = plant.work();
    Ok(Ending {
        x: position.x,
        y: position.y,
        changes,
        evaluations: work.evaluations,
        factorisations: work.factorisations,
    })
}
