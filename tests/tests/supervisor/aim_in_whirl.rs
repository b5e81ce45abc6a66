//! Where the force that is *delivered* points while the rotor whirls in contact.

use crate::common::contend;
use firmware_bench::run::closed_loop::Keep;
use firmware_studies::machines::plants::{RATES_HZ, plants};
use firmware_studies::machines::tuned_gains::stored;
use firmware_studies::overloads::catalogue::cases;
use firmware_studies::overloads::contenders::Contender;
use plant_model::V2;
use supervisor::Mode;

/// Against the whirl and up to atan μ inwards of it, in spite of delay and lag; never outwards, which would press the
/// rotor on. Also where soft walls let the orbit grow to twice the clearance (P1 with 1500 N).
/// Requirement: SR-23
#[test]
fn the_delivered_force_is_aimed_against_the_whirl_and_never_outwards() {
    for rate_hz in RATES_HZ {
        for plant in plants(rate_hz).unwrap() {
            let found = stored(&plant.name, rate_hz).unwrap();
            let cap_n = plant.scene.force_max_n(0);
            let mut inwards_rad = Vec::new();
            let all = cases(&plant, found.tuned).into_iter();
            for case in all.filter(|case| case.group == "whirl") {
                let (_, trace) = contend(Contender::Supervisor, &found, &case.scene, Keep::Trace);
                // From when the force has come; where it is nearly all used, it is this law's.
                for row in trace.rows.iter().filter(|row| row.plant.t_s > 1e-3) {
                    let (now, force_n) = (&row.plant, row.plant.delivered_n);
                    let braked = row.supervisor_mode() == Some(Mode::BackwardWhirl)
                        && now.normal_force_n > 0.0
                        && force_n.norm() > 0.9 * cap_n;
                    if braked {
                        let normal = now.position_m.normalize();
                        let along = V2::new(-normal.y, normal.x);
                        let sense = now.velocity_m_s.dot(&along).signum();
                        let against_n = -sense * force_n.dot(&along);
                        inwards_rad.push((-force_n.dot(&normal)).atan2(against_n));
                    }
                }
            }
            inwards_rad.sort_by(f64::total_cmp);
            let place = format!("{} at {rate_hz} Hz", plant.name);
            let count = inwards_rad.len();
            assert!(count > 50, "{place}: {count}");
            let sliding = &plant.scene.plant(0).friction.sliding;
            let tilt_rad = sliding.coefficient(0.0).atan();
            let [low, middle] = [count / 20, count / 2].map(|i| inwards_rad[i]);
            println!("{place}: {count}, {low:.3} {middle:.3} of {tilt_rad:.3}");
            assert!(low > 0.0, "{place}: {low}");
            let wanted = 0.9 * tilt_rad..3.0 * tilt_rad;
            assert!(wanted.contains(&middle), "{place}: {middle}");
        }
    }
}
