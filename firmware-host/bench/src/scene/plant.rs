//! The plant from the scene's keys: alternatives resolved, every value checked.

use crate::scene::diagnostic::{Given, SceneError, SceneText};
use crate::scene::plane_spec::PlaneSpec;
use crate::scene::tables::{ContactTable, FrictionTable, RingTable, SceneTables};
use plant_model::contact::ball_bearing::{BallBearing, fitted_curve};
use plant_model::contact::{damping_for_restitution, hunt_crossley};
use plant_model::params::{
    ContactLaw, ContactParams, EllipseParams, FrictionParams, HuntCrossley, LinearContact,
    MagnetParams, ParamError, PlantParams, RaceParams, RingParams, RotorParams, SlidingFriction,
    SpinParams, StatorParams,
};
use std::f64::consts::TAU;

/// The plant of a plane with a rotor that is known, checked.
pub(crate) fn plant(spec: &PlaneSpec, rotor: RotorParams) -> Result<PlantParams, SceneError> {
    let (file, text) = (&spec.tables, &spec.text);
    let magnet = file.magnet.as_ref();
    let mut plant = PlantParams {
        rotor,
        spin: spin(file, text)?,
        stator: stator(file, text)?,
        contact: ContactParams {
            clearance_m: spec.contact.clearance_m,
            law: law(&spec.contact, text)?,
        },
        friction: FrictionParams {
            sliding: sliding(&spec.friction, text)?,
            rolling_coefficient: spec.friction.rolling_coefficient,
        },
        magnet: magnet.map(|m| MagnetParams {
            force_max_n: m.force_max_n,
            // Of second order, its mean delay.
            lag_s: m.lag_s * m.lag_damping_ratio.map_or(1.0, |ratio| 2.0 * ratio),
        }),
        race: file.race.as_ref().map(|race| RaceParams {
            inertia_kg_m2: race.inertia_kg_m2,
            drag_n_m_s: race.drag_n_m_s,
            start_spin_rad_s: race.start_frequency_hz * TAU,
        }),
    };
    plant.validate().map_err(|error| refused(&error, text))?;
    restore(&mut plant, &spec.contact, text)?;
    Ok(plant)
}

/// Held, or free with its inertia.
pub(crate) fn spin(file: &SceneTables, text: &SceneText) -> Result<SpinParams, SceneError> {
    match (file.spin.inertia_kg_m2, file.spin.drive_torque_n_m) {
        (Some(inertia_kg_m2), torque) => Ok(SpinParams::Free {
            inertia_kg_m2,
            drive_torque_n_m: torque.unwrap_or(0.0),
        }),
        (None, None) => Ok(SpinParams::Held),
        (None, Some(_)) => {
            let message = "has no effect while the speed is held".to_owned();
            let help = Some("give spin.inertia_kg_m2, or remove the torque".to_owned());
            Err(text.error_at_key("spin.drive_torque_n_m", message, help))
        }
    }
}

/// What the plant refuses, at the key that it comes from.
pub(crate) fn refused(error: &ParamError, text: &SceneText) -> SceneError {
    let key = match error.field.as_str() {
        "start.spin_rad_s" => "spin.frequency_hz",
        "race.start_spin_rad_s" => "race.start_frequency_hz",
        field => field,
    };
    text.refused(key, error.value, error.expected)
}

/// The stator with its rings, or rigid with its bore.
fn stator(file: &SceneTables, text: &SceneText) -> Result<StatorParams, SceneError> {
    let refused = |key: &str, message: &str, help: &str| {
        Err(text.error_at_key(key, message.to_owned(), Some(help.to_owned())))
    };
    let retainer = &file.retainer;
    let rings = (&file.stator.inner, &file.stator.outer);
    if retainer.ellipticity != 0.0 {
        let key = "retainer.ellipticity";
        if rings.0.is_some() || rings.1.is_some() {
            let help = "remove [stator], or leave the bearing round";
            return refused(key, "needs a rigid stator: rings are round", help);
        }
        if file.race.is_some() {
            let help = "remove [race], or leave the bearing round";
            return refused(key, "does not go with a race, which would turn it", help);
        }
        return Ok(StatorParams::RigidEllipse(EllipseParams {
            ellipticity: retainer.ellipticity,
            long_axis_rad: retainer.long_axis_deg.unwrap_or(0.0).to_radians(),
        }));
    }
    if retainer.long_axis_deg.is_some() {
        let help = "give retainer.ellipticity, or remove the direction";
        return refused("retainer.long_axis_deg", "has no meaning on a circle", help);
    }
    Ok(match rings {
        (None, None) => StatorParams::Rigid,
        (Some(inner), None) => StatorParams::OneMass(ring(inner)),
        (Some(inner), Some(outer)) => StatorParams::TwoMass {
            inner: ring(inner),
            outer: ring(outer),
        },
        (None, Some(_)) => {
            let help = "describe a single ring as stator.inner";
            return refused("stator.outer", "an outer ring without an inner one", help);
        }
    })
}

