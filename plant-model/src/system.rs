//! The parts composed: eqs (2.1)–(2.9) as one smooth vector field per mode.

mod geometry;
mod state;

use crate::V2;
use crate::contact::Normal;
use crate::energy::Flows;
use crate::magnet::Amplifier;
use crate::mode::{Slide, Whirl};
use crate::params::{ContactLaw, HuntCrossley, RotorParams};
use crate::part::Body;
use crate::plane::{Bore, Plane, Raceway};
use crate::spin::Spin;
use crate::stator::{Rings, Stator};
use crate::vector::perp;

pub(crate) use geometry::Geometry;
pub(crate) use state::{State, StateOf};

/// What acts on the plant from outside, held until the next call.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inputs {
    /// Commanded magnet force \[N\]; limited to the magnet's cap, ignored without a magnet.
    pub command_n: V2,
    /// External force on the rotor, weight included \[N\].
    pub external_n: V2,
}

impl RotorParams {
    /// A force on the rotor with that of its shaft and damper, f − k·x − d·v \[N\]. Linear in both, so also for changes and
    /// for the coefficients of a series.
    #[inline]
    pub(crate) fn with_shaft_n(&self, force_n: V2, rotor: &Body) -> V2 {
        force_n - self.stiffness_n_m * rotor.position - self.damping_n_s_m * rotor.velocity
    }
}

/// The plant for one combination of parts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct System<S, W, M, B, R> {
    pub(crate) rotor: RotorParams,
    pub(crate) plane: Plane<B, R>,
    pub(crate) stator: S,
    pub(crate) spin: W,
    pub(crate) amplifier: M,
}

/// Guards of a contact mode: each is positive while the mode holds; unused ones are infinite.
pub(crate) type Guards = [f64; GUARDS];
pub(crate) const GUARDS: usize = 5;
/// Normal force, or what has its sign; see [`crate::contact::Normal`].
pub(crate) const NORMAL: usize = 0;
/// Slip: speed in its direction. Roll: room to the upper edge of the friction cone.
pub(crate) const SLIDE: usize = 1;
/// Roll: room to the lower edge.
pub(crate) const SLIDE_LOW: usize = 2;
/// Whirl: speed in its direction. Still: room to the upper edge of the rolling cone.
pub(crate) const WHIRL: usize = 3;
/// Still: room to the lower edge.
pub(crate) const WHIRL_LOW: usize = 4;

/// Guards that are not asked for a moment, having ended a mode at this very instant: one bit each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct SuppressedGuards(u8);

impl SuppressedGuards {
    pub(crate) const NONE: Self = Self(0);
    /// All that decide between modes of contact.
    pub(crate) const MODES: Self = Self(!(1 << NORMAL));
    pub(crate) const NORMAL: Self = Self(1 << NORMAL);

    pub(crate) fn has(self, guard: usize) -> bool {
        self.0 & (1 << guard) != 0
    }

    pub(crate) fn and(self, guard: usize) -> Self {
        Self(self.0 | (1 << guard))
    }

    pub(crate) fn among(self, others: Self) -> Self {
        Self(self.0 & others.0)
    }
}

/// Forces in the contact.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Touch {
    pub(crate) normal_n: f64,
    pub(crate) normal_rate_n_s: f64,
    /// Rate of the guard of the normal force, in its unit over a second.
    pub(crate) guard_rate: f64,
    /// Sliding part of the tangential force on the rotor, along t̂ \[N\].
    pub(crate) sliding_n: f64,
    /// Rolling part \[N\].
    pub(crate) rolling_n: f64,
    /// Largest sliding friction, μ·f_n \[N\].
    pub(crate) cone_n: f64,
    pub(crate) sliding_acceleration: f64,
    pub(crate) whirl_acceleration: f64,
    pub(crate) whirl_speed_m_s: f64,
    pub(crate) penetration_m: f64,
    pub(crate) normal_speed_m_s: f64,
}

/// The vector field at one point of a contact mode, with what the same terms give for free.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Evaluation<Y> {
    pub(crate) rates: Y,
    pub(crate) powers: Flows,
    pub(crate) guards: Guards,
    pub(crate) touch: Touch,
}

