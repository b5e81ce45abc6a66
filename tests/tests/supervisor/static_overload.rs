//! A load that presses the rotor onto the bearing for long: lifted off where the cap can, held with all of it where not.

use crate::common::{RATE_HZ, contend, plant};
use firmware_bench::run::closed_loop::Keep;
use firmware_bench::run::figures::Figures;
use firmware_bench::run::trace::{Trace, TraceRow};
use firmware_studies::machines::plants::PlantCase;
use firmware_studies::machines::tuned_gains::{TunedGains, stored};
use firmware_studies::overloads::case::Case;
use firmware_studies::overloads::catalogue::cases;
use firmware_studies::overloads::contenders::Contender;

/// A plant of the catalogue, what was found for it, and its scene with a load of so many caps for a second.
fn loaded(name: &str, caps: f64) -> Loaded {
    let plant = plant(name);
    let found = stored(&plant.name, RATE_HZ).unwrap();
    let name = format!("load {caps} × cap for 1000 ms");
    let mut all = cases(&plant, found.tuned).into_iter();
    let case = all.find(|case| case.name == name).unwrap();
    (plant, found, case)
}

type Loaded = (PlantCase, TunedGains, Case);

fn under(contender: Contender, (_, found, case): &Loaded) -> (Figures, Trace) {
    contend(contender, found, &case.scene, Keep::Trace)
}

/// Rows of when the load has settled.
fn settled(trace: &Trace) -> impl Iterator<Item = &TraceRow> {
    (trace.rows.iter()).filter(|row| row.plant.t_s > 0.5 && row.plant.t_s < 1.0)
}

/// A load a little below the cap throws the rotor onto the bearing once; then it is lifted off and kept away, also where
/// the levitation controller would leave it there.
/// Requirement: SR-25
#[test]
fn a_load_just_below_the_cap_is_lifted_off_and_kept_away() {
    for plant in ["P2", "P3", "P4"] {
        let loaded = loaded(plant, 0.9);
        let (alone, _) = under(Contender::Tuned, &loaded);
        let (own, trace) = under(Contender::Supervisor, &loaded);
        assert!(own.recovered && own.impacts == 1, "{plant}: {own:?}");
        let share = own.contact_impulse_n_s / alone.contact_impulse_n_s;
        assert!(share < 0.01, "{plant}: {share}");
        // Where the restoring force and its half more, (5.10d), are in balance with the load: away from the wall.
        let clearance_m = loaded.0.scene.clearance_m(0);
        for row in settled(&trace) {
            let share = row.plant.position_m.norm() / clearance_m;
            assert!((0.5..0.8).contains(&share), "{plant}: {share}");
        }
    }
}

/// What cannot be lifted off is relieved by the whole cap.
/// Requirement: SR-25
#[test]
fn what_the_cap_cannot_lift_is_held_with_all_of_it() {
    for plant in ["P2", "P4"] {
        let loaded = loaded(plant, 1.5);
        let (_, trace) = under(Contender::Supervisor, &loaded);
        let pressing_n = settled(&trace)
            .map(|row| row.plant.normal_force_n)
            .sum::<f64>();
        let pressing_n = pressing_n / settled(&trace).count() as f64;
        let of_plane = loaded.0.scene.plant(0);
        let cap_n = of_plane.magnet.unwrap().force_max_n;
        let pull_n = -of_plane.rotor.stiffness_n_m * of_plane.contact.clearance_m;
        let held = (1.5 * cap_n + pull_n - pressing_n) / cap_n;
        assert!((0.995..1.002).contains(&held), "{plant}: {held}");
    }
}
