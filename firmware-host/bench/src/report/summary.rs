//! A scene in words, for the head of its report.

use crate::device::actuator::{Delivers, Outage};
use crate::device::axis::Axis;
use crate::device::loads::{Shape, TimedChange};
use crate::device::sensor_fault::{Fault, FaultKind};
use crate::report::plot::text::figures;
use crate::scene::nominal::named;
use crate::scene::{PlaneScene, Scene};
use plant_model::V2;
use plant_model::machine::params::MachinePlane;
use plant_model::params::{ContactLaw, PlantParams, SlidingFriction, SpinParams, StatorParams};
use std::f64::consts::TAU;

/// Something that happens to the rotor, its magnet or its sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct Disturbed {
    /// What, in words.
    pub what: String,
    /// Beginning \[s\].
    pub from_s: f64,
    /// End \[s\]; the beginning for a change that stays.
    pub to_s: f64,
}

/// What a report needs to know of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneSummary {
    /// Title of the scene, one line.
    pub title: String,
    /// Its story, a few sentences of plain text.
    pub story: String,
    /// Clearance c \[m\].
    pub clearance_m: f64,
    /// Ellipticity and direction of the longer axis \[rad\] of a bearing that is out of round.
    pub out_of_round: Option<(f64, f64)>,
    /// Force cap of the magnet \[N\], if there is one.
    pub force_max_n: Option<f64>,
    /// Backward contact speed above which a run counts as whirl \[m/s\].
    pub whirl_speed_m_s: f64,
    /// What was simulated, in words: name and value.
    pub facts: Vec<(&'static str, String)>,
    /// What the scene says and hardly means.
    pub warnings: Vec<String>,
    /// What happens to the rotor, its magnet or its sensor.
    pub disturbances: Vec<Disturbed>,
    /// Duration of the run \[s\].
    pub duration_s: f64,
}

/// A plane of a scene, with what a report needs of it.
struct At<'a> {
    scene: &'a Scene,
    own: &'a PlaneScene,
    wall: &'a MachinePlane,
    /// The plane alone.
    plant: PlantParams,
}

/// What a report needs to know of a plane of a scene.
pub fn summary(scene: &Scene, plane: usize) -> SceneSummary {
    let at = &At {
        scene,
        own: &scene.planes[plane],
        wall: &scene.machine.planes[plane],
        plant: scene.plant(plane),
    };
    SceneSummary {
        title: scene.title.clone(),
        story: scene.story.clone(),
        clearance_m: at.plant.contact.clearance_m,
        out_of_round: match at.plant.stator {
            StatorParams::RigidEllipse(e) => Some((e.ellipticity, e.long_axis_rad)),
            _ => None,
        },
        force_max_n: at.plant.magnet.map(|m| m.force_max_n),
        whirl_speed_m_s: at.own.whirl_speed_m_s,
        facts: facts(at),
        warnings: scene.warnings.clone(),
        disturbances: disturbances(at),
        duration_s: scene.duration_s,
    }
}

/// What was simulated, beside what the summary has in numbers.
fn facts(at: &At<'_>) -> Vec<Fact> {
    let (rotor, spin_hz) = (&at.plant.rotor, at.scene.start.spin_rad_s / TAU);
    let held = match at.plant.spin {
        SpinParams::Held => ", held",
        SpinParams::Free { .. } => "",
    };
    let friction = match at.plant.friction.sliding {
        SlidingFriction::Constant { coefficient } => figures(coefficient),
        SlidingFriction::Falling {
            at_rest, at_speed, ..
        } => format!("{} falling to {}", figures(at_rest), figures(at_speed)),
    };
    let weight_n = at.own.weight_n.norm();
    let mut facts = vec![
        ("Mass", figures(rotor.mass_kg) + " kg"),
        ("Stiffness", figures(rotor.stiffness_n_m) + " N/m"),
        ("Spin", format!("{} Hz{held}", figures(spin_hz))),
        ("Friction", friction),
    ];
    facts.extend(contact(at));
    facts.extend(amplifier(at));
    facts.extend([
        (
            "Control rate",
            figures(1e-3 * at.scene.sample_rate_hz) + " kHz",
        ),
        (
            "Sensor noise",
            format!(
                "{} µm, seed {}",
                figures(1e6 * at.own.sensor.noise_rms_m),
                at.own.seed
            ),
        ),
    ]);
    facts.extend(sensor(at));
    if weight_n > 0.0 {
        let fed = if at.own.feed_forward_n == V2::zeros() {
            ""
        } else {
            ", fed forward"
        };
        facts.push(("Weight", format!("{} N{fed}", figures(weight_n))));
    }
    if rotor.eccentricity_m > 0.0 {
        facts.push(("Eccentricity", figures(1e6 * rotor.eccentricity_m) + " µm"));
    }
    let offset_m = at.wall.centre_m.norm();
    if offset_m > 0.0 {
        let offset = figures(1e6 * offset_m);
        facts.push((
            "Retainer bearing",
            format!("{offset} µm off the sensors' centre"),
        ));
    }
    if !at.own.overrides.is_empty() {
        let overrides: Vec<String> = named(&at.own.overrides)
            .map(|(name, value)| format!("{name} {value}"))
            .collect();
        facts.push(("Set in [supervisor]", overrides.join(", ")));
    }
    facts.push((
        "Program",
        format!("firmware-host {}", env!("CARGO_PKG_VERSION")),
    ));
    facts
}

