//! A machine's equations, apart from how they are integrated: what holds what, and how much it takes.

use super::body::{LinearBody, Port};
use super::params::{BearingHeat, Change, LoadDrag, MAX_PLANES, MachineParams, MachineStart};
use super::poles::MagnetLaw;
use crate::V2;
use crate::contact::NO_DENT;
use crate::ellipse::Ellipse;
use crate::integrate::{Fastest, PlantError};
use crate::mode::{Phase, Slide, Whirl};
use crate::params::{ContactLaw, ParamError, SlidingFriction, SpinParams, StatorParams, check};
use crate::race::Race;
use crate::vector::Body;
use nalgebra::SMatrix;

/// Most speeds that friction may hold at once: sliding and rolling in each plane.
pub(crate) const MAX_HELD: usize = 2 * MAX_PLANES;

/// A start is on the wall within this share of the clearance, and moves along it within this share of its speed: sine,
/// cosine, a product and the length leave up to 2.5ε. The [guard](super::guards) of the wall knows it as well.
pub(crate) const ON_WALL: f64 = 4.0 * f64::EPSILON;

/// A way in which friction acts in a plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Channel {
    /// On the sliding speed, and on the spin.
    Sliding,
    /// On the whirl.
    Rolling,
}

/// Channels that hold their speeds at zero in these phases.
pub(crate) fn holding_channels(phases: &[Phase]) -> impl Iterator<Item = (usize, Channel)> + '_ {
    phases.iter().enumerate().flat_map(|(p, phase)| {
        let (slides, whirls) = match phase {
            Phase::Contact(slide, whirl) => (*slide == Slide::Rolling, *whirl == Whirl::Still),
            _ => (false, false),
        };
        let sliding = slides.then_some((p, Channel::Sliding));
        sliding
            .into_iter()
            .chain(whirls.then_some((p, Channel::Rolling)))
    })
}

/// A plane without what moves in it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlaneData {
    pub(crate) centre_m: V2,
    pub(crate) radius_m: f64,
    /// Now, and when cold.
    pub(crate) clearance_m: f64,
    pub(crate) cold_m: f64,
    /// Of a bore that is out of round.
    pub(crate) bore: Option<Ellipse>,
    pub(crate) heat: Option<BearingHeat>,
    pub(crate) law: ContactLaw,
    /// Of the contact; where it grows with the depth, at that of one clearance.
    pub(crate) stiffness_n_m: f64,
    /// Of sliding; μ at rest, and μ_r.
    pub(crate) friction: SlidingFriction,
    pub(crate) sliding: f64,
    pub(crate) rolling: f64,
    pub(crate) race: Option<Race>,
    pub(crate) load_drag: Option<LoadDrag>,
}

/// Where the rotor is against a wall.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    /// From the centre of the bore, out of round from that of curvature at the nearest point, and how long \[m\].
    pub(crate) from_centre_m: V2,
    pub(crate) distance_m: f64,
    /// Outward.
    pub(crate) normal: V2,
    /// A; negative inside the clearance.
    pub(crate) penetration_m: f64,
}

impl PlaneData {
    /// Where `u` from the centre of the bore is.
    #[inline]
    pub(crate) fn place(&self, u: V2) -> Place {
        if let Some(bore) = &self.bore {
            let closest = bore.closest_point(u);
            let distance_m = closest.radius_m + closest.depth_m;
            return Place {
                from_centre_m: distance_m * closest.normal,
                distance_m,
                normal: closest.normal,
                penetration_m: closest.depth_m,
            };
        }
        let distance_m = u.norm();
        Place {
            from_centre_m: u,
            distance_m,
            // Concentric: every direction is as good; contact needs a clearance, so none is felt.
            normal: if distance_m > 0.0 {
                u / distance_m
            } else {
                V2::x()
            },
            penetration_m: distance_m - self.clearance_m,
        }
    }

    /// The wall nearest to the middle \[m\].
    pub(crate) fn nearest_m(&self) -> f64 {
        (self.bore).map_or(self.clearance_m, |bore| bore.nearest_m())
    }

    /// Radius at which the race turns; 0 for a bushing.
    #[inline]
    pub(crate) fn race_radius_m(&self) -> f64 {
        self.race.map_or(0.0, |race| race.radius_m)
    }

