//! What can be read off a machine.

use super::params::{MAX_MAGNETS, MAX_PLANES, Rotor};
use super::poles::MagnetLaw;
use super::rows::{AnyRows, Rows, of_rows};
use super::series::{MachineSeries, Parts};
use super::system::{MachineInputs, MachineState, MachineSystem, Place};
use crate::V2;
use crate::energy::Flows;
use crate::mode::{ContactMode, Phase, Slide, Whirl};
use crate::params::ContactLaw;
use crate::quadrature::{EIGHT, Nodes, SIX};
use crate::readout::Peaks;
use crate::series::Scalar;
use crate::vector::Body;

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
    pub mode: ContactMode,
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
        let Place {
            distance_m,
            normal,
            penetration_m,
            ..
        } = data.place(u);
        let whirl_m_s = normal.perp(&w);
        let surface = data.radius_m * y.spin_rad_s - data.race_radius_m() * y.races_rad_s[plane];
        ContactMotion {
            distance_m,
            penetration_m,
            normal,
            normal_m_s: normal.dot(&w),
            whirl_m_s,
            sliding_m_s: whirl_m_s + surface,
            speed_m_s: w.norm(),
        }
    }

    /// Kinetic and elastic energy; contact springs of planes that touch included \[J\].
    pub(crate) fn stored_j(&self, y: &MachineState, phases: &[Phase]) -> f64 {
        let kinetic: f64 = y.velocity.iter().map(V2::norm_squared).sum();
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

/// Energy through each door over a step up to θ, and largest values at the nodes of its sums.
pub(crate) struct StepFlows {
    pub(crate) machine: Flows,
    pub(crate) planes: [PlaneFlows; MAX_PLANES],
    pub(crate) tops: [Peaks; MAX_PLANES],
}

impl StepFlows {
    /// Off all walls.
    pub(crate) fn of_machine(machine: Flows) -> Self {
        Self {
            machine,
            planes: [PlaneFlows::default(); MAX_PLANES],
            tops: [Peaks::default(); MAX_PLANES],
        }
    }
}

/// What is held over a step, and the coordinates' way under it.
#[derive(Clone, Copy)]
pub(crate) struct Held<'a> {
    pub(crate) inputs: &'a MachineInputs,
    pub(crate) path: &'a [V2],
}

impl MachineSeries {
    /// Books a step from `y` to `end`, with work of what is held as force times path.
    pub(crate) fn flows(
        &self,
        system: &MachineSystem,
        phases: &[Phase],
        (theta, backward): (f64, &[f64]),
        held: Held<'_>,
    ) -> StepFlows {
        let about = (system, phases, backward);
        of_rows!(&self.rows, rows => match self.parts.order <= 12 {
            true => self.parts.flows_by(rows, about, theta, held, &Nodes::stretched(&SIX, theta)),
            false => self.parts.flows_by(rows, about, theta, held, &Nodes::stretched(&EIGHT, theta)),
        })
    }
}