impl<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway> System<S, W, M, B, R> {
    /// Unbalance: acceleration by the square of the speed, and acceleration per unit of spin
    /// acceleration. `None` without eccentricity.
    #[inline]
    pub(crate) fn unbalance(&self, t_s: f64, y: &StateOf<S, W, M, R>) -> Option<(V2, V2)> {
        let e = self.rotor.eccentricity_m;
        if e == 0.0 {
            return None;
        }
        let (sin, cos) = self.spin.phase_rad(&y.spin, t_s).sin_cos();
        let spin = self.spin.spin_rad_s(&y.spin);
        let direction = V2::new(cos, sin);
        Some((e * spin * spin * direction, -e * perp(direction)))
    }

    /// The field in contact. Smooth for given `slide` and `whirl`, also where a guard is negative.
    #[inline(never)]
    pub(crate) fn contact(
        &self,
        t_s: f64,
        y: &StateOf<S, W, M, R>,
        inputs: &Inputs,
        mode: (Slide, Whirl),
    ) -> Evaluation<StateOf<S, W, M, R>> {
        // Compiled once for each law, so that the linear one pays for a branch only.
        match &self.plane.contact.law {
            ContactLaw::Linear(law) => {
                self.contact_by(|depth, rate| law.at(depth, rate), t_s, y, inputs, mode)
            }
            ContactLaw::HuntCrossley(law) => self.hardening_contact(law, t_s, y, inputs, mode),
        }
    }

    /// Apart, so that its registers are not saved for the linear law.
    #[cold]
    #[inline(never)]
    fn hardening_contact(
        &self,
        law: &HuntCrossley,
        t_s: f64,
        y: &StateOf<S, W, M, R>,
        inputs: &Inputs,
        mode: (Slide, Whirl),
    ) -> Evaluation<StateOf<S, W, M, R>> {
        self.contact_by(|depth, rate| law.at(depth, rate), t_s, y, inputs, mode)
    }