/// Name and value.
pub(super) type Fact = (&'static str, String);

/// Wall, friction that a rolling rotor has, race and bore; what is not there has no row.
fn contact(at: &At<'_>) -> Vec<Fact> {
    let plant = &at.plant;
    let mut facts = Vec::new();
    let damping = match &plant.contact.law {
        ContactLaw::Linear(law) => {
            let stiffness = figures(law.stiffness_n_m) + " N/m";
            facts.push(("Contact stiffness", stiffness));
            (law.damping_n_s_m, "N s/m")
        }
        ContactLaw::HuntCrossley(law) => {
            let (stiffness, n) = (figures(law.stiffness_n_mn), figures(law.exponent));
            let law_text = format!("Hunt and Crossley, {stiffness} N/m^{n}");
            facts.push(("Contact", law_text));
            (law.damping_s_m, "s/m")
        }
    };
    // Of a linear contact restitution says it all; of the other it goes with a speed.
    match (at.own.nominal.restitution, plant.contact.law.linear()) {
        (Some(e), Some(_)) => facts.push(("Restitution", figures(e))),
        _ if damping.0 > 0.0 => {
            let damping = format!("{} {}", figures(damping.0), damping.1);
            facts.push(("Contact damping", damping));
        }
        _ => {}
    }
    let rolling = plant.friction.rolling_coefficient;
    if rolling > 0.0 {
        facts.push(("Rolling friction", figures(rolling)));
    }
    if let Some(race) = &plant.race {
        let words = format!(
            "{} kg m², drag {} N m s, {} Hz at the start",
            figures(race.inertia_kg_m2),
            figures(race.drag_n_m_s),
            figures(race.start_spin_rad_s / TAU)
        );
        facts.push(("Race", words));
    }
    if let StatorParams::RigidEllipse(e) = &plant.stator {
        let words = format!(
            "by {} of the clearance, longer at {}°",
            figures(e.ellipticity),
            figures(e.long_axis_rad.to_degrees())
        );
        facts.push(("Out of round", words));
    }
    facts
}

/// What the amplifier has beside the cap, and how late it is.
fn amplifier(at: &At<'_>) -> Vec<Fact> {
    let Some(magnet) = &at.plant.magnet else {
        return Vec::new();
    };
    let (amplifier, mut facts) = (&at.own.amplifier, Vec::new());
    if let Some(cap_n) = amplifier.axis_force_max_n {
        facts.push(("Cap of each axis", figures(cap_n) + " N"));
    }
    if let Some(slew_n_s) = amplifier.slew_n_s {
        facts.push(("Slew limit", figures(slew_n_s) + " N/s"));
    }
    if magnet.lag_s > 0.0 {
        facts.push(("Amplifier lag", figures(1e3 * magnet.lag_s) + " ms"));
    }
    let samples = |count: usize| match count {
        1 => "1 sample".to_owned(),
        _ => format!("{count} samples"),
    };
    facts.push(("Delay of the magnet", samples(amplifier.delay_samples)));
    if at.own.sensor.delay_samples > 0 {
        let delay = samples(at.own.sensor.delay_samples);
        facts.push(("Delay of the sensor", delay));
    }
    facts
}

fn sensor(at: &At<'_>) -> Vec<Fact> {
    let mut facts = Vec::new();
    if at.own.sensor.quantum_m > 0.0 {
        let step = figures(1e6 * at.own.sensor.quantum_m) + " µm";
        facts.push(("Step of the converter", step));
    }
    if let Some(range_m) = at.own.sensor.range_m {
        facts.push(("Sensor range", format!("±{} mm", figures(1e3 * range_m))));
    }
    facts
}

/// Loads, outages, faults and changes, in order of time.
fn disturbances(at: &At<'_>) -> Vec<Disturbed> {
    let vector = |v: V2| format!("[{}, {}]", figures(v.x), figures(v.y));
    let disturbed = |what: String, from_s: f64, to_s: f64| Disturbed {
        what,
        from_s,
        // What goes on for ever goes on to the end.
        to_s: to_s.min(at.scene.duration_s),
    };
    let mut all = Vec::new();
    for d in &at.scene.disturbances {
        let what = format!("force {} N{}", vector(d.force_n), course(&d.shape));
        all.push(disturbed(what, d.start_s, d.end_s()));
    }
    for b in &at.scene.base_motions {
        let what = format!(
            "base motion {} m/s²{}",
            vector(b.acceleration_m_s2),
            course(&b.shape)
        );
        all.push(disturbed(what, b.start_s, b.start_s + b.duration_s));
    }
    for o in &at.own.outages {
        all.push(disturbed(outage(o), o.start_s, o.end_s()));
    }
    for f in &at.own.faults {
        all.push(disturbed(fault(f), f.start_s, f.end_s()));
    }
    for c in &at.scene.changes {
        all.push(disturbed(change(c), c.at_s, c.at_s));
    }
    for s in &at.own.set_downs {
        let known = if s.announced { "" } else { "not " };
        let to = vector(1e6 * s.to_m);
        let what = format!("reference to {to} µm, {known}announced");
        all.push(disturbed(what, s.start_s, s.end_s()));
    }
    all.sort_by(|a, b| a.from_s.total_cmp(&b.from_s));
    all
}

fn course(shape: &Shape) -> String {
    match shape {
        Shape::Constant => String::new(),
        Shape::HalfSine => ", half a sine".to_owned(),
        Shape::Sine { frequency_hz, .. } => format!(", sine of {} Hz", figures(*frequency_hz)),
        Shape::Recorded(course) => format!(" times {}", course.file),
    }
}

fn along(axis: Axis) -> &'static str {
    match axis {
        Axis::X => " along x",
        Axis::Y => " along y",
        Axis::Both => "",
    }
}

