//! Bending modes that were configured, as coefficients of a tick.

use crate::border::config::Config;
use crate::border::parts::BENDING;
use crate::number::scalar::Scalar;
use crate::number::vec2::Vec2;

/// Modes that may be configured.
pub(crate) const MODES: usize = if BENDING { 2 } else { 0 };
/// Share of what is left of the swing that is learnt in a tick. The double of it makes the observer swing by itself near the
/// slowest modes that it can tell.
pub(crate) const LEARNT: f32 = 1.0 / 8.0;
/// Centre of what is kept apart, over the configured frequency. Above the centre the rest of the swing leads and is damped; below it
/// is late, and is driven.
const CENTRE: f32 = 0.97;
/// Most that the rest has to be lengthened by: what swings more slowly the observer follows so well that it is motion.
const MOST_LENGTHENED: f32 = 4.0;
/// Largest angle of a tick \[rad\].
const MOST_ANGLE: f32 = 3.0;

/// A mode as a tick has it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct BendingMode<S> {
    /// Cosine and sine of the angle of a tick.
    pub(crate) turn: Vec2<S>,
    /// What the rest is multiplied by, as a complex number, to be learnt from.
    pub(crate) gain: Vec2<S>,
}

/// The configured modes; others neither turn nor learn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Modes<S>(pub(crate) [BendingMode<S>; MODES]);

/// As complex numbers: the turn of a tick, and what makes the swing of what the observer in flight leaves of it.
fn turn_and_lead(hz: f32, config: &Config) -> Option<[Vec2<f32>; 2]> {
    let angle = core::f32::consts::TAU * CENTRE * hz * config.sample_period_s;
    if !(BENDING && angle > 0.0 && angle <= MOST_ANGLE) {
        return None;
    }
    let eighth = Vec2::at_angle(0.125 * angle);
    let quarter = eighth.rotated(eighth);
    let half = quarter.rotated(quarter);
    let turn = half.rotated(half).direction();
    // The rest of a sine z is ((1 − 1/z)/(1 − ρ/z))³ of it.
    let pole = config.observer_pole_flight;
    let left = Vec2::new(1.0 - turn.x, turn.y);
    let of = Vec2::new(1.0 - pole * turn.x, pole * turn.y);
    let lead = of.rotated(Vec2::new(left.x, -left.y)) * (1.0 / left.length_squared());
    let lead = lead.rotated(lead).rotated(lead);
    (!lead.exceeds(MOST_LENGTHENED)).then_some([turn, lead])
}

impl<S: Scalar> Modes<S> {
    /// Of a valid configuration; `None` where nothing can be kept apart.
    pub(crate) fn new(config: &Config) -> Option<Self> {
        let configured = [config.bending_first_hz, config.bending_second_hz];
        let mut modes = [BendingMode::default(); MODES];
        let mut any = false;
        for (mode, hz) in modes.iter_mut().zip(configured) {
            if let Some([turn, lead]) = turn_and_lead(hz, config) {
                let taken = |v: Vec2<f32>| Vec2::new(S::from_f32(v.x), S::from_f32(v.y));
                *mode = BendingMode {
                    turn: taken(turn),
                    gain: taken(lead * LEARNT),
                };
                any = true;
            }
        }
        any.then_some(Self(modes))
    }
}

impl Config {
    /// Whether a bending mode of this frequency can be kept apart from the motion of the rigid rotor: it has an effect to tell it.
    /// Slower ones, up to about the crossover (5.12b), the observer follows as motion; at most a little less than half the rate
    /// can be told.
    pub fn keeps_apart(&self, bending_hz: f32) -> bool {
        turn_and_lead(bending_hz, self).is_some()
    }
}
