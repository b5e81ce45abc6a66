//! What a sample costs, over the degrees of freedom: prints the table of `docs/src/theory/whole-rotor.md`.

use crate::support::rotor::*;
use plant_model::V2;
use plant_model::machine::params::*;
use plant_model::machine::{Machine, MachineInputs};
use plant_model::{Method, Mode, Options};
use std::time::Instant;

const PERIOD_S: f64 = 5e-5;

fn rotor(modes: usize, poles: bool) -> MachineParams {
    let mut params = machine();
    params.rotor = match modes {
        0 => rigid(0.2, 0.05),
        _ => Rotor::Modal {
            rigid: *rigid(0.2, 0.05).rigid(),
            bending: bending(modes, 2500.0),
            polar_coupling_kg_m2: vec![],
            damping_n_s_m: vec![],
        },
    };
    let magnet = |position_m: f64| MachineMagnet {
        position_m,
        force_max_n: 500.0,
        lag_s: 1.6e-4,
        lag_damping_ratio: None,
        poles: poles.then_some(Poles {
            bias_current_a: 4.0,
            current_max_a: 4.0,
            air_gap_m: 5e-3,
            coil: None,
        }),
    };
    params.magnets = vec![magnet(-0.18), magnet(0.18)];
    params.probes_m = vec![-0.18, 0.18];
    params
}

/// Microseconds a sample of a run, from a sample on; `None` where not every one of them is spent in `mode`.
fn cost_us(
    params: &MachineParams,
    (speed, levitated): (f64, bool),
    method: Method,
    mode: Mode,
) -> Option<f64> {
    let start = MachineStart {
        centre_velocity_m_s: V2::new(speed, 0.0),
        spin_rad_s: 400.0,
        ..MachineStart::default()
    };
    let options = Options {
        method,
        ..Options::default()
    };
    let mut machine = Machine::new(params, &start, options).unwrap();
    let mut inputs = MachineInputs {
        commands_n: vec![V2::zeros(); 2],
        loads_n: vec![],
    };
    let mut run = |samples: std::ops::Range<u32>| {
        let mut all = true;
        for i in samples {
            for (m, command_n) in inputs.commands_n.iter_mut().enumerate() {
                let at = machine.probe(m).unwrap();
                let wanted = -2e5 * at.position - 400.0 * at.velocity;
                *command_n = if levitated { wanted } else { V2::zeros() };
            }
            let t_s = PERIOD_S * f64::from(i + 1);
            machine.advance(t_s, &inputs, &mut |_, _| {}).unwrap();
            all &= [0, 1]
                .iter()
                .all(|plane| machine.mode(*plane) == Some(mode));
        }
        all
    };
    run(0..1000);
    let began = Instant::now();
    let all = run(1000..5000);
    all.then(|| began.elapsed().as_secs_f64() / 4000.0 * 1e6)
}

#[test]
#[ignore = "prints times"]
fn cost_over_degrees_of_freedom() {
    println!(
        "| lateral degrees of freedom | levitated, series | levitated, collocation | with poles | both rolling, series | both rolling, collocation |"
    );
    println!("|--:|--:|--:|--:|--:|--:|");
    for modes in [0, 1, 2, 4, 6, 8] {
        let plain = rotor(modes, false);
        let poles = rotor(modes, true);
        let row = [
            cost_us(&plain, (0.01, true), Method::Series, Mode::Flight),
            cost_us(&plain, (0.01, true), Method::Collocation, Mode::Flight),
            cost_us(&poles, (0.01, true), Method::Auto, Mode::Flight),
            cost_us(&plain, (0.3, false), Method::Series, Mode::Roll),
            cost_us(&plain, (0.3, false), Method::Collocation, Mode::Roll),
        ];
        let cells: Vec<String> = row
            .iter()
            .map(|us| {
                us.map_or("–".to_owned(), |us| {
                    format!("{us:.1} µs, {:.0} ×", 1e6 * PERIOD_S / us)
                })
            })
            .collect();
        println!("| {} | {} |", 4 + 2 * modes, cells.join(" | "));
    }
}
