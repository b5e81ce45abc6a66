//! The motion of a machine as a power series over one step: the linear body's coordinates, the spins, and in every plane
//! that is touched the contact, all orders one after the other.
//!
//! Series run over θ = time / step; entry k holds the k-th coefficient times step^k. The recurrence is that of one plane,
//! eqs (3.5)–(3.8), with S·q for the rotor's position. Friction that holds a speed at zero enters in proportion at each
//! order, so it is first left out there, and what it has to be follows from the speed that is then not zero: one
//! small linear system, the same for all orders.

use super::body::LinearBody;
use super::holding::Holding;
use super::poles::MagnetLaw;
use super::system::{Channel, MachineState, MachineSystem, PlaneData, holding_channels};
use crate::V2;
use crate::mode::{Phase, Whirl};
use crate::params::ContactLaw;
use crate::series::{INVERSE, MAX_ORDER, Scalar, Series};
use crate::vector::perp;

/// Coefficients of a vector of n numbers, one row after the other.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rows {
    n: usize,
    data: Vec<f64>,
}

impl Rows {
    fn new(n: usize) -> Self {
        Self {
            n,
            data: vec![0.0; n * (MAX_ORDER + 2)],
        }
    }

    #[inline]
    pub(crate) fn row(&self, k: usize) -> &[f64] {
        &self.data[k * self.n..(k + 1) * self.n]
    }

    #[inline]
    pub(crate) fn row_mut(&mut self, k: usize) -> &mut [f64] {
        &mut self.data[k * self.n..(k + 1) * self.n]
    }

    /// Values at θ.
    pub(crate) fn at(&self, theta: f64, order: usize, out: &mut [f64]) {
        out.copy_from_slice(self.row(order));
        for k in (0..order).rev() {
            for (o, c) in out.iter_mut().zip(self.row(k)) {
                *o = *o * theta + c;
            }
        }
    }

    /// Square of the length of row k.
    pub(crate) fn square(&self, k: usize) -> f64 {
        self.row(k).iter().map(|c| c * c).sum()
    }
}

/// Series of one plane.
#[derive(Debug, Clone, Default)]
pub(crate) struct PlaneSeries {
    /// Rotor against ring, and its rate.
    pub(crate) gap: Series,
    pub(crate) gap_rate: Series,
    /// ρ, its rate, r̂.
    pub(crate) distance: Scalar,
    pub(crate) normal_speed: Scalar,
    normal: Series,
    /// f_n and f_n·r̂.
    pub(crate) force: Scalar,
    push: Series,
    /// What falls through zero where contact of a law that is not linear ends; of collocation alone.
    pub(crate) lift: Scalar,
    /// v_w, R·Ω − R_i·Ω_i, v_rel.
    pub(crate) whirl_speed: Scalar,
    surface: Scalar,
    pub(crate) slip: Scalar,
    /// Parts of the tangential force, their sum, and it as a vector.
    pub(crate) sliding: Scalar,
    pub(crate) rolling: Scalar,
    grip: Scalar,
    tangential: Series,
    /// Ω_i.
    pub(crate) race: Scalar,
}

/// Series of everything.
#[derive(Debug, Clone)]
pub(crate) struct MachineSeries {
    pub(crate) step_s: f64,
    pub(crate) order: usize,
    pub(crate) position: Rows,
    pub(crate) velocity: Rows,
    pub(crate) spin: Scalar,
    spin_rate: Scalar,
    /// Direction (cos σ, sin σ), Ω times it, and the unbalance's acceleration per eccentricity.
    direction: Series,
    turning: Series,
    pub(crate) unbalance: Series,
    /// Forces of magnets that are not held; currents of poles, and rates of forces of second order.
    pub(crate) magnets: Vec<Series>,
    pub(crate) currents: Vec<Series>,
    pub(crate) planes: Vec<PlaneSeries>,
    acceleration: Vec<f64>,
    spun: Vec<f64>,
    holding: Holding,
}

