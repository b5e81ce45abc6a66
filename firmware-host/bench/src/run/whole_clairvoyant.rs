//! The reference policy of a whole rotor: the true state of both planes, no noise, no delay, the same caps and amplifiers.
//!
//! Each plane has the law of the [point mass](crate::run::clairvoyant) that an impact finds there. What the laws want is
//! allocated over both magnets by the mobilities of the rigid rotor,
//!
//! ```text
//! f_p + s·M(z_q, z_p)/M(z_p, z_p)·f_q
//! ```
//!
//! to the magnet of plane p: with s > 0 it lends to the other plane q what it can do there, with s < 0 it takes off what the
//! other magnet does to its own plane. s is free, as the weights of the laws are.

use crate::device::levitation::{LevitationParams, TrueLevitation};
use crate::run::clairvoyant::{Clairvoyant, ClairvoyantLaw, largest_share, restitution, rotated};
use crate::scene::{PlaneScene, Scene};
use plant_model::{Snapshot, V2};

/// The free weights of the reference.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WholeClairvoyantLaw {
    /// Of each plane.
    pub plane: ClairvoyantLaw,
    /// Share of what a magnet can do for the other plane that is lent to it; negative: that is taken off.
    pub lent: f64,
}

/// Who sees the true state of a rotor in two planes with a magnet each.
#[derive(Debug, Clone, PartialEq)]
pub struct WholeReference {
    /// Which planes these are.
    planes: [usize; 2],
    by: By,
}

/// What it does with that.
#[derive(Debug, Clone, PartialEq)]
enum By {
    /// A law with weights that were searched.
    Law(WholeClairvoyant),
    /// A PD of each plane.
    Loops([TrueLevitation; 2]),
}

/// The law on one rotor.
#[derive(Debug, Clone, PartialEq)]
struct WholeClairvoyant {
    planes: [OfPlane; 2],
    lent: f64,
    /// I_p/I_t.
    nutation: f64,
}

#[derive(Debug, Clone, PartialEq)]
struct OfPlane {
    law: Clairvoyant,
    position_m: f64,
    cap_n: f64,
    /// Velocity of the other plane for that of this one, by its own magnet.
    at_other: f64,
}

impl WholeClairvoyant {
    /// The law on the rotor of a scene; `None` unless that has two planes with a magnet each.
    fn new(law: WholeClairvoyantLaw, scene: &Scene) -> Option<Self> {
        let [first, second] = scene.supervised_planes()?;
        let rigid = scene.machine.rotor.rigid();
        let planes = scene.supervised()?;
        let at = |plane: usize| {
            scene
                .machine
                .planes
                .get(planes[plane])
                .map(|p| p.position_m)
        };
        let of = |plane: usize, own: &PlaneScene| {
            let magnet = scene.machine.magnets.get(own.magnet?)?;
            let moves = |z_m: f64| rigid.mobility(z_m, magnet.position_m);
            let plant = &scene.plant(planes[plane]);
            let rate_hz = scene.sample_rate_hz;
            Some(OfPlane {
                law: Clairvoyant::new(law.plane, plant, restitution(plant), rate_hz),
                position_m: at(plane)?,
                cap_n: magnet.force_max_n,
                at_other: moves(at(1 - plane)?) / moves(at(plane)?),
            })
        };
        Some(Self {
            planes: [of(0, first)?, of(1, second)?],
            lent: law.lent,
            nutation: rigid.polar_inertia_kg_m2 / rigid.transverse_inertia_kg_m2,
        })
    }

    fn forces_n(&self, now: [&Snapshot; 2]) -> [V2; 2] {
        let slope = (now[1].velocity_m_s - now[0].velocity_m_s)
            / (self.planes[1].position_m - self.planes[0].position_m);
        let parts = [0, 1].map(|plane| {
            let own = &self.planes[plane];
            // By then the tilt has turned.
            let angle = self.nutation * now[plane].spin_rad_s * own.law.horizon_s();
            let tilting = own.position_m * slope;
            let damped = now[plane].velocity_m_s + rotated(tilting, angle) - tilting;
            own.law.parts(now[plane], damped)
        });
        let mut forces = [V2::zeros(); 2];
        let [of_first, of_second] = parts;
        for (first, second) in of_first.into_iter().zip(of_second) {
            let wanted = [(first, second), (second, first)];
            for (plane, (sum, (own, other))) in forces.iter_mut().zip(wanted).enumerate() {
                let caps = self.planes[1 - plane].cap_n / self.planes[plane].cap_n;
                let both = own + self.lent * self.planes[plane].at_other * caps * other;
                *sum += both * largest_share(*sum, both);
            }
        }
        [
            forces[0] * self.planes[0].cap_n,
            forces[1] * self.planes[1].cap_n,
        ]
    }
}