    /// Whether contact that ends leaves a dent that relaxes alone.
    pub(crate) fn leaves_dent(&self, penetration_m: f64) -> bool {
        let damped = match &self.law {
            ContactLaw::Linear(law) => law.damping_n_s_m > 0.0,
            ContactLaw::HuntCrossley(law) => law.damping_s_m > 0.0,
        };
        damped && penetration_m > NO_DENT * self.clearance_m
    }
}

/// What acts on a machine from outside, held until the next call.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MachineInputs {
    /// Commanded force of each magnet \[N\]; limited to its cap. As many as there are magnets.
    pub commands_n: Vec<V2>,
    /// Force at each place of `loads_m` \[N\]. As many as there are places.
    pub loads_n: Vec<V2>,
}

/// What changes in time.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct MachineState {
    /// Of the pairs.
    pub(crate) position: Vec<V2>,
    pub(crate) velocity: Vec<V2>,
    pub(crate) spin_rad_s: f64,
    pub(crate) phase_rad: f64,
    pub(crate) races_rad_s: Vec<f64>,
    /// Forces of magnets that lag, control currents of poles.
    pub(crate) magnets: Vec<V2>,
    /// Rates of the forces of amplifiers of second order.
    pub(crate) magnet_slopes: Vec<V2>,
}

impl MachineState {
    /// Motion at a port.
    pub(crate) fn motion_at(&self, port: &Port) -> Body {
        Body {
            position: port.of(&self.position),
            velocity: port.of(&self.velocity),
        }
    }

    pub(crate) fn is_finite(&self) -> bool {
        // What is finite is zero times zero, and what is not is no number: one sum for all.
        let vectors = [
            &self.position,
            &self.velocity,
            &self.magnets,
            &self.magnet_slopes,
        ];
        let of = |sum: f64, v: &V2| sum + 0.0 * v.x + 0.0 * v.y;
        let sum = vectors
            .iter()
            .fold(0.0, |sum, all| all.iter().fold(sum, of));
        let races: f64 = self.races_rad_s.iter().map(|spin| 0.0 * spin).sum();
        sum + races + 0.0 * (self.spin_rad_s + self.phase_rad) == 0.0
    }
}

/// Share of the largest mobility below which two motions are one.
const SINGULAR: f64 = 1e-12;

/// Inverse of the first rows and columns, zero elsewhere; `None` where it is as good as singular.
fn inverse(
    a: &SMatrix<f64, MAX_HELD, MAX_HELD>,
    count: usize,
) -> Option<SMatrix<f64, MAX_HELD, MAX_HELD>> {
    let mut left = *a;
    let mut right = SMatrix::<f64, MAX_HELD, MAX_HELD>::zeros();
    let largest = a.amax();
    for i in 0..count {
        right[(i, i)] = 1.0;
    }
    for column in 0..count {
        let size = |row: &usize| left[(*row, column)].abs();
        let pivot = (column..count).max_by(|a, b| size(a).total_cmp(&size(b)))?;
        if size(&pivot) <= SINGULAR * largest {
            return None;
        }
        left.swap_rows(column, pivot);
        right.swap_rows(column, pivot);
        let per = 1.0 / left[(column, column)];
        for j in 0..count {
            left[(column, j)] *= per;
            right[(column, j)] *= per;
        }
        for row in (0..count).filter(|row| *row != column) {
            let factor = left[(row, column)];
            for j in 0..count {
                left[(row, j)] -= factor * left[(column, j)];
                right[(row, j)] -= factor * right[(column, j)];
            }
        }
    }
    Some(right)
}

/// The machine.
#[derive(Debug, Clone)]
pub(crate) struct MachineSystem {
    pub(crate) body: LinearBody,
    pub(crate) planes: Vec<PlaneData>,
    pub(crate) mass_kg: f64,
    /// 1/J; 0 where the speed is held.
    pub(crate) inverse_inertia: f64,
    pub(crate) drive_torque_n_m: f64,
    pub(crate) magnets: Vec<MagnetLaw>,
    pub(crate) caps_n: Vec<f64>,
    /// Largest rate of a contact with its damper as it is at the touch \[1/s\].
    contact_rate_s: f64,
}

