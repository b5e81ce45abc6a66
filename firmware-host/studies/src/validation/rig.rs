//! The rig as a scene, and runs of it.
//!
//! A fixed pivot is a rotor whose centre of mass is in the pivot, with a mass that nothing moves, and the transverse inertia
//! about the pivot: only tilts are left, and the gyroscopic moment stays. A point mass at the retainer bearing would lack that.

use super::fit::fitted;
use super::record::Record;
use crate::campaign::StudyError;
use firmware_bench::device::loads::{Disturbance, Shape};
use firmware_bench::run::closed_loop::{Accuracy, Recorders, record};
use firmware_bench::run::trace::{AxisRow, Recorder};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use nalgebra::Rotation2;
use plant_model::V2;
use plant_model::contact::damping_for_restitution;
use plant_model::machine::params::{RigidRotor, Rotor, Unbalance};
use plant_model::params::{HuntCrossley, LinearContact, RingParams, SlidingFriction, StatorParams};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// What is known of the rig beside the house; places count from the pivot.
const SCENE: &str = r#"
title = "Rotor about a fixed pivot, DTU 2019"
[run]
duration_s = 0.1
sample_rate_hz = 8000
policies = ["passive"]
[rotor]
mass_kg = 1e12
transverse_inertia_kg_m2 = 7.085371e-2
polar_inertia_kg_m2 = 1.06132e-3
contact_radius_m = 0.0125
[spin]
frequency_hz = -17.0
[contact]
clearance_m = 2e-3
stiffness_n_m = 2e8
restitution = 0.5
[friction]
coefficient = 0.2
[[plane]]
name = "free end"
position_m = 0.4287
[[support]]
position_m = 0.1717
stiffness_n_m = [3.09e4, 3.09e4]
cross_stiffness_n_m = [-2456.0, -292.0]
damping_n_s_m = [8.48, 7.7]
"#;
/// Where the exciter acts and the disc is, from the pivot \[m\].
const EXCITER_M: f64 = 0.0725;
const DISC_M: f64 = 0.2597;
/// Time that an impact is taken to last before it is fitted \[s\].
const IMPACT_S: f64 = 0.003;

/// What is fitted of a flight: how it begins, the unbalance, the spin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flight {
    pub tilt_rad: V2,
    pub tilt_rate_rad_s: V2,
    /// At the disc, where the spin begins.
    pub unbalance_kg_m: V2,
    pub spin_hz: f64,
}

impl Flight {
    /// Sizes of its numbers.
    const SIZES: [f64; 7] = [1e-3, 1e-3, 0.1, 0.1, 1e-4, 1e-4, 1.0];

    fn of([a, b, c, d, e, f, spin_hz]: [f64; 7]) -> Self {
        Self {
            tilt_rad: V2::new(a, b),
            tilt_rate_rad_s: V2::new(c, d),
            unbalance_kg_m: V2::new(e, f),
            spin_hz,
        }
    }

    /// Another beginning.
    fn begun(&self, [a, b, c, d]: [f64; 4]) -> Self {
        let [.., e, f, spin_hz] = self.numbers();
        Self::of([a, b, c, d, e, f, spin_hz])
    }

    fn numbers(&self) -> [f64; 7] {
        let ([a, b], [c, d]) = (self.tilt_rad.into(), self.tilt_rate_rad_s.into());
        let [e, f]: [f64; 2] = self.unbalance_kg_m.into();
        [a, b, c, d, e, f, self.spin_hz]
    }
}

/// A contact at the free end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    pub stiffness_n_m: f64,
    pub restitution: f64,
    pub clearance_m: f64,
    pub friction: f64,
    /// Another law in the place of stiffness and restitution.
    pub law: Option<HuntCrossley>,
}

