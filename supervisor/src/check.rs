//! Whether the machine does what its configuration says: found while it levitates, before the supervisor may act.
//!
//! Firmware adds a small sine ([`crate::Supervisor::stimulus_n`]) to what its levitation controller asks for. Four lines of it, two an
//! axis, are looked at one after the other: a sum over a window of what the sensor reads, X, and of the acceleration that the
//! configuration makes of the commands since, A. Least squares of κ·X − ω²·X = G·A, κ as configured, have to give G = 1: axes,
//! signs, gain, mass, period and unit are all in it, and in its phase the delay that the model does not have. Then the orbit of the
//! unbalance, where it shows, has to go round as the spin says. Before the bearing is on, a rotor at rest has to lie on its
//! retainer bearing.
//!
//! All that is found is given as what it looks like: a mass that is wrong by two and a gain that is are the same.

use crate::border::coeffs::Coeffs;
use crate::border::config::Config;
use crate::border::finding::{Checked, CheckedCell, Finding};
use crate::border::parts::CHECK;
use crate::border::signal::{CoreSample, Status};
use crate::number::scalar::{max, min};
use crate::number::vec2::Vec2;

/// Length of the stimulus \[caps\].
const AMPLITUDE: f32 = 0.05;
/// Its lines \[1/t₀\], along x and y in turn; those so near to a multiple of the spin go to the middle between two.
const LINES: [f32; 4] = [0.9, 1.1, 1.5, 1.9];
const FROM_SPIN: f32 = 0.35;
/// Up to so many times the spin there are lines of sensor and rotor.
const HARMONICS: f32 = 4.0;
/// What all lines are multiplied by in each round, since what hums is where nobody knows.
const BESIDE: [f32; MOST_ROUNDS as usize] = [1.0, 1.13, 0.89, 1.06];
/// Length of a window \[s\], and \[t₀\].
const LEAST_S: f32 = 0.2;
const LEAST_TIME: f32 = 63.0;
/// The stimulus goes with the cube of so many times the window, up to its length; in a window before the others with the eighth power
/// of the time, so slowly that a force which is set in amperes does not throw the rotor before it is seen to move too far: by so much
/// more than so many times what it does of itself \[clearances\]. Then the stimulus is a quarter from there on, so many times at most.
const STEEP: f32 = 1.5;
const TOO_FAR: f32 = 0.2;
const FIRST_TOO_FAR: f32 = 0.1;
const MORE: f32 = 1.5;
const MOST_SOFTER: u8 = 5;
/// A gain that nobody types: it is not the stimulus that moves the rotor.
const MOST_BELIEVED: f32 = 3000.0;
/// Attempts that may contradict: then the rotor is left in peace until it is configured anew.
const MOST_REFUSED: u8 = 3;
/// Two over the mean of the square of the window where the stimulus has its own.
const SEEN: f32 = 3.9995;
/// Times that the four lines are looked at until G is known.
const LEAST_ROUNDS: u8 = 2;
const MOST_ROUNDS: u8 = 4;
/// To this, as a standard error; what is judged is judged beyond so many of them.
const KNOWN: f32 = 0.04;
const SURE: f32 = 2.5;
/// Unexplained share of the motion from which on the rotor does not answer, where this share of the stimulus came through.
const UNEXPLAINED: f32 = 0.95;
const CAME_THROUGH: f32 = 0.25;
/// Limits of what is right: the gain and its inverse, the tangent of the angle, the cosine between axes, the ratio of their gains.
const MOST_GAIN: f32 = 1.33;
const MOST_TURN: f32 = 0.213;
const MOST_SKEW: f32 = 0.2;
const MOST_RATIO: f32 = 1.4;
/// Most delay: ticks, and \[t₀\].
const MOST_TICKS: f32 = 0.75;
const MOST_DELAY: f32 = 0.03;
/// Turns in a window from which on a line is no rest of what stands still; and the quickest that is looked for \[rad a tick\].
const LEAST_TURNS: f32 = 4.0;
const QUICKEST: f32 = 1.5;
/// Lines beside those at the spin, forward and backward: where it would be were the spin in 1/min, and where nothing is.
const PER_MINUTE: f32 = core::f32::consts::TAU / 60.0;
const BETWEEN: f32 = 0.37;
/// An orbit is no smaller than this, else it says nothing \[clearances\].
const LEAST_ORBIT: f32 = 0.002;
/// A line stands out from others by this, and the backward one from the forward one by that.
const STANDS_OUT: f32 = 4.0;
const BACKWARD: f32 = 4.0;
/// A levitated rotor is nearer than that, and one at rest between those, unless it is not on the bearing at all.
const OUTSIDE: f32 = 1.5;
const AT_REST: (f32, f32) = (0.7, 1.4);
const NOT_ON_IT: f32 = 0.2;
/// Below this a pivot is none.
const LEAST_PIVOT: f32 = 1e-30;
/// A rotor at rest moves less.
const STILL: f32 = 0.05;
/// A window with one of these is none.
const UNUSUAL: Status = Status::SET_DOWN
    .union(Status::AXIS_X_LOST)
    .union(Status::AXIS_Y_LOST)
    .union(Status::LATE);