/// The contact law with the damping that is given directly.
fn law(file: &ContactTable, text: &SceneText) -> Result<ContactLaw, SceneError> {
    let refused = |key: &str, message: String, help: String| {
        Err::<ContactLaw, _>(text.error_at_key(key, message, Some(help)))
    };
    let linear = file.stiffness_n_m;
    let hardening = hardening(file, text)?;
    let (foreign, own) = match hardening {
        Some(_) => (
            &[("contact.damping_n_s_m", file.damping_n_s_m)][..],
            "stiffness_n_m",
        ),
        None => (
            &[
                ("contact.exponent", file.exponent),
                ("contact.damping_s_m", file.damping_s_m),
                ("contact.restitution_speed_m_s", file.restitution_speed_m_s),
            ][..],
            "stiffness_n_mn",
        ),
    };
    if let Some((key, _)) = foreign.iter().find(|(_, value)| value.is_some()) {
        let message = format!("belongs to a contact with {own}");
        return refused(key, message, format!("remove it, or give contact.{own}"));
    }
    match (linear, hardening) {
        (_, Some(law)) => Ok(HuntCrossley {
            damping_s_m: file.damping_s_m.unwrap_or(0.0),
            ..law
        }
        .into()),
        (Some(stiffness_n_m), None) => Ok(LinearContact {
            stiffness_n_m,
            damping_n_s_m: file.damping_n_s_m.unwrap_or(0.0),
        }
        .into()),
        (None, None) => {
            let help = "give stiffness_n_m (linear), stiffness_n_mn (Hunt and Crossley), balls (a ball bearing), or deflections_m and forces_n (a measured curve)";
            refused("contact", "has no stiffness".to_owned(), help.to_owned())
        }
    }
}

/// Share of a force by which a fitted curve may miss it.
const MISFIT: f64 = 0.1;

/// A stiffness that grows with the depth, however it is given.
fn hardening(file: &ContactTable, text: &SceneText) -> Result<Option<HuntCrossley>, SceneError> {
    let refused = |key: &str, message: String, help: &str| {
        Err(text.error_at_key(key, message, Some(help.to_owned())))
    };
    let given = [
        ("contact.stiffness_n_m", file.stiffness_n_m.is_some()),
        ("contact.stiffness_n_mn", file.stiffness_n_mn.is_some()),
        ("contact.balls", file.balls.is_some()),
        ("contact.deflections_m", file.deflections_m.is_some()),
    ];
    let mut stiff = given.iter().filter(|(_, given)| *given);
    if let (Some((key, _)), Some((other, _))) = (stiff.next(), stiff.next()) {
        let message = format!("given together with {other}, which says the same");
        return refused(key, message, &format!("remove {key} or {other}"));
    }
    let by_other = file.balls.is_some() || file.deflections_m.is_some();
    if by_other && file.exponent.is_some() {
        let message = "follows from the balls or the curve".to_owned();
        return refused("contact.exponent", message, "remove it");
    }
    if file.deflections_m.is_none() && file.forces_n.is_some() {
        let help = "give the deflections of these forces";
        return refused("contact.forces_n", "needs deflections_m".to_owned(), help);
    }
    if let Some(balls) = &file.balls {
        let bearing = BallBearing {
            balls: balls.count,
            ball_diameter_m: balls.diameter_m,
            contact_angle_rad: balls.contact_angle_deg.to_radians(),
        };
        return Ok(Some(hertz(bearing.stiffness_n_mn(), 1.5)));
    }
    let (deflections, forces) = match (&file.deflections_m, &file.forces_n) {
        (Some(deflections), Some(forces)) => (&deflections.0, &forces.0),
        (None, _) => {
            let exponent = file.exponent.unwrap_or(1.5);
            return Ok(file.stiffness_n_mn.map(|k| hertz(k, exponent)));
        }
        (Some(_), None) => {
            let help = "give a force for each deflection";
            return refused("contact.deflections_m", "needs forces_n".to_owned(), help);
        }
    };
    let Some(fitted) = fitted_curve(deflections, forces) else {
        let message = format!(
            "is no curve with forces_n: {} deflections, {} forces",
            deflections.len(),
            forces.len()
        );
        let help =
            "give as many deflections as forces, at least two, all above 0 and not all alike";
        return refused("contact.deflections_m", message, help);
    };
    let exponent = fitted.law.exponent;
    if fitted.misfit > MISFIT || !(1.0..=3.0).contains(&exponent) {
        let message = format!(
            "is no power of the deflection: the best, {exponent:.2}, misses a force by {:.0} %",
            100.0 * fitted.misfit
        );
        let help = "take out the internal clearance and the ends; a power from 1 to 3 is to miss no force by more than 10 %";
        return refused("contact.forces_n", message, help);
    }
    Ok(Some(fitted.law))
}

