//! From what the user wrote to a scene that can be run.

use crate::device::sensor::SpinSensorParams;
use crate::scene::Scene;
use crate::scene::devices::centre_offset_m;
use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::events::events;
use crate::scene::guess;
use crate::scene::limits::{damping_n_s_m, whirl_speed_m_s};
use crate::scene::lint::{Told, slips, unseen, warnings};
use crate::scene::nominal::{NominalKeys, config, nominal, overrides};
use crate::scene::own_controller::own_controller;
use crate::scene::plane_spec::PlaneSpec;
use crate::scene::plant::{hardening_key, plant, plant_of, refused};
use crate::scene::policy_kind::PolicyKind;
use crate::scene::spec::Spec;
use crate::scene::tables::SceneTables;
use crate::scene::values::MethodName;
use plant_model::V2;
use plant_model::machine::point_mass::PointMass;
use plant_model::params::{ContactLaw, PlantParams, RotorParams, Start};
use std::f64::consts::TAU;

/// Rows of traces that a run may keep, of all its policies: some 0.3 KB each.
const MOST_ROWS: f64 = 1e7;

impl Spec {
    /// The scene, every value checked: in its range, and against the others.
    ///
    /// # Errors
    /// [`SceneError`] with file, line and key, and with slips beside it that may be the reason.
    pub fn resolve(&self) -> Result<Scene, SceneError> {
        let plane = self.only_plane()?;
        let resolved = || {
            self.check_ranges()?;
            plane.resolve(None)
        };
        resolved().map_err(|error| error.beside(&slips(&plane)))
    }
}

/// What a plane is to the rotor that it shares with others.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OfMachine {
    /// The rotor as an impact in this plane finds it.
    pub(crate) point: PointMass,
    /// Mass whose weight its magnet carries \[kg\].
    pub(crate) carried_kg: f64,
    /// What the shaft gives way there beside its modes \[m/N\].
    pub(crate) residual_m_n: f64,
    pub(crate) retainer_plane_ratio: f64,
    pub(crate) magnet_plane_ratio: f64,
    /// Force at a plane without a magnet that moves it as all magnets elsewhere do together \[N\]; 0 where it has one, or
    /// nobody has.
    pub(crate) others_n: f64,
    /// Whether it is levitated by a controller of its own.
    pub(crate) levitated_alone: bool,
}

impl PlaneSpec {
    /// A scene of this plane alone; `of` a rotor that it shares, the design model that controllers of the plane have of it.
    pub(crate) fn resolve(&self, of: Option<&OfMachine>) -> Result<Scene, SceneError> {
        let (written, text) = (&self.tables, &self.text);
        let plant = match of {
            None => plant(self)?,
            Some(of) => {
                let point = RotorParams {
                    mass_kg: of.point.mass_kg,
                    stiffness_n_m: of.point.stiffness_n_m,
                    damping_n_s_m: of.point.damping_n_s_m,
                    eccentricity_m: 0.0,
                    contact_radius_m: self.contact_radius_m,
                };
                let mut plant = plant_of(self, point)?;
                give_way(&mut plant, of.residual_m_n);
                plant
            }
        };
        let mut start = Start {
            position_m: written.start.position_m.into(),
            velocity_m_s: written.start.velocity_m_s.into(),
            spin_rad_s: written.spin.frequency_hz * TAU,
            spin_phase_rad: written.start.spin_phase_rad,
        };
        start.validate().map_err(|error| refused(&error, text))?;
        check_method(self, &plant)?;
        check_title_and_length(written, text)?;
        if let Some(m) = &written.magnet
            && m.delay_samples + m.delay_jitter_samples > 7
        {
            let message = format!(
                "makes {} samples with magnet.delay_samples, expected at most 7",
                m.delay_samples + m.delay_jitter_samples
            );
            let help = Some("shorten one of them".to_owned());
            return Err(text.error_at_key("magnet.delay_jitter_samples", message, help));
        }
        // Where others have the magnets, policies are theirs.
        let others_n = of.map_or(0.0, |of| of.others_n);
        let policies = policies(self, others_n > 0.0)?;
        let events = events(self)?;
        let centre_offset_m = centre_offset_m(self)?;
        start.position_m -= centre_offset_m;
        let whirl_speed_m_s = whirl_speed_m_s(self, &plant, others_n)?;
        let damps = policies.contains(&PolicyKind::Damping) && others_n == 0.0;
        let damping_n_s_m = damping_n_s_m(self, &plant, damps)?;
        let weight_n = match of {
            None => plant.rotor.mass_kg,
            Some(of) => of.carried_kg,
        } * V2::from(written.rotor.gravity_m_s2);
        let mut nominal = nominal(&plant, self);
        if let Some(of) = of {
            nominal.load_n = weight_n.norm();
            nominal.retainer_plane_ratio = of.retainer_plane_ratio;
            nominal.magnet_plane_ratio = of.magnet_plane_ratio;
        }
        let nominal_keys = NominalKeys::new(&nominal, self);
        let overrides = overrides(self)?;
        let supervised = policies.contains(&PolicyKind::Supervisor) && others_n == 0.0;
        let supervisor = supervised
            .then(|| config(&nominal, &nominal_keys, &overrides, text))
            .transpose()?;
        let told = Told {
            nominal: &nominal,
            overrides: &overrides,
            config: supervisor.as_ref(),
            levitated_alone: of.is_none_or(|of| of.levitated_alone),
        };
        let warnings = match text.warns {
            true => [warnings(self, &plant, told), unseen(self)].concat(),
            false => Vec::new(),
        };
        let (run, spin_sensor) = (&written.run, &written.spin_sensor);
        let levitation = written.levitation.as_ref();
        let controller = match of {
            // That of several planes is the machine's.
            Some(_) => None,
            None => own_controller(written, text, std::slice::from_ref(self))?,
        };
        Ok(Scene {
            title: written.title.clone(),
            story: written.story.trim().to_owned(),
            plant,
            start,
            weight_n,
            feed_forward_n: match written.feeds_weight_forward() {
                true => -weight_n,
                false => V2::zeros(),
            },
            disturbances: events.disturbances,
            base_motions: events.base_motions,
            changes: events.changes,
            set_downs: events.set_downs,
            levitated_before: written.start.levitated_before,
            centre_offset_m,
            severity_allowed: written.retainer.severity_allowed,
            duration_s: run.duration_s,
            sample_rate_hz: run.sample_rate_hz,
            rtol: run.rtol,
            method: run.method.into(),
            seed: run.seed,
            policies,
            amplifier: written.magnet.as_ref().map(Into::into).unwrap_or_default(),
            outages: events.outages,
            sensor: (&written.sensor).into(),
            faults: events.faults,
            spin_sensor: SpinSensorParams {
                valid: spin_sensor.valid,
                gain: match spin_sensor.reversed {
                    true => -spin_sensor.gain,
                    false => spin_sensor.gain,
                },
            },
            levitation: levitation.map(Into::into),
            controller,
            radial_band: written.radial.band,
            damping_n_s_m,
            supervisor,
            nominal,
            nominal_keys,
            decided: Vec::new(),
            overrides,
            whirl_speed_m_s,
            warnings,
        })
    }
}

