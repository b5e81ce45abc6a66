//! What is found out from records, against what the plant did: on machines on which nothing was tuned.

use firmware_bench::record::file::RecordFile;
use firmware_bench::record::identify::{Estimate, Findings};
use firmware_bench::run::clairvoyant::restitution;
use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::run::trace::Trace;
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_studies::campaign::{Extent, run_all};
use firmware_studies::found_in_records::{Share, contacts, study};
use firmware_studies::paired::events::Point as Event;
use firmware_studies::paired::plan::Class;
use firmware_studies::paired::sensors::Sensors;

const SEED: u64 = 20_261_201;
const MACHINES: u64 = 40;

#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    /// Impacts of the plant that were found, and contacts found that are the plant's.
    impacts: Share,
    contacts: Share,
    friction: Share,
    restitution: Share,
    clearance: Share,
    eccentricity: Share,
    load: Share,
}

fn compare(event: Event, scene: &Scene, trace: &Trace, last: u32, found: &Findings) -> Counts {
    let seen = contacts(scene, trace, last, found);
    let mut counts = Counts {
        impacts: seen.impacts,
        contacts: seen.contacts,
        ..Counts::default()
    };
    let id = &found.identified;
    let near = |share: &mut Share, estimate: Option<Estimate>, truth: f64, off: f64| {
        if let Some(estimate) = estimate {
            share.count((estimate.value - truth).abs() <= off);
        }
    };
    let plant = scene.plant(0);
    let (mu, clearance_m) = (
        plant.friction.sliding.coefficient(0.0),
        plant.contact.clearance_m,
    );
    near(&mut counts.friction, id.friction_coefficient, mu, 0.1 * mu);
    near(
        &mut counts.restitution,
        id.restitution,
        restitution(&plant),
        0.1,
    );
    near(
        &mut counts.clearance,
        id.clearance_m,
        clearance_m,
        0.05 * clearance_m,
    );
    let eccentricity_m = plant.rotor.eccentricity_m;
    near(
        &mut counts.eccentricity,
        id.eccentricity_m,
        eccentricity_m,
        0.05 * clearance_m,
    );
    // What lasts as long as a flight before the first contact; a push is over by then.
    let cap_n = plant.magnet.map_or(0.0, |magnet| magnet.force_max_n);
    if let (Event::Overload, [load]) = (event, &scene.disturbances[..]) {
        near(&mut counts.load, id.load_x_n, load.force_n.x, 0.2 * cap_n);
        near(&mut counts.load, id.load_y_n, load.force_n.y, 0.2 * cap_n);
    }
    counts
}

/// Every other machine has an unbalance that takes a twentieth of its force.
fn unbalance(scene: &mut Scene, number: u64) {
    let mass_kg = scene.machine.rotor.rigid().mass_kg;
    let share = if number % 2 == 1 { 0.05 } else { 0.0 };
    let eccentricity_m = share * scene.force_max_n(0) / (mass_kg * scene.start.spin_rad_s.powi(2));
    scene.machine.eccentricity_m = eccentricity_m.min(0.05 * scene.clearance_m(0));
}

#[test]
fn what_is_found_in_records_is_what_the_plant_did() {
    let mut jobs = Vec::new();
    let events = [
        Event::Impact,
        Event::Marginal,
        Event::Eccentric,
        Event::Shock,
        Event::Overload,
        Event::Whirl,
    ];
    for number in 0..MACHINES {
        jobs.extend(events.map(|event| (event, number)));
    }
    let all = run_all(&jobs, &(), |(event, number)| {
        let class = Class::of_point_masses(*event, Sensors::AsConfigured);
        let (mut scene, _) = class.scene(SEED, *number).unwrap();
        unbalance(&mut scene, *number);
        let ran = run(&scene, PolicyKind::Supervisor, Keep::Trace, &mut |_| {});
        let (_, trace) = ran.ok()?;
        let bytes = trace.read_out.as_ref()?.flight_record.as_ref()?;
        let file = RecordFile::of(bytes);
        let last = file.records[0].entries.values().last()?.sequence;
        let found = file.events()[0].findings()?;
        Some(compare(*event, &scene, &trace, last, &found))
    });
    let mut sum = Counts::default();
    let mut records = 0;
    for counts in all.into_iter().flatten() {
        records += 1;
        sum.impacts += counts.impacts;
        sum.contacts += counts.contacts;
        sum.friction += counts.friction;
        sum.restitution += counts.restitution;
        sum.clearance += counts.clearance;
        sum.eccentricity += counts.eccentricity;
        sum.load += counts.load;
    }
    println!("{records} records: {sum:#?}");
    let at_least = |share: Share, per_cent: usize| 100 * share.right >= per_cent * share.of;
    assert!(
        records >= 130 && sum.impacts.of >= 200,
        "{records}: {sum:?}"
    );
    assert!(at_least(sum.impacts, 95), "{:?}", sum.impacts);
    assert!(at_least(sum.contacts, 99), "{:?}", sum.contacts);
    for (share, fewest) in [
        (sum.friction, 3),
        (sum.restitution, 3),
        (sum.clearance, 3),
        (sum.eccentricity, 80),
    ] {
        assert!(share.of >= fewest && at_least(share, 95), "{sum:#?}");
    }
    assert!(sum.load.of >= 50 && at_least(sum.load, 85), "{sum:#?}");
}

/// Over a quarter of the catalogue. Where sensor and drive do as they say and loads are constant in flight nothing is missed.
#[test]
fn what_is_found_in_records_of_the_catalogue_is_what_the_plant_did() {
    let report = study(Extent::Quick, &()).unwrap();
    let measured: Vec<f64> = report.claims.iter().map(|claim| claim.measured).collect();
    let [
        all,
        honest,
        steady,
        contacts,
        of_honest,
        friction,
        restitution,
        outcomes,
    ] = measured[..]
    else {
        panic!("{measured:?}")
    };
    assert!(report.cases > 500, "{}", report.cases);
    assert_eq!((friction, restitution), (1.0, 1.0));
    assert!(steady >= 0.98, "{measured:?}");
    // Touches that are left to levitation, before an engagement and after it, are known by fewer ticks.
    assert!(all >= 0.84 && honest >= 0.94, "{measured:?}");
    assert!(contacts >= 0.97 && of_honest >= 0.99, "{measured:?}");
    assert!(outcomes >= 0.99, "{measured:?}");
}
