//! From what the user wrote of a plane to a plane of a scene, every value checked.

use crate::device::axis::Turned;
use crate::device::loads::{BaseMotion, Disturbance, TimedChange};
use crate::scene::PlaneScene;
use crate::scene::diagnostic::SceneError;
use crate::scene::events::events;
use crate::scene::guess;
use crate::scene::limits::{damping_n_s_m, whirl_speed_m_s};
use crate::scene::lint::{Setup, unseen, warnings};
use crate::scene::nominal::{NominalKeys, config, nominal, overrides};
use crate::scene::plane_spec::PlaneSpec;
use crate::scene::plant::{hardening_key, plant};
use crate::scene::policy_kind::PolicyKind;
use crate::scene::values::MethodName;
use plant_model::V2;
use plant_model::machine::point_mass::PointMass;
use plant_model::params::{ContactLaw, PlantParams, RotorParams};

/// What a plane is to the rotor that it shares with others.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RotorContext {
    /// The rotor as an impact in this plane finds it.
    pub(crate) point: PointMass,
    /// Mass whose weight its magnet carries \[kg\].
    pub(crate) carried_kg: f64,
    /// What the shaft gives way there beside its modes \[m/N\].
    pub(crate) residual_m_n: f64,
    /// Which magnet of the machine is its own.
    pub(crate) magnet: Option<usize>,
    pub(crate) retainer_plane_ratio: f64,
    pub(crate) magnet_plane_ratio: f64,
    /// Force at a plane without a magnet that moves it as all magnets elsewhere do together \[N\]; 0 where it has one, or
    /// nobody has.
    pub(crate) others_n: f64,
}

/// A plane, and what it says of the scene, in which all planes agree.
pub(crate) struct Resolved {
    pub(crate) plane: PlaneScene,
    /// The plant that its controllers are designed for; its wall is the machine's.
    pub(crate) plant: PlantParams,
    pub(crate) disturbances: Vec<Disturbance>,
    pub(crate) base_motions: Vec<BaseMotion>,
    pub(crate) changes: Vec<TimedChange>,
    pub(crate) policies: Vec<PolicyKind>,
    pub(crate) warnings: Vec<String>,
}

impl PlaneSpec {
    /// The plane, every value checked.
    pub(crate) fn resolve(&self, of: &RotorContext) -> Result<Resolved, SceneError> {
        let (written, text) = (&self.tables, &self.text);
        let point = RotorParams {
            mass_kg: of.point.mass_kg,
            stiffness_n_m: of.point.stiffness_n_m,
            damping_n_s_m: of.point.damping_n_s_m,
            eccentricity_m: written.rotor.eccentricity_m,
            contact_radius_m: self.contact_radius_m,
        };
        let mut plant = plant(self, point)?;
        add_shaft_compliance(&mut plant, of.residual_m_n);
        check_method(self, &plant)?;
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
        let magnet_deg = written.magnet.as_ref().map_or(0.0, |m| m.axes_deg);
        if magnet_deg != 0.0 && written.magnet.as_ref().is_some_and(|m| m.poles.is_some()) {
            let message = "does not go with magnet.poles, which stand along x and y".to_owned();
            let help = Some("turn loads, weight and the sensor's axes the other way".to_owned());
            return Err(text.error_at_key("magnet.axes_deg", message, help));
        }
        let axes_rad = [written.sensor.axes_deg, magnet_deg].map(f64::to_radians);
        // Where others have the magnets, policies are theirs.
        let policies = policies(self, of.others_n > 0.0)?;
        let events = events(self)?;
        let whirl_speed_m_s = whirl_speed_m_s(self, &plant, of.others_n)?;
        let acts = |kind| policies.contains(&kind) && of.others_n == 0.0;
        let damping_n_s_m = damping_n_s_m(self, &plant, acts(PolicyKind::Damping))?;
        let weight_n = of.carried_kg * V2::from(written.rotor.gravity_m_s2);
        let mut nominal = nominal(&plant, self);
        nominal.load_n = weight_n.norm();
        nominal.retainer_plane_ratio = of.retainer_plane_ratio;
        nominal.magnet_plane_ratio = of.magnet_plane_ratio;
        let nominal_keys = NominalKeys::new(&nominal, self);
        let overrides = overrides(self)?;
        let supervisor = acts(PolicyKind::Supervisor)
            .then(|| config(&nominal, &nominal_keys, &overrides, text))
            .transpose()?;
        let setup = Setup {
            nominal: &nominal,
            overrides: &overrides,
            config: supervisor.as_ref(),
        };
        let warnings = match text.warns {
            true => [warnings(self, &plant, setup), unseen(self)].concat(),
            false => Vec::new(),
        };
        let plane = PlaneScene {
            name: self.name.clone(),
            seal: self.seal,
            magnet: of.magnet,
            weight_n,
            feed_forward_n: match written.feeds_weight_forward() {
                true => -Turned::by(axes_rad[1]).seen(weight_n),
                false => V2::zeros(),
            },
            severity_allowed: written.retainer.severity_allowed,
            // Noise of its own, and that of the file for the first.
            seed: (written.run.seed)
                .wrapping_add(0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(self.index as u64)),
            amplifier: written.magnet.as_ref().map(Into::into).unwrap_or_default(),
            outages: events.outages,
            set_downs: events.set_downs,
            sensor: (&written.sensor).into(),
            axes_rad,
            faults: events.faults,
            levitation: written.levitation.as_ref().map(Into::into),
            radial_band: written.radial.band,
            damping_n_s_m,
            supervisor,
            nominal,
            nominal_keys,
            decided: Vec::new(),
            overrides,
            whirl_speed_m_s,
        };
        Ok(Resolved {
            plane,
            plant,
            disturbances: events.disturbances,
            base_motions: events.base_motions,
            changes: events.changes,
            policies,
            warnings,
        })
    }
}

/// A contact in series with a spring: what the shaft bends there in modes that are not kept.
fn add_shaft_compliance(plant: &mut PlantParams, residual_m_n: f64) {
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
