//! The scenes of the catalogue, on one plant.

use super::case::{Case, Sizes, aimed, load, off_centre};
use super::contenders::Contender;
use super::situations::{Situation, situations};
use super::takeover::let_whirl;
use crate::machines::plants::PlantCase;
use firmware_bench::device::actuator::{Delivers, Outage};
use firmware_bench::device::axis::Axis;
use firmware_bench::device::levitation::LevitationParams;
use firmware_bench::device::loads::{BaseMotion, Disturbance, Shape, TimedChange};
use firmware_bench::scene::Scene;
use plant_model::machine::params::MachineStart;
use plant_model::params::{EllipseParams, RaceParams, SpinParams, StatorParams};
use plant_model::{Change, V2};
use std::f64::consts::TAU;

const G_M_S2: f64 = 9.81;
/// When things begin \[s\].
const BEGIN_S: f64 = 0.01;
/// What is left to come back in \[s\].
const AFTER_S: f64 = 0.12;

/// Collects the cases of one plant.
struct Collector<'a> {
    base: &'a Scene,
    sizes: Sizes,
    cases: Vec<Case>,
}

impl Collector<'_> {
    /// A case that lasts until some time after `end_s`, as `edit` makes it.
    fn add(
        &mut self,
        group: &'static str,
        name: impl Into<String>,
        end_s: f64,
        edit: impl FnOnce(&mut Scene),
    ) {
        let mut scene = self.base.clone();
        scene.duration_s = end_s + AFTER_S;
        edit(&mut scene);
        // What happens comes soon, or at once.
        scene.levitated_before = true;
        self.cases.push(Case {
            group,
            name: name.into(),
            scene,
            contenders: &Contender::ALL,
        });
    }

    /// The start of an impact at a share of the reference speed.
    fn impact(&self, share: f64, angle_deg: f64) -> MachineStart {
        aimed(self.base, share * self.sizes.impact_m_s, angle_deg)
    }

    fn mass_kg(&self) -> f64 {
        self.base.machine.rotor.rigid().mass_kg
    }

    fn load(&self, share: f64, start_s: f64, duration_s: f64) -> Disturbance {
        load(self.sizes, share, start_s, duration_s)
    }

    fn bursts(&self) -> Vec<Disturbance> {
        let from_s = |i| BEGIN_S + 0.025 * f64::from(i);
        (0..8).map(|i| self.load(1.5, from_s(i), 0.005)).collect()
    }

    fn impacts(&mut self) {
        for angle in [0.0, 30.0, -30.0, 50.0, -50.0] {
            for share in [0.5, 1.0, 1.5] {
                let start = self.impact(share, angle);
                let name = format!("impact {angle:+.0}°, {share} v_ref");
                self.add("impacts", name, 0.0, |s| s.start = start);
            }
        }
    }

    fn whirl(&mut self) {
        for share in [0.3, 0.5, 0.7, 0.85, 0.95, 1.05, 1.1] {
            let speed_m_s = share * self.sizes.limit_m_s;
            let name = format!("whirl at take-over, {share} v_lim");
            self.add("whirl", name, 0.0, |s| let_whirl(s, speed_m_s));
        }
    }

    fn overloads(&mut self) {
        for duration_s in [0.05, 1.0] {
            for share in [0.8, 0.9, 1.0, 1.1, 1.2, 1.5, 2.0, 3.0] {
                let load = self.load(share, BEGIN_S, duration_s);
                let name = format!("load {share} × cap for {:.0} ms", 1e3 * duration_s);
                self.add("static overload", name, load.end_s(), |s| {
                    s.disturbances = vec![load];
                });
            }
        }
        let bursts = self.bursts();
        self.add("surge", "8 bursts of 1.5 × cap, 5 ms", 0.2, |s| {
            s.disturbances = bursts;
        });
    }

    fn base_motions(&mut self) {
        for (g, ms) in [(5.0, 30.0), (15.0, 11.0), (30.0, 6.0)] {
            let shock = BaseMotion {
                start_s: BEGIN_S,
                duration_s: 1e-3 * ms,
                acceleration_m_s2: V2::new(0.8, 0.6) * g * G_M_S2,
                shape: Shape::HalfSine,
            };
            let name = format!("base shock {g} g, {ms} ms");
            self.add("shock", name, shock.end_s(), |s| {
                s.base_motions = vec![shock];
            });
        }
        for hz in [1.0, 2.0, 5.0, 10.0, 20.0, 35.0] {
            let shaking = BaseMotion {
                start_s: BEGIN_S,
                duration_s: (1.0_f64 / hz).max(0.2),
                acceleration_m_s2: V2::new(0.5 * G_M_S2, 0.0),
                shape: Shape::Sine {
                    frequency_hz: hz,
                    phase_rad: 0.0,
                },
            };
            let name = format!("base motion 0.5 g, {hz} Hz");
            self.add("base motion", name, shaking.end_s(), |s| {
                s.base_motions = vec![shaking];
            });
        }
    }

    fn blade_loss(&mut self) {
        // For a while, as if the machine were balanced again, and for good, as it is.
        for (hz, share, lasts_s) in [
            (166.0, 1.5, Some(0.1)),
            (1000.0, 1.5, Some(0.1)),
            (166.0, 1.2, None),
            (1000.0, 1.5, None),
            (333.0, 1.2, None),
            (333.0, 1.5, None),
            (333.0, 2.0, None),
        ] {
            let spin = hz * TAU;
            let force_n = share * self.sizes.force_n;
            let eccentricity = force_n / (self.mass_kg() * spin * spin);
            let change = |at_s, e| TimedChange {
                at_s,
                change: Change {
                    eccentricity_m: Some(e),
                    ..Change::default()
                },
            };
            let mut changes = vec![change(BEGIN_S, eccentricity)];
            changes.extend(lasts_s.map(|lasts_s| change(BEGIN_S + lasts_s, 0.0)));
            let how_long = match lasts_s {
                Some(lasts_s) => format!("for {:.0} ms", 1e3 * lasts_s),
                None => "for good".into(),
            };
            let name = format!("blade lost at {hz} Hz, {share} × cap {how_long}");
            self.add("blade loss", name, BEGIN_S + 0.1, |s| {
                s.start.spin_rad_s = spin;
                s.machine.spin = SpinParams::Held;
                s.changes = changes;
            });
        }
    }

    fn outages(&mut self) {
        for ms in [20.0, 200.0, 2000.0] {
            let outage = Outage {
                start_s: BEGIN_S,
                duration_s: 1e-3 * ms,
                delivers: Delivers::Nothing,
                axis: Axis::Both,
                known: true,
            };
            let name = format!("no power for {ms:.0} ms");
            self.add("power loss", name, outage.end_s(), |s| {
                s.planes[0].outages = vec![outage];
                // The rotor does not stand in the very middle when the power goes.
                s.start.centre_velocity_m_s = V2::new(1e-3, 2e-3);
            });
        }
    }

    /// One axis is lost, and known to be, while the supervisor is in each of its modes.
    fn lost_axes(&mut self, situations: &[Situation]) {
        for situation in situations {
            for (axis, letter) in [(Axis::X, 'x'), (Axis::Y, 'y')] {
                let outage = Outage {
                    start_s: situation.at_s,
                    duration_s: 0.02,
                    delivers: Delivers::Nothing,
                    axis,
                    known: true,
                };
                let name = format!("{letter} axis lost for 20 ms while in {}", situation.name);
                self.add("axis lost", name, outage.end_s(), |s| {
                    s.start = situation.scene.start;
                    s.disturbances = situation.scene.disturbances.clone();
                    s.planes[0].whirl_speed_m_s = situation.scene.planes[0].whirl_speed_m_s;
                    s.planes[0].outages = vec![outage];
                });
            }
        }
    }

    fn starts(&mut self) {
        let c = self.base.clearance_m(0);
        self.add("start", "from rest on the bearing", 0.0, |s| {
            s.start.centre_m = s.machine.planes[0].centre_m + V2::new(0.0, -c);
        });
    }

    fn friction(&mut self) {
        for coefficient in [0.3, 0.5] {
            let change = friction_from(0.0, coefficient);
            let start = self.impact(0.4, 30.0);
            let name = format!("impact with friction {coefficient}, untold");
            self.add("friction", name, 0.0, |s| {
                s.start = start;
                s.changes = vec![change];
            });
        }
        let change = friction_from(3e-3, 0.03);
        let speed_m_s = 0.85 * self.sizes.limit_m_s;
        self.add("friction", "friction collapses in whirl", 3e-3, |s| {
            let_whirl(s, speed_m_s);
            s.changes = vec![change];
        });
    }

    fn spins(&mut self) {
        for hz in [15.0, 40.0, 166.0, 333.0, 1000.0, -200.0] {
            let start = self.impact(1.0, 30.0);
            let name = format!("impact at {hz} Hz spin");
            self.add("speeds", name, 0.0, |s| {
                s.start = start;
                s.start.spin_rad_s = hz * TAU;
            });
        }
        let start = self.impact(1.0, 30.0);
        self.add("speeds", "impact, spin unknown", 0.0, |s| {
            s.start = start;
            s.spin_sensor.valid = false;
        });
        // A drive that turns the machine round, through a standstill, under one burst after the other.
        let (hz, lasts_s) = (40.0, 0.2);
        let inertia_kg_m2 = 1e-3 * self.mass_kg();
        let bursts = self.bursts();
        self.add("speeds", "bursts while the spin reverses", lasts_s, |s| {
            s.start.spin_rad_s = hz * TAU;
            s.machine.spin = SpinParams::Free {
                inertia_kg_m2,
                drive_torque_n_m: -2.0 * hz * TAU / lasts_s * inertia_kg_m2,
            };
            s.disturbances = bursts;
        });
        let race = RaceParams {
            inertia_kg_m2: 1e-3 * self.mass_kg() / 10.0,
            drag_n_m_s: 0.0,
            start_spin_rad_s: 0.0,
        };
        self.add(
            "speeds",
            "impact in a ball bearing that spins up",
            0.0,
            |s| {
                s.start = start;
                s.machine.planes[0].race = Some(race);
            },
        );
    }

    fn offsets(&mut self) {
        let c = self.base.clearance_m(0);
        for share in [0.1, 0.2] {
            let start = self.impact(1.0, 30.0);
            let name = format!(
                "impact, bearing {:.0} % of c off the centre, untold",
                100.0 * share
            );
            self.add("offset", name, 0.0, |s| {
                s.start = start;
                off_centre(s, share * c * V2::new(0.6, 0.8));
            });
        }
    }

    fn out_of_round(&mut self) {
        for ellipticity in [0.05, 0.1] {
            let start = self.impact(1.0, 30.0);
            let percent = 100.0 * ellipticity;
            let name = format!("impact, bearing {percent:.0} % out of round, untold");
            self.add("out of round", name, 0.0, |s| {
                s.start = start;
                s.machine.planes[0].stator = StatorParams::RigidEllipse(EllipseParams {
                    ellipticity,
                    // No axis, and not where the impact is aimed.
                    long_axis_rad: 70_f64.to_radians(),
                });
            });
        }
    }
}

/// Another coefficient of friction from a time on.
fn friction_from(at_s: f64, coefficient: f64) -> TimedChange {
    TimedChange {
        at_s,
        change: Change {
            friction_coefficient: Some(coefficient),
            ..Change::default()
        },
    }
}

/// Every scene on a plant. `tuned` is the loop that is behind the supervisor where a mode has to be found.
pub fn cases(plant: &PlantCase, tuned: LevitationParams) -> Vec<Case> {
    let Some(sizes) = Sizes::of(&plant.scene) else {
        return Vec::new();
    };
    let mut collector = Collector {
        base: &plant.scene,
        sizes,
        cases: Vec::new(),
    };
    collector.impacts();
    collector.whirl();
    collector.overloads();
    collector.base_motions();
    collector.blade_loss();
    let situations = situations(&plant.scene, sizes, tuned);
    collector.outages();
    collector.lost_axes(&situations);
    collector.starts();
    collector.friction();
    collector.spins();
    collector.offsets();
    collector.out_of_round();
    let mut cases = collector.cases;
    cases.extend(super::fault_matrix::cases(plant, &situations));
    cases
}