impl Touch {
    /// Restitution, friction and clearance of the thesis, with a linear stiffness.
    pub(super) const STIFF: Self = Self {
        stiffness_n_m: 2e8,
        restitution: 0.5,
        clearance_m: 2e-3,
        friction: 0.2,
        law: None,
    };
    /// A wall that nothing reaches.
    pub const NONE: Self = Self {
        clearance_m: 1.0,
        ..Self::STIFF
    };
    /// Sizes of stiffness, restitution and clearance.
    const SIZES: [f64; 3] = [1e5, 0.1, 1e-4];

    /// As the thesis simulates it: Hertz's contact between shaft and bearing with the hysteresis of Lankarani and Nikravesh, whose
    /// damping is 3·(1 − e²)/4 over the speed of the impact.
    pub(super) fn of_the_thesis(impact_m_s: f64) -> Self {
        let law = HuntCrossley {
            stiffness_n_mn: HERTZ_N_M15,
            exponent: 1.5,
            damping_s_m: 0.75 * (1.0 - Self::STIFF.restitution.powi(2)) / impact_m_s,
        };
        Self {
            law: Some(law),
            ..Self::STIFF
        }
    }
}

/// An impact as the record alone tells it: what must have pushed the free end for it to fly on as it does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Its middle, and how long it is \[s\].
    pub at_s: f64,
    pub long_s: f64,
    /// How far the free end is from the middle where it begins \[m\].
    pub clearance_m: f64,
    /// Direction from the middle to where it touches \[rad\].
    pub angle_rad: f64,
    /// Towards the middle, and across, counter-clockwise \[N s\].
    pub normal_n_s: f64,
    pub tangential_n_s: f64,
    /// Outward speed before and after \[m/s\].
    pub normal_m_s: [f64; 2],
    /// Root mean square of the distance of the flight with this push from the record \[m\].
    pub rms_m: f64,
}

/// A run.
#[derive(Debug, Clone, PartialEq)]
pub struct Ran {
    /// Centre of the disc at each sample \[m\].
    pub disc_m: Vec<V2>,
    tilt: Vec<[V2; 2]>,
    pub touches: u64,
    pub first_contact_s: Option<f64>,
    pub normal_impulse_n_s: f64,
}

/// Tilt and its rate, a pair a sample.
#[derive(Debug, Default)]
struct Tilts(Vec<[V2; 2]>);

impl Recorder<AxisRow> for Tilts {
    fn row(&mut self, row: &AxisRow) {
        self.0
            .push([row.axis.tilt.position, row.axis.tilt.velocity]);
    }
}

/// The rig under the exciter's force of a record.
#[derive(Debug, Clone)]
pub struct Rig {
    scene: Scene,
    period_s: f64,
}

impl Rig {
    /// # Errors
    /// None; the scene is a constant.
    pub fn new(of: &Record) -> Result<Self, StudyError> {
        let mut scene = Scene::parse("rig.toml", SCENE)?;
        scene.sample_rate_hz = 1.0 / of.period_s;
        // Between two samples the mean of both.
        let pairs = of.exciter_n.windows(2).enumerate();
        scene.disturbances = pairs
            .map(|(sample, both)| Disturbance {
                position_m: EXCITER_M,
                start_s: sample as f64 * of.period_s,
                duration_s: of.period_s,
                force_n: V2::new(0.5 * (both[0] + both[1]), 0.0),
                shape: Shape::Constant,
            })
            .collect();
        Ok(Self {
            scene,
            period_s: of.period_s,
        })
    }

    fn rigid(&mut self) -> Option<&mut RigidRotor> {
        match &mut self.scene.machine.rotor {
            Rotor::Rigid(rigid) => Some(rigid),
            Rotor::Modal { .. } => None,
        }
    }

    /// The same without gyroscopic moment.
    #[must_use]
    pub(super) fn without_gyroscopics(mut self) -> Self {
        if let Some(rigid) = self.rigid() {
            rigid.polar_inertia_kg_m2 = 0.0;
        }
        self
    }

