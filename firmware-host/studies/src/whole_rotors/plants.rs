//! The plants of the catalogue that are whole rotors, from their scene files.

use firmware_bench::device::levitation::LevitationParams;
use firmware_bench::device::loads::Disturbance;
use firmware_bench::device::modal_levitation::{ModalLevitationParams, Station, TiltParams};
use firmware_bench::device::whole_levitation::WholeLevitationParams;
use firmware_bench::scene::diagnostic::SceneError;
use firmware_bench::scene::{PlaneScene, Scene};
use plant_model::V2;
use std::f64::consts::TAU;

/// A rotor of the catalogue with its file's levitation controllers, in the middle, nothing happening.
#[derive(Debug, Clone)]
pub struct RotorPlant {
    /// Name, `P5`.
    pub name: &'static str,
    /// What it is.
    pub scene: Scene,
    /// Text of the scene, and of that with its robust loop.
    text: &'static str,
    robust: &'static str,
}

/// Text of its scene.
pub(super) const P5: &str = include_str!("../../scenes/rotors/p5.toml");

/// Name, scene, scene with the robust loop.
const FILES: [(&str, &str, &str); 4] = [
    ("P5", P5, include_str!("../../scenes/rotors/p5_robust.toml")),
    (
        "P6",
        include_str!("../../scenes/rotors/p6.toml"),
        include_str!("../../scenes/rotors/p6_robust.toml"),
    ),
    (
        "P7",
        include_str!("../../scenes/rotors/p7.toml"),
        include_str!("../../scenes/rotors/p7_robust.toml"),
    ),
    (
        "P8",
        include_str!("../../scenes/rotors/p8.toml"),
        include_str!("../../scenes/rotors/p8_robust.toml"),
    ),
];

/// Overload of the catalogue: over the caps that it is put against, and how long it lasts \[s\].
pub(super) const OVERLOAD: (f64, f64) = (1.3, 0.1);
/// Stiffness of a seal over that of a retainer bearing: thin teeth or carbon in a holder.
const SEAL_STIFFNESS: f64 = 0.2;
const SEAL_RESTITUTION: f64 = 0.5;
/// Dry, and rougher than what a retainer bearing is made of.
const SEAL_FRICTION: f64 = 0.3;

/// Which way a blow moves the rotor: as an impulse at a place does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Blow {
    /// At the centre of mass.
    Centre,
    /// At the first plane, at the second.
    End(usize),
    /// A pair at both planes against each other.
    Conical,
}

impl Blow {
    pub const ALL: [Self; 4] = [Self::Centre, Self::End(0), Self::End(1), Self::Conical];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Centre => "at the centre",
            Self::End(0) => "at the first end",
            Self::End(_) => "at the second end",
            Self::Conical => "conical",
        }
    }
}

/// Gains by frequency, so that one search serves plants of any size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loop {
    /// Natural frequency \[Hz\].
    pub frequency_hz: f64,
    pub damping_ratio: f64,
    /// Time constant of the derivative's filter \[samples\].
    pub filter: f64,
    /// Share of the gyroscopic moment that cross feedback takes, by mode; `None`: each plane its own PD.
    pub cross: Option<f64>,
}

impl Loop {
    fn gains(&self, mass: f64, stiffness: f64, period_s: f64) -> LevitationParams {
        let omega = TAU * self.frequency_hz;
        LevitationParams {
            proportional_n_m: mass * omega * omega - stiffness,
            integral_n_m_s: 0.0,
            derivative_n_s_m: 2.0 * self.damping_ratio * mass * omega,
            derivative_filter_s: self.filter * period_s,
        }
    }
}

impl RotorPlant {
    /// All of them.
    ///
    /// # Errors
    /// [`SceneError`] if a file of the catalogue is not valid.
    pub fn all() -> Result<Vec<Self>, SceneError> {
        let of = |(name, text, robust): &(&'static str, &'static str, &'static str)| {
            let scene = Scene::parse(&format!("rotors/{}.toml", name.to_lowercase()), text)?;
            Ok(Self {
                name,
                scene,
                text,
                robust,
            })
        };
        FILES.iter().map(of).collect()
    }

    /// The same with another levitation controller.
    pub fn levitated_by(&self, by: &Loop) -> Self {
        let mut with = self.clone();
        let period_s = 1.0 / self.scene.sample_rate_hz;
        let Some(cross) = by.cross else {
            with.scene.levitation = None;
            for (i, plane) in with.scene.planes.iter_mut().enumerate() {
                let rotor = self.scene.plant(i).rotor;
                let gains = by.gains(rotor.mass_kg, rotor.stiffness_n_m, period_s);
                plane.levitation = Some(gains);
            }
            return with;
        };
        let machine = &self.scene.machine;
        let rigid = machine.rotor.rigid();
        let (mut pull, mut pull_of_tilt) = (0.0, 0.0);
        for support in &machine.supports {
            let stiffness = support.stiffness_n_m.mean();
            pull += stiffness;
            pull_of_tilt += stiffness * support.position_m.powi(2);
        }
        let translation = by.gains(rigid.mass_kg, pull, period_s);
        let tilt = by.gains(rigid.transverse_inertia_kg_m2, pull_of_tilt, period_s);
        let station = |plane: &PlaneScene, sensor_m: f64| Station {
            sensor_m,
            magnet: plane
                .magnet
                .and_then(|m| machine.magnets.get(m))
                .map(|m| (m.position_m, m.force_max_n)),
        };
        with.scene.levitation = Some(WholeLevitationParams::Modal(ModalLevitationParams {
            translation,
            tilt: TiltParams {
                proportional_n_m_rad: tilt.proportional_n_m,
                integral_n_m_rad_s: 0.0,
                derivative_n_m_s_rad: tilt.derivative_n_s_m,
                cross_kg_m2: cross * rigid.polar_inertia_kg_m2,
            },
            stations: (self.scene.planes.iter().zip(&machine.probes_m))
                .map(|(plane, sensor_m)| station(plane, *sensor_m))
                .collect(),
        }));
        with
    }