/// A contact in series with a spring: what the shaft bends there in modes that are not kept.
fn give_way(plant: &mut PlantParams, residual_m_n: f64) {
    if let ContactLaw::Linear(law) = &mut plant.contact.law {
        let share = 1.0 / (1.0 + law.stiffness_n_m * residual_m_n);
        law.stiffness_n_m *= share;
        // Of slow motions the damper sees that share of the way, and its force counts by it once more.
        law.damping_n_s_m *= share * share;
    }
}

fn check_method(spec: &PlaneSpec, plant: &PlantParams) -> Result<(), SceneError> {
    if spec.tables.run.method != MethodName::Series || plant.has_series() {
        return Ok(());
    }
    let with = hardening_key(&spec.contact).unwrap_or("retainer.ellipticity");
    let message = format!("series does not go with {with}");
    let help = "take auto or collocation: this contact has no power series at the touch";
    Err((spec.text).error_at_key("run.method", message, Some(help.to_owned())))
}

fn check_title_and_length(written: &SceneTables, text: &SceneText) -> Result<(), SceneError> {
    let (run, title) = (&written.run, &written.title);
    let ticks = run.duration_s * run.sample_rate_hz;
    let policies = run.policies.0.len();
    if ticks * policies as f64 > MOST_ROWS {
        let help = "shorten run.duration_s, lower run.sample_rate_hz or run fewer policies";
        let message = format!(
            "{ticks:e} control samples for each of {policies} policies: expected at most 10 million in all"
        );
        return Err(text.error_at_key("run.duration_s", message, Some(help.to_owned())));
    }
    // A terminal takes other control characters for orders.
    if title.trim().is_empty() || title.chars().any(char::is_control) {
        let help = Some("what the scene is for goes into story".to_owned());
        let message = "expected a name in one line, without control characters".to_owned();
        return Err(text.error_at_key("title", message, help));
    }
    Ok(())
}

fn policies(spec: &PlaneSpec, of_others: bool) -> Result<Vec<PolicyKind>, SceneError> {
    let known = PolicyKind::ALL.map(PolicyKind::name);
    let names = known.join(", ");
    let refused = |message: String, help: String| {
        (spec.text).error_at_key("run.policies", message, Some(help))
    };
    let mut policies = Vec::new();
    for name in &spec.tables.run.policies.0 {
        let kind = PolicyKind::from_name(name).ok_or_else(|| {
            let help = guess::before(format!("policies are {names}"), name, known);
            refused(format!("there is no policy \"{name}\""), help)
        })?;
        let (message, help) = if policies.contains(&kind) {
            ("is named twice", "name each policy once")
        } else if of_others {
            policies.push(kind);
            continue;
        } else if kind != PolicyKind::Passive && spec.tables.magnet.is_none() {
            ("needs a magnet", "add a [magnet], or run only \"passive\"")
        } else if kind.levitates() && !spec.tables.levitates() {
            (
                "needs a levitation controller",
                "add [levitation] with its gains, or a controller of your own: [state_space], [biquads] or [controller]",
            )
        } else {
            policies.push(kind);
            continue;
        };
        return Err(refused(format!("\"{name}\" {message}"), help.to_owned()));
    }
    if policies.is_empty() {
        let help = format!("name at least one of {names}");
        return Err(refused("is empty".to_owned(), help));
    }
    Ok(policies)
}
