//! What can be read off a machine.

use super::params::{MAX_MAGNETS, MAX_PLANES, Rotor};
use super::poles::MagnetLaw;
use super::series::MachineSeries;
use super::system::{MachineInputs, MachineState, MachineSystem};
use crate::V2;
use crate::energy::Flows;
use crate::integrate::series_readout::highest;
use crate::mode::{Mode, Phase, Slide, Whirl};
use crate::params::ContactLaw;
use crate::part::Body;
use crate::quadrature::{EIGHT, Nodes, SIX};
use crate::readout::Peaks;
use crate::series::Scalar;

/// What can be read off one plane at an instant, SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneSnapshot {
    /// Centre of the rotor in this plane.
    pub rotor: Body,
    /// Centre of the ring that it touches there, without the offset of its bore; at rest at zero for a rigid one.
    pub ring: Body,
    /// The ring below that; at rest at zero where there is none.
    pub outer_ring: Body,
    /// What the rotor does here.
    pub mode: Mode,
    /// A of eq. (2.8) \[m\]; negative inside the clearance.
    pub penetration_m: f64,
    /// f_n \[N\]; 0 without contact.
    pub normal_force_n: f64,
    /// Sliding friction on the rotor along t̂ \[N\].
    pub sliding_force_n: f64,
    /// Rolling friction on the rotor along t̂ \[N\].
    pub rolling_force_n: f64,
    /// v_w, tangential speed of the rotor against the ring \[m/s\].
    pub whirl_speed_m_s: f64,
    /// v_rel, speed of the rotor's surface on the ring's \[m/s\].
    pub sliding_speed_m_s: f64,
    /// Spin of the race \[rad/s\]; 0 for a bushing.
    pub race_spin_rad_s: f64,
    /// Angle of the contact point, summed over all contact so far \[rad\]; differences are meaningful within one contact.
    pub whirl_angle_rad: f64,
}

/// The rotor's axis at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisMotion {
    /// Centre of mass \[m\] and its velocity \[m/s\].
    pub centre: Body,
    /// Slope, dx/dz and dy/dz \[rad\], and its rate \[rad/s\].
    pub tilt: Body,
    /// Kinetic and elastic energy of the bending modes \[J\].
    pub bending_j: f64,
}

/// What can be read off a machine at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachineSnapshot {
    /// Time \[s\].
    pub t_s: f64,
    /// Spin Ω \[rad/s\].
    pub spin_rad_s: f64,
    /// Angle σ of the rotor \[rad\], not wound back.
    pub phase_rad: f64,
    pub(crate) planes: [Option<PlaneSnapshot>; MAX_PLANES],
    pub(crate) delivered_n: [Option<V2>; MAX_MAGNETS],
}

impl MachineSnapshot {
    /// The planes, as they stand in the parameters.
    pub fn planes(&self) -> impl Iterator<Item = &PlaneSnapshot> {
        self.planes.iter().flatten()
    }

    /// Forces that the magnets deliver \[N\], as they stand in the parameters.
    pub fn delivered_n(&self) -> impl Iterator<Item = V2> + '_ {
        self.delivered_n.iter().flatten().copied()
    }
}

impl Rotor {
    /// Where the centre line is at a place, for the motion of the axis and of the bending modes \[m\].
    pub fn centre_line_m(&self, axis: &AxisMotion, bending: &[Body], position_m: f64) -> V2 {
        let straight = axis.centre.position + position_m * axis.tilt.position;
        (self.bending().iter().zip(bending)).fold(straight, |sum, (mode, motion)| {
            sum + mode.displacement(position_m) * motion.position
        })
    }
}

/// Energy that one plane took, and its impulse.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlaneFlows {
    /// Contact damping, and the dent left in the wall at lift-off \[J\].
    pub contact_damping: f64,
    /// Sliding friction \[J\].
    pub sliding_friction: f64,
    /// Rolling friction \[J\].
    pub rolling_friction: f64,
    /// Drag of the race \[J\].
    pub race_drag: f64,
    /// ∫ f_n dt \[N s\].
    pub normal_impulse_n_s: f64,
}

/// How the rotor moves against the ring in a plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ContactMotion {
    pub(crate) distance_m: f64,
    /// A; negative inside the clearance.
    pub(crate) penetration_m: f64,
    pub(crate) normal: V2,
    pub(crate) normal_m_s: f64,
    pub(crate) whirl_m_s: f64,
    pub(crate) sliding_m_s: f64,
    /// |u̇| and the surface's, of which the others are made.
    pub(crate) speed_m_s: f64,
}