fn outage(o: &Outage) -> String {
    let along = along(o.axis);
    match o.delivers {
        Delivers::Nothing => {
            let known = if o.known { "known" } else { "unknown" };
            format!("amplifier out{along}, {known} to the firmware")
        }
        Delivers::Inverted => format!("amplifier inverted{along}"),
        Delivers::Swapped => "axes of the amplifier swapped".to_owned(),
    }
}

fn fault(f: &Fault) -> String {
    let micrometres = |m: f64| figures(1e6 * m) + " µm";
    let what = match f.kind {
        FaultKind::Nan => "not a number".to_owned(),
        FaultKind::Infinity => "infinity".to_owned(),
        FaultKind::Zero => "zero".to_owned(),
        FaultKind::Rail => "end of the range".to_owned(),
        FaultKind::Stuck => "stuck".to_owned(),
        FaultKind::Offset(m) => format!("{} too much", micrometres(m)),
        FaultKind::Gain(gain) => format!("{} times", figures(gain)),
        FaultKind::Inverted => "inverted".to_owned(),
        FaultKind::Swapped => "axes swapped".to_owned(),
        FaultKind::Noise(times) => format!("{} times the noise", figures(times)),
        FaultKind::Spikes { rate_hz, size_m } => {
            format!(
                "spikes of {}, {} a second",
                micrometres(size_m),
                figures(rate_hz)
            )
        }
        FaultKind::Dropout => "no samples".to_owned(),
        FaultKind::Delay(samples) => format!("{samples} samples late"),
        FaultKind::Bits(bits) => format!("{bits} bits"),
        FaultKind::Oscillation {
            frequency_hz,
            amplitude_m,
        } => format!(
            "oscillation of {} at {} Hz",
            micrometres(amplitude_m),
            figures(frequency_hz)
        ),
    };
    format!("sensor fault{}: {what}", along(f.axis))
}

