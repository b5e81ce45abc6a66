//! The motion of a machine as a power series over one step: the linear body's coordinates, the spins, and in every plane
//! that is touched the contact, all orders one after the other.
//!
//! Series run over θ = time / step; entry k holds the k-th coefficient times step^k. The recurrence is that of one plane,
//! eqs (3.5)–(3.8), per distance: with u the rotor against what it touches, w = u̇, ρ = |u|, κ = f_n/ρ and τ the friction over ρ
//! the force on the rotor is −κ·u + τ·(u turned by a right angle), and speeds along the wall are (u × w)/ρ. So no direction and no
//! speed needs a series of its own. Friction that holds a speed at zero enters in proportion at each order, so it is first left out
//! there, and what it has to be follows from the speed that is then not zero: one small linear system, the same for all orders.

use super::body::LinearBody;
use super::holding::Holding;
use super::orders::{Order, extend_touched, whirl_coefficient};
use super::plane_series::{Grip, PlaneSeries, State};
use super::poles::MagnetLaw;
use super::rows::{AnyRows, Pushes, Rows, of_rows};
use super::system::{Channel, MachineState, MachineSystem, PlaneData, holding_channels};
use crate::V2;
use crate::integrate::order_control::LOWEST_ORDER;
use crate::mode::{Phase, Slide, Whirl};
use crate::params::{ContactLaw, SlidingFriction};
use crate::series::{INVERSE, Scalar, Series};
use crate::vector::perp;

/// Series of everything.
#[derive(Debug, Clone)]
pub(crate) struct MachineSeries {
    pub(super) rows: AnyRows,
    pub(crate) parts: Parts,
}

/// All series but those of the coordinates.
#[derive(Debug, Clone)]
pub(crate) struct Parts {
    pub(crate) step_s: f64,
    pub(crate) order: usize,
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
    holding: Holding,
}

/// What a series is of: nothing here changes from order to order.
#[derive(Clone, Copy)]
pub(crate) struct Step<'a> {
    pub(crate) system: &'a MachineSystem,
    pub(crate) phases: &'a [Phase],
    /// Forces that are held, on the coordinates.
    pub(crate) forces: &'a [V2],
    /// Commands of magnets that lag.
    pub(crate) commands_n: &'a [V2],
    pub(crate) step_s: f64,
}

impl PlaneSeries {
    /// Where it starts, and how friction acts from there.
    fn begin(&mut self, step: &Step<'_>, plane: usize, y: &MachineState) {
        let (system, data) = (step.system, &step.system.planes[plane]);
        self.gap.0[0] = system.body.contacts[plane].of(&y.position) - data.centre_m;
        self.gap_rate.0[0] = system.body.contacts[plane].of(&y.velocity);
        self.race.0[0] = y.races_rad_s[plane];
        self.state = match step.phases[plane] {
            Phase::Inside => State::Inside,
            Phase::Beyond => State::Beyond,
            Phase::Contact(..) => State::Touched,
        };
        self.wall_m = data.clearance_m;
        if data.bore.is_some() && self.state != State::Inside {
            // For a moment's look: on the circle of curvature.
            let place = data.place(self.gap.0[0]);
            self.gap.0[0] = place.from_centre_m;
            self.wall_m = place.distance_m - place.penetration_m;
        }
        self.distance.0[0] = self.gap.0[0].norm();
        self.per_m = 1.0 / self.distance.0[0];
        match &data.law {
            ContactLaw::Linear(law) => {
                (self.by_depth_n_m, self.by_rate_n_s_m) = (law.stiffness_n_m, law.damping_n_s_m);
                self.offset_n = 0.0;
            }
            law @ ContactLaw::HuntCrossley(_) => {
                // For a moment's look: at the touch itself there are no slopes.
                let rate_m_s = self.per_m * self.gap.0[0].dot(&self.gap_rate.0[0]);
                let depth_m = self.distance.0[0] - self.wall_m;
                let soon = law.at(depth_m + rate_m_s.abs() * step.step_s, rate_m_s);
                (self.by_depth_n_m, self.by_rate_n_s_m) = (soon.by_depth_n_m, soon.by_rate_n_s_m);
                self.offset_n = law.normal_force_n(depth_m, rate_m_s)
                    - soon.by_depth_n_m * depth_m
                    - soon.by_rate_n_s_m * rate_m_s;
            }
        }
        self.grip = Grip::none(system, plane);
        let Phase::Contact(slide, whirl) = step.phases[plane] else {
            self.falling = None;
            return;
        };
        let sign = slide.sign();
        let mut sliding = -sign * data.sliding;
        if let SlidingFriction::Falling {
            at_rest,
            at_speed,
            speed_scale_m_s,
        } = data.friction
            && slide != Slide::Rolling
        {
            let falling = self.falling.get_or_insert_default();
            (falling.sign, falling.at_speed) = (sign, at_speed);
            (falling.fall, falling.per_speed_s_m) = (at_rest - at_speed, 1.0 / speed_scale_m_s);
            sliding = 0.0;
        } else {
            self.falling = None;
        }
        self.grip = Grip {
            sliding,
            rolling: -whirl.sign() * data.rolling,
            holds: slide == Slide::Rolling || whirl == Whirl::Still,
            rolls: slide == Slide::Rolling,
            ..self.grip
        };
    }