    /// The same with the house: the bearing's ring on a frame, by the stiffness of two force transducers each way.
    #[must_use]
    pub(super) fn with_house(mut self) -> Self {
        for plane in &mut self.scene.machine.planes {
            plane.stator = StatorParams::TwoMass {
                inner: RingParams {
                    mass_kg: 1.79,
                    stiffness_n_m: V2::new(9.709e8, 2.0 * TRANSDUCER_N_M),
                    damping_n_s_m: V2::new(2168.0, 0.0),
                },
                outer: RingParams {
                    mass_kg: 8.44,
                    stiffness_n_m: V2::new(2.0 * 1.26e7, 1.41e9),
                    damping_n_s_m: V2::new(0.0, 12_983.0),
                },
            };
        }
        self
    }

    /// Place of the retainer bearing \[m\].
    fn free_end_m(&self) -> f64 {
        self.scene.machine.planes[0].position_m
    }

    /// Mass that an impact at the free end finds \[kg\].
    fn impact_mass_kg(&self) -> f64 {
        self.scene.machine.point_mass(self.free_end_m()).mass_kg
    }

    /// Runs so many samples.
    ///
    /// # Errors
    /// A run that cannot be trusted, or a contact that there is not.
    pub fn run(&self, flight: &Flight, touch: &Touch, samples: usize) -> Result<Ran, StudyError> {
        let mut scene = self.scene.clone();
        scene.duration_s = samples as f64 * self.period_s;
        scene.start.tilt_rad = flight.tilt_rad;
        scene.start.tilt_rate_rad_s = flight.tilt_rate_rad_s;
        scene.start.spin_rad_s = TAU * flight.spin_hz;
        let unbalance = flight.unbalance_kg_m;
        scene.machine.unbalances = vec![Unbalance {
            position_m: DISC_M,
            moment_kg_m: unbalance.norm(),
            angle_rad: unbalance.y.atan2(unbalance.x),
        }];
        let (mass_kg, stiffness_n_m) = (self.impact_mass_kg(), touch.stiffness_n_m);
        let damping = damping_for_restitution(touch.restitution, stiffness_n_m, mass_kg);
        let plane = &mut scene.machine.planes[0];
        plane.contact.clearance_m = touch.clearance_m;
        plane.contact.law = match touch.law {
            Some(law) => law.into(),
            None => LinearContact {
                stiffness_n_m,
                damping_n_s_m: damping.ok_or("restitution: expected a number from 0 to 1")?,
            }
            .into(),
        };
        plane.friction.sliding = SlidingFriction::Constant {
            coefficient: touch.friction,
        };
        let mut tilt = Tilts::default();
        let recorders = Recorders {
            planes: Vec::new(),
            axis: Some(&mut tilt),
        };
        let (passive, accuracy) = (PolicyKind::Passive, Accuracy::default());
        let ended = record(&scene, passive, recorders, accuracy, &mut |_| {})?;
        let (figures, _) = ended.first().ok_or("a scene without planes")?;
        let Tilts(mut tilt) = tilt;
        tilt.truncate(samples);
        Ok(Ran {
            disc_m: tilt.iter().map(|[tilt_rad, _]| DISC_M * tilt_rad).collect(),
            tilt,
            touches: figures.impacts,
            first_contact_s: figures.first_contact_s,
            normal_impulse_n_s: figures.contact_impulse_n_s,
        })
    }