/// Pull of the magnets that leaves a rotor without force no place but the bearing \[caps a clearance\].
const PULL: f32 = -0.02;

const SPIN: u8 = 4;
const LAST_SPIN: u8 = 6;
const DONE: u8 = 7;
const REST: u8 = 8;
const LISTEN: u8 = 9;
const HALTED: u8 = 10;
/// As the first line of all.
const PROBE: u8 = 12;

/// What a tick was, per unit.
pub(crate) struct Seen {
    /// As firmware gave it.
    pub(crate) status: Status,
    pub(crate) sequence: u32,
    pub(crate) position: [f32; 2],
    pub(crate) levitation: [f32; 2],
    pub(crate) spin: f32,
    /// The levitation controller has the bearing.
    pub(crate) levitated: bool,
    /// What the configuration says that the rotor is accelerated by now, its own stiffness and damping apart \[caps\].
    pub(crate) acceleration: Vec2<f32>,
    /// t₀ \[s\], h, κ and δ of the configuration.
    pub(crate) time_s: f32,
    pub(crate) tick: f32,
    pub(crate) stiffness: f32,
    pub(crate) damping: f32,
}

impl Seen {
    pub(crate) fn new(
        sample: &CoreSample<f32>,
        (levitated, acceleration): (bool, Vec2<f32>),
        coeffs: &Coeffs<f32>,
    ) -> Self {
        let half = coeffs.stiffness * coeffs.tick * 0.5;
        Self {
            status: sample.status,
            sequence: sample.sequence,
            position: sample.position,
            levitation: sample.levitation,
            spin: sample.spin,
            levitated,
            acceleration,
            time_s: coeffs.scaling.time_s,
            tick: coeffs.tick,
            stiffness: coeffs.stiffness,
            damping: coeffs.damping_step * coeffs.per_tick - half,
        }
    }
}

/// The check of a plane; nothing where it is left out.
#[derive(Debug, Clone)]
pub(crate) struct Check([Progress; CHECK as usize]);

impl Check {
    /// As asked for.
    pub(crate) const fn new(config: &Config) -> Self {
        Self([Progress::new(config.check_first >= 0.5); CHECK as usize])
    }

    /// None is asked for: for a test in the place of the supervisor.
    pub(crate) const fn off() -> Self {
        Self([Progress::new(false); CHECK as usize])
    }

    /// Whether the supervisor may act.
    #[inline]
    pub(crate) fn is_open(&self) -> bool {
        self.0.first().is_none_or(|progress| progress.open)
    }

    /// What a tick sees of a status: until the check has passed it only watches, and a spin that is contradicted is none.
    #[inline]
    pub(crate) fn admitted(&self, status: Status) -> Status {
        self.0
            .first()
            .map_or(status, |progress| (status | progress.adds) - progress.takes)
    }