    /// The same with the robust loop that is stored for it.
    ///
    /// # Errors
    /// [`SceneError`] if the stored scene is not valid.
    pub fn robust(&self) -> Result<Self, SceneError> {
        let mut with = self.clone();
        let file = format!("rotors/{}_robust.toml", self.name.to_lowercase());
        with.scene.levitation = Scene::parse(&file, self.robust)?.levitation;
        Ok(with)
    }

    /// The same with a seal in the middle between its planes, of a clearance that is this share of theirs.
    ///
    /// # Errors
    /// [`SceneError`] if that is no valid scene.
    pub fn sealed(&self, share: f64) -> Result<Self, SceneError> {
        let mut with = self.clone();
        let Some(plane) = self.scene.machine.planes.first() else {
            return Ok(with);
        };
        let places = self.scene.machine.planes.iter().map(|p| p.position_m);
        let seal = format!(
            "[[plane]]\nname = \"seal\"\nposition_m = {:e}\ncontact_radius_m = {:e}\nseal = true\n\
             contact = {{ clearance_m = {:e}, stiffness_n_m = {:e}, restitution = {SEAL_RESTITUTION:e} }}\n\
             friction = {{ coefficient = {SEAL_FRICTION:e} }}\n",
            places.sum::<f64>() / self.scene.planes.len() as f64,
            plane.radius_m,
            share * plane.contact.clearance_m,
            SEAL_STIFFNESS * plane.contact.stiffness_n_m(),
        );
        let file = format!("rotors/{}.toml", self.name.to_lowercase());
        with.scene = Scene::parse(&file, &format!("{}\n{seal}", self.text))?;
        // Whoever levitates it here.
        with.scene.levitation.clone_from(&self.scene.levitation);
        for (plane, own) in with.scene.planes.iter_mut().zip(&self.scene.planes) {
            plane.levitation = own.levitation;
        }
        Ok(with)
    }

    /// Under a load of so many caps (in the middle: of all caps together) for so long \[s\], in this direction, with other
    /// noise.
    pub(crate) fn overloaded(
        &self,
        end: Option<usize>,
        (share, duration_s): (f64, f64),
        (angle_rad, seed): (f64, u64),
    ) -> Scene {
        let mut scene = self.with_noise(seed);
        let machine = &scene.machine;
        let plane = end.and_then(|end| machine.planes.get(end));
        let position_m = plane.map_or(0.0, |plane| plane.position_m);
        let cap_n: f64 = match end {
            Some(end) => machine.magnets.get(end).map_or(0.0, |m| m.force_max_n),
            None => machine.magnets.iter().map(|m| m.force_max_n).sum(),
        };
        let (sin, cos) = angle_rad.sin_cos();
        scene.disturbances.push(Disturbance {
            position_m,
            start_s: 0.02,
            duration_s,
            force_n: share * cap_n * V2::new(cos, sin),
            ..Disturbance::default()
        });
        scene
    }

    /// Nothing happens to it, with other noise.
    fn with_noise(&self, seed: u64) -> Scene {
        let mut scene = self.scene.clone();
        for plane in &mut scene.planes {
            plane.seed = plane.seed.wrapping_add(seed);
        }
        scene
    }

    /// After a blow that gives the plane that it moves most this speed, in this direction, with other noise.
    pub fn struck(&self, blow: Blow, speed_m_s: f64, angle_rad: f64, seed: u64) -> Scene {
        let mut scene = self.with_noise(seed);
        let machine = &scene.machine;
        let places: Vec<f64> = machine.planes.iter().map(|p| p.position_m).collect();
        let rigid = machine.rotor.rigid();
        let (centre, tilt) = match blow {
            Blow::Centre => (speed_m_s, 0.0),
            Blow::Conical => {
                let farthest_m = places.iter().fold(0.0, |far: f64, z| far.max(z.abs()));
                (0.0, speed_m_s / farthest_m)
            }
            Blow::End(end) => {
                let z = places.get(end).copied().unwrap_or_default();
                let impulse = speed_m_s / rigid.mobility(z, z);
                let tilt = impulse * z / rigid.transverse_inertia_kg_m2;
                (impulse / rigid.mass_kg, tilt)
            }
        };
        let (sin, cos) = angle_rad.sin_cos();
        let along = V2::new(cos, sin);
        scene.start.centre_velocity_m_s = centre * along;
        scene.start.tilt_rate_rad_s = tilt * along;
        scene.levitated_before = true;
        scene
    }
}