/// What a series is of: nothing here changes from order to order.
#[derive(Clone, Copy)]
pub(crate) struct Step<'a> {
    pub(crate) system: &'a MachineSystem,
    pub(crate) phases: &'a [Phase],
    /// Forces that are held, on the coordinates.
    pub(crate) forces: &'a [f64],
    /// Commands of magnets that lag.
    pub(crate) commands_n: &'a [V2],
    pub(crate) step_s: f64,
}

impl PlaneSeries {
    /// What is positive while contact lasts.
    pub(crate) fn lift(&self, data: &PlaneData) -> &Scalar {
        match data.law {
            ContactLaw::Linear(_) => &self.force,
            ContactLaw::HuntCrossley(_) => &self.lift,
        }
    }
}

impl MachineSeries {
    pub(crate) fn new(body: &LinearBody) -> Self {
        let planes = body.contacts.len();
        Self {
            step_s: 0.0,
            order: 0,
            position: Rows::new(body.n),
            velocity: Rows::new(body.n),
            spin: Scalar::default(),
            spin_rate: Scalar::default(),
            direction: Series::default(),
            turning: Series::default(),
            unbalance: Series::default(),
            magnets: vec![Series::default(); body.magnets.len()],
            currents: vec![Series::default(); body.magnets.len()],
            planes: vec![PlaneSeries::default(); planes],
            acceleration: vec![0.0; body.n],
            spun: vec![0.0; body.n],
            holding: Holding::new(body.n),
        }
    }

    /// Becomes the solution from `y`, up to the order at which there is `enough`, or to `highest`.
    pub(crate) fn fill(
        &mut self,
        step: &Step<'_>,
        y: &MachineState,
        highest: usize,
        mut enough: impl FnMut(&Self, usize) -> bool,
    ) {
        let Step {
            system,
            phases,
            step_s,
            ..
        } = *step;
        self.step_s = step_s;
        self.position.row_mut(0).copy_from_slice(&y.position);
        self.velocity.row_mut(0).copy_from_slice(&y.velocity);
        self.spin.0[0] = y.spin_rad_s;
        if system.body.unbalance.is_some() {
            let (sin, cos) = y.phase_rad.sin_cos();
            self.direction.0[0] = V2::new(cos, sin);
        }
        for (m, series) in self.magnets.iter_mut().enumerate() {
            series.0[0] = system.magnet_n(m, y);
        }
        for (p, plane) in self.planes.iter_mut().enumerate() {
            plane.gap.0[0] = system.body.contacts[p].of(&y.position) - system.planes[p].centre_m;
            plane.gap_rate.0[0] = system.body.contacts[p].of(&y.velocity);
            plane.race.0[0] = y.races_rad_s[p];
            let distance_m = plane.gap.0[0].norm();
            plane.distance.0[0] = distance_m;
            plane.normal.0[0] = if distance_m > 0.0 {
                plane.gap.0[0] / distance_m
            } else {
                V2::x()
            };
        }
        let (planes, direction) = (&self.planes, self.direction.0[0]);
        (self.holding).set(
            system,
            holding_channels(phases),
            |p| planes[p].normal.0[0],
            direction,
        );
        let mut k = 0;
        loop {
            self.extend_positions(step, k);
            self.extend_forces(step, k);
            self.extend_spins(step, k);
            let last = k == highest || enough(self, k);
            // What has to be held at the last order follows from the next one's speeds.
            if !last || !self.holding.held().is_empty() {
                self.extend_velocities(step, k);
            }
            if last {
                break;
            }
            k += 1;
        }
        self.order = k;
        for (p, plane) in self.planes.iter_mut().enumerate() {
            if matches!(phases[p], Phase::Inside) {
                for i in 1..=k {
                    plane.gap.0[i] = system.body.contacts[p].of(self.position.row(i));
                }
            }
        }
    }

