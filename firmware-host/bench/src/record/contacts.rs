//! Contacts found in a record: where a flight that comes to the wall and the one that leaves it do not fit together.

use crate::record::flights::{BEYOND, Fit, Flight, State};
use crate::record::motion::Motion;
use plant_model::V2;
use serde::Serialize;

/// A contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Contact {
    /// When the rotor came to the wall and when it left it for a flight \[ticks since the first of those that follow each other\].
    pub from_tick: f64,
    /// See `from_tick`; the last tick where the record ends before.
    pub to_tick: f64,
    /// Normal speed before, towards the wall \[m/s\]; not known where the record begins in contact.
    pub normal_m_s: Option<f64>,
    /// What the wall did, where flights before and after are in the record.
    pub impulse: Option<Impulse>,
}

/// What a wall did in a contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Impulse {
    /// Normal speed before, towards the wall, and after, away from it \[m/s\].
    pub normal_m_s: [f64; 2],
    /// Their standard errors \[m/s\].
    pub normal_errors_m_s: [f64; 2],
    /// Impulse over mass along the inward normal, and along the wall, counter-clockwise positive \[m/s\].
    pub over_mass_m_s: [f64; 2],
    /// Their standard errors \[m/s\].
    pub errors_m_s: [f64; 2],
    /// Whether it is one impact and no more.
    pub single: bool,
    /// Whether the same load acted before and after.
    pub steady: bool,
}

/// Fewest ticks of a flight that is fitted, and of a part of one that is cut off.
const FLIGHT_TICKS: usize = 3;
const PART_TICKS: usize = 6;
/// A flight is cut where that makes the sum of squares smaller by so many times the square of the noise, and two neighbours have
/// one load where that makes it larger by less than so many.
const CUT: f64 = 40.0;
const SAME_LOAD: f64 = 12.0;
/// So many places for a cut are tried first, and so many flights before the next decide whether it has their load.
const PLACES: usize = 48;
const NEIGHBOURS: usize = 6;
/// No more flights are fitted than this; what comes later in the record is left out.
const FLIGHTS: usize = 200;
/// A contact has an impulse of so many standard errors.
const CERTAIN: f64 = 4.0;
/// Longer than so many times what an impact lasts is no single one.
const SINGLE: f64 = 1.8;

/// Contacts between flights, and the flights as fitted.
pub(super) struct Found<'m> {
    /// The flights.
    pub(super) fit: Fit<'m>,
    /// Contacts, each with the number of the flight after it.
    pub(super) contacts: Vec<(usize, Contact)>,
}

impl<'m> Found<'m> {
    /// `None` where no flight can be fitted.
    pub(super) fn new(motion: &'m Motion) -> Option<Self> {
        let wall = motion.clearance_m() * (1.0 - f64::from(motion.config.contact_band));
        let near = |tick: usize| motion.instants[tick].position_m.norm() >= wall;
        let mut flights = Vec::new();
        for flight in between(motion, near) {
            cut(motion, flight, &mut flights);
        }
        let left_out = usize::from(flights.len() > FLIGHTS);
        flights.truncate(FLIGHTS);
        let fit = with_loads(motion, flights)?;
        let count = fit.flights.len();
        // Between the flights before and after, where there are.
        let gap = |after: usize| {
            let from = after.checked_sub(1).map_or(0, |i| fit.flights[i].to);
            let to = fit
                .flights
                .get(after)
                .map_or(motion.instants.len(), |f| f.from);
            from..to
        };
        let contacts = (0..=count - left_out)
            .filter(|after| gap(*after).any(near))
            .filter_map(|after| {
                let contact = match after {
                    0 => began(motion, &fit)?,
                    _ if after == count => stayed(motion, &fit)?,
                    _ => contact(motion, &fit, after - 1)?,
                };
                Some((after, contact))
            })
            .collect();
        Some(Self { fit, contacts })
    }
}