    /// Becomes u × w, the speed of the whirl times ρ.
    pub(crate) fn whirl_of(&self, out: &mut Scalar, order: usize) {
        for k in 0..=order {
            out.0[k] = whirl_coefficient(self, k);
        }
    }

    /// Adds the surfaces' speed times ρ, which makes the sliding speed times ρ of it.
    pub(crate) fn add_surface(
        &self,
        out: &mut Scalar,
        (data, spin): (&PlaneData, &Scalar),
        order: usize,
    ) {
        let mut surface = Scalar::default();
        surface.combine(
            (data.radius_m, spin),
            (-data.race_radius_m(), &self.race),
            order,
        );
        for k in 0..=order {
            out.0[k] += if self.grip.turns {
                surface.product_coefficient(&self.distance, k)
            } else {
                surface.0[0] * self.distance.0[k]
            };
        }
    }
}

/// Asked from this order on, order by order: whether that is enough, by the series and the squares of the coordinates' coefficients.
const LEAST: usize = LOWEST_ORDER - 1;
pub(crate) type Asks<'a> = dyn FnMut(&Parts, usize, (f64, f64)) -> bool + 'a;

impl Parts {
    fn new(body: &LinearBody) -> Self {
        let planes = body.contacts.len();
        Self {
            step_s: 0.0,
            order: 0,
            spin: Scalar::default(),
            spin_rate: Scalar::default(),
            direction: Series::default(),
            turning: Series::default(),
            unbalance: Series::default(),
            magnets: vec![Series::default(); body.magnets.len()],
            currents: vec![Series::default(); body.magnets.len()],
            planes: vec![PlaneSeries::default(); planes],
            holding: Holding::new(body.pairs),
        }
    }

    /// What does not change from order to order.
    fn begin(&mut self, step: &Step<'_>, y: &MachineState) {
        let (system, phases) = (step.system, step.phases);
        self.step_s = step.step_s;
        self.spin.0[0] = y.spin_rad_s;
        if system.body.unbalance.is_some() {
            let (sin, cos) = y.phase_rad.sin_cos();
            self.direction.0[0] = V2::new(cos, sin);
        }
        for (m, series) in self.magnets.iter_mut().enumerate() {
            if !system.magnets[m].is_held() {
                series.0[0] = system.magnet_n(m, y);
            }
        }
        for (p, plane) in self.planes.iter_mut().enumerate() {
            plane.begin(step, p, y);
        }
        let (planes, direction) = (&self.planes, self.direction.0[0]);
        (self.holding).set(
            system,
            holding_channels(phases),
            |p| planes[p].gap.0[0] / planes[p].distance.0[0],
            direction,
        );
    }

    /// Becomes the solution, up to the order at which there is enough, or to `highest`.
    fn fill<const P: usize>(
        &mut self,
        rows: &mut Rows<P>,
        step: &Step<'_>,
        highest: usize,
        enough: &mut Asks<'_>,
    ) {
        let mut k = 0;
        loop {
            let next = step.step_s * INVERSE[k + 1];
            rows.extend_positions(k, next);
            self.extend_forces(step, k);
            self.extend_spins(step, k);
            let last = k == highest || k >= LEAST && enough(self, k, rows.squares(k));
            // What has to be held at the last order follows from the next one's speeds.
            if !last || !self.holding.held().is_empty() {
                self.extend_velocities(rows, step, k);
            }
            if last {
                break;
            }
            k += 1;
        }
        self.order = k;
        for (p, plane) in self.planes.iter_mut().enumerate() {
            if step.phases[p] == Phase::Inside {
                for i in 1..=k {
                    plane.gap.0[i] = rows.gap(p, i);
                }
            }
        }
    }