impl MachineSystem {
    pub(crate) fn motion(&self, plane: usize, y: &MachineState) -> ContactMotion {
        let data = &self.planes[plane];
        let u = self.body.contacts[plane].of(&y.position) - data.centre_m;
        let w = self.body.contacts[plane].of(&y.velocity);
        let distance_m = u.norm();
        let normal = if distance_m > 0.0 {
            u / distance_m
        } else {
            V2::x()
        };
        let whirl_m_s = normal.perp(&w);
        let surface = data.radius_m * y.spin_rad_s - data.race_radius_m() * y.races_rad_s[plane];
        ContactMotion {
            distance_m,
            penetration_m: distance_m - data.clearance_m,
            normal,
            normal_m_s: normal.dot(&w),
            whirl_m_s,
            sliding_m_s: whirl_m_s + surface,
            speed_m_s: w.norm(),
        }
    }

    /// Kinetic and elastic energy; contact springs of planes that touch included \[J\].
    pub(crate) fn stored_j(&self, y: &MachineState, phases: &[Phase]) -> f64 {
        let kinetic: f64 = y.velocity.iter().map(|v| v * v).sum();
        let mut stored =
            0.5 * (kinetic + self.body.stiffness.quadratic(&y.position)) + self.turning_j(y);
        for (p, phase) in phases.iter().enumerate() {
            if matches!(phase, Phase::Contact(..)) {
                stored += self.planes[p].law.stored_j(self.motion(p, y).penetration_m);
            }
        }
        stored
    }

    /// Energy of the spins \[J\].
    pub(crate) fn turning_j(&self, y: &MachineState) -> f64 {
        let mut stored = 0.0;
        if self.inverse_inertia > 0.0 {
            stored += 0.5 * y.spin_rad_s * y.spin_rad_s / self.inverse_inertia;
        }
        for (data, spin) in self.planes.iter().zip(&y.races_rad_s) {
            stored += data.race.map_or(0.0, |race| race.stored_j(*spin));
        }
        stored
    }
}

/// Energy through each door over a step up to θ.
pub(crate) struct StepFlows {
    pub(crate) machine: Flows,
    pub(crate) planes: [PlaneFlows; MAX_PLANES],
}

impl StepFlows {
    /// Off all walls.
    pub(crate) fn of_machine(machine: Flows) -> Self {
        Self {
            machine,
            planes: [PlaneFlows::default(); MAX_PLANES],
        }
    }
}

/// What is held over a step, and the coordinates' way under it.
#[derive(Clone, Copy)]
pub(crate) struct Held<'a> {
    pub(crate) inputs: &'a MachineInputs,
    pub(crate) path: &'a [f64],
}

impl MachineSeries {
    /// Books a step from `y` to `end`, with work of what is held as force times path.
    pub(crate) fn flows(
        &self,
        system: &MachineSystem,
        phases: &[Phase],
        theta: f64,
        held: Held<'_>,
        scratch: &mut [f64],
    ) -> StepFlows {
        if self.order <= 12 {
            self.flows_by(
                system,
                phases,
                theta,
                held,
                (&Nodes::stretched(&SIX, theta), scratch),
            )
        } else {
            self.flows_by(
                system,
                phases,
                theta,
                held,
                (&Nodes::stretched(&EIGHT, theta), scratch),
            )
        }
    }

