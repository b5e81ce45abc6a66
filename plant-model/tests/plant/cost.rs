//! What a sample costs, over the degrees of freedom: prints a table.

use crate::support::*;
use std::time::Instant;

const PERIOD_S: f64 = 5e-5;

fn with(modes: usize, poles: bool) -> MachineParams {
    let mut params = machine();
    if modes > 0 {
        params.rotor = modal(&params.rotor, bending(modes, 2500.0));
    }
    let poles = poles.then_some(Poles {
        bias_current_a: 4.0,
        current_max_a: 4.0,
        air_gap_m: 5e-3,
        coil: None,
    });
    params.probes_m = vec![-0.18, 0.18];
    let magnet = |z: &f64| MachineMagnet {
        poles,
        ..magnet(*z, 500.0, 1.6e-4)
    };
    params.magnets = params.probes_m.iter().map(magnet).collect();
    params
}

/// Times real time of levitated flight or of rolling in both planes, from a sample on; `None` where not every one of them is spent
/// in that mode.
fn speed(params: &MachineParams, method: Method, mode: ContactMode) -> Option<f64> {
    let levitated = mode == ContactMode::Flight;
    let from = moving([if levitated { 0.01 } else { 0.3 }, 0.0], [0.0; 2], 400.0);
    let mut machine = Machine::new(params, &from, options(method, 1e-9)).unwrap();
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
            all &= (0..2).all(|plane| machine.mode(plane) == Some(mode));
        }
        all
    };
    run(0..1000);
    let began = Instant::now();
    let all = run(1000..5000);
    all.then(|| 4000.0 * PERIOD_S / began.elapsed().as_secs_f64())
}

#[test]
#[ignore = "prints times"]
fn cost_over_degrees_of_freedom() {
    println!(
        "degrees of freedom: levitated by series, collocation and with poles; rolling by series and collocation"
    );
    for modes in [0, 1, 2, 4, 6, 8] {
        let [plain, poles] = [false, true].map(|poles| with(modes, poles));
        let row = [
            speed(&plain, Method::Series, ContactMode::Flight),
            speed(&plain, Method::Collocation, ContactMode::Flight),
            speed(&poles, Method::Auto, ContactMode::Flight),
            speed(&plain, Method::Series, ContactMode::Roll),
            speed(&plain, Method::Collocation, ContactMode::Roll),
        ];
        let cells = row.map(|times| {
            let us = |times| format!("{:.1} µs, {times:.0} ×", 1e6 * PERIOD_S / times);
            times.map_or("–".to_owned(), us)
        });
        println!("{}: {}", 4 + 2 * modes, cells.join(" | "));
    }
}