    /// Whether there is nothing left to look at.
    #[inline]
    pub(crate) fn is_over(&self) -> bool {
        self.0.first().is_none_or(Progress::is_over)
    }

    /// Attempts that have come to an end: of two planes, then the other one is looked at.
    #[inline]
    pub(crate) fn attempts(&self) -> u8 {
        self.0.first().map_or(0, |progress| progress.attempts)
    }

    /// Says at first how it stands.
    pub(crate) fn begin(&self, cell: &CheckedCell) {
        let finding = if self.is_open() {
            Finding::Unchecked
        } else {
            Finding::NotYet
        };
        let value = 0.0;
        cell.store(Checked { finding, value });
    }

    /// What firmware should add to the force that it asks for next \[caps\].
    #[inline]
    pub(crate) fn stimulus(&self) -> [f32; 2] {
        (self.0.first()).map_or([0.0; 2], Progress::stimulus)
    }

    /// After each tick.
    #[inline]
    pub(crate) fn watch(&mut self, cell: &CheckedCell, seen: &Seen) {
        if let Some(progress) = self.0.first_mut()
            && !progress.is_over()
        {
            progress.watched(seen, cell);
        }
    }

    /// Of the plane whose turn it is not: nothing.
    #[inline]
    pub(crate) fn pause(&mut self) {
        if let Some(progress) = self.0.first_mut() {
            progress.left = 0;
        }
    }
}

const _: () = assert!(size_of::<Progress>() <= 160);

/// What is summed and remembered.
#[derive(Debug, Clone, Copy)]
struct Progress {
    /// Of the window: X and A of each axis by the line, or four lines of the orbit, or where a rotor at rest is.
    sums: [Vec2<f32>; 4],
    /// Where the window began, and how far the rotor goes from there without a stimulus.
    from: Vec2<f32>,
    usual: f32,
    /// The stimulus is a quarter of itself so many times.
    softer: u8,
    /// Of the least squares: squares of A, its product across, and those times ω; or of the orbit, two lines more.
    normal: [f32; 5],
    /// Products of A with both rows of −ω²·X + κ·X, and squares of these.
    right: [[Vec2<f32>; 2]; 2],
    square: f32,
    /// Where a rotor at rest lay that should not lie there \[clearances\].
    off_rest: f32,
    /// The line, and how far it turns in a tick \[rad\].
    phase: Vec2<f32>,
    turn: f32,
    next: u32,
    left: u16,
    length: u16,
    outside: u16,
    stage: u8,
    rounds: u8,
    /// Attempts that have come to an end, and whether the last one passed.
    attempts: u8,
    refused: u8,
    open: bool,
    spin_seen: bool,
    /// What comes to a status, and what goes.
    adds: Status,
    takes: Status,
}

impl Progress {
    const fn new(first: bool) -> Self {
        Self {
            sums: [Vec2::ZERO; 4],
            from: Vec2::ZERO,
            usual: 0.0,
            softer: 0,
            normal: [0.0; 5],
            right: [[Vec2::ZERO; 2]; 2],
            square: 0.0,
            off_rest: 0.0,
            phase: Vec2::ZERO,
            turn: 0.0,
            next: 0,
            left: 0,
            length: 0,
            outside: 0,
            stage: if first { LISTEN } else { DONE },
            rounds: 0,
            attempts: 0,
            refused: 0,
            open: !first,
            spin_seen: !first,
            adds: if first {
                Status::SHADOW
            } else {
                Status::empty()
            },
            takes: Status::empty(),
        }
    }

    #[inline]
    fn is_over(&self) -> bool {
        self.stage == HALTED || (self.stage == DONE && self.spin_seen)
    }

    fn stimulus(&self) -> [f32; 2] {
        if !self.excites() || self.left == 0 || self.outside > 0 {
            return [0.0; 2];
        }
        let force = self.amplitude() * self.phase.x;
        if self.stage & 1 == 0 {
            [force, 0.0]
        } else {
            [0.0, force]
        }
    }

