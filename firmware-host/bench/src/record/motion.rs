//! A record in SI, for what is found out from it: where the rotor was, and what forces on it are known.

use crate::record::file::PlaneRecord;
use nalgebra::Matrix3;
use plant_model::V2;
use std::f64::consts::TAU;
use supervisor::{Config, Entry, Events, Status};

/// A tick.
#[derive(Debug, Clone, Copy)]
pub(super) struct Instant {
    /// Position at the retainer bearing \[m\].
    pub(super) position_m: V2,
    /// Whether it may be relied on.
    pub(super) good: bool,
    /// Force of the magnet \[N\], mean over the tick that follows.
    pub(super) force_n: V2,
    /// Spin \[rad/s\], and the angle that it has come to \[rad\].
    pub(super) spin_rad_s: f64,
    /// See `spin_rad_s`.
    pub(super) angle_rad: f64,
    /// What happened.
    pub(super) events: Events,
}

/// Ticks without a break, as they follow each other in time.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    /// Length of a tick \[s\].
    pub(super) period_s: f64,
    /// The machine as the supervisor was configured.
    pub(super) config: Config,
    /// Whether the spin is known throughout.
    pub(super) spin_known: bool,
    /// Sequence number of the first tick.
    pub(super) first: u32,
    /// The ticks.
    pub(super) instants: Vec<Instant>,
    /// Free motion over a tick of position, speed, and an acceleration that stays; and the same backward.
    maps: [Matrix3<f64>; 2],
}

impl Motion {
    /// The last ticks of a record that follow each other; `None` where there is no configuration or no tick.
    ///
    /// `late`: so many ticks later than forces positions are sampled; counts where forces are measured.
    pub(super) fn of(record: &PlaneRecord, late: usize) -> Option<Self> {
        let config = record.config.filter(|c| c.validate().is_ok())?;
        let (numbers, entries): (Vec<usize>, Vec<&Entry>) = record.entries.iter().unzip();
        let follows = |pair: &[&Entry]| pair[1].sequence == pair[0].sequence.wrapping_add(1);
        let broken = entries.windows(2).rposition(|pair| !follows(pair));
        let from = broken.map_or(0, |i| i + 1);
        let (numbers, entries) = (&numbers[from..], &entries[from..]);
        let unbelieved = record.unbelieved();
        let first = entries.first()?.sequence;
        let period_s = f64::from(config.sample_period_s);
        let spin_unit = f64::from(config.scaling().time_s);
        let delivered = delivered(record, entries, &config, late);
        let mut angle_rad = 0.0;
        let mut instants = Vec::with_capacity(entries.len());
        for ((number, entry), force_n) in numbers.iter().zip(entries).zip(delivered) {
            let [x, y] = entry.position.map(|bits| record.number(bits));
            let spin_rad_s = record.number(entry.spin) / spin_unit;
            let position_m = f64::from(config.clearance_m) * V2::new(x, y);
            instants.push(Instant {
                position_m,
                good: !unbelieved.contains(number) && position_m.iter().all(|x| x.is_finite()),
                force_n,
                spin_rad_s,
                angle_rad,
                events: Events::from_bits_truncate(u32::from(entry.events)),
            });
            angle_rad = (angle_rad + spin_rad_s * period_s) % TAU;
        }
        let known = |e: &&Entry| Status::from_bits_retain(e.status).contains(Status::SPIN_VALID);
        Some(Self {
            period_s,
            config,
            spin_known: entries.iter().all(known) && angle_rad.is_finite(),
            first,
            instants,
            maps: maps(&config, period_s),
        })
    }

    /// Mass that an impact here moves \[kg\].
    pub(super) fn mass_kg(&self) -> f64 {
        f64::from(self.config.mass_kg)
    }

    /// Clearance that the supervisor was configured with \[m\].
    pub(super) fn clearance_m(&self) -> f64 {
        f64::from(self.config.clearance_m)
    }

    /// How long an impact lasts as configured \[ticks\].
    pub(super) fn impact_ticks(&self) -> f64 {
        let stiffness = f64::from(self.config.contact_stiffness_n_m);
        std::f64::consts::PI * (self.mass_kg() / stiffness).sqrt() / self.period_s
    }

    /// Acceleration by the magnet in the tick that follows \[m/s²\].
    pub(super) fn known_m_s2(&self, tick: usize) -> V2 {
        self.instants[tick].force_n / self.mass_kg()
    }

    /// Position and speed a tick later under an acceleration that is none of springs and dampers; `back`: a tick before.
    pub(super) fn moved(&self, [x, v]: [f64; 2], acceleration: f64, back: bool) -> [f64; 2] {
        let map = &self.maps[usize::from(back)];
        [0, 1].map(|row| map[(row, 0)] * x + map[(row, 1)] * v + map[(row, 2)] * acceleration)
    }
}

fn maps(config: &Config, period_s: f64) -> [Matrix3<f64>; 2] {
    let mass = f64::from(config.mass_kg);
    let spring = f64::from(config.stiffness_n_m) / mass;
    let damper = f64::from(config.damping_n_s_m) / mass;
    let rate = Matrix3::new(0.0, 1.0, 0.0, -spring, -damper, 1.0, 0.0, 0.0, 0.0);
    [period_s, -period_s].map(|t| (rate * t).exp())
}

/// Whether each tick says what the actuator delivered.
pub(super) fn is_measured<'a>(mut entries: impl Iterator<Item = &'a Entry>) -> bool {
    entries.all(|e| Status::from_bits_retain(e.status).contains(Status::APPLIED_VALID))
}

/// Force at the retainer bearing in each tick, mean over it: as measured, else by delay and lag from the commands.
fn delivered(record: &PlaneRecord, entries: &[&Entry], config: &Config, late: usize) -> Vec<V2> {
    let unit_n = f64::from(config.force_max_n) * f64::from(config.magnet_plane_ratio);
    let vector = |bits: [u32; 2]| {
        let [x, y] = bits.map(|bits| record.number(bits));
        let v = unit_n * V2::new(x, y);
        if v.iter().all(|x| x.is_finite()) {
            v
        } else {
            V2::zeros()
        }
    };
    let status = |e: &Entry| Status::from_bits_retain(e.status);
    if is_measured(entries.iter().copied()) {
        let at = |i: usize| vector(entries[i.saturating_sub(late).min(entries.len() - 1)].applied);
        return (0..entries.len())
            .map(|i| 0.5 * (at(i) + at(i + 1)))
            .collect();
    }
    let commanded = |e: &Entry| match status(e).contains(Status::BEARING_ON) {
        true if status(e).contains(Status::SHADOW) => vector(e.levitation),
        true => vector(e.force),
        false => V2::zeros(),
    };
    let delay = config.delay_samples.round() as usize;
    let lags = f64::from(config.sample_period_s) / f64::from(config.amplifier_lag_s).max(1e-12);
    let (left, mean) = ((-lags).exp(), -(-lags).exp_m1() / lags);
    let mut force_n = entries.first().map_or(V2::zeros(), |e| commanded(e));
    (0..entries.len())
        .map(|i| {
            let wanted = commanded(entries[i.saturating_sub(delay)]);
            let apart = force_n - wanted;
            force_n = wanted + left * apart;
            wanted + mean * apart
        })
        .collect()
}
