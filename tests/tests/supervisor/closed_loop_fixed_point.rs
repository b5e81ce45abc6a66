//! The fixed-point supervisor keeps rotors as well as `f32`: hardest impact that is recovered from.

use crate::common::ran;
use firmware_bench::run::closed_loop::Keep;
use firmware_bench::run::controller::{Supervise, supervised};
use firmware_bench::scene::Scene;
use firmware_studies::machines::plants::plants;
use firmware_studies::machines::tuned_gains::stored;
use firmware_studies::overloads::impact::recoverable_m_s;
use plant_model::V2;
use supervisor::{Q, Scalar, Supervisor};
use system_tests::per_unit::Behind;

type Make = fn(&Scene) -> Option<Box<dyn Supervise>>;

fn single(scene: &Scene) -> Option<Box<dyn Supervise>> {
    let config = scene.planes[0].supervisor?;
    Some(Box::new(Supervisor::<512>::new(&config).ok()?))
}

fn of<S: Scalar + 'static>(scene: &Scene) -> Option<Box<dyn Supervise>> {
    let config = scene.planes[0].supervisor?;
    Some(Box::new(Behind::<S>::new(&config).ok()?))
}

/// By the search of the catalogue, in steps of 5 %.
fn by_the_catalogue_m_s(scene: &Scene, make: Make) -> f64 {
    recoverable_m_s(scene, "supervised", &|s| supervised(s, make(s)?)).unwrap()
}

/// The same on a grid of half a percent, from a speed on that is recovered from.
fn recoverable_m_s_finely(scene: &Scene, make: Make, from_m_s: f64) -> f64 {
    let mut scene = scene.clone();
    let (mut speed, mut last) = (from_m_s, 0.0);
    loop {
        scene.start.centre_velocity_m_s = V2::new(speed, 0.0);
        let policy = supervised(&scene, make(&scene).unwrap()).unwrap();
        if !ran(&scene, policy, Keep::Decision).0.recovered {
            return last;
        }
        last = speed;
        speed *= 1.005;
    }
}

/// On every plant of the catalogue (P1 with four magnets, P2, P3, P4) at both control rates: the same by the catalogue's
/// search, and within 1 % on a finer grid that begins at half of it.
#[test]
fn fixed_point_recovers_from_the_same_impacts() {
    for rate_hz in [10_000.0, 20_000.0] {
        for plant in plants(rate_hz).unwrap() {
            let mut scene = plant.scene.clone();
            scene.planes[0].levitation = stored(&plant.name, rate_hz).map(|found| found.tuned);
            let name = format!("{} at {rate_hz} Hz", plant.name);
            let [float, fixed] = [single, of::<Q>].map(|make| by_the_catalogue_m_s(&scene, make));
            let same = float > 0.2 && fixed == float;
            assert!(same, "{name}: {float} m/s, fixed point {fixed} m/s");
            let from_m_s = 0.5 * float;
            let [float, fixed] =
                [single, of::<Q>].map(|make| recoverable_m_s_finely(&scene, make, from_m_s));
            let text = format!("{name}: {float:.4} m/s, fixed point {fixed:.4} m/s");
            println!("{text}");
            assert!((fixed / float - 1.0).abs() < 0.01, "{text}");
        }
    }
}