impl WholeReference {
    /// A law with weights on the rotor of a scene; `None` unless that has two planes with a magnet each.
    pub fn law(law: WholeClairvoyantLaw, scene: &Scene) -> Option<Self> {
        Some(Self {
            planes: scene.supervised()?,
            by: By::Law(WholeClairvoyant::new(law, scene)?),
        })
    }

    /// A PD of each plane; `None` unless there are two with a magnet each.
    pub fn loops(gains: [LevitationParams; 2], scene: &Scene) -> Option<Self> {
        let of = |params, plane: usize| TrueLevitation {
            params,
            force_max_n: scene.force_max_n(plane),
            centre_m: -scene.machine.planes[plane].centre_m,
        };
        let ([first, second], [for_first, for_second]) = (scene.supervised()?, gains);
        Some(Self {
            planes: [first, second],
            by: By::Loops([of(for_first, first), of(for_second, second)]),
        })
    }

    /// Planes, and forces of their magnets for the true state \[N\]; none where there are no such planes.
    pub(crate) fn forces_n(&self, now: &[Snapshot]) -> Option<[(usize, V2); 2]> {
        let [first, second] = self.planes;
        let now = [now.get(first)?, now.get(second)?];
        let forces = match &self.by {
            By::Law(law) => law.forces_n(now),
            By::Loops(loops) => {
                [0, 1].map(|i| loops[i].force_n(now[i].position_m, now[i].velocity_m_s))
            }
        };
        Some([(first, forces[0]), (second, forces[1])])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::fixture;
    use crate::run::closed_loop::{Keep, run_reference};

    const P6: &str = include_str!("../../scenes/rotors/p6.toml");

    fn law(lent: f64) -> WholeClairvoyantLaw {
        WholeClairvoyantLaw {
            plane: ClairvoyantLaw {
                flight_gain: 0.8,
                contact_gain: 0.8,
                tilt: 0.15,
                damper: 4.0,
                restoring: 0.2,
            },
            lent,
        }
    }

    /// What one plane wants the other does not feel, where all that its magnet does there is taken off.
    #[test]
    fn planes_can_be_decoupled() {
        let scene = Scene::parse("p6.toml", P6).unwrap();
        let moves = |forces: [V2; 2], plane: usize| {
            let rigid = scene.machine.rotor.rigid();
            let z = scene.machine.planes[plane].position_m;
            let by = |i: usize| rigid.mobility(z, scene.machine.magnets[i].position_m) * forces[i];
            (by(0) + by(1)).norm()
        };
        let now = |position_m: f64| Snapshot {
            position_m: V2::new(position_m, 0.0),
            spin_rad_s: scene.start.spin_rad_s,
            velocity_m_s: V2::zeros(),
            ..fixture::row(0.0, false).plant
        };
        let now = [now(5e-5), now(0.0)];
        let forces = |lent: f64| {
            WholeClairvoyant::new(law(lent), &scene)
                .unwrap()
                .forces_n([&now[0], &now[1]])
        };
        let (by_itself, apart) = (forces(0.0), forces(-1.0));
        assert_eq!(by_itself[1], V2::zeros());
        assert!(by_itself[0].x < 0.0);
        assert!(moves(apart, 1) < 1e-12 * moves(by_itself, 1));
        // Lent: the far magnet helps.
        assert!(moves(forces(1.0), 0) > 1.01 * moves(by_itself, 0));
    }

    #[test]
    fn brings_a_struck_rotor_back() {
        let mut scene = Scene::parse("p6.toml", P6).unwrap();
        scene.start.tilt_rate_rad_s = V2::new(3.0, 0.0);
        let run = |of: &WholeReference, keep| run_reference(&scene, of, keep).unwrap();
        let reference = WholeReference::law(law(0.0), &scene).unwrap();
        let full = run(&reference, Keep::Verdict);
        assert!(full.iter().all(|f| f.recovered) && full.iter().any(|f| f.impacts > 0));
        // It may end as soon as it is decided.
        let decided = run(&reference, Keep::Decision);
        assert_eq!(decided[0].impacts, full[0].impacts);
        let gains = scene.planes[0].levitation.unwrap();
        let loops = WholeReference::loops([gains; 2], &scene).unwrap();
        assert!(run(&loops, Keep::Verdict).iter().all(|f| f.recovered));
    }
}
