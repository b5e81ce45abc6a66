//! A recorded event once more, simulated on a scene's machine with what the record tells of it.

use crate::device::loads::{Disturbance, Shape};
use crate::record::file::PlaneRecord;
use crate::record::identify::{Estimate, Findings};
use crate::scene::Scene;
use crate::scene::diagnostic::SceneError;
use crate::scene::spec::{Setting, Spec};
use plant_model::V2;
use std::f64::consts::TAU;
use supervisor::Mode;
use toml::Value;

/// The simulation goes on for so long after the record froze, in times of what it holds; and no longer than this \[s\].
const BEYOND: f64 = 0.5;
const LONGEST_S: f64 = 5.0;

/// The scene of an event: it begins where the rotor flew to its first contact, under the load that was found, and ends some time
/// after the record froze. Of the machine, what the record tells is put in the place of what the scene says; what else
/// happens in the scene is left out. `given` has the last word.
///
/// # Errors
/// [`SceneError`] where these do not make a scene.
pub fn scene_of_event(
    mut spec: Spec,
    (record, findings): (&PlaneRecord, &Findings),
    given: &[Setting],
) -> Result<Scene, SceneError> {
    let (launch, found) = (&findings.launch, &findings.identified);
    let identified = [
        ("friction.coefficient", found.friction_coefficient),
        ("contact.restitution", found.restitution),
        ("contact.clearance_m", found.clearance_m),
    ];
    for (key, estimate) in identified {
        // A scene that says it by other keys keeps what it says.
        if let (Some(estimate), Some(_)) = (estimate, spec.get(key)?) {
            spec.set(key, estimate.value)?;
        }
    }
    let pair = |v: V2| vec![Value::Float(v.x), Value::Float(v.y)];
    spec.set("start.position_m", pair(launch.position_m))?;
    spec.set("start.velocity_m_s", pair(launch.velocity_m_s))?;
    spec.set("spin.frequency_hz", launch.spin_rad_s / TAU)?;
    // A record begins before the event.
    spec.set("start.levitated_before", true)?;
    let policies = ["passive", "levitation", "supervisor"].map(|p| Value::String(p.to_owned()));
    spec.set("run.policies", policies.to_vec())?;
    for setting in given {
        spec.set(&setting.path, setting.value.clone())?;
    }
    let mut scene = spec.resolve()?;
    if !spec.tables.plane.is_empty() {
        let message = "a record tells of one plane, and of a point mass in it".to_owned();
        let help = "give a scene of this plane alone, without [[plane]]".to_owned();
        return Err(spec.text.error_at_key("plane", message, Some(help)));
    }
    if scene.planes[0].axes_rad != [0.0; 2] {
        let message = "a record is along the axes of the instruments".to_owned();
        let help = "turn the scene instead, and leave axes_deg at 0".to_owned();
        return Err(spec
            .text
            .error_at_key("sensor.axes_deg", message, Some(help)));
    }
    let since = |sequence: u32| {
        let ticks = sequence.wrapping_sub(findings.first).cast_signed();
        (f64::from(ticks) - launch.tick as f64) / scene.sample_rate_hz
    };
    let frozen_s = since(record.head.closed_at).max(0.0);
    let duration_s = (frozen_s * (1.0 + BEYOND)).clamp(0.05, LONGEST_S);
    let (from, to) = findings.loaded;
    let at = |tick: usize| (tick as f64 - launch.tick as f64).max(0.0) / scene.sample_rate_hz;
    let end_s = to.map_or_else(|| handed_over(record).map_or(duration_s, since), at);
    let zero = |estimate: Option<Estimate>| estimate.map_or(0.0, |e| e.value);
    let load_n = V2::new(zero(found.load_x_n), zero(found.load_y_n));
    scene.disturbances.clear();
    if load_n.norm() > 0.0 && end_s > at(from) {
        scene.disturbances.push(Disturbance {
            position_m: 0.0,
            start_s: at(from),
            duration_s: end_s - at(from),
            force_n: load_n,
            shape: Shape::Constant,
        });
    }
    scene.base_motions.clear();
    scene.changes.clear();
    for plane in &mut scene.planes {
        plane.outages.clear();
        plane.faults.clear();
        plane.set_downs.clear();
    }
    scene.duration_s = duration_s;
    scene.title = format!("The event once more, on: {}", scene.title);
    Ok(scene)
}

/// Sequence number at which hand-over began, by the slow track.
fn handed_over(record: &PlaneRecord) -> Option<u32> {
    let over = 1 << Mode::Handover as u16;
    let stretch = record.track.iter().find(|s| s.modes & over != 0)?;
    Some(stretch.sequence.wrapping_sub(u32::from(stretch.ticks)))
}