fn change(c: &TimedChange) -> String {
    let values = [
        (c.change.eccentricity_m).map(|m| format!("eccentricity {} µm", figures(1e6 * m))),
        (c.change.friction_coefficient).map(|mu| format!("friction {}", figures(mu))),
        (c.change.drive_torque_n_m).map(|t| format!("drive torque {} N m", figures(t))),
        (c.change.unbalance.as_ref())
            .map(|u| format!("{} g mm of unbalance more", figures(1e6 * u.moment_kg_m))),
    ];
    let values: Vec<String> = values.into_iter().flatten().collect();
    format!("from now on {}", values.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facts_and_spans(scene: &str) -> (String, Vec<String>) {
        let summary = summary(&Scene::parse("test", scene).unwrap(), 0);
        let facts: Vec<String> = (summary.facts.iter())
            .map(|(name, value)| format!("{name} {value}"))
            .collect();
        let spans = (summary.disturbances.iter())
            .map(|d| format!("{} to {}: {}", d.from_s, d.to_s, d.what))
            .collect();
        (facts.join("; "), spans)
    }

    /// What decides a result has a row, and what is not there has none.
    #[test]
    fn what_decides_a_result_is_among_the_facts() {
        let scene = include_str!("../../scenes/shock_15_g_on_amb.toml");
        let (facts, _) = facts_and_spans(scene);
        for fact in [
            "Contact stiffness 1e9 N/m",
            "Restitution 0.7",
            "Cap of each axis 1000 N",
            "Slew limit 2e6 N/s",
            "Amplifier lag 0.16 ms",
            "Delay of the magnet 2 samples",
            "Sensor range ±0.5 mm",
        ] {
            assert!(facts.contains(fact), "{fact}: {facts}");
        }
        for word in [
            "Race",
            "Out of round",
            "Rolling",
            "Contact damping",
            "Delay of the sensor",
        ] {
            assert!(!facts.contains(word), "{word}: {facts}");
        }
        let other = scene
            .replacen(
                "stiffness_n_m = 1e9",
                "stiffness_n_mn = 1e13\ndamping_s_m = 0.5",
                1,
            )
            .replacen("restitution = 0.7", "", 1)
            .replacen(
                "coefficient = 0.15",
                "coefficient = 0.15\nrolling_coefficient = 0.02",
                1,
            )
            .replacen("[sensor]", "[sensor]\ndelay_samples = 1", 1)
            + "\n[race]\ninertia_kg_m2 = 1e-3\ndrag_n_m_s = 1e-4\nstart_frequency_hz = 2.0\n";
        let (facts, _) = facts_and_spans(&other);
        for fact in [
            "Contact Hunt and Crossley, 1e13 N/m^1.5",
            "Contact damping 0.5 s/m",
            "Rolling friction 0.02",
            "Race 0.001 kg m², drag 1e\u{2212}4 N m s, 2 Hz at the start",
            "Delay of the sensor 1 sample",
            "Step of the converter 0.1 µm",
        ] {
            assert!(facts.contains(fact), "{fact}: {facts}");
        }
        assert!(!facts.contains("Restitution") && !facts.contains("Contact stiffness"));
        let bore = "[retainer]\nellipticity = 0.05\nlong_axis_deg = 30.0\n";
        let (facts, _) = facts_and_spans(&scene.replacen("[retainer]", bore, 1));
        let fact = "Out of round by 0.05 of the clearance, longer at 30°";
        assert!(facts.contains(fact), "{facts}");
    }

    #[test]
    fn a_scene_is_told_whole() {
        let scene = include_str!("../../scenes/shock_15_g_on_amb.toml");
        let (facts, _) = facts_and_spans(scene);
        for fact in ["Mass 10 kg", "Spin 200 Hz", "20 µm off", "seed 1"] {
            assert!(facts.contains(fact), "{facts}");
        }
        let more = "
            [[disturbance]]\nstart_s = 0.01\nduration_s = 1.0\nforce_n = [3.0, -4.0]\nshape = \"sine\"\nfrequency_hz = 60.0
            [[outage]]\nstart_s = 0.03\nduration_s = 0.01\naxis = \"y\"\nknown = true
            [[fault]]\nstart_s = 0.04\nduration_s = 0.01\nkind = \"offset\"\nvalue_m = 2e-5\naxis = \"x\"
            [[change]]\nat_s = 0.05\nfriction_coefficient = 0.3\neccentricity_m = 2e-6\n";
        let (_, spans) = facts_and_spans(&format!("{scene}{more}"));
        assert_eq!(
            spans,
            [
                "0.01 to 0.1: force [3, \u{2212}4] N, sine of 60 Hz",
                "0.02 to 0.031: base motion [147, 0] m/s², half a sine",
                "0.03 to 0.04: amplifier out along y, known to the firmware",
                "0.04 to 0.05: sensor fault along x: 20 µm too much",
                "0.05 to 0.05: from now on eccentricity 2 µm, friction 0.3",
            ]
        );
    }
}
