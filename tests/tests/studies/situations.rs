//! Where the catalogue's faults strike: the supervisor really is in the mode that the scene's name says.

use firmware_bench::device::levitation::LevitationParams;
use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_studies::machines::plants::{RATES_HZ, plants};
use firmware_studies::machines::tuned_gains::stored;
use firmware_studies::overloads::case::Sizes;
use firmware_studies::overloads::situations::{Situation, situations};
use std::ops::Range;
use supervisor::Mode;

/// Noise that the situations were not found with.
const SEEDS: Range<u64> = 100..120;

/// On every plant there is a situation for each mode, and with other noise, too, the supervisor is in that mode there.
#[test]
fn situations_are_in_their_modes() {
    for rate_hz in RATES_HZ {
        for plant in plants(rate_hz).unwrap() {
            let tuned = stored(&plant.name, rate_hz).unwrap().tuned;
            let all = situations(&plant.scene, Sizes::of(&plant.scene).unwrap(), tuned);
            let names: Vec<&str> = all.iter().map(|s| s.name).collect();
            let place = format!("{} at {rate_hz} Hz", plant.name);
            let modes = ["idle", "approach", "bounce", "whirl", "pinned", "hand-over"];
            assert_eq!(names, modes, "{place}");
            for situation in all {
                let there =
                    SEEDS.filter(|&seed| mode_in(&situation, tuned, seed) == Some(situation.mode));
                let seeds = SEEDS.count();
                assert!(
                    10 * there.count() >= 9 * seeds,
                    "{place}, {}",
                    situation.name
                );
            }
        }
    }
}

/// Mode of the supervisor at the instant of a situation, under other noise.
fn mode_in(situation: &Situation, tuned: LevitationParams, seed: u64) -> Option<Mode> {
    let mut scene = Scene {
        duration_s: situation.at_s + 1.0 / situation.scene.sample_rate_hz,
        ..situation.scene.clone()
    };
    scene.planes[0].levitation = Some(tuned);
    scene.planes[0].seed = seed;
    let (_, trace) = run(&scene, PolicyKind::Supervisor, Keep::Trace, &mut |_| {}).unwrap();
    let mut rows = trace.rows.iter().rev();
    rows.find(|row| row.plant.t_s <= situation.at_s)?
        .supervisor_mode()
}