    /// A flight as it begins at a later sample.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn later(&self, flight: &Flight, sample: usize) -> Result<Flight, StudyError> {
        let ran = self.run(flight, &Touch::NONE, sample + 1)?;
        let [tilt_rad, tilt_rate_rad_s] = ran.tilt[sample];
        let turned_rad = TAU * flight.spin_hz * sample as f64 * self.period_s;
        Ok(Flight {
            tilt_rad,
            tilt_rate_rad_s,
            unbalance_kg_m: Rotation2::new(turned_rad) * flight.unbalance_kg_m,
            ..*flight
        })
    }

    /// The flight that is nearest to the first samples of a record, without a wall.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn fit_flight(&self, of: &Record, samples: usize) -> Result<Flight, StudyError> {
        let first = of.disc_m.first().copied().unwrap_or_default();
        let rate_m_s = (of.disc_m.get(1)).map_or(V2::zeros(), |next| (next - first) / of.period_s);
        let start = Flight {
            tilt_rad: first / DISC_M,
            tilt_rate_rad_s: rate_m_s / DISC_M,
            unbalance_kg_m: V2::zeros(),
            spin_hz: self.scene.start.spin_rad_s / TAU,
        };
        let off = |numbers: [f64; 7]| {
            let ran = self.run(&Flight::of(numbers), &Touch::NONE, samples)?;
            Ok::<_, StudyError>(off_mm(&ran, of))
        };
        // Without an unbalance no spin is better than another: first the six that the flight is linear in.
        let ([a, b, c, d, e, f, spin_hz], [sizes @ .., _]) = (start.numbers(), Flight::SIZES);
        let [a, b, c, d, e, f] = fitted([a, b, c, d, e, f], sizes, |&[a, b, c, d, e, f]| {
            off([a, b, c, d, e, f, spin_hz])
        })?;
        let all = [a, b, c, d, e, f, spin_hz];
        fitted(all, Flight::SIZES, |numbers| off(*numbers)).map(Flight::of)
    }

    /// What a record tells of an impact without any wall: the push with which the flight about it is nearest to the record.
    /// Unbalance and spin are those of `begin`, how it begins is fitted again, and so is how long the push lasts, where that is
    /// not given.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn impact(
        &self,
        of: &Record,
        begin: &Flight,
        long_s: Option<f64>,
    ) -> Result<Impact, StudyError> {
        let samples = of.disc_m.len();
        let pushed = |&[a, b, c, d, at_s, x, y, long_s]: &[f64; 8]| {
            let mut pushed = self.clone();
            pushed.scene.disturbances.push(Disturbance {
                position_m: self.free_end_m(),
                start_s: at_s - 0.5 * long_s,
                duration_s: long_s,
                force_n: FRAC_PI_2 / long_s * V2::new(x, y),
                shape: Shape::HalfSine,
            });
            pushed.run(&begin.begun([a, b, c, d]), &Touch::NONE, samples)
        };
        let ([a, b, c, d, ..], [sa, sb, sc, sd, ..]) = (begin.numbers(), Flight::SIZES);
        let middle_s = 0.5 * samples as f64 * self.period_s;
        let start = [a, b, c, d, middle_s, 0.0, 0.0, long_s.unwrap_or(IMPACT_S)];
        // What is given does not change.
        let size_s = if long_s.is_some() { 0.0 } else { 1e-3 };
        let sizes = [sa, sb, sc, sd, 1e-3, 0.01, 0.01, size_s];
        let found = fitted(start, sizes, |numbers| {
            Ok::<_, StudyError>(off_mm(&pushed(numbers)?, of))
        })?;
        let rms_m = rms_m(&pushed(&found)?.disc_m, &of.disc_m, samples);
        let [a, b, c, d, at_s, x, y, long_s] = found;
        let unpushed = self.run(&begin.begun([a, b, c, d]), &Touch::NONE, samples)?;
        let free_end = |t_s: f64| {
            let sample = (t_s / self.period_s).round() as usize;
            unpushed.tilt[sample.min(samples - 1)].map(|tilt| self.free_end_m() * tilt)
        };
        let [begins_m, _] = free_end(at_s - 0.5 * long_s);
        let [place_m, rate_m_s] = free_end(at_s);
        let (outward, impulse) = (place_m.normalize(), V2::new(x, y));
        let normal_n_s = -impulse.dot(&outward);
        let before_m_s = rate_m_s.dot(&outward);
        Ok(Impact {
            at_s,
            long_s,
            clearance_m: begins_m.norm(),
            angle_rad: outward.y.atan2(outward.x),
            normal_n_s,
            tangential_n_s: outward.perp(&impulse),
            normal_m_s: [before_m_s, before_m_s - normal_n_s / self.impact_mass_kg()],
            rms_m,
        })
    }

    /// Stiffness with which the mass of an impact takes half a period for it \[N/m\].
    pub fn stiffness_n_m(&self, impact: &Impact) -> f64 {
        self.impact_mass_kg() * (PI / impact.long_s).powi(2)
    }

    /// The contact that an impact tells of, without friction: restitution by its speeds, stiffness by how long it is, and
    /// the clearance with which a flight about it is nearest to the record.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn touch(&self, of: &Record, begin: &Flight, impact: &Impact) -> Result<Touch, StudyError> {
        let [before, after] = impact.normal_m_s;
        let touch = Touch {
            stiffness_n_m: self.stiffness_n_m(impact),
            restitution: -after / before,
            clearance_m: impact.clearance_m,
            friction: 0.0,
            law: None,
        };
        let [.., size_m] = Touch::SIZES;
        self.nearest(of, begin, (&touch, [0.0, 0.0, size_m]))
    }

    /// The contact with which a flight about an impact is nearest to the record, all three numbers at once.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn fit_touch(
        &self,
        of: &Record,
        begin: &Flight,
        near: &Touch,
    ) -> Result<Touch, StudyError> {
        self.nearest(of, begin, (near, Touch::SIZES))
    }

    /// By stiffness, restitution and clearance of these sizes; 0 for what is given.
    fn nearest(
        &self,
        of: &Record,
        begin: &Flight,
        (near, [size_n_m, size, size_m]): (&Touch, [f64; 3]),
    ) -> Result<Touch, StudyError> {
        let with = |stiffness_n_m, restitution, clearance_m| Touch {
            stiffness_n_m,
            restitution,
            clearance_m,
            ..*near
        };
        let ([a, b, c, d, ..], [sa, sb, sc, sd, ..]) = (begin.numbers(), Flight::SIZES);
        let best = [near.stiffness_n_m, near.restitution, near.clearance_m];
        let [.., stiffness_n_m, restitution, clearance_m] = fitted(
            [a, b, c, d, best[0], best[1], best[2]],
            [sa, sb, sc, sd, size_n_m, size, size_m],
            |&[a, b, c, d, stiffness_n_m, restitution, clearance_m]| {
                let touch = with(stiffness_n_m, restitution, clearance_m);
                let ran = self.run(&begin.begun([a, b, c, d]), &touch, of.disc_m.len())?;
                Ok::<_, StudyError>(off_mm(&ran, of))
            },
        )?;
        Ok(with(stiffness_n_m, restitution, clearance_m))
    }
}

/// What a run is off a record, x and y one after the other \[mm\].
fn off_mm(ran: &Ran, of: &Record) -> Vec<f64> {
    let both = ran.disc_m.iter().zip(&of.disc_m);
    both.flat_map(|(a, b)| [1e3 * (a.x - b.x), 1e3 * (a.y - b.y)])
        .collect()
}

/// Hertz's stiffness of the thesis: Young's moduli of 70 and 100 GPa, Poisson's ratios of 0.35, radii of 12.5 and 14.5 mm taken as
/// spheres that are both convex \[N/m^1.5\].
const HERTZ_N_M15: f64 = 5.13e9;
/// Stiffness of one force transducer along y, of which two hold the bearing's ring \[N/m\].
pub(super) const TRANSDUCER_N_M: f64 = 8.42e6;

/// Root mean square of the distance between a run and a record over their first samples \[m\].
pub(super) fn rms_m(ran: &[V2], of: &[V2], samples: usize) -> f64 {
    let both = ran.iter().zip(of).take(samples);
    let sum: f64 = both.map(|(a, b)| (a - b).norm_squared()).sum();
    (sum / samples as f64).sqrt()
}