    /// Whether the window is one of the stimulus.
    #[inline]
    fn excites(&self) -> bool {
        self.stage < SPIN || self.stage == PROBE
    }

    /// Length of the stimulus in the middle of a window \[caps\].
    #[inline]
    fn full(&self) -> f32 {
        AMPLITUDE / f32::from(1_u16 << (2 * self.softer.min(MOST_SOFTER)))
    }

    /// And now.
    #[inline]
    fn amplitude(&self) -> f32 {
        if self.stage == PROBE {
            let part = 1.0 - f32::from(self.left) / f32::from(self.length);
            let fourth = part * part * part * part;
            return self.full() * fourth * fourth;
        }
        let part = min(STEEP * self.window(), 1.0);
        self.full() * part * part * part
    }

    /// Of the ticks that are left: from nothing to 1 and back.
    #[inline]
    fn window(&self) -> f32 {
        let part = f32::from(self.left) / f32::from(self.length);
        4.0 * part * (1.0 - part)
    }

    fn watched(&mut self, seen: &Seen, cell: &CheckedCell) {
        let missed = seen.sequence != self.next;
        self.next = seen.sequence.wrapping_add(1);
        let status = seen.status;
        let on = status.intersects(Status::BEARING_ON | Status::SHADOW);
        let at_rest = !on && seen.levitation == [0.0; 2] && seen.stiffness < PULL;
        // While it acts, what the rotor does is not to be looked at.
        let levitated = on && !status.intersects(UNUSUAL) && (seen.levitated || !self.open);
        if missed || !(levitated || at_rest) {
            self.left = 0;
            return;
        }
        if at_rest != (self.stage == REST) {
            if self.open {
                return;
            }
            self.restart();
            self.stage = if at_rest { REST } else { LISTEN };
        }
        let spin = if status.contains(Status::SPIN_VALID) && seen.spin.is_finite() {
            seen.spin
        } else {
            0.0
        };
        if self.left == 0 && !self.start(spin, seen) {
            return;
        }
        let position = Vec2::from_array(seen.position);
        let away = position - self.from;
        if position.exceeds(OUTSIDE) || !position.is_finite() {
            // Without a stimulus from here on.
            self.outside = self.outside.saturating_add(1);
        } else if self.excites() && away.exceeds(self.too_far()) {
            if let Some(checked) = self.thrown(away, seen) {
                self.conclude(checked, cell);
            }
            return;
        } else {
            self.accumulate(position, spin, seen);
        }
        self.left = self.left.saturating_sub(1);
        if self.left == 0
            && let Some(checked) = self.over(seen)
        {
            self.conclude(checked, cell);
        }
    }

    fn conclude(&mut self, checked: Checked, cell: &CheckedCell) {
        self.admit(checked.finding);
        cell.store(checked);
    }

    /// How far the rotor may go from where the window began.
    #[inline]
    fn too_far(&self) -> f32 {
        let far = if self.stage == PROBE {
            FIRST_TOO_FAR
        } else {
            TOO_FAR
        };
        far + MORE * self.usual
    }

    /// The rotor goes too far: the stimulus is less from here on.
    #[cold]
    #[inline(never)]
    fn thrown(&mut self, away: Vec2<f32>, seen: &Seen) -> Option<Checked> {
        let omega = self.turn / seen.tick;
        let by = max(self.amplitude(), LEAST_PIVOT);
        let gain = root(away.length_squared()) * omega * omega / by;
        if gain > MOST_BELIEVED {
            self.restart();
            return None;
        }
        if self.softer >= MOST_SOFTER {
            return Some(self.failed(Finding::Gain, gain));
        }
        if self.stage == PROBE {
            self.stage = 0;
            while self.softer < MOST_SOFTER && self.full() > by {
                self.softer += 1;
            }
        } else {
            self.softer += 1;
        }
        self.left = 0;
        None
    }