    /// The field with a contact law. Inlined, so that each law has its own copy without calls.
    #[inline(always)]
    fn contact_by(
        &self,
        law: impl Fn(f64, f64) -> Normal,
        t_s: f64,
        y: &StateOf<S, W, M, R>,
        inputs: &Inputs,
        (slide, whirl): (Slide, Whirl),
    ) -> Evaluation<StateOf<S, W, M, R>> {
        let g = self.geometry(y);
        let (n, t) = (g.normal, g.tangent);
        let radius = self.plane.radius_m;
        let velocity = y.rotor.velocity;
        let law = law(g.penetration_m, g.normal_speed_m_s);
        let normal_n = law.force_n;

        let magnet_n = self.amplifier.force_n(&y.force, inputs.command_n);
        let free_n = (self.rotor).with_shaft_n(magnet_n + inputs.external_n, &y.rotor);
        let inverse_m = 1.0 / self.rotor.mass_kg;
        let mut rotor_acceleration = (free_n - normal_n * n) * inverse_m;
        let unbalance = self.unbalance(t_s, y);
        let mut per_spin_acceleration = 0.0;
        if let Some((by_speed, by_acceleration)) = unbalance {
            rotor_acceleration += by_speed;
            per_spin_acceleration = by_acceleration.dot(&t);
        }
        let ring_pushed = self.stator.rates(&y.stator, normal_n * n);
        let ring_acceleration = ring_pushed.inner().velocity;

        // v̇_w = base + M·(s + q) + e_t·Ω̇ and Ω̇ = (t_d + R·s)/J for sliding part s, rolling part q.
        let base = (rotor_acceleration - ring_acceleration).dot(&t)
            - g.normal_speed_m_s * g.whirl_speed_m_s / g.distance_m;
        let mobility = inverse_m + self.stator.inverse_mass();
        let inverse_j = self.spin.inverse_inertia();
        let torque = self.spin.drive_torque_n_m();
        let whirl_by_torque = per_spin_acceleration * inverse_j;
        let slide_by_torque = whirl_by_torque + radius * inverse_j;
        let race = self.plane.race.race();
        let race_rad_s = R::spin_rad_s(&y.race);

        let at = slide.sign() * g.sliding_speed_m_s;
        let mu = self.plane.friction.sliding.coefficient(at);
        let mu_r = self.plane.friction.rolling_coefficient;
        let (sliding_n, rolling_n) = match (slide, whirl) {
            (Slide::Rolling, Whirl::Still) => {
                if let Some(race) = race {
                    // The surfaces turn on together, held by friction that both give way to.
                    let parting = radius * inverse_j * torque + race.falling_back_m_s2(race_rad_s);
                    let s = -parting / (radius * radius * inverse_j + race.mobility());
                    let pushed = base + whirl_by_torque * (torque + radius * s);
                    (s, -pushed / mobility - s)
                } else if inverse_j > 0.0 {
                    let s = -torque / radius;
                    (s, -base / mobility - s)
                } else {
                    let both = -base / mobility;
                    let share = if mu + mu_r > 0.0 {
                        mu / (mu + mu_r)
                    } else {
                        0.0
                    };
                    (both * share, both * (1.0 - share))
                }
            }
            (Slide::Rolling, _) => {
                let q = -whirl.sign() * mu_r * normal_n;
                let mut parting = base + slide_by_torque * torque + mobility * q;
                let mut give = mobility + slide_by_torque * radius;
                if let Some(race) = race {
                    parting += race.falling_back_m_s2(race_rad_s);
                    give += race.mobility();
                }
                (-parting / give, q)
            }
            (_, Whirl::Still) => {
                let s = -slide.sign() * mu * normal_n;
                let pushed = base + whirl_by_torque * (torque + radius * s) + mobility * s;
                (s, -pushed / mobility)
            }
            _ => (
                -slide.sign() * mu * normal_n,
                -whirl.sign() * mu_r * normal_n,
            ),
        };
        let tangential_n = sliding_n + rolling_n;
        let spin_acceleration = inverse_j * (torque + radius * sliding_n);
        let whirl_acceleration =
            base + mobility * tangential_n + per_spin_acceleration * spin_acceleration;

        rotor_acceleration += tangential_n * inverse_m * t;
        let mut unbalance_w = 0.0;
        if let Some((by_speed, by_acceleration)) = unbalance {
            rotor_acceleration += spin_acceleration * by_acceleration;
            let force = self.rotor.mass_kg * (by_speed + spin_acceleration * by_acceleration);
            unbalance_w = force.dot(&velocity);
        }
        let rates = State {
            rotor: Body {
                position: velocity,
                velocity: rotor_acceleration,
            },
            stator: self
                .stator
                .rates(&y.stator, normal_n * n - tangential_n * t),
            spin: self.spin.rates(&y.spin, spin_acceleration),
            race: self.plane.race.rates(&y.race, sliding_n),
            force: self.amplifier.rates(&y.force, inputs.command_n),
        };

        let spin = self.spin.spin_rad_s(&y.spin);
        let drive_n_m = if inverse_j > 0.0 {
            torque
        } else {
            -radius * sliding_n
        };
        let mut stator_w = self.stator.damping_w(&y.stator);
        let mut sliding_acceleration = whirl_acceleration + radius * spin_acceleration;
        if let Some(race) = race {
            stator_w += race.drag_w(race_rad_s);
            sliding_acceleration -= race.radius_m * race.acceleration(race_rad_s, sliding_n);
        }
        let powers = Flows {
            control: magnet_n.dot(&velocity),
            external: inputs.external_n.dot(&velocity),
            drive: drive_n_m * spin,
            unbalance: unbalance_w,
            rotor_damping: self.rotor.damping_n_s_m * velocity.norm_squared(),
            stator_damping: stator_w,
            contact_damping: law.damper_n * g.normal_speed_m_s,
            sliding_friction: -sliding_n * g.sliding_speed_m_s,
            rolling_friction: -rolling_n * g.whirl_speed_m_s,
            normal_impulse_n_s: normal_n,
        };

        let mut guards = [f64::INFINITY; GUARDS];
        guards[NORMAL] = law.guard;
        match slide {
            Slide::Rolling => {
                guards[SLIDE] = mu * normal_n - sliding_n;
                guards[SLIDE_LOW] = mu * normal_n + sliding_n;
            }
            // Without friction the direction of slip changes nothing.
            _ if mu == 0.0 => {}
            _ => guards[SLIDE] = slide.sign() * g.sliding_speed_m_s,
        }
        match whirl {
            Whirl::Ignored => {}
            Whirl::Still => {
                guards[WHIRL] = mu_r * normal_n - rolling_n;
                guards[WHIRL_LOW] = mu_r * normal_n + rolling_n;
            }
            _ => guards[WHIRL] = whirl.sign() * g.whirl_speed_m_s,
        }

        let normal_acceleration = (rotor_acceleration - rates.stator.inner().velocity).dot(&n)
            + g.whirl_speed_m_s * g.whirl_speed_m_s / g.distance_m;
        Evaluation {
            rates,
            powers,
            guards,
            touch: Touch {
                normal_n,
                normal_rate_n_s: law.by_depth_n_m * g.normal_speed_m_s
                    + law.by_rate_n_s_m * normal_acceleration,
                guard_rate: law.guard_by_depth * g.normal_speed_m_s
                    + law.guard_by_rate * normal_acceleration,
                sliding_n,
                rolling_n,
                cone_n: mu * normal_n,
                sliding_acceleration,
                whirl_acceleration,
                whirl_speed_m_s: g.whirl_speed_m_s,
                penetration_m: g.penetration_m,
                normal_speed_m_s: g.normal_speed_m_s,
            },
        }
    }

