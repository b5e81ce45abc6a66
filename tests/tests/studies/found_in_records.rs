//! What is found out from records, against what the plant did: on machines on which nothing was tuned.

use firmware_bench::record::file::RecordFile;
use firmware_bench::record::identify::{Estimate, Findings};
use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::run::trace::{Trace, TraceRow};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_studies::campaign::run_all;
use firmware_studies::harm::conditions::Condition;
use firmware_studies::harm::events::Event;
use firmware_studies::harm::plan::scene;
use firmware_studies::overloads::contenders::restitution;
use plant_model::Mode;

const SEED: u64 = 20_261_201;
const MACHINES: u64 = 40;
/// Normal speed from which an impact is to be found \[m/s\], and by how much its time may be off \[ticks\].
const IMPACT_M_S: f64 = 0.005;
const OFF_TICKS: f64 = 2.0;

/// Of how many things how many are right.
#[derive(Debug, Clone, Copy, Default)]
struct Share {
    right: usize,
    of: usize,
}

impl Share {
    fn count(&mut self, right: bool) {
        self.right += usize::from(right);
        self.of += 1;
    }

    fn add(&mut self, other: Self) {
        self.right += other.right;
        self.of += other.of;
    }
}

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

/// Times at which the rotor came to the wall with its normal speed, and times at which it was there \[ticks since the first\].
fn truth(scene: &Scene, trace: &Trace, first: u32, last: u32) -> (Vec<(f64, f64)>, Vec<f64>) {
    let tick = |row: &TraceRow| row.plant.t_s * scene.sample_rate_hz - f64::from(first);
    let within = |row: &TraceRow| (0.0..=f64::from(last.wrapping_sub(first))).contains(&tick(row));
    let (mut impacts, mut touching) = (Vec::new(), Vec::new());
    for pair in trace.rows.windows(2).filter(|pair| within(&pair[1])) {
        let plant = &pair[1].plant;
        if plant.mode != Mode::Flight {
            touching.push(tick(&pair[1]));
            if pair[0].plant.mode == Mode::Flight {
                let n = plant.position_m.normalize();
                impacts.push((tick(&pair[1]), plant.velocity_m_s.dot(&n)));
            }
        }
    }
    (impacts, touching)
}

fn compare(event: Event, scene: &Scene, trace: &Trace, last: u32, found: &Findings) -> Counts {
    let (impacts, touching) = truth(scene, trace, found.first, last);
    let mut counts = Counts::default();
    for (tick, _) in impacts.iter().filter(|(_, speed)| *speed > IMPACT_M_S) {
        let at = |from: f64, to: f64| (from - OFF_TICKS..=to + OFF_TICKS).contains(tick);
        let mut contacts = found.contacts.iter();
        counts
            .impacts
            .count(contacts.any(|c| at(c.from_tick, c.to_tick)));
    }
    for contact in &found.contacts {
        let at = contact.from_tick - OFF_TICKS..=contact.to_tick + OFF_TICKS;
        counts
            .contacts
            .count(touching.iter().any(|tick| at.contains(tick)));
    }
    let told = &found.identified;
    let near = |share: &mut Share, estimate: Option<Estimate>, truth: f64, off: f64| {
        if let Some(estimate) = estimate {
            share.count((estimate.value - truth).abs() <= off);
        }
    };
    let plant = &scene.plant;
    let (mu, clearance_m) = (
        plant.friction.sliding.coefficient(0.0),
        plant.contact.clearance_m,
    );
    near(
        &mut counts.friction,
        told.friction_coefficient,
        mu,
        0.1 * mu,
    );
    near(
        &mut counts.restitution,
        told.restitution,
        restitution(scene),
        0.1,
    );
    near(
        &mut counts.clearance,
        told.clearance_m,
        clearance_m,
        0.05 * clearance_m,
    );
    let eccentricity_m = plant.rotor.eccentricity_m;
    near(
        &mut counts.eccentricity,
        told.eccentricity_m,
        eccentricity_m,
        0.05 * clearance_m,
    );
    // What lasts as long as a flight before the first contact; a push is over by then.
    let cap_n = plant.magnet.map_or(0.0, |magnet| magnet.force_max_n);
    if let (Event::Overload, [load]) = (event, &scene.disturbances[..]) {
        near(&mut counts.load, told.load_x_n, load.force_n.x, 0.2 * cap_n);
        near(&mut counts.load, told.load_y_n, load.force_n.y, 0.2 * cap_n);
    }
    counts
}

/// Every other machine has an unbalance that takes a twentieth of its force.
fn unbalance(scene: &mut Scene, number: u64) {
    let rotor = &mut scene.plant.rotor;
    let force_n = scene.plant.magnet.map_or(0.0, |magnet| magnet.force_max_n);
    let share = if number % 2 == 1 { 0.05 } else { 0.0 };
    let eccentricity_m = share * force_n / (rotor.mass_kg * scene.start.spin_rad_s.powi(2));
    rotor.eccentricity_m = eccentricity_m.min(0.05 * scene.plant.contact.clearance_m);
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
        let (_, mut scene) = scene(SEED, (*event, Condition::Told), *number);
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
        sum.impacts.add(counts.impacts);
        sum.contacts.add(counts.contacts);
        sum.friction.add(counts.friction);
        sum.restitution.add(counts.restitution);
        sum.clearance.add(counts.clearance);
        sum.eccentricity.add(counts.eccentricity);
        sum.load.add(counts.load);
    }
    println!("{records} records: {sum:#?}");
    let at_least = |share: Share, per_cent: usize| 100 * share.right >= per_cent * share.of;
    assert!(
        records >= 130 && sum.impacts.of >= 200,
        "{records}: {sum:?}"
    );
    assert!(at_least(sum.impacts, 96), "{:?}", sum.impacts);
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