    /// What follows from a finding. Without its spin the supervisor works against the whirl that it sees.
    fn admit(&mut self, finding: Finding) {
        let spin = matches!(finding, Finding::SpinReversed | Finding::SpinUnit);
        self.open = spin || finding == Finding::Passed;
        self.adds.set(Status::SHADOW, !self.open);
        self.takes.set(Status::SPIN_VALID, spin);
    }

    /// A window begins; false where there is nothing to see in it.
    #[cold]
    #[inline(never)]
    fn start(&mut self, spin: f32, seen: &Seen) -> bool {
        let tick = seen.tick;
        let length = min(max(LEAST_S / seen.time_s, LEAST_TIME) / tick, 65_000.0);
        let turned = spin.abs() * tick;
        match self.stage {
            SPIN..=DONE => {
                if turned * length < LEAST_TURNS * core::f32::consts::TAU {
                    // Too slow to tell; it may come to be faster.
                    if self.stage == DONE {
                        return false;
                    }
                    self.stage = DONE;
                    self.left = 1;
                    self.length = 1;
                    return true;
                }
                if self.stage == DONE {
                    self.stage = SPIN;
                }
                // Other lines than this one.
                self.normal = [0.0; 5];
                [self.normal[0], self.normal[2]] = [1.0; 2];
            }
            REST | LISTEN => {}
            stage => {
                let line = LINES.get(usize::from(stage) & 3).copied().unwrap_or(1.0);
                let beside = BESIDE.get(usize::from(self.rounds)).copied().unwrap_or(1.0);
                self.turn = away_from(spin.abs(), line * beside) * tick;
            }
        }
        self.from = Vec2::from_array(seen.position);
        self.sums = [Vec2::ZERO; 4];
        self.phase = Vec2::new(1.0, 0.0);
        self.length = length as u16;
        self.left = self.length;
        self.outside = 0;
        true
    }

    /// A tick of the window.
    fn accumulate(&mut self, position: Vec2<f32>, spin: f32, seen: &Seen) {
        let weight = self.window() * self.window();
        let away = position - self.from;
        match self.stage {
            REST | LISTEN => {
                let far = away.length_squared();
                self.sums[1].x = max(self.sums[1].x, far);
                self.sums[0] = self.sums[0] + position;
            }
            SPIN..=LAST_SPIN => {
                let weighed = away * weight;
                let [cos_minute, sin_minute, cos_between, sin_between, _] = self.normal;
                let minute = Vec2::new(cos_minute, sin_minute);
                let between = Vec2::new(cos_between, sin_between);
                let lines = [
                    mirrored(self.phase),
                    self.phase,
                    mirrored(minute),
                    mirrored(between),
                ];
                for (sum, line) in self.sums.iter_mut().zip(lines) {
                    *sum = *sum + weighed.rotated(line);
                }
                let angle = spin * seen.tick;
                self.phase = turned(self.phase, angle);
                let minute = turned(minute, angle * PER_MINUTE);
                let between = turned(between, angle * BETWEEN);
                self.normal = [minute.x, minute.y, between.x, between.y, 0.0];
            }
            _ => {
                let conjugate = mirrored(self.phase) * weight;
                let [x, a] = [position, seen.acceleration];
                for (sum, value) in self.sums.iter_mut().zip([x.x, x.y, a.x, a.y]) {
                    *sum = *sum + conjugate * value;
                }
                self.phase = turned(self.phase, self.turn);
            }
        }
    }