    fn flows_by<const N: usize>(
        &self,
        system: &MachineSystem,
        phases: &[Phase],
        theta: f64,
        held: Held<'_>,
        (nodes, scratch): (&Nodes<N>, &mut [f64]),
    ) -> StepFlows {
        let (h, order, body) = (self.step_s, self.order, &system.body);
        let Held { inputs, path } = held;
        let (control, external) = system.held_work_j(inputs, path);
        let mut machine = Flows {
            control,
            external,
            ..Flows::default()
        };
        let mut planes = [PlaneFlows::default(); MAX_PLANES];
        let lags = !system.magnets.iter().all(MagnetLaw::is_held);
        let damped = !body.damping.is_zero();
        if damped || lags || body.unbalance.is_some() {
            let mut powers = [Flows::default(); N];
            for (power, at) in powers.iter_mut().zip(nodes.theta) {
                self.velocity.at(at, order, scratch);
                if damped {
                    power.rotor_damping = body.damping.quadratic(scratch);
                }
                for (m, port) in body.magnets.iter().enumerate() {
                    if !system.magnets[m].is_held() {
                        power.control += self.magnets[m].at(at, order).dot(&port.of(scratch));
                    }
                }
                if let Some(unbalance) = &body.unbalance {
                    power.unbalance = self.unbalance.at(at, order).dot(&unbalance.of(scratch));
                }
            }
            machine.rotor_damping = h * nodes.integral(|j| powers[j].rotor_damping);
            machine.control += h * nodes.integral(|j| powers[j].control);
            machine.unbalance = h * nodes.integral(|j| powers[j].unbalance);
        }
        let free = system.inverse_inertia > 0.0;
        if free && system.drive_torque_n_m != 0.0 {
            machine.drive = system.drive_torque_n_m * h * self.spin.integral(theta, order);
        }
        for (p, phase) in phases.iter().enumerate() {
            let (data, series) = (&system.planes[p], &self.planes[p]);
            let plane = &mut planes[p];
            match (&data.race, phase) {
                (None, _) => {}
                (Some(race), Phase::Contact(..)) => {
                    let spin = series.race.at_all(&nodes.theta, order);
                    plane.race_drag = h * nodes.integral(|j| race.drag_w(spin[j]));
                    if let Some(drag) = &data.load_drag {
                        let load = series.force.at_all(&nodes.theta, order);
                        plane.race_drag +=
                            h * nodes.integral(|j| drag.per_load_m(spin[j]) * load[j] * spin[j]);
                    }
                }
                (Some(race), _) => {
                    let before = series.race.0[0];
                    let after = race.coasted_rad_s(before, theta * h);
                    plane.race_drag = race.coasting_loss_j(before, after);
                }
            }
            if let Phase::Contact(slide, whirl) = phase {
                plane.normal_impulse_n_s = h * series.force.integral(theta, order);
                if !free {
                    machine.drive -=
                        data.radius_m * h * self.spin.0[0] * series.sliding.integral(theta, order);
                }
                let speed = series.normal_speed.at_all(&nodes.theta, order);
                plane.contact_damping = match &data.law {
                    ContactLaw::Linear(law) => {
                        law.damping_n_s_m * h * nodes.integral(|j| speed[j] * speed[j])
                    }
                    law @ ContactLaw::HuntCrossley(_) => {
                        let distance = series.distance.at_all(&nodes.theta, order);
                        let damper_n =
                            |j: usize| law.at(distance[j] - data.clearance_m, speed[j]).damper_n;
                        h * nodes.integral(|j| damper_n(j) * speed[j])
                    }
                };
                if *slide != Slide::Rolling {
                    let (force, speed) = (
                        series.sliding.at_all(&nodes.theta, order),
                        series.slip.at_all(&nodes.theta, order),
                    );
                    plane.sliding_friction = -h * nodes.integral(|j| force[j] * speed[j]);
                }
                if !matches!(whirl, Whirl::Still | Whirl::Ignored) {
                    let (force, speed) = (
                        series.rolling.at_all(&nodes.theta, order),
                        series.whirl_speed.at_all(&nodes.theta, order),
                    );
                    plane.rolling_friction = -h * nodes.integral(|j| force[j] * speed[j]);
                }
            }
            machine.stator_damping += plane.race_drag;
            machine.contact_damping += plane.contact_damping;
            machine.sliding_friction += plane.sliding_friction;
            machine.rolling_friction += plane.rolling_friction;
            machine.normal_impulse_n_s += plane.normal_impulse_n_s;
        }
        StepFlows { machine, planes }
    }

    /// Largest values in a plane up to θ.
    pub(crate) fn peaks(
        &self,
        system: &MachineSystem,
        plane: usize,
        (theta, backward): (f64, f64),
    ) -> Peaks {
        let (series, data, order) = (&self.planes[plane], &system.planes[plane], self.order);
        let top = |s, sign| {
            highest(
                (s, sign),
                (theta, Scalar::with_slope(s, theta, order)),
                order,
            )
            .1
        };
        let normal_n = top(&series.force, 1.0);
        Peaks {
            normal_n,
            penetration_m: top(&series.distance, 1.0) - data.clearance_m,
            sliding_n: (top(&series.sliding, 1.0).max(top(&series.sliding, -1.0)))
                .min(data.sliding * normal_n.max(0.0)),
            backward_m_s: top(&series.whirl_speed, backward),
        }
    }
}

impl PlaneFlows {
    /// What the bearing has taken as heat \[J\].
    pub fn losses_j(&self) -> f64 {
        self.contact_damping + self.sliding_friction + self.rolling_friction + self.race_drag
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.contact_damping += other.contact_damping;
        self.sliding_friction += other.sliding_friction;
        self.rolling_friction += other.rolling_friction;
        self.race_drag += other.race_drag;
        self.normal_impulse_n_s += other.normal_impulse_n_s;
    }
}
