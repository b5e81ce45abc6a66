//! Course of a whirl: one run followed from the excitation until the rotor flies free again.

use super::whirl::{WhirlMeter, WhirlReading};
use crate::mode::ContactMode;
use crate::plant::{Inputs, Plant};
use crate::readout::Snapshot;
use crate::{PlantError, V2};
use std::f64::consts::TAU;

/// Excitation: a force along x that ends before the wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pulse {
    /// Force \[N\].
    pub force_n: f64,
    /// When it begins \[s\].
    pub from_s: f64,
    /// Distance of the rotor from the centre at which it ends for good \[m\].
    pub until_m: f64,
}

/// How a run is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Watch {
    /// Time between samples \[s\].
    pub sample_s: f64,
    /// Window of the whirl frequency \[s\].
    pub window_s: f64,
    /// End at the latest \[s\].
    pub end_s: f64,
    /// End once the rotor has flown free for so long after its first touch \[s\].
    pub free_s: f64,
    /// The excitation, if any.
    pub pulse: Option<Pulse>,
}

/// What is kept of a run at a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time \[s\].
    pub t_s: f64,
    /// Rotor \[m\].
    pub position_m: V2,
    /// Inner ring \[m\].
    pub inner_ring_m: V2,
    /// Outer ring \[m\].
    pub outer_ring_m: V2,
    /// Spin Ω \[Hz\].
    pub spin_hz: f64,
    /// Spin Ω_i of the race \[Hz\]; 0 for a bushing.
    pub race_spin_hz: f64,
    /// What the rotor does.
    pub mode: ContactMode,
    /// f_n \[N\].
    pub normal_force_n: f64,
    /// Tangential speed of the rotor against the ring, backward positive \[m/s\].
    pub backward_m_s: f64,
    /// Sliding speed v_rel \[m/s\]; not finite without contact.
    pub sliding_m_s: f64,
}

/// Contact from a touch to the lift-off after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Touch \[s\].
    pub from_s: f64,
    /// Lift-off, or the end of the run \[s\].
    pub to_s: f64,
}

/// A run as it was followed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Course {
    /// Evenly spaced.
    pub samples: Vec<Sample>,
    /// Whirl frequency wherever a window fits into one contact, in order of time.
    pub whirl: Vec<WhirlReading>,
    /// Every contact, in order.
    pub contacts: Vec<Contact>,
    /// When the excitation acted \[s\].
    pub pulse_s: Option<(f64, f64)>,
}

/// Carries a plant that was just built through the run. The spin at the start is taken as positive.
///
/// # Errors
/// [`PlantError`] of the run.
pub fn follow(plant: &mut Plant, watch: &Watch) -> Result<Course, PlantError> {
    let mut course = Course::default();
    let mut meter = WhirlMeter::new(watch.window_s);
    let mut open: Option<f64> = None;
    let mut lifted_s: Option<f64> = None;
    let mut pulse_over = watch.pulse.is_none();
    let steps = (watch.end_s / watch.sample_s).round() as u64;
    course.samples.push(sample(&plant.snapshot()));
    for i in 1..=steps {
        let mut inputs = Inputs::default();
        let before = plant.snapshot();
        if let Some(pulse) = watch.pulse.filter(|_| !pulse_over) {
            let now_s = before.t_s;
            if before.position_m.norm() >= pulse.until_m {
                pulse_over = true;
            } else if now_s >= pulse.from_s - 0.5 * watch.sample_s {
                inputs.external_n = V2::new(pulse.force_n, 0.0);
                let from_s = course.pulse_s.map_or(now_s, |(from, _)| from);
                course.pulse_s = Some((from_s, now_s + watch.sample_s));
            }
        }
        let contacts = &mut course.contacts;
        plant.advance(i as f64 * watch.sample_s, &inputs, &mut |now| match (
            open,
            now.mode.in_contact(),
        ) {
            (None, true) => {
                open = Some(now.t_s);
                lifted_s = None;
            }
            (Some(from_s), false) => {
                contacts.push(Contact {
                    from_s,
                    to_s: now.t_s,
                });
                open = None;
                lifted_s = Some(now.t_s);
            }
            _ => {}
        })?;
        let now = plant.snapshot();
        course.samples.push(sample(&now));
        // Two contacts with a lift-off between two samples are two.
        let same = open.is_some_and(|from_s| from_s < before.t_s) || !now.mode.in_contact();
        if !same {
            meter.push(now.t_s, 0.0, false, 1.0);
        }
        meter.push(now.t_s, now.whirl_angle_rad, now.mode.in_contact(), 1.0);
        course.whirl.extend(meter.latest());
        if lifted_s.is_some_and(|t| now.t_s - t > watch.free_s) {
            break;
        }
    }
    if let (Some(from_s), Some(last)) = (open, course.samples.last()) {
        let to_s = last.t_s;
        course.contacts.push(Contact { from_s, to_s });
    }
    Ok(course)
}

fn sample(now: &Snapshot) -> Sample {
    let contact = now.mode.in_contact();
    let speed = now.contact_tangential_speed_m_s;
    Sample {
        t_s: now.t_s,
        position_m: now.position_m,
        inner_ring_m: now.inner_ring.position,
        outer_ring_m: now.outer_ring.position,
        spin_hz: now.spin_rad_s / TAU,
        race_spin_hz: now.race_spin_rad_s / TAU,
        mode: now.mode,
        normal_force_n: now.normal_force_n,
        backward_m_s: -speed,
        sliding_m_s: if contact {
            now.sliding_speed_m_s
        } else {
            f64::NAN
        },
    }
}

impl Course {
    /// The longest contact: where the whirl is, if there is one.
    pub fn longest_contact(&self) -> Option<Contact> {
        let length = |c: &Contact| c.to_s - c.from_s;
        (self.contacts.iter())
            .max_by(|a, b| length(a).total_cmp(&length(b)))
            .copied()
    }

    /// Largest whirl frequency, the first of equals.
    pub fn fastest(&self) -> Option<WhirlReading> {
        self.whirl.iter().copied().reduce(|best, r| {
            if r.backward_hz > best.backward_hz {
                r
            } else {
                best
            }
        })
    }

    /// First sample with the spin below a speed \[Hz\]: its time \[s\].
    pub fn spin_below_s(&self, spin_hz: f64) -> Option<f64> {
        self.samples
            .iter()
            .find(|s| s.spin_hz < spin_hz)
            .map(|s| s.t_s)
    }

    /// Last sample not later than a time \[s\].
    pub fn at(&self, t_s: f64) -> Option<&Sample> {
        let after = self.samples.partition_point(|s| s.t_s <= t_s);
        self.samples.get(after.checked_sub(1)?)
    }

    /// Largest of a quantity over all samples.
    pub fn largest(&self, quantity: impl Fn(&Sample) -> f64) -> f64 {
        self.samples.iter().map(quantity).fold(0.0, f64::max)
    }
}