    /// A window is over. What is new, if anything is.
    #[cold]
    #[inline(never)]
    fn over(&mut self, seen: &Seen) -> Option<Checked> {
        if self.stage == DONE {
            return Some(self.passed());
        }
        if 2 * u32::from(self.outside) > u32::from(self.length) {
            return Some(self.failed(Finding::Position, OUTSIDE));
        }
        if self.outside > 0 {
            return None;
        }
        match self.stage {
            REST => self.rested(),
            LISTEN => {
                self.usual = root(self.sums[1].x);
                self.stage = PROBE;
                None
            }
            PROBE => {
                self.stage = 0;
                None
            }
            SPIN..=LAST_SPIN => {
                let turns =
                    seen.spin.abs() * seen.tick * f32::from(self.length) / core::f32::consts::TAU;
                self.orbited(turns)
            }
            stage => {
                self.scale_lines();
                let omega = self.turn / seen.tick;
                let by = self.inertia(omega, seen);
                self.fit(omega, by);
                self.stage = stage + 1;
                (self.stage == SPIN)
                    .then(|| self.fitted(seen.tick))
                    .flatten()
            }
        }
    }

    fn passed(&mut self) -> Checked {
        self.ended(Finding::Passed, 0.0)
    }

    /// Nothing contradicts but this.
    fn ended(&mut self, finding: Finding, value: f32) -> Checked {
        if self.off_rest > 0.0 {
            return self.failed(Finding::Clearance, self.off_rest);
        }
        self.attempts = self.attempts.wrapping_add(1);
        self.stage = DONE;
        Checked { finding, value }
    }

    /// An attempt has come to nothing.
    fn failed(&mut self, finding: Finding, value: f32) -> Checked {
        self.restart();
        self.refused = self
            .refused
            .saturating_add(u8::from(finding.is_contradiction()));
        if self.refused >= MOST_REFUSED {
            self.stage = HALTED;
        }
        Checked { finding, value }
    }

    /// Begins anew.
    fn restart(&mut self) {
        self.attempts = self.attempts.wrapping_add(1);
        self.stage = LISTEN;
        self.left = 0;
        self.clear();
    }

    fn clear(&mut self) {
        self.normal = [0.0; 5];
        self.right = [[Vec2::ZERO; 2]; 2];
        self.square = 0.0;
        self.rounds = 0;
    }

    /// Sums to amplitudes: of a sine under the window, seen through it.
    fn scale_lines(&mut self) {
        let scale = SEEN / f32::from(self.length);
        self.sums = self.sums.map(|sum| sum * scale);
    }

    /// −ω²·X, with stiffness and damping as configured, of each axis.
    fn inertia(&self, omega: f32, seen: &Seen) -> [Vec2<f32>; 2] {
        let [x, y, ..] = self.sums;
        let along = seen.stiffness - omega * omega;
        [x, y].map(|sum| sum * along + sum.perp() * (omega * seen.damping))
    }

    /// Adds a line to the least squares.
    fn fit(&mut self, omega: f32, by: [Vec2<f32>; 2]) {
        let [_, _, x, y] = self.sums;
        let across = product(x, y);
        let [square_x, square_y] = [x, y].map(Vec2::length_squared);
        let sums = [
            square_x,
            square_y,
            across.x,
            across.y,
            omega * (square_x + square_y),
        ];
        for (sum, more) in self.normal.iter_mut().zip(sums) {
            *sum += more;
        }
        for ([of_x, of_y], by) in self.right.iter_mut().zip(by) {
            *of_x = *of_x + product(x, by);
            *of_y = *of_y + product(y, by);
            self.square += by.length_squared();
        }
    }