/// Flights between ticks that are left out with a tick on both sides.
fn between(motion: &Motion, left_out: impl Fn(usize) -> bool) -> Vec<Flight> {
    let count = motion.instants.len();
    let out = |tick: usize| (tick.saturating_sub(1)..count.min(tick + 2)).any(&left_out);
    let (mut flights, mut from) = (Vec::new(), None);
    for tick in 0..=count {
        let flying = tick < count && !out(tick);
        match from {
            Some(start) if !flying => {
                if tick >= start + FLIGHT_TICKS {
                    let (to, load) = (tick - 1, 0);
                    flights.push(Flight {
                        from: start,
                        to,
                        load,
                    });
                }
                from = None;
            }
            None if flying => from = Some(tick),
            _ => {}
        }
    }
    flights
}

/// Sum of squares \[m²\] and noise \[m\] of a fit.
fn squares(motion: &Motion, flights: &[Flight]) -> Option<(f64, f64)> {
    let fit = Fit::new(motion, flights, motion.spin_known)?;
    Some((fit.squares_m2, fit.noise_m))
}

/// A flight in parts, each with a load of its own: what pushes sets in and ends.
fn cut(motion: &Motion, whole: Flight, parts: &mut Vec<Flight>) {
    let two = |at: usize| {
        let before = Flight {
            to: at - 1,
            ..whole
        };
        let after = Flight {
            from: at + 1,
            load: 1,
            ..whole
        };
        [before, after]
    };
    let whole = Flight { load: 0, ..whole };
    let (first, end) = (
        whole.from + PART_TICKS,
        (whole.to + 1).saturating_sub(PART_TICKS),
    );
    let best_of = |cuts: &mut dyn Iterator<Item = usize>| {
        let tried = cuts.filter_map(|at| Some((at, squares(motion, &two(at))?)));
        tried.min_by(|(_, (a, _)), (_, (b, _))| a.total_cmp(b))
    };
    // Some places all along, and then those around the best of them.
    let step = end.saturating_sub(first) / PLACES + 1;
    let best = best_of(&mut (first..end).step_by(step)).and_then(|(at, _)| {
        let around = first.max((at + 1).saturating_sub(step))..end.min(at + step);
        best_of(&mut around.into_iter())
    });
    if let (Some((at, (apart, noise_m))), Some((together, _))) = (best, squares(motion, &[whole]))
        && together - apart > CUT * noise_m * noise_m
    {
        let [before, after] = two(at);
        cut(motion, before, parts);
        cut(motion, after, parts);
    } else {
        parts.push(whole);
    }
}

/// Neighbours with one load where that fits as well.
fn with_loads(motion: &Motion, mut flights: Vec<Flight>) -> Option<Fit<'_>> {
    let mut load = 0;
    for i in 0..flights.len() {
        // Of the flights with the load so far the last ones; numbers count from their first.
        let first = i.saturating_sub(NEIGHBOURS);
        let mut same: Vec<Flight> = (flights[first..=i].iter())
            .filter(|f| f.from == flights[i].from || f.load == load)
            .map(|f| Flight { load: 0, ..*f })
            .collect();
        let together = squares(motion, &same);
        if let Some(last) = same.last_mut() {
            last.load = usize::from(i > 0);
        }
        let other = match (together, squares(motion, &same)) {
            (Some((together, _)), Some((apart, noise_m))) => {
                together - apart > SAME_LOAD * noise_m * noise_m
            }
            _ => false,
        };
        load += usize::from(other);
        flights[i].load = load;
    }
    Fit::new(motion, &flights, motion.spin_known)
}

/// When a flight passes a radius \[ticks\]: outwards from `from` on, or inwards before it (`back`); within so many ticks.
fn passes(
    fit: &Fit<'_>,
    flight: usize,
    (from, reach): (f64, f64),
    radius_m: f64,
    back: bool,
) -> Option<f64> {
    let step = if back { -0.25 } else { 0.25 };
    let beyond = |tick: f64| fit.state(flight, tick).position_m.norm() >= radius_m;
    let count = (reach / 0.25).ceil() as usize;
    let (mut inside, mut outside) = (from, None);
    for i in 0..=count {
        let tick = from + step * i as f64;
        if beyond(tick) {
            outside = Some(tick);
            break;
        }
        inside = tick;
    }
    let mut outside = outside?;
    for _ in 0..12 {
        let middle = 0.5 * (inside + outside);
        if beyond(middle) {
            outside = middle;
        } else {
            inside = middle;
        }
    }
    Some(outside)
}