    /// Coefficients k + 1 of positions, distances and normals.
    fn extend_positions(&mut self, step: &Step<'_>, k: usize) {
        let next = step.step_s * INVERSE[k + 1];
        let n = self.position.n;
        let (velocity, position) = (
            self.velocity.row(k),
            &mut self.position.data[(k + 1) * n..(k + 2) * n],
        );
        for (q, v) in position.iter_mut().zip(velocity) {
            *q = next * v;
        }
        for (plane, phase) in self.planes.iter_mut().zip(step.phases) {
            if matches!(phase, Phase::Inside) {
                continue;
            }
            let m = k + 1;
            plane.gap.0[m] = next * plane.gap_rate.0[k];
            let (gap, distance) = (&plane.gap.0, &plane.distance.0);
            let inverse = 1.0 / distance[0];
            let mut sum = 0.0;
            for i in 1..m {
                sum += gap[i].dot(&gap[m - i]) - distance[i] * distance[m - i];
            }
            plane.distance.0[m] = (gap[0].dot(&gap[m]) + 0.5 * sum) * inverse;
            plane.normal_speed.0[k] = plane.distance.0[m] * (m as f64 / step.step_s);
            let mut mixed = V2::zeros();
            for i in 0..m {
                mixed += plane.distance.0[m - i] * plane.normal.0[i];
            }
            plane.normal.0[m] = (plane.gap.0[m] - mixed) * inverse;
        }
    }

    /// Coefficients k of the contact forces; friction that holds is left out.
    fn extend_forces(&mut self, step: &Step<'_>, k: usize) {
        for (p, plane) in self.planes.iter_mut().enumerate() {
            let data = &step.system.planes[p];
            if matches!(step.phases[p], Phase::Inside) {
                continue;
            }
            let first = if k == 0 { data.clearance_m } else { 0.0 };
            let (depth_m, rate_m_s) = (plane.distance.0[k] - first, plane.normal_speed.0[k]);
            plane.force.0[k] = match &data.law {
                ContactLaw::Linear(law) => law.normal_force_n(depth_m, rate_m_s),
                law @ ContactLaw::HuntCrossley(_) => {
                    // A moment's look, by the slopes a moment from now: at the touch itself there are none.
                    let rate_now_m_s = plane.normal_speed.0[0];
                    let now_m = plane.distance.0[0] - data.clearance_m;
                    let soon = law.at(now_m + rate_now_m_s.abs() * step.step_s, rate_now_m_s);
                    match k {
                        0 => law.normal_force_n(depth_m, rate_m_s),
                        _ => soon.by_depth_n_m * depth_m + soon.by_rate_n_s_m * rate_m_s,
                    }
                }
            };
            let Phase::Contact(slide, whirl) = step.phases[p] else {
                continue;
            };
            plane.push.0[k] = plane.normal.times_coefficient(&plane.force, k);
            plane.whirl_speed.0[k] = plane.normal.cross_coefficient(&plane.gap_rate, k);
            plane.surface.0[k] =
                data.radius_m * self.spin.0[k] - data.race_radius_m() * plane.race.0[k];
            plane.slip.0[k] = plane.whirl_speed.0[k] + plane.surface.0[k];
            // Friction that falls with speed is not integrated by series: a moment's look has it as it is now.
            let mu = data.friction.coefficient(slide.sign() * plane.slip.0[0]);
            plane.sliding.0[k] = -slide.sign() * mu * plane.force.0[k];
            plane.rolling.0[k] = match whirl {
                Whirl::Still | Whirl::Ignored => 0.0,
                _ => -whirl.sign() * data.rolling * plane.force.0[k],
            };
            plane.grip.0[k] = plane.sliding.0[k] + plane.rolling.0[k];
            plane.tangential.0[k] = perp(plane.normal.times_coefficient(&plane.grip, k));
        }
    }