impl MachineSystem {
    pub(crate) fn new(params: &MachineParams) -> Result<Self, ParamError> {
        let body = LinearBody::new(params)?;
        let planes = params.planes.iter().map(|plane| PlaneData {
            centre_m: plane.centre_m,
            radius_m: plane.radius_m,
            clearance_m: (plane.heat).map_or(plane.contact.clearance_m, |heat| {
                heat.clearance_m(plane.contact.clearance_m, heat.start_rise_k)
            }),
            cold_m: plane.contact.clearance_m,
            bore: match &plane.stator {
                StatorParams::RigidEllipse(bore) => {
                    Some(Ellipse::new(bore, plane.contact.clearance_m))
                }
                _ => None,
            },
            heat: plane.heat,
            law: plane.contact.law,
            stiffness_n_m: plane.contact.stiffness_n_m(),
            friction: plane.friction.sliding,
            sliding: plane.friction.sliding.coefficient(0.0),
            rolling: plane.friction.rolling_coefficient,
            race: (plane.race.as_ref())
                .map(|race| Race::new(plane.radius_m + plane.contact.clearance_m, race)),
            load_drag: plane.load_drag,
        });
        let (inverse_inertia, drive_torque_n_m) = match params.spin {
            SpinParams::Held => (0.0, 0.0),
            SpinParams::Free {
                inertia_kg_m2,
                drive_torque_n_m,
            } => (1.0 / inertia_kg_m2, drive_torque_n_m),
        };
        let mut system = Self {
            body,
            planes: planes.collect(),
            mass_kg: params.rotor.rigid().mass_kg,
            inverse_inertia,
            drive_torque_n_m,
            magnets: params.magnets.iter().map(MagnetLaw::new).collect(),
            caps_n: params.magnets.iter().map(|m| m.force_max_n).collect(),
            contact_rate_s: 0.0,
        };
        system.contact_rate_s = system.contact_rate_rad_s();
        Ok(system)
    }

    pub(crate) fn start(
        &self,
        params: &MachineParams,
        start: &MachineStart,
    ) -> Result<MachineState, ParamError> {
        start.validate()?;
        let rigid = params.rotor.rigid();
        let (m, i) = (rigid.mass_kg.sqrt(), rigid.transverse_inertia_kg_m2.sqrt());
        let coordinates = |centre: V2, tilt: V2| {
            let mut q = vec![V2::zeros(); self.body.pairs];
            q[0] = m * centre;
            if rigid.tilts() {
                q[1] = i * tilt;
            }
            q
        };
        Ok(MachineState {
            position: coordinates(start.centre_m, start.tilt_rad),
            velocity: coordinates(start.centre_velocity_m_s, start.tilt_rate_rad_s),
            spin_rad_s: start.spin_rad_s,
            phase_rad: start.spin_phase_rad,
            races_rad_s: self
                .planes
                .iter()
                .map(|p| p.race.map_or(0.0, |r| r.start_spin_rad_s))
                .collect(),
            magnets: vec![V2::zeros(); self.caps_n.len()],
            magnet_slopes: vec![V2::zeros(); self.caps_n.len()],
        })
    }

    /// Takes other values over.
    pub(crate) fn change(&mut self, change: &Change) -> Result<(), ParamError> {
        change.validate(self.body.rotor())?;
        if let Some(torque) = change.drive_torque_n_m {
            let rule = "nothing while the speed is held";
            let free = self.inverse_inertia > 0.0;
            check(free, "spin.drive_torque_n_m", torque, rule)?;
            self.drive_torque_n_m = torque;
        }
        if let Some(unbalance) = &change.unbalance {
            self.body.add_unbalance(unbalance);
        }
        if let Some(eccentricity_m) = change.eccentricity_m {
            self.body.move_centre(eccentricity_m);
        }
        if let Some(coefficient) = change.friction_coefficient {
            for plane in &mut self.planes {
                plane.friction = SlidingFriction::Constant { coefficient };
                plane.sliding = coefficient;
            }
        }
        Ok(())
    }

    /// Acceleration of the spin and of the race by one newton of a channel.
    pub(crate) fn turned_by(&self, plane: usize, channel: Channel) -> (f64, f64) {
        let data = &self.planes[plane];
        match channel {
            Channel::Sliding => {
                let race = data
                    .race
                    .map_or(0.0, |race| -race.radius_m / race.inertia_kg_m2);
                (data.radius_m * self.inverse_inertia, race)
            }
            Channel::Rolling => (0.0, 0.0),
        }
    }