    /// What rounding may leave of a guard that is zero: guards are differences of larger terms.
    pub(crate) fn guard_round_off(
        &self,
        y: &StateOf<S, W, M, R>,
        (slide, whirl): (Slide, Whirl),
    ) -> Guards {
        const ULPS: f64 = 4.0 * f64::EPSILON;
        let g = self.geometry(y);
        let mut surface = (self.spin.spin_rad_s(&y.spin) * self.plane.radius_m).abs();
        if let Some(race) = self.plane.race.race() {
            surface += race.radius_m * R::spin_rad_s(&y.race).abs();
        }
        let (normal, force) = self.plane.contact.law.round_off(
            (g.penetration_m, g.normal_speed_m_s),
            (g.distance_m, y.rotor.velocity.norm()),
            ULPS,
        );
        let speed = ULPS * (y.rotor.velocity.norm() + surface);
        let of = |held: bool| if held { force } else { speed };
        let (slide, whirl) = (of(slide == Slide::Rolling), of(whirl == Whirl::Still));
        [normal, slide, slide, whirl, whirl]
    }

    /// Kinetic and elastic energy, the contact spring included while `touching` \[J\].
    pub(crate) fn stored_j(&self, y: &StateOf<S, W, M, R>, touching: bool) -> f64 {
        let dent = if touching {
            self.plane
                .contact
                .law
                .stored_j(self.geometry(y).penetration_m)
        } else {
            0.0
        };
        0.5 * self.rotor.mass_kg * y.rotor.velocity.norm_squared()
            + 0.5 * self.rotor.stiffness_n_m * y.rotor.position.norm_squared()
            + self.stator.stored_j(&y.stator)
            + self.turning_j(y)
            + dent
    }

    /// Part of it that is in the spin of rotor and race \[J\].
    pub(crate) fn turning_j(&self, y: &StateOf<S, W, M, R>) -> f64 {
        let rate = self.spin.spin_rad_s(&y.spin);
        let inverse_j = self.spin.inverse_inertia();
        let mut turning = if inverse_j > 0.0 {
            0.5 * rate * rate / inverse_j
        } else {
            0.0
        };
        if let Some(race) = self.plane.race.race() {
            turning += race.stored_j(R::spin_rad_s(&y.race));
        }
        turning
    }

    /// Angular frequency of the rotor on the contact spring \[rad/s\]; where the spring hardens, at a
    /// depth of one clearance.
    pub(crate) fn undamped_contact_rate_rad_s(&self) -> f64 {
        let mobility = 1.0 / self.rotor.mass_kg + self.stator.inverse_mass();
        (self.plane.contact.stiffness_n_m() * mobility).sqrt()
    }

    /// The same with its damping: the fastest rate in contact \[rad/s\]. A damper that grows with depth
    /// has no rate of its own and is left out; see [`System::moment_s`].
    pub(crate) fn contact_rate_rad_s(&self) -> f64 {
        let mobility = 1.0 / self.rotor.mass_kg + self.stator.inverse_mass();
        let damping_n_s_m = self.plane.contact.law.by_rate_n_s_m(0.0);
        self.undamped_contact_rate_rad_s() + damping_n_s_m * mobility
    }

    /// A time that nothing in contact notices.
    pub(crate) fn moment_s(&self, y: &StateOf<S, W, M, R>) -> f64 {
        let mut rate = self.contact_rate_rad_s();
        if matches!(self.plane.contact.law, ContactLaw::HuntCrossley(_)) {
            let mobility = 1.0 / self.rotor.mass_kg + self.stator.inverse_mass();
            let depth_m = self.geometry(y).penetration_m.max(0.0);
            rate += self.plane.contact.law.by_rate_n_s_m(depth_m) * mobility;
        }
        1e-6 / rate
    }
}