    /// Coefficients k + 1 of the spins and k of what they do to the unbalance, which the energies are read off as well: also at the
    /// last order. A race that is not touched coasts, which needs no series.
    fn extend_spins(&mut self, step: &Step<'_>, k: usize) {
        let (system, next) = (step.system, step.step_s * INVERSE[k + 1]);
        let mut torque = if k == 0 { system.drive_torque_n_m } else { 0.0 };
        for (p, plane) in self.planes.iter_mut().enumerate() {
            let data = &system.planes[p];
            if !matches!(step.phases[p], Phase::Contact(..)) {
                plane.race.0[k + 1] = 0.0;
                continue;
            }
            let sliding_n = plane.sliding.0[k];
            torque += data.radius_m * sliding_n;
            if let Some(race) = &data.race {
                plane.race.0[k + 1] = next * race.acceleration(plane.race.0[k], sliding_n);
                if let Some(drag) = &data.load_drag {
                    let drag_m = drag.per_load_m(plane.race.0[0]);
                    plane.race.0[k + 1] -= next * drag_m * plane.force.0[k] / race.inertia_kg_m2;
                }
            }
        }
        self.spin_rate.0[k] = torque * system.inverse_inertia;
        self.spin.0[k + 1] = next * self.spin_rate.0[k];
        if system.body.unbalance.is_some() {
            self.turning.0[k] = self.direction.times_coefficient(&self.spin, k);
            self.direction.0[k + 1] = next * perp(self.turning.0[k]);
            let mut by_speed = self.turning.times_coefficient(&self.spin, k);
            if system.inverse_inertia > 0.0 {
                by_speed -= perp(self.direction.times_coefficient(&self.spin_rate, k));
            }
            self.unbalance.0[k] = by_speed;
        }
    }

    /// Coefficients k + 1 of the velocities, and k of the friction that holds.
    fn extend_velocities(&mut self, step: &Step<'_>, k: usize) {
        let (system, next) = (step.system, step.step_s * INVERSE[k + 1]);
        let body = &system.body;
        for (m, series) in self.magnets.iter_mut().enumerate() {
            let Some(rate) = system.magnets[m].lag() else {
                // Poles are not integrated by series: a moment's look has their force as it is now.
                series.0[k + 1] = V2::zeros();
                continue;
            };
            let command_n = if k == 0 {
                step.commands_n[m]
            } else {
                V2::zeros()
            };
            series.0[k + 1] = next * rate * (command_n - series.0[k]);
        }
        // Forces on the coordinates.
        let acceleration = &mut self.acceleration;
        match k {
            0 => acceleration.copy_from_slice(step.forces),
            _ => acceleration.fill(0.0),
        }
        body.stiffness
            .add_product(acceleration, -1.0, self.position.row(k));
        body.damping
            .add_product(acceleration, -1.0, self.velocity.row(k));
        if system.inverse_inertia == 0.0 {
            body.gyroscopic
                .add_product(acceleration, -self.spin.0[0], self.velocity.row(k));
        } else if !body.gyroscopic.is_zero() {
            self.spun.fill(0.0);
            for i in 0..=k {
                let spin = self.spin.0[i];
                for (s, v) in self.spun.iter_mut().zip(self.velocity.row(k - i)) {
                    *s += spin * v;
                }
            }
            body.gyroscopic.add_product(acceleration, -1.0, &self.spun);
        }
        for (m, series) in self.magnets.iter().enumerate() {
            if !system.magnets[m].is_held() {
                body.magnets[m].push(acceleration, series.0[k]);
            }
        }
        if let Some(unbalance) = &body.unbalance {
            unbalance.push(acceleration, self.unbalance.0[k]);
        }
        for (p, plane) in self.planes.iter().enumerate() {
            if matches!(step.phases[p], Phase::Contact(..)) {
                body.contacts[p].push(acceleration, plane.tangential.0[k] - plane.push.0[k]);
            }
        }
        for (v, a) in self
            .velocity
            .row_mut(k + 1)
            .iter_mut()
            .zip(acceleration.iter())
        {
            *v = next * a;
        }
        self.read_rates(step, k + 1);
        if !self.holding.held().is_empty() {
            self.hold_speeds(step, k);
        }
    }