    /// G from all lines so far: real but for what the force is behind.
    #[cold]
    #[inline(never)]
    fn fitted(&mut self, tick: f32) -> Option<Checked> {
        self.rounds = self.rounds.saturating_add(1);
        let [xx, yy, re, im, weighed] = self.normal;
        let xy = Vec2::new(re, im);
        let determinant = xx * yy - xy.length_squared();
        let inverse = if determinant > LEAST_PIVOT {
            1.0 / determinant
        } else {
            0.0
        };
        let solved = (self.right).map(|[x, y]| {
            let of_x = x * yy - times(xy, y);
            let of_y = y * xx - product(xy, x);
            [of_x * inverse, of_y * inverse]
        });
        let mut explained = 0.0;
        for ([gx, gy], [x, y]) in solved.into_iter().zip(self.right) {
            explained += gx.dot(x) + gy.dot(y);
        }
        let unexplained = max(self.square - explained, 0.0);
        // Two numbers a line and row, less the unknowns.
        let free = f32::from(self.rounds) * 16.0 - 8.0;
        let spread = root(unexplained / free * max(xx, yy) * inverse);
        let size = root(explained / max(xx + yy, LEAST_PIVOT));
        let known = inverse > 0.0 && spread < KNOWN * max(size, 1.0);
        if self.rounds < LEAST_ROUNDS || (!known && self.rounds < MOST_ROUNDS) {
            self.stage = 0;
            return None;
        }
        if !known {
            let lines = f32::from(self.rounds) * LINES.len() as f32;
            let least = self.full() * CAME_THROUGH;
            let share = unexplained / max(self.square, LEAST_PIVOT);
            let answers = xx + yy < lines * least * least || share < UNEXPLAINED;
            let (finding, value) = if answers {
                (Finding::NotYet, spread)
            } else {
                (Finding::NoAnswer, share)
            };
            return Some(self.failed(finding, value));
        }
        let [[gxx, gxy], [gyx, gyy]] = solved;
        let whole = times(gxx, gyy) - times(gxy, gyx);
        let whole = if whole.x < 0.0 { -whole } else { whole };
        let behind = -0.5 * micromath::F32(whole.y).atan2(micromath::F32(whole.x)).0;
        let ahead = turned(Vec2::new(1.0, 0.0), behind);
        let real = solved.map(|row| row.map(|g| times(g, ahead).x));
        if let Some((finding, value)) = judge(&real, SURE * spread) {
            return Some(self.failed(finding, value));
        }
        let time = behind * (xx + yy) / max(weighed, LEAST_PIVOT);
        let doubt = SURE * spread * (xx + yy) / max(weighed, LEAST_PIVOT);
        if time.abs() > max(MOST_TICKS * tick, MOST_DELAY) + doubt {
            return Some(self.failed(Finding::Delay, time / tick));
        }
        None
    }

    /// Four lines of the orbit.
    #[cold]
    #[inline(never)]
    fn orbited(&mut self, turns: f32) -> Option<Checked> {
        let mut squares = self.sums.map(Vec2::length_squared);
        // What turns too little is a rest of what stands still, and what turns too far is not seen.
        let lines = [1.0, 1.0, PER_MINUTE, BETWEEN];
        let most = QUICKEST / core::f32::consts::TAU * f32::from(self.length);
        for (square, line) in squares.iter_mut().zip(lines) {
            if turns * line < LEAST_TURNS || turns * line > most {
                *square = 0.0;
            }
        }
        let [forward, backward, minute, between] = squares;
        // A mean over the window's square, which has 8/15 of its length.
        let least = LEAST_ORBIT * f32::from(self.length) * (8.0 / 15.0);
        let shows = max(backward, minute) > least * least;
        let stands_out = |line: f32, others: f32| shows && line > STANDS_OUT * STANDS_OUT * others;
        let unit = stands_out(minute, max(max(forward, backward), between));
        let reversed =
            stands_out(backward, max(minute, between)) && backward > BACKWARD * BACKWARD * forward;
        // All windows have to say the same.
        let signs = u8::from(unit) + 2 * u8::from(reversed);
        self.rounds = if self.stage == SPIN {
            signs
        } else {
            self.rounds & signs
        };
        if self.stage < LAST_SPIN {
            self.stage += 1;
            return None;
        }
        self.spin_seen = true;
        match self.rounds {
            1 => Some(self.ended(Finding::SpinUnit, PER_MINUTE)),
            2 => {
                let ratio = root(backward / max(forward, LEAST_PIVOT));
                Some(self.ended(Finding::SpinReversed, ratio))
            }
            _ => Some(self.passed()),
        }
    }

