//! Flight over one control sample as a map. Without unbalance flight is linear and its axes do not
//! couple, so where the rotor flies from sample to sample the end state is a constant matrix times
//! state and inputs, and each work a constant quadratic form. The columns come from the series, flown
//! from unit states; near the wall the series itself decides.

use super::flight::Segment;
use crate::V2;
use crate::energy::Flows;
use crate::magnet::Amplifier;
use crate::part::{Body, Part};
use crate::plane::{Bore, Raceway};
use crate::quadrature::{EIGHT, Nodes};
use crate::spin::Spin;
use crate::stator::Stator;
use crate::system::{Inputs, State, StateOf, System};

/// Most plane vectors that flight depends on: rotor 2, rings 4, delivered force 1, inputs 2.
const SLOTS: usize = 9;

/// A step length must come so often in a row before a map is made for it.
const OFTEN: u32 = 16;

/// Entry (i, k) belongs to slots i and k, its components to the two axes.
type Matrix = [[V2; SLOTS]; SLOTS];

/// Flight over one step length.
#[derive(Debug, Clone)]
struct FlightMap {
    step_s: f64,
    /// End state by start.
    end: Matrix,
    /// Largest part of each slot in the rotor's way from its ring, over the whole step.
    reach: [V2; SLOTS],
    /// Works as quadratic forms, on and above the diagonal.
    control: Matrix,
    rotor_damping: Matrix,
    stator_damping: Matrix,
}

/// The map of the step length that recurs, once one does.
#[derive(Debug, Clone, Default)]
pub(crate) struct FlightMaps {
    map: Option<FlightMap>,
    candidate_s: f64,
    times: u32,
}

/// Lengths that differ by the rounding of the clock only.
fn same(a_s: f64, b_s: f64) -> bool {
    (a_s - b_s).abs() <= 1e-9 * a_s
}

impl<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway> System<S, W, M, B, R> {
    /// Slots that are state; the two inputs follow.
    const STATE_SLOTS: usize = (Body::STATES + S::State::STATES + M::State::STATES) / 2;
    const USED_SLOTS: usize = Self::STATE_SLOTS + 2;

    /// Flies the whole of `dt_s` by the map, if there is one and the wall is out of reach.
    pub(crate) fn fly_by_map(
        &self,
        maps: &mut FlightMaps,
        y: &StateOf<S, W, M, R>,
        inputs: &Inputs,
        dt_s: f64,
    ) -> Option<(StateOf<S, W, M, R>, Flows)> {
        if self.rotor.eccentricity_m != 0.0 {
            return None;
        }
        if maps.map.as_ref().is_some_and(|map| same(dt_s, map.step_s)) {
            maps.times = 0;
        } else {
            if !same(dt_s, maps.candidate_s) {
                (maps.candidate_s, maps.times) = (dt_s, 0);
            }
            maps.times += 1;
            if maps.times < OFTEN {
                return None;
            }
            maps.map = Some(self.flight_map(dt_s));
        }
        let map = maps.map.as_ref()?;
        let start = gather::<S, W, M, R>(y, inputs);
        let mut reach = 0.0;
        for (reach_of, z) in map.reach.iter().zip(&start).take(Self::USED_SLOTS) {
            reach += reach_of.dot(&z.abs());
        }
        let wall_m = match self.plane.bore.ellipse() {
            None => self.plane.contact.clearance_m,
            Some(ellipse) => ellipse.nearest_m(),
        };
        if reach.is_nan() || reach >= wall_m {
            return None;
        }
        let mut end = [V2::zeros(); SLOTS];
        for (end, row) in end.iter_mut().zip(&map.end).take(Self::STATE_SLOTS) {
            for (a, z) in row.iter().zip(&start).take(Self::USED_SLOTS) {
                *end += a.component_mul(z);
            }
        }
        let mut end = scatter::<S, W, M, R>(
            &end,
            self.spin.coast(&y.spin, dt_s),
            self.plane.race.coast(&y.race, dt_s),
        );
        // The map's length carries the rounding of the clock at which it was made, and would add it up.
        let rates = self.flight_rates(&end, inputs);
        end.add_scaled(dt_s - map.step_s, &rates);
        let work = |form: &Matrix| quadratic(form, &start[..Self::USED_SLOTS]);
        let path = end.rotor.position - y.rotor.position;
        let race_loss_j = self.race_loss_j(&y.race, &end.race);
        let flows = Flows {
            control: match M::LAGS {
                true => work(&map.control),
                false => inputs.command_n.dot(&path),
            },
            external: inputs.external_n.dot(&path),
            drive: self.drive_work(&y.spin, &end.spin),
            rotor_damping: match self.rotor.damping_n_s_m != 0.0 {
                true => work(&map.rotor_damping),
                false => 0.0,
            },
            stator_damping: match (self.stator.is_damped(), race_loss_j) {
                (true, Some(loss_j)) => work(&map.stator_damping) + loss_j,
                (true, None) => work(&map.stator_damping),
                (false, loss_j) => loss_j.unwrap_or(0.0),
            },
            ..Flows::default()
        };
        Some((end, flows))
    }

    /// Rates of everything but the spin, without unbalance.
    fn flight_rates(&self, y: &StateOf<S, W, M, R>, inputs: &Inputs) -> StateOf<S, W, M, R> {
        let magnet_n = self.amplifier.force_n(&y.force, inputs.command_n);
        let force = (self.rotor).with_shaft_n(magnet_n + inputs.external_n, &y.rotor);
        State {
            rotor: Body {
                position: y.rotor.velocity,
                velocity: force / self.rotor.mass_kg,
            },
            stator: self.stator.rates(&y.stator, V2::zeros()),
            spin: W::State::default(),
            race: R::State::default(),
            force: self.amplifier.rates(&y.force, inputs.command_n),
        }
    }