    /// Coefficient k of the rates in planes that are touched.
    fn read_rates(&mut self, step: &Step<'_>, k: usize) {
        for (p, plane) in self.planes.iter_mut().enumerate() {
            if !matches!(step.phases[p], Phase::Inside) {
                plane.gap_rate.0[k] = step.system.body.contacts[p].of(self.velocity.row(k));
            }
        }
    }

    /// Speed that a channel holds, coefficient k.
    fn speed(&self, system: &MachineSystem, (p, channel): (usize, Channel), k: usize) -> f64 {
        let plane = &self.planes[p];
        let whirl = plane.normal.cross_coefficient(&plane.gap_rate, k);
        whirl + system.surface_of(p, channel, self.spin.0[k], plane.race.0[k])
    }

    /// Coefficients k of the friction that holds: so that coefficients k + 1 of the speeds become zero.
    fn hold_speeds(&mut self, step: &Step<'_>, k: usize) {
        let (system, next) = (step.system, step.step_s * INVERSE[k + 1]);
        let friction_n = self
            .holding
            .against(|held| self.speed(system, (held.plane, held.channel), k + 1) / next);
        let n = self.velocity.n;
        for (held, force_n) in self.holding.held().iter().zip(friction_n) {
            let velocity = &mut self.velocity.data[(k + 1) * n..(k + 2) * n];
            for (v, a) in velocity.iter_mut().zip(&held.accelerations) {
                *v += next * force_n * a;
            }
            self.spin_rate.0[k] += held.spin * force_n;
            self.spin.0[k + 1] += next * held.spin * force_n;
            self.unbalance.0[k] -= held.spin * force_n * perp(self.direction.0[0]);
            let plane = &mut self.planes[held.plane];
            plane.race.0[k + 1] += next * held.race * force_n;
            match held.channel {
                Channel::Sliding => plane.sliding.0[k] += force_n,
                Channel::Rolling => plane.rolling.0[k] += force_n,
            }
            plane.grip.0[k] += force_n;
            plane.tangential.0[k] += force_n * perp(plane.normal.0[0]);
        }
        self.read_rates(step, k + 1);
    }

    /// State at θ.
    pub(crate) fn at(
        &self,
        (system, phases): (&MachineSystem, &[Phase]),
        theta: f64,
        y: &mut MachineState,
    ) {
        let order = self.order;
        self.position.at(theta, order, &mut y.position);
        self.velocity.at(theta, order, &mut y.velocity);
        y.phase_rad += self.step_s * self.spin.integral(theta, order);
        if system.inverse_inertia > 0.0 {
            y.spin_rad_s = self.spin.at(theta, order);
        }
        for (p, plane) in self.planes.iter().enumerate() {
            y.races_rad_s[p] = match (&system.planes[p].race, phases[p]) {
                (None, _) => continue,
                (Some(_), Phase::Contact(..)) => plane.race.at(theta, order),
                (Some(race), _) => race.coasted_rad_s(plane.race.0[0], theta * self.step_s),
            };
        }
        for (m, law) in system.magnets.iter().enumerate() {
            match law {
                MagnetLaw::Held => {}
                MagnetLaw::Lag(_) => y.magnets[m] = self.magnets[m].at(theta, order),
                MagnetLaw::SecondOrder(..) => {
                    y.magnets[m] = self.magnets[m].at(theta, order);
                    y.magnet_slopes[m] = self.currents[m].at(theta, order);
                }
                MagnetLaw::Poles(_) => y.magnets[m] = self.currents[m].at(theta, order),
            }
        }
    }
}