    /// Coefficients k of the contact forces, and k + 1 of the distances; friction that holds is left out.
    #[inline(always)]
    fn extend_forces(&mut self, step: &Step<'_>, k: usize) {
        for (plane, data) in self.planes.iter_mut().zip(&step.system.planes) {
            if plane.state == State::Inside {
                continue;
            }
            let order = Order {
                wall_m: plane.wall_m,
                next: step.step_s * INVERSE[k + 1],
                per_next: (k + 1) as f64 / step.step_s,
            };
            extend_touched(plane, k, order);
            if plane.falling.is_some() {
                let surface =
                    data.radius_m * self.spin.0[k] - data.race_radius_m() * plane.race.0[k];
                let moves = k == 0 || plane.grip.turns;
                let whirl = whirl_coefficient(plane, k);
                plane.extend_falling(k, whirl, if moves { surface } else { 0.0 });
            }
        }
    }

    /// Coefficients k + 1 of the spins and k of what they do to the unbalance, which the energies are read off as well: also at the
    /// last order. A race that is not touched coasts, which needs no series.
    #[inline(always)]
    fn extend_spins(&mut self, step: &Step<'_>, k: usize) {
        let (system, next) = (step.system, step.step_s * INVERSE[k + 1]);
        let free = system.inverse_inertia > 0.0;
        let mut torque = if k == 0 { system.drive_torque_n_m } else { 0.0 };
        for (plane, data) in self.planes.iter_mut().zip(&system.planes) {
            if !(plane.grip.turns && plane.state == State::Touched) {
                continue;
            }
            torque += data.radius_m * plane.torque_n;
            if let Some(race) = &data.race {
                plane.race.0[k + 1] = next * race.acceleration(plane.race.0[k], plane.torque_n);
                if let Some(drag) = &data.load_drag {
                    let drag_m = drag.per_load_m(plane.race.0[0]);
                    plane.race.0[k + 1] -= next * drag_m * plane.force.0[k] / race.inertia_kg_m2;
                }
            }
        }
        if free {
            self.spin_rate.0[k] = torque * system.inverse_inertia;
            self.spin.0[k + 1] = next * self.spin_rate.0[k];
        }
        if system.body.unbalance.is_none() {
            return;
        }
        if free {
            self.turning.0[k] = self.direction.times_coefficient(&self.spin, k);
            self.direction.0[k + 1] = next * perp(self.turning.0[k]);
            self.unbalance.0[k] = self.turning.times_coefficient(&self.spin, k)
                - perp(self.direction.times_coefficient(&self.spin_rate, k));
        } else {
            let turning = self.spin.0[0] * self.direction.0[k];
            self.direction.0[k + 1] = next * perp(turning);
            self.unbalance.0[k] = self.spin.0[0] * turning;
        }
    }

    /// Coefficients k + 1 of the velocities, and k of the friction that holds.
    #[inline(always)]
    fn extend_velocities<const P: usize>(&mut self, rows: &mut Rows<P>, step: &Step<'_>, k: usize) {
        let (system, next) = (step.system, step.step_s * INVERSE[k + 1]);
        for (m, (series, law)) in self.magnets.iter_mut().zip(&system.magnets).enumerate() {
            let command_n = if k == 0 {
                step.commands_n[m]
            } else {
                V2::zeros()
            };
            series.0[k + 1] = match law.lag() {
                Some(rate) => next * rate * (command_n - series.0[k]),
                // Others are not integrated by series: a moment's look has their force as it is now, that of held ones is zero here.
                None => V2::zeros(),
            };
        }
        let pushes = Pushes {
            forces: if k == 0 { step.forces } else { &[] },
            magnets: &self.magnets,
            planes: &self.planes,
            unbalance: self.unbalance.0[k],
        };
        let spin = match system.inverse_inertia > 0.0 {
            true => self.spin.0.as_slice(),
            false => &self.spin.0[..1],
        };
        rows.extend_velocities((k, next), pushes, spin);
        rows.read_rates(&mut self.planes, k + 1);
        if !self.holding.held().is_empty() {
            self.hold_speeds(rows, step, k);
        }
    }

    /// Speed that a channel holds times ρ over that of the start, coefficient k.
    fn speed(&self, system: &MachineSystem, (p, channel): (usize, Channel), k: usize) -> f64 {
        let plane = &self.planes[p];
        let surface = |i: usize| system.surface_of(p, channel, self.spin.0[i], plane.race.0[i]);
        let mut speed = whirl_coefficient(plane, k);
        if channel == Channel::Sliding {
            let steady = if plane.grip.turns { k } else { 0 };
            for i in 0..=steady {
                speed += surface(i) * plane.distance.0[k - i];
            }
        }
        plane.per_m * speed
    }

