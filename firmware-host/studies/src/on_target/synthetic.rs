//! Synthetic samples: what closed loops do not reach, of a seeded generator.
//!
//! A rotor is led by the hand through moves that are drawn one after the other (rest in the middle, way to the
//! wall, whirl, rest on the wall, jump, random bits, …), under configurations of the catalogue with times drawn
//! down to zero, while the bearing is switched, axes fail and ticks are lost.

use super::numbers::Number;
use super::tick_log::{Piece, TickLog};
use crate::machines::plants::{RATES_HZ, plants};
use crate::overloads::plan::CatalogueError;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use std::f32::consts::TAU;
use supervisor::{Config, Mode, Sample, Status};

/// Of the moves: of the first three hundred the one whose rarest way between modes is the most frequent; the
/// ignored test below finds it.
const SEED: u64 = 305;
/// Ticks of a supervisor before the next one.
const PIECE_TICKS: usize = 4000;

/// So many ticks, and how many configurations were passed over because they do not fit the numbers.
///
/// # Errors
/// [`CatalogueError`] if the catalogue is not valid.
pub(crate) fn pieces(number: Number, ticks: usize) -> Result<(Vec<Piece>, usize), CatalogueError> {
    seeded(SEED, number, ticks)
}

/// The same by another seed.
///
/// # Errors
/// As [`pieces`].
pub(super) fn seeded(
    seed: u64,
    number: Number,
    ticks: usize,
) -> Result<(Vec<Piece>, usize), CatalogueError> {
    let mut configs: Vec<Config> = Vec::new();
    for rate_hz in RATES_HZ {
        configs.extend((plants(rate_hz)?.iter()).filter_map(|p| p.scene.planes[0].supervisor));
    }
    // Of one that does not fit no variation is tried.
    let before = configs.len();
    configs.retain(|config| number.fits(config));
    let mut left_out = before - configs.len();
    let mut chance = Chance::new(seed);
    let mut pieces = Vec::new();
    let mut left = ticks;
    while left > 0 && !configs.is_empty() {
        let config = varied(configs[chance.below(configs.len())], &mut chance);
        let log = TickLog::default();
        let Some(mut supervisor) = number.recorder(&config, &log) else {
            left_out += 1;
            continue;
        };
        let mut hand = Hand::new(&config, &mut chance);
        for _ in 0..left.min(PIECE_TICKS) {
            let sample = hand.sample(&mut chance);
            let command = supervisor.tick(&sample);
            hand.sees(command.mode, &mut chance);
        }
        let ticks = log.take();
        left -= ticks.len();
        pieces.push(Piece { config, ticks });
    }
    Ok((pieces, left_out))
}

/// Draws.
pub(super) struct Chance(ChaCha8Rng);

impl Chance {
    pub(super) fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }
    pub(super) fn below(&mut self, n: usize) -> usize {
        self.0.next_u64() as usize % n
    }
    pub(super) fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }
    /// From 0 to 1.
    fn share(&mut self) -> f32 {
        (self.0.next_u32() >> 8) as f32 / 16_777_216.0
    }
    pub(super) fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.share()
    }
    fn any_bits(&mut self) -> f32 {
        f32::from_bits(self.0.next_u32())
    }
}

/// A configuration whose times are drawn: usual ones or down to nothing. Every other lets go soon and blends
/// long, and recognises whirl and rest either at once or late: then contact that comes back during hand-over
/// is known at its first tick.
fn varied(config: Config, chance: &mut Chance) -> Config {
    let t = config.sample_period_s;
    let lets_go_soon = chance.one_in(2);
    let whirl_time_s = if chance.one_in(2) { 1e-5 } else { 60.0 * t };
    // From a stream of their own, so that the moves stay as they are.
    let mut limits = Chance(chance.0.clone());
    limits.0.set_stream(1);
    let mut bound = |usual: f32, tight: f32| match limits.one_in(3) {
        true => usual.min(tight * limits.between(1.0, 2.0)),
        false => usual,
    };
    let mut time = |usual: f32, least: f32| match chance.below(3) {
        0 => usual,
        1 => least,
        _ => chance.between(least, 3.0 * usual.max(8.0 * t)),
    };
    let mut config = Config {
        // Each binds in some pieces: a box in the disc, a slow magnet, one that is soon warm.
        axis_force_max_n: bound(config.axis_force_max_n, 0.5 * config.force_max_n),
        force_slew_n_s: bound(config.force_slew_n_s, 0.2 * config.force_max_n / t),
        continuous_force_n: bound(config.continuous_force_n, 0.4 * config.force_max_n),
        whirl_time_s: time(config.whirl_time_s, 1e-5),
        handover_dwell_s: time(config.handover_dwell_s, 0.0),
        handover_blend_s: time(config.handover_blend_s, 0.0),
        fault_blend_s: time(config.fault_blend_s, 0.0),
        coast_down_s: time(config.coast_down_s, 0.0),
        thermal_time_s: time(0.02, 0.01),
        fault_ticks: chance.between(2.0, 12.0),
        delay_samples: chance.between(0.0, 7.0),
        severity_limit: chance.between(0.1, 100.0),
        ..config
    };
    if lets_go_soon {
        config.handover_dwell_s = 0.0;
        config.handover_blend_s = 150.0 * t;
        config.whirl_time_s = whirl_time_s;
    }
    config
}