/// When a flight comes out to a radius and when the next one comes in from there \[ticks\]; `None` of one that does not.
pub(super) fn meets(fit: &Fit<'_>, before: usize, radius_m: f64) -> [Option<f64>; 2] {
    let (last, first) = (
        fit.flights[before].to as f64,
        fit.flights[before + 1].from as f64,
    );
    let reach = first - last + 2.0;
    [
        passes(fit, before, (last - 2.0, reach), radius_m, false),
        passes(fit, before + 1, (first + 2.0, reach), radius_m, true),
    ]
}

/// Whether a flight that went on as it did would be beyond the wall where the rotor was not, in some of these ticks.
fn was_kept(
    motion: &Motion,
    fit: &Fit<'_>,
    flight: usize,
    ticks: impl Iterator<Item = usize>,
) -> bool {
    let mut ticks = ticks.filter(|tick| motion.instants[*tick].good);
    ticks.any(|tick| {
        let state = fit.state(flight, tick as f64);
        let n = state.position_m.normalize();
        let beyond = state.position_m.norm() - motion.instants[tick].position_m.dot(&n);
        beyond > CERTAIN * fit.error_m(&state, n).hypot(fit.noise_m)
    })
}

/// The contact in which a record begins.
fn began(motion: &Motion, fit: &Fit<'_>) -> Option<Contact> {
    let first = fit.flights.first()?.from;
    let ticks = first.saturating_sub(BEYOND)..first;
    was_kept(motion, fit, 0, ticks.rev()).then(|| {
        let reach = (first as f64 + 2.0, BEYOND as f64);
        let to = passes(fit, 0, reach, motion.clearance_m(), true);
        Contact {
            from_tick: 0.0,
            to_tick: to.unwrap_or(first as f64).max(0.0),
            normal_m_s: None,
            impulse: None,
        }
    })
}

/// The contact in which a record ends.
fn stayed(motion: &Motion, fit: &Fit<'_>) -> Option<Contact> {
    let (number, end) = (fit.flights.len() - 1, motion.instants.len());
    let last = fit.flights.last()?.to;
    was_kept(motion, fit, number, last + 1..end.min(last + BEYOND)).then(|| {
        let reach = (last as f64 - 2.0, BEYOND as f64);
        let from = passes(fit, number, reach, motion.clearance_m(), false).unwrap_or(last as f64);
        let from = from.min((end - 1) as f64);
        let state = fit.state(number, from);
        Contact {
            from_tick: from,
            to_tick: (end - 1) as f64,
            normal_m_s: Some(state.velocity_m_s.dot(&state.position_m.normalize())),
            impulse: None,
        }
    })
}