impl Parts {
    fn flows_by<const P: usize, const N: usize>(
        &self,
        rows: &Rows<P>,
        (system, phases, backward): (&MachineSystem, &[Phase], &[f64]),
        theta: f64,
        held: Held<'_>,
        nodes: &Nodes<N>,
    ) -> StepFlows {
        let (h, order, body) = (self.step_s, self.order, &system.body);
        let Held { inputs, path } = held;
        let (control, external) = system.held_work_j(inputs, path);
        let mut flows = StepFlows::of_machine(Flows {
            control,
            external,
            ..Flows::default()
        });
        let lags = !system.magnets.iter().all(MagnetLaw::is_held);
        let damped = !body.damping.is_zero();
        let touches = |phase: &Phase| matches!(phase, Phase::Contact(..));
        let pushed = lags || body.unbalance.is_some() || !body.swirl.is_zero();
        let moves = damped || pushed || phases.iter().any(touches);
        let velocities = match moves {
            true => rows.velocities_at(&nodes.theta, order),
            false => [[V2::zeros(); P]; N],
        };
        let velocity = |j: usize| &velocities[j];
        let machine = &mut flows.machine;
        if damped {
            let power_w: [_; N] = std::array::from_fn(|j| rows.damping_w(velocity(j)));
            machine.rotor_damping = h * nodes.integral(|j| power_w[j][0]);
            machine.stator_damping = h * nodes.integral(|j| power_w[j][1]);
        }
        if let Some(power_w) = rows.swirl_w((&nodes.theta, order), &velocities) {
            machine.external += h * nodes.integral(|j| power_w[j]);
        }
        for (m, series) in self.magnets.iter().enumerate() {
            if !system.magnets[m].is_held() {
                let force_n = series.at_all(&nodes.theta, order);
                let power_w = |j: usize| force_n[j].dot(&rows.magnet_of(m, velocity(j)));
                machine.control += h * nodes.integral(power_w);
            }
        }
        if body.unbalance.is_some() {
            let force = self.unbalance.at_all(&nodes.theta, order);
            let power_w = |j: usize| force[j].dot(&rows.unbalance_of(velocity(j)));
            machine.unbalance = h * nodes.integral(power_w);
        }
        let free = system.inverse_inertia > 0.0;
        if free && system.drive_torque_n_m != 0.0 {
            machine.drive = system.drive_torque_n_m * h * self.spin.integral(theta, order);
        }
        let spin = match free {
            true => self.spin.at_all(&nodes.theta, order),
            false => [self.spin.0[0]; N],
        };
        for (p, phase) in phases.iter().enumerate() {
            let (data, series) = (&system.planes[p], &self.planes[p]);
            let Phase::Contact(slide, whirl) = phase else {
                if let Some(race) = &data.race {
                    let before = series.race.0[0];
                    let after = race.coasted_rad_s(before, theta * h);
                    flows.planes[p].race_drag = race.coasting_loss_j(before, after);
                    flows.machine.stator_damping += flows.planes[p].race_drag;
                }
                continue;
            };
            let rate: [V2; N] = std::array::from_fn(|j| rows.contact_of(p, velocity(j)));
            let gap = series.gap.at_all(&nodes.theta, order);
            let force = series.force.at_all(&nodes.theta, order);
            let race = match data.race {
                Some(_) => series.race.at_all(&nodes.theta, order),
                None => [0.0; N],
            };
            let distance = gap.map(|u| u.norm());
            let depth_m = match &data.bore {
                None => distance.map(|rho| rho - data.clearance_m),
                Some(_) => series.depth.at_all(&nodes.theta, order),
            };
            let per_m = distance.map(|rho| 1.0 / rho);
            let inwards: [f64; N] = std::array::from_fn(|j| gap[j].dot(&rate[j]) * per_m[j]);
            let along: [f64; N] = std::array::from_fn(|j| gap[j].perp(&rate[j]) * per_m[j]);
            let surface = |j: usize| data.radius_m * spin[j] - data.race_radius_m() * race[j];
            // In proportion to the normal force, or for itself.
            let part = |share: f64, of: &Scalar| match share {
                0.0 => of.at_all(&nodes.theta, order),
                _ => force.map(|n| share * n),
            };
            let sliding: [f64; N] = match *slide == Slide::Rolling || data.sliding > 0.0 {
                true => part(series.grip.sliding, &series.sliding_n),
                false => [0.0; N],
            };
            let plane = &mut flows.planes[p];
            plane.normal_impulse_n_s = h * series.force.integral(theta, order);
            plane.contact_damping = match &data.law {
                ContactLaw::Linear(law) => {
                    law.damping_n_s_m * h * nodes.integral(|j| inwards[j] * inwards[j])
                }
                law @ ContactLaw::HuntCrossley(_) => {
                    let damper_n = |j: usize| law.at(depth_m[j], inwards[j]).damper_n;
                    h * nodes.integral(|j| damper_n(j) * inwards[j])
                }
            };
            if *slide != Slide::Rolling {
                let power_w = |j: usize| sliding[j] * (along[j] + surface(j));
                plane.sliding_friction = -h * nodes.integral(power_w);
            }
            if !matches!(whirl, Whirl::Still | Whirl::Ignored) {
                let rolling: [f64; N] = part(series.grip.rolling, &series.rolling_n);
                plane.rolling_friction = -h * nodes.integral(|j| rolling[j] * along[j]);
            }
            if let Some(race_of) = &data.race {
                plane.race_drag = h * nodes.integral(|j| race_of.drag_w(race[j]));
                if let Some(drag) = &data.load_drag {
                    let load_w = |j: usize| drag.per_load_m(race[j]) * force[j] * race[j];
                    plane.race_drag += h * nodes.integral(load_w);
                }
            }
            let machine = &mut flows.machine;
            if !free {
                let torque_n_m = data.radius_m * nodes.integral(|j| sliding[j]);
                machine.drive -= h * self.spin.0[0] * torque_n_m;
            }
            machine.stator_damping += plane.race_drag;
            machine.contact_damping += plane.contact_damping;
            machine.sliding_friction += plane.sliding_friction;
            machine.rolling_friction += plane.rolling_friction;
            machine.normal_impulse_n_s += plane.normal_impulse_n_s;
            let (top, backward) = (&mut flows.tops[p], backward[p]);
            for j in 0..N {
                top.normal_n = top.normal_n.max(force[j]);
                top.penetration_m = top.penetration_m.max(depth_m[j]);
                top.sliding_n = top.sliding_n.max(sliding[j].abs());
                top.backward_m_s = top.backward_m_s.max(backward * along[j]);
            }
        }
        flows
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