/// What the rotor does for some ticks; lengths in clearances, angles in radians.
#[derive(Clone, Copy)]
enum Move {
    /// Stays about where it is.
    Stay,
    /// Straight on, so far a tick.
    Straight { step: [f32; 2] },
    /// Around the middle, so much a tick.
    Circle { radius: f32, step: f32 },
    /// Bits of no meaning in every field.
    Bits,
    /// A position that is no number.
    Nan,
    /// No new sample.
    Dropout,
}

/// The hand that leads the rotor.
struct Hand {
    clearance_m: f32,
    force_max_n: f32,
    /// Speed at which the cap no longer holds the rotor on the wall \[clearances per tick\].
    lift_off: f32,
    /// Noise of a position \[clearances\].
    noise: f32,
    doing: Move,
    /// Whether the last move led off the wall, or back towards it from there.
    off_the_wall: bool,
    mode: Mode,
    left: usize,
    /// Position \[clearances\].
    at: [f32; 2],
    sequence: u32,
    status: Status,
    spin_rad_s: f32,
    /// Inward force of the stand-in controller per position \[caps per clearance\].
    gain: f32,
}

impl Hand {
    fn new(config: &Config, chance: &mut Chance) -> Self {
        Self {
            clearance_m: config.clearance_m / config.retainer_plane_ratio,
            force_max_n: config.force_max_n,
            lift_off: (config.force_max_n * config.sample_period_s * config.sample_period_s
                / (config.mass_kg * config.clearance_m))
                .sqrt(),
            noise: if chance.one_in(2) { 1e-5 } else { 2e-3 },
            doing: Move::Stay,
            off_the_wall: false,
            mode: Mode::Levitated,
            left: 4,
            at: [0.0; 2],
            sequence: 0,
            status: Status::SPIN_VALID | Status::BEARING_ON | Status::LEVITATED_BEFORE,
            spin_rad_s: 1000.0,
            gain: 1.0,
        }
    }

    /// Looks at what the supervisor does: where it has just begun to approach or to hand over, something else
    /// happens at once, more often than by chance.
    fn sees(&mut self, mode: Mode, chance: &mut Chance) {
        let before = std::mem::replace(&mut self.mode, mode);
        let short = matches!(mode, Mode::Approach | Mode::Handover);
        if short && mode != before && chance.one_in(2) {
            self.left = 0;
            self.off_the_wall = true;
        }
    }

    fn next_move(&mut self, chance: &mut Chance) {
        let [x, y] = self.at;
        let angle = y.atan2(x);
        self.left = 1 + chance.below(60);
        // What comes back to the wall soon after it has left it is the rarest.
        let kind = match (self.off_the_wall, chance.below(4)) {
            (true, 0) => 9,
            (true, 1) => 16,
            (true, 2) => 22,
            _ => chance.below(22),
        };
        self.off_the_wall = kind >= 18;
        self.doing = match kind {
            0 | 1 => Move::Stay,
            // Outwards until the wall, so slowly that it is no bounce.
            16 | 17 => {
                let speed = self.lift_off * chance.between(0.02, 0.25);
                self.left = 1 + ((1.02 - x.hypot(y)).max(0.0) / speed).min(150.0) as usize;
                Move::Straight {
                    step: [speed * angle.cos(), speed * angle.sin()],
                }
            }
            2..=4 => {
                let aim = if chance.one_in(2) {
                    0.0
                } else {
                    TAU * chance.share()
                };
                let speed = chance.between(0.005, 0.15);
                self.left = 1 + chance.below(30);
                Move::Straight {
                    step: [speed * (angle + aim).cos(), speed * (angle + aim).sin()],
                }
            }
            // A hop off the wall, gentle enough to be let go.
            18..=21 => {
                let step = -self.lift_off * chance.between(0.1, 0.6);
                self.left = 5 + chance.below(20);
                Move::Straight {
                    step: [step * angle.cos(), step * angle.sin()],
                }
            }
            // Back towards it, so fast that it cannot be stopped.
            22 => {
                let step = self.lift_off * chance.between(0.5, 2.0);
                self.left = 1 + chance.below(8);
                Move::Straight {
                    step: [step * angle.cos(), step * angle.sin()],
                }
            }
            // To the middle and no farther.
            5..=8 => {
                self.left = 3 + chance.below(40);
                let step = -chance.between(0.5, 1.0) / self.left as f32;
                Move::Straight {
                    step: [step * x, step * y],
                }
            }
            9..=12 => {
                self.left = 1 + chance.below(150);
                let fastest = if chance.one_in(2) {
                    0.15
                } else {
                    3.0 * self.lift_off
                };
                let step = chance.between(-fastest, fastest);
                let radius = chance.between(0.97, 1.03);
                Move::Circle { radius, step }
            }
            13 => Move::Circle {
                radius: chance.between(0.99, 1.03),
                step: 0.0,
            },
            _ => {
                self.left = 1 + chance.below(14);
                match chance.below(3) {
                    0 => Move::Bits,
                    1 => Move::Nan,
                    _ => Move::Dropout,
                }
            }
        };
        if chance.one_in(3) {
            self.status.set(Status::BEARING_ON, !chance.one_in(3));
            self.status.set(Status::SPIN_VALID, !chance.one_in(4));
            self.status.set(Status::APPLIED_VALID, chance.one_in(4));
            self.status.set(Status::SET_DOWN, chance.one_in(6));
            self.status.set(Status::AXIS_X_LOST, chance.one_in(8));
            self.status.set(Status::AXIS_Y_LOST, chance.one_in(8));
            self.spin_rad_s = chance.between(-1000.0, 1000.0);
            self.gain = chance.between(-0.5, 2.0);
        }
    }