    /// Whether the speed of a plane's surfaces changes in contact.
    pub(crate) fn turns(&self, plane: usize) -> bool {
        self.inverse_inertia > 0.0 || self.planes[plane].race.is_some()
    }

    /// Acceleration of a plane's race under sliding friction and load \[rad/s²\]; 0 for a bushing.
    #[inline]
    pub(crate) fn race_acceleration(
        &self,
        plane: usize,
        spin: f64,
        (sliding_n, load_n): (f64, f64),
    ) -> f64 {
        let data = &self.planes[plane];
        let Some(race) = &data.race else { return 0.0 };
        let drag_m = data.load_drag.map_or(0.0, |drag| drag.per_load_m(spin));
        race.acceleration(spin, sliding_n) - drag_m * load_n / race.inertia_kg_m2
    }

    /// What the spins add to the speed that a channel holds.
    #[inline]
    pub(crate) fn surface_of(&self, plane: usize, channel: Channel, spin: f64, race: f64) -> f64 {
        let data = &self.planes[plane];
        match channel {
            Channel::Sliding => data.radius_m * spin - data.race_radius_m() * race,
            Channel::Rolling => 0.0,
        }
    }

    /// Forces that channels have to give per unit of their speeds' rates, from their mobility. Where channels hold the same
    /// motion, as planes at one place do, many forces would: they share as their coefficients of friction are. Of `give` the first
    /// rows and columns are written.
    pub(crate) fn inverse_mobility(
        &self,
        give: &mut SMatrix<f64, MAX_HELD, MAX_HELD>,
        channels: impl ExactSizeIterator<Item = (usize, Channel)>,
        mobility: impl Fn(usize, usize) -> f64,
    ) {
        let count = channels.len();
        // Of one and of two the inverse is written out.
        if count == 1 {
            give[(0, 0)] = 1.0 / mobility(0, 0);
            return;
        }
        if count == 2 {
            let [a, b, c, d] = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| mobility(i, j));
            let (determinant, largest) = (a * d - b * c, a.abs().max(d.abs()));
            if determinant.abs() > SINGULAR * largest * largest {
                (give[(0, 0)], give[(0, 1)]) = (d / determinant, -b / determinant);
                (give[(1, 0)], give[(1, 1)]) = (-c / determinant, a / determinant);
                return;
            }
        }
        let mut share = [1.0_f64; MAX_HELD];
        for (share, (p, channel)) in share.iter_mut().zip(channels) {
            let mu = match channel {
                Channel::Sliding => self.planes[p].sliding,
                Channel::Rolling => self.planes[p].rolling,
            };
            *share = mu.max(f64::MIN_POSITIVE).sqrt();
        }
        let mut scaled = SMatrix::<f64, MAX_HELD, MAX_HELD>::zeros();
        for row in 0..count {
            for column in 0..count {
                scaled[(row, column)] = share[row] * mobility(row, column) * share[column];
            }
        }
        *give = inverse(&scaled, count).unwrap_or_else(|| {
            let largest = scaled.amax();
            scaled
                .pseudo_inverse(SINGULAR * largest)
                .unwrap_or_default()
        });
        for row in 0..count {
            for column in 0..count {
                give[(row, column)] *= share[row] * share[column];
            }
        }
    }

    /// Force of a magnet that is not held \[N\].
    pub(crate) fn magnet_n(&self, magnet: usize, y: &MachineState) -> V2 {
        match &self.magnets[magnet] {
            MagnetLaw::Poles(poles) => {
                let port = &self.body.magnets[magnet];
                poles.force_n(y.magnets[magnet], port.of(&y.position))
            }
            _ => y.magnets[magnet],
        }
    }

    /// Port of a plane's contact.
    pub(crate) fn contact(&self, plane: usize) -> &Port {
        &self.body.contacts[plane]
    }

    /// Rate of a plane's contact spring on the mobility there \[rad/s\].
    pub(crate) fn undamped_contact_rate_rad_s(&self, plane: usize) -> f64 {
        (self.planes[plane].stiffness_n_m * self.contact(plane).mobility()).sqrt()
    }

    /// Rate of a plane's contact damper on the mobility there \[1/s\].
    fn contact_decay_rate_s(&self, plane: usize) -> f64 {
        let data = &self.planes[plane];
        data.law.by_rate_n_s_m(data.clearance_m) * self.contact(plane).mobility()
    }

    /// Whether stability and not the tolerance would set the steps of the series: a contact damper so strong that it stops the rotor
    /// many times within the time in which the spring gives way.
    pub(crate) fn is_overdamped(&self) -> bool {
        const FAST_S: f64 = 1e6;
        (0..self.planes.len()).any(|p| {
            let rate_s = self.contact_decay_rate_s(p);
            rate_s > FAST_S && rate_s > 4.0 * self.undamped_contact_rate_rad_s(p)
        })
    }

    /// Sign of backward whirl in a plane. Without spin friction drives against the way in which the surfaces slide on each other.
    pub(crate) fn backward(&self, plane: usize, y: &MachineState) -> f64 {
        let sense = match y.spin_rad_s == 0.0 {
            true => -self.planes[plane].race_radius_m() * y.races_rad_s[plane],
            false => y.spin_rad_s,
        };
        if sense >= 0.0 { -1.0 } else { 1.0 }
    }

    /// A limit of work with what moves fastest.
    #[cold]
    pub(crate) fn naming_fastest(&self, error: PlantError) -> PlantError {
        let PlantError::WorkLimit { t_s, steps, .. } = error else {
            return error;
        };
        let body = &self.body;
        let mut fastest = Fastest {
            what: "rotor on its supports, or a ring on its mounting",
            plane: None,
            rate_s: body.undamped_rate_rad_s().max(body.damping_rate_s()),
        };
        let mut compare = |what, plane, rate_s: f64| {
            if rate_s > fastest.rate_s {
                let plane = Some(plane);
                fastest = Fastest {
                    what,
                    plane,
                    rate_s,
                };
            }
        };
        for p in 0..self.planes.len() {
            let [spring, damper] = match body.rings[p].is_some() {
                true => ["ring on the contact spring", "ring on the contact damper"],
                false => ["contact spring", "contact damper"],
            };
            compare(spring, p, self.undamped_contact_rate_rad_s(p));
            compare(damper, p, self.contact_decay_rate_s(p));
        }
        PlantError::WorkLimit {
            t_s,
            steps,
            fastest: Some(fastest),
        }
    }

    /// Rate of a plane's contact with its damper at a depth \[rad/s\].
    fn contact_rate_at(&self, plane: usize, depth_m: f64) -> f64 {
        let damper_n_s_m = self.planes[plane].law.by_rate_n_s_m(depth_m);
        self.undamped_contact_rate_rad_s(plane) + damper_n_s_m * self.contact(plane).mobility()
    }

    /// The largest of them at the touch \[rad/s\].
    pub(crate) fn contact_rate_rad_s(&self) -> f64 {
        let rates = (0..self.planes.len()).map(|p| self.contact_rate_at(p, 0.0));
        rates.fold(0.0, f64::max)
    }

    /// A time that nothing in contact notices, where the rotor is.
    pub(crate) fn moment_s(&self, y: &MachineState) -> f64 {
        let mut rate = self.contact_rate_s;
        for (p, data) in self.planes.iter().enumerate() {
            if let ContactLaw::HuntCrossley(_) = data.law {
                let depth_m = self.motion(p, y).penetration_m.max(0.0);
                rate = rate.max(self.contact_rate_at(p, depth_m));
            }
        }
        1e-6 / rate
    }

    /// Work of what is held along the coordinates' way: of magnets that do not lag, and of loads and gravity \[J\].
    pub(crate) fn held_work_j(&self, inputs: &MachineInputs, path: &[V2]) -> (f64, f64) {
        let (mut control, mut external) = (0.0, 0.0);
        for (port, load_n) in self.body.loads.iter().zip(&inputs.loads_n) {
            external += load_n.dot(&port.of(path));
        }
        for (force, way) in self.body.gravity.iter().zip(path) {
            external += force.dot(way);
        }
        let magnets = self.body.magnets.iter().zip(&self.magnets);
        for ((port, law), command_n) in magnets.zip(&inputs.commands_n) {
            if law.is_held() {
                control += command_n.dot(&port.of(path));
            }
        }
        (control, external)
    }
}