/// The key by which a contact has a stiffness that grows with the depth.
pub(crate) fn hardening_key(file: &ContactTable) -> Option<&'static str> {
    let keys = [
        ("contact.stiffness_n_mn", file.stiffness_n_mn.is_some()),
        ("contact.balls", file.balls.is_some()),
        ("contact.deflections_m", file.deflections_m.is_some()),
    ];
    let given = keys.into_iter().find(|(_, given)| *given)?;
    Some(given.0)
}

fn hertz(stiffness_n_mn: f64, exponent: f64) -> HuntCrossley {
    HuntCrossley {
        stiffness_n_mn,
        exponent,
        damping_s_m: 0.0,
    }
}

/// Damping from a restitution, where the file gives that instead.
fn restore(
    plant: &mut PlantParams,
    file: &ContactTable,
    text: &SceneText,
) -> Result<(), SceneError> {
    let mass_kg = plant.contact_mass_kg();
    const KEY: &str = "contact.restitution";
    const SPEED: &str = "contact.restitution_speed_m_s";
    let damping = match &plant.contact.law {
        ContactLaw::Linear(_) => Given::new("contact.damping_n_s_m", file.damping_n_s_m),
        ContactLaw::HuntCrossley(_) => Given::new("contact.damping_s_m", file.damping_s_m),
    };
    text.either(damping, Given::new(KEY, file.restitution))?;
    let Some(e) = file.restitution else {
        return match file.restitution_speed_m_s {
            None => Ok(()),
            Some(_) => {
                let message = "has no effect without contact.restitution".to_owned();
                let help = Some("give contact.restitution, or remove the speed".to_owned());
                Err(text.error_at_key(SPEED, message, help))
            }
        };
    };
    let no_damping = |with: &str| {
        let message = format!("gives no finite damping with {with}");
        let help = Some(format!("check {with}"));
        text.error_at_key(KEY, message, help)
    };
    match &mut plant.contact.law {
        ContactLaw::Linear(law) => {
            law.damping_n_s_m = damping_for_restitution(e, law.stiffness_n_m, mass_kg)
                .filter(|d| d.is_finite())
                .ok_or_else(|| no_damping("contact.stiffness_n_m and the masses"))?;
        }
        ContactLaw::HuntCrossley(law) => {
            let Some(speed_m_s) = file.restitution_speed_m_s else {
                let message = "needs the impact speed that it belongs to".to_owned();
                let help = Some(
                    "give contact.restitution_speed_m_s too: with this law e falls with speed"
                        .to_owned(),
                );
                return Err(text.error_at_key(KEY, message, help));
            };
            law.damping_s_m = hunt_crossley::damping_for_restitution(e, speed_m_s)
                .filter(|d| d.is_finite())
                .ok_or_else(|| no_damping(SPEED))?;
        }
    }
    Ok(())
}

fn ring(file: &RingTable) -> RingParams {
    RingParams {
        mass_kg: file.mass_kg,
        stiffness_n_m: file.stiffness_n_m.into(),
        damping_n_s_m: file.damping_n_s_m.into(),
    }
}

fn sliding(f: &FrictionTable, text: &SceneText) -> Result<SlidingFriction, SceneError> {
    match (f.coefficient_at_speed, f.speed_scale_m_s) {
        (None, None) => Ok(SlidingFriction::Constant {
            coefficient: f.coefficient,
        }),
        (Some(at_speed), Some(speed_scale_m_s)) => Ok(SlidingFriction::Falling {
            at_rest: f.coefficient,
            at_speed,
            speed_scale_m_s,
        }),
        (at_speed, _) => {
            let (have, want) = match at_speed {
                Some(_) => ("friction.coefficient_at_speed", "friction.speed_scale_m_s"),
                None => ("friction.speed_scale_m_s", "friction.coefficient_at_speed"),
            };
            let help = Some("friction that falls with speed needs both keys".to_owned());
            Err(text.error_at_key(have, format!("given without {want}"), help))
        }
    }
}