    fn flight_map(&self, dt_s: f64) -> FlightMap {
        let mut map = FlightMap {
            step_s: dt_s,
            end: [[V2::zeros(); SLOTS]; SLOTS],
            reach: [V2::zeros(); SLOTS],
            control: [[V2::zeros(); SLOTS]; SLOTS],
            rotor_damping: [[V2::zeros(); SLOTS]; SLOTS],
            stator_damping: [[V2::zeros(); SLOTS]; SLOTS],
        };
        // One unit start for each slot, flown piece by piece in step with the others.
        let mut starts = [[V2::zeros(); SLOTS]; SLOTS];
        for (i, start) in starts.iter_mut().enumerate() {
            start[i] = V2::repeat(1.0);
        }
        let mut segment = Segment::<S>::new(self.flight_rate_rad_s());
        let mut flown_s = 0.0;
        while flown_s < dt_s {
            let mut velocity = [[V2::zeros(); EIGHT.theta.len()]; SLOTS];
            let mut force = velocity;
            let mut dampers = [velocity; 2];
            let mut step_s = 0.0;
            for (i, start) in starts[..Self::USED_SLOTS].iter_mut().enumerate() {
                let y = scatter::<S, W, M, R>(start, W::State::default(), R::State::default());
                let inputs = Inputs {
                    command_n: start[Self::STATE_SLOTS],
                    external_n: start[Self::STATE_SLOTS + 1],
                };
                self.fly(&mut segment, (0.0, &y), &inputs, dt_s - flown_s);
                step_s = segment.step_s;
                let values = segment.values(&EIGHT);
                (velocity[i], force[i]) = (values.velocity, values.force);
                let [a, b] = S::damper_speeds(&segment.stator, &EIGHT, segment.order);
                (dampers[0][i], dampers[1][i]) = (a, b);
                map.reach[i] = map.reach[i].sup(&segment.reach::<B>());
                let end = self.flown(&segment, &y, 1.0);
                *start = gather::<S, W, M, R>(&end, &inputs);
            }
            let [inner, outer] = self.stator.damper_constants();
            let damping = V2::repeat(self.rotor.damping_n_s_m);
            let unit = V2::repeat(step_s);
            let nodes = &EIGHT;
            add_products(&mut map.control, unit, (&force, &velocity), nodes);
            add_products(
                &mut map.rotor_damping,
                step_s * damping,
                (&velocity, &velocity),
                nodes,
            );
            for (constant, speed) in [inner, outer].iter().zip(&dampers) {
                add_products(
                    &mut map.stator_damping,
                    step_s * constant,
                    (speed, speed),
                    nodes,
                );
            }
            flown_s += step_s;
        }
        for (i, start) in starts[..Self::USED_SLOTS].iter().enumerate() {
            for (row, end) in map.end[..Self::STATE_SLOTS].iter_mut().zip(start) {
                row[i] = *end;
            }
        }
        map
    }
}

/// State and inputs as plane vectors.
fn gather<S: Stator, W: Spin, M: Amplifier, R: Raceway>(
    y: &StateOf<S, W, M, R>,
    inputs: &Inputs,
) -> [V2; SLOTS] {
    let mut raw = [0.0; 2 * SLOTS];
    let (rotor, rest) = raw.split_at_mut(Body::STATES);
    y.rotor.write(rotor);
    let (stator, rest) = rest.split_at_mut(S::State::STATES);
    y.stator.write(stator);
    let (force, rest) = rest.split_at_mut(M::State::STATES);
    y.force.write(force);
    rest[..2].copy_from_slice(inputs.command_n.as_slice());
    rest[2..4].copy_from_slice(inputs.external_n.as_slice());
    std::array::from_fn(|i| V2::new(raw[2 * i], raw[2 * i + 1]))
}

/// The state back from them.
fn scatter<S: Stator, W: Spin, M: Amplifier, R: Raceway>(
    slots: &[V2; SLOTS],
    spin: W::State,
    race: R::State,
) -> StateOf<S, W, M, R> {
    let mut raw = [0.0; 2 * SLOTS];
    for (pair, slot) in raw.chunks_exact_mut(2).zip(slots) {
        pair.copy_from_slice(slot.as_slice());
    }
    let (rotor, rest) = raw.split_at(Body::STATES);
    let (stator, rest) = rest.split_at(S::State::STATES);
    State {
        rotor: Body::read(rotor),
        stator: S::State::read(stator),
        spin,
        race,
        force: M::State::read(rest),
    }
}

/// Adds factor·∫ a_i·b_k dθ to each entry, on and above the diagonal both halves together.
fn add_products<const N: usize>(
    form: &mut Matrix,
    factor: V2,
    (a, b): (&[[V2; N]; SLOTS], &[[V2; N]; SLOTS]),
    nodes: &Nodes<N>,
) {
    for i in 0..SLOTS {
        for k in 0..SLOTS {
            let product = V2::new(
                nodes.integral(|j| a[i][j].x * b[k][j].x),
                nodes.integral(|j| a[i][j].y * b[k][j].y),
            );
            form[i.min(k)][i.max(k)] += factor.component_mul(&product);
        }
    }
}

/// Σ form_ik·z_i·z_k over both axes.
#[inline]
fn quadratic(form: &Matrix, z: &[V2]) -> f64 {
    let mut sum = V2::zeros();
    for (i, (row, z_i)) in form.iter().zip(z).enumerate() {
        let mut inner = V2::zeros();
        for (q, z_k) in row[..z.len()].iter().zip(z).skip(i) {
            inner += q.component_mul(z_k);
        }
        sum += inner.component_mul(z_i);
    }
    sum.x + sum.y
}