    /// A rotor at rest.
    fn rested(&mut self) -> Option<Checked> {
        self.attempts = self.attempts.wrapping_add(1);
        let mean = self.sums[0] * (1.0 / f32::from(self.length));
        let radius = root(mean.length_squared());
        if self.sums[1].x > STILL * STILL || radius < NOT_ON_IT {
            return None;
        }
        let (least, most) = AT_REST;
        self.off_rest = if radius < least || radius > most {
            radius
        } else {
            0.0
        };
        (self.off_rest > 0.0).then_some(Checked {
            finding: Finding::Clearance,
            value: radius,
        })
    }
}

/// A line that is no multiple of the spin.
fn away_from(spin: f32, line: f32) -> f32 {
    let below = (line / max(spin, 1e-3)) as u16;
    let from = line - f32::from(below) * spin;
    let near = min(from, spin - from) < min(FROM_SPIN, 0.45 * spin);
    if near && line < (HARMONICS + 0.5) * spin {
        (f32::from(below) + 0.5) * spin
    } else {
        line
    }
}

/// A phase after an angle of at most a quarter turn, kept at length 1.
#[inline(never)]
fn turned(phase: Vec2<f32>, angle: f32) -> Vec2<f32> {
    let angle = min(max(angle, -QUICKEST), QUICKEST);
    let square = angle * angle;
    let cos =
        1.0 - square * (0.5 - square * (1.0 / 24.0 - square * (1.0 / 720.0 - square / 40_320.0)));
    let sin = angle * (1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0 - square / 5_040.0)));
    let next = phase.rotated(Vec2::new(cos, sin));
    next * (1.5 - 0.5 * next.length_squared())
}

/// One copy, wherever it is wanted.
#[inline(never)]
fn root(x: f32) -> f32 {
    crate::number::scalar::sqrt(x)
}

/// Of two numbers of the plane, and with the first one mirrored.
fn times(a: Vec2<f32>, b: Vec2<f32>) -> Vec2<f32> {
    b.rotated(a)
}

fn product(a: Vec2<f32>, b: Vec2<f32>) -> Vec2<f32> {
    times(mirrored(a), b)
}

fn mirrored(phase: Vec2<f32>) -> Vec2<f32> {
    Vec2::new(phase.x, -phase.y)
}

/// What G says, beyond this doubt.
fn judge(&[[xx, xy], [yx, yy]]: &[[f32; 2]; 2], doubt: f32) -> Option<(Finding, f32)> {
    let determinant = xx * yy - xy * yx;
    let gain = root(determinant.abs());
    // As far as two rows of such an error move it.
    let doubt = doubt / max(gain, 1e-6);
    if determinant < 0.0 {
        return Some(if xy.abs() + yx.abs() > xx.abs() + yy.abs() {
            (Finding::AxesSwapped, gain)
        } else {
            (Finding::AxisInverted, gain)
        });
    }
    let (along, across) = (xx + yy, yx - xy);
    if along < 0.0 && across.abs() < -0.577 * along {
        return Some((Finding::ForceInverted, gain));
    }
    if along <= 0.0 || across.abs() > (MOST_TURN + doubt) * along {
        let angle = micromath::F32(across).atan2(micromath::F32(along)).0;
        return Some((Finding::AxesTurned, angle));
    }
    let (first, second) = (Vec2::new(xx, yx), Vec2::new(xy, yy));
    let [a, b] = [first, second].map(|column| root(column.length_squared()));
    if gain > MOST_GAIN * (1.0 + doubt) || gain * MOST_GAIN * (1.0 + doubt) < 1.0 {
        return Some((Finding::Gain, gain));
    }
    let ratio = max(a, b) / max(min(a, b), 1e-6);
    let skew = first.dot(second) / max(a * b, 1e-12);
    if skew.abs() > MOST_SKEW + doubt {
        return Some((Finding::AxesSkewed, skew));
    }
    (ratio > MOST_RATIO * (1.0 + doubt)).then_some((Finding::AxesSkewed, ratio))
}