/// The contact between a flight and the next, where that is certain.
fn contact(motion: &Motion, fit: &Fit<'_>, before: usize) -> Option<Contact> {
    let (a, b) = (fit.flights[before], fit.flights[before + 1]);
    let (last, first) = (a.to as f64, b.from as f64);
    let (from, to) = match meets(fit, before, motion.clearance_m()) {
        [Some(from), Some(to)] if from <= to => (from, to),
        [Some(from), Some(to)] => [0.5 * (from + to); 2].into(),
        [Some(from), None] => (from, from.max(first)),
        [None, Some(to)] => (to.min(last), to),
        [None, None] => (0.5 * (last + first), 0.5 * (last + first)),
    };
    // The wall lets go before the rotor is back where it came to it, and what turns fast is drawn outwards from there on.
    let single = to - from < SINGLE * motion.impact_ticks() + 1.5;
    let to = if single {
        to.min(from + motion.impact_ticks())
    } else {
        to
    };
    let (came, left) = (fit.state(before, from), fit.state(before + 1, to));
    let (n_came, n_left) = (came.position_m.normalize(), left.position_m.normalize());
    let (t_came, t_left) = (turned(n_came), turned(n_left));
    let speed = |state: &State, n: V2| state.velocity_m_s.dot(&n);
    let (u, w) = (speed(&came, n_came), speed(&left, n_left));
    let time_s = (to - from) * motion.period_s;
    let around = Around::new(motion, fit, (from, to), [&came, &left], b.load);
    let impulse = Impulse {
        normal_m_s: [u, -w],
        normal_errors_m_s: [
            fit.error_m_s(&[(&came, n_came)]),
            fit.error_m_s(&[(&left, n_left)]),
        ],
        over_mass_m_s: [
            u - w + around.outward_m_s2 * time_s,
            (momentum(&left) - momentum(&came) - around.torque_m2_s2 * time_s) / around.arm_m,
        ],
        errors_m_s: [
            fit.error_m_s(&[(&came, n_came), (&left, -n_left)]),
            fit.error_m_s(&[(&came, t_came), (&left, -t_left)]),
        ],
        single: single && u > 0.0 && w < 0.0,
        steady: a.load == b.load,
    };
    let ([normal, _], [error, _]) = (impulse.over_mass_m_s, impulse.errors_m_s);
    let certain = normal > CERTAIN * error;
    let ahead = a.to + 1..b.from.min(a.to + BEYOND);
    let behind = (b.from.saturating_sub(BEYOND).max(a.to + 1)..b.from).rev();
    let kept = || was_kept(motion, fit, before, ahead) || was_kept(motion, fit, before + 1, behind);
    (certain || kept()).then_some(Contact {
        from_tick: from,
        to_tick: to,
        normal_m_s: Some(u),
        impulse: certain.then_some(impulse),
    })
}

/// Means over a contact, in polar coordinates.
struct Around {
    /// Acceleration outwards by all but the wall \[m/s²\], with what the turning makes.
    outward_m_s2: f64,
    /// Moment of the accelerations by all but the wall \[m²/s²\].
    torque_m2_s2: f64,
    /// Radius at which friction acts \[m\], by depth as the force is.
    arm_m: f64,
}

impl Around {
    fn new(
        motion: &Motion,
        fit: &Fit<'_>,
        (from, to): (f64, f64),
        [came, left]: [&State; 2],
        load: usize,
    ) -> Self {
        let (first, last) = (
            from.ceil() as usize,
            (to as usize).min(motion.instants.len() - 1),
        );
        let ends = [(from, came.position_m), (to, left.position_m)];
        let inside = (first..=last).map(|tick| (tick as f64, motion.instants[tick].position_m));
        let of: Vec<(f64, V2)> = inside.filter(|(_, x)| x.norm() > 0.0).chain(ends).collect();
        let (mut outward, mut torque, mut arm, mut depths) = (0.0, 0.0, 0.0, 0.0);
        for (tick, position_m) in &of {
            let part = if to > from {
                (tick - from) / (to - from)
            } else {
                0.5
            };
            let moment = momentum(came) + part * (momentum(left) - momentum(came));
            let (radius, n) = (position_m.norm(), position_m.normalize());
            let whole = (*tick as usize).min(motion.instants.len() - 1);
            let acceleration = fit.acceleration_m_s2(load, whole, *position_m);
            outward += acceleration.dot(&n) + moment * moment / radius.powi(3);
            torque += radius * acceleration.dot(&turned(n));
            let depth = (radius - motion.clearance_m()).max(0.0);
            arm += depth * radius;
            depths += depth;
        }
        let count = of.len() as f64;
        Self {
            outward_m_s2: outward / count,
            torque_m2_s2: torque / count,
            arm_m: if depths > 0.0 {
                arm / depths
            } else {
                motion.clearance_m()
            },
        }
    }
}

/// Moment of momentum over mass \[m²/s\].
fn momentum(state: &State) -> f64 {
    state.position_m.dot(&-turned(state.velocity_m_s))
}

/// A quarter turn counter-clockwise.
fn turned(v: V2) -> V2 {
    V2::new(-v.y, v.x)
}