    fn sample(&mut self, chance: &mut Chance) -> Sample {
        if self.left == 0 {
            self.next_move(chance);
        }
        self.left -= 1;
        let [x, y] = self.at;
        match self.doing {
            Move::Stay => {}
            Move::Straight { step: [dx, dy] } => self.at = [x + dx, y + dy],
            Move::Circle { radius, step } => {
                let angle = y.atan2(x) + step;
                self.at = [radius * angle.cos(), radius * angle.sin()];
            }
            Move::Bits => return self.bits(chance),
            Move::Nan | Move::Dropout => {}
        }
        if !matches!(self.doing, Move::Dropout) {
            let lost = if chance.one_in(100) {
                chance.below(8)
            } else {
                0
            };
            self.sequence = self.sequence.wrapping_add(1 + lost as u32);
        }
        let [x, y] = self.at.map(|a| a + self.noise * chance.between(-1.0, 1.0));
        let force = |along: f32| -self.gain * along * self.force_max_n;
        let mut applied_n = [force(y), force(x)];
        if chance.one_in(50) {
            applied_n = [chance.any_bits(), chance.any_bits()];
        }
        Sample {
            sequence: self.sequence,
            status: self.status,
            position_m: match self.doing {
                Move::Nan => [f32::NAN, self.clearance_m * y],
                _ => [self.clearance_m * x, self.clearance_m * y],
            },
            spin_rad_s: self.spin_rad_s,
            levitation_n: [force(x), force(y)],
            applied_n,
        }
    }

    fn bits(&mut self, chance: &mut Chance) -> Sample {
        Sample {
            sequence: match chance.one_in(4) {
                true => chance.0.next_u32(),
                false => self.sequence.wrapping_add(1),
            },
            status: Status::from_bits_retain(chance.0.next_u32()) | Status::BEARING_ON,
            position_m: [chance.any_bits(), chance.any_bits()],
            spin_rad_s: chance.any_bits(),
            levitation_n: [chance.any_bits(), chance.any_bits()],
            applied_n: [chance.any_bits(), chance.any_bits()],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::on_target::coverage::{Coverage, ways};
    use crate::on_target::record::Length;

    /// How often a seed's rarest way is taken, in the numbers that have fewer.
    fn rarest(seed: u64) -> u64 {
        let of = |number| {
            let ticks = Length::QUICK.all - Length::QUICK.closed_loop;
            let (pieces, _) = seeded(seed, number, ticks).unwrap();
            let mut coverage = Coverage::default();
            for piece in &pieces {
                coverage.merge(&piece.coverage());
            }
            ways().map(|(from, to)| coverage.of_way(from, to)).min()
        };
        of(Number::Float).min(of(Number::Fixed)).unwrap_or(0)
    }

    #[test]
    #[ignore = "a search, for when the ways of the stream have changed"]
    fn the_seed_is_the_best_of_four_hundred() {
        let best = (1..=400).max_by_key(|seed| (rarest(*seed), std::cmp::Reverse(*seed)));
        assert_eq!(Some(SEED), best, "{:?}", best.map(rarest));
    }
}