    /// Coefficients k of the friction that holds: so that coefficients k + 1 of the speeds become zero.
    fn hold_speeds<const P: usize>(&mut self, rows: &mut Rows<P>, step: &Step<'_>, k: usize) {
        let (system, next) = (step.system, step.step_s * INVERSE[k + 1]);
        let friction_n = self
            .holding
            .against(|held| self.speed(system, (held.plane, held.channel), k + 1) / next);
        for (held, force_n) in self.holding.held().iter().zip(friction_n) {
            let turned = -held.spin * force_n * perp(self.direction.0[0]);
            let force = (held.plane, next * force_n * held.tangent);
            rows.add_to_velocities(k + 1, force, next * turned);
            self.unbalance.0[k] += turned;
            if held.spin != 0.0 {
                self.spin_rate.0[k] += held.spin * force_n;
                self.spin.0[k + 1] += next * held.spin * force_n;
            }
            let plane = &mut self.planes[held.plane];
            plane.race.0[k + 1] += next * held.race * force_n;
            let per_m = force_n * plane.per_m;
            match held.channel {
                Channel::Sliding => plane.sliding_n_m.0[k] += per_m,
                Channel::Rolling => plane.rolling_n_m.0[k] += per_m,
            }
            plane.held_n_m.0[k] += per_m;
        }
        rows.read_rates(&mut self.planes, k + 1);
    }
}

impl MachineSeries {
    pub(crate) fn new(body: &LinearBody) -> Self {
        Self {
            rows: AnyRows::new(body),
            parts: Parts::new(body),
        }
    }

    /// Squares of the lengths of the coordinates' coefficients k: positions, velocities.
    pub(crate) fn squares(&self, k: usize) -> (f64, f64) {
        of_rows!(&self.rows, rows => rows.squares(k))
    }

    /// Takes over what has changed in the body.
    pub(crate) fn renew(&mut self, body: &LinearBody) {
        self.rows = AnyRows::new(body);
    }

    /// Becomes the solution from `y`, up to the order at which there is enough, or to `highest`.
    pub(crate) fn fill(
        &mut self,
        step: &Step<'_>,
        y: &MachineState,
        highest: usize,
        enough: &mut Asks<'_>,
    ) {
        let Self { rows, parts } = self;
        parts.begin(step, y);
        of_rows!(rows, rows => {
            rows.set(0, &y.position, &y.velocity);
            parts.fill(rows, step, highest, enough);
        });
        for (p, plane) in parts.planes.iter_mut().enumerate() {
            if let Phase::Contact(slide, whirl) = step.phases[p] {
                let slides = slide == Slide::Rolling || step.system.planes[p].sliding > 0.0;
                let whirls = !matches!(whirl, Whirl::Still | Whirl::Ignored);
                plane.finish(parts.order, (slides, whirls));
            }
        }
    }

    /// State at θ.
    pub(crate) fn at(
        &self,
        (system, phases): (&MachineSystem, &[Phase]),
        theta: f64,
        y: &mut MachineState,
    ) {
        let parts = &self.parts;
        let order = parts.order;
        let (position, velocity) = (&mut y.position, &mut y.velocity);
        of_rows!(&self.rows, rows => rows.at(theta, order, position, velocity));
        if system.inverse_inertia > 0.0 {
            y.phase_rad += parts.step_s * parts.spin.integral(theta, order);
            y.spin_rad_s = parts.spin.at(theta, order);
        } else {
            y.phase_rad += parts.step_s * theta * y.spin_rad_s;
        }
        for (p, plane) in parts.planes.iter().enumerate() {
            y.races_rad_s[p] = match (&system.planes[p].race, phases[p]) {
                (None, _) => continue,
                (Some(_), Phase::Contact(..)) => plane.race.at(theta, order),
                (Some(race), _) => race.coasted_rad_s(plane.race.0[0], theta * parts.step_s),
            };
        }
        for (m, law) in system.magnets.iter().enumerate() {
            match law {
                MagnetLaw::Held => {}
                MagnetLaw::Lag(_) => y.magnets[m] = parts.magnets[m].at(theta, order),
                MagnetLaw::SecondOrder(..) => {
                    y.magnets[m] = parts.magnets[m].at(theta, order);
                    y.magnet_slopes[m] = parts.currents[m].at(theta, order);
                }
                MagnetLaw::Poles(_) => y.magnets[m] = parts.currents[m].at(theta, order),
            }
        }
    }
}
