//! Whirl frequency: rate of the contact angle, averaged over a window inside one contact.

use std::collections::VecDeque;

/// Rate of the contact angle over a sliding window.
#[derive(Debug, Clone)]
pub struct WhirlMeter {
    window_s: f64,
    /// (time, angle) within the present contact, a little more than one window.
    samples: VecDeque<(f64, f64)>,
    fastest: Option<WhirlReading>,
    latest: Option<WhirlReading>,
}

/// One reading of a [`WhirlMeter`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WhirlReading {
    /// Middle of the window \[s\].
    pub t_s: f64,
    /// Mean rate of the contact angle \[Hz\], backward positive.
    pub backward_hz: f64,
}

impl WhirlMeter {
    /// A meter with a window \[s\], > 0.
    pub fn new(window_s: f64) -> Self {
        Self {
            window_s,
            samples: VecDeque::new(),
            fastest: None,
            latest: None,
        }
    }

    /// Takes a sample in time order: the contact angle summed so far, whether the rotor touches, and
    /// the direction of the spin (its sign says what backward is; 0 keeps counter-clockwise spin).
    pub fn push(&mut self, t_s: f64, angle_rad: f64, in_contact: bool, spin_rad_s: f64) {
        self.latest = None;
        if !in_contact {
            self.samples.clear();
            return;
        }
        self.samples.push_back((t_s, angle_rad));
        // A window counts as full within a thousandth: sample times carry round-off.
        let full = self.window_s * 0.999;
        while self.samples.len() > 2 && t_s - self.samples[1].0 >= full {
            self.samples.pop_front();
        }
        let (t0, angle0) = self.samples[0];
        if t_s - t0 < full {
            return;
        }
        let backward = if spin_rad_s < 0.0 { 1.0 } else { -1.0 };
        let backward_hz = backward * (angle_rad - angle0) / (t_s - t0) / std::f64::consts::TAU;
        let reading = WhirlReading {
            t_s: 0.5 * (t0 + t_s),
            backward_hz,
        };
        self.latest = Some(reading);
        if self.fastest.is_none_or(|f| backward_hz > f.backward_hz) {
            self.fastest = Some(reading);
        }
    }

    /// Reading of the window that ends with the last sample; `None` where it does not fit into the
    /// contact.
    pub fn latest(&self) -> Option<WhirlReading> {
        self.latest
    }

    /// Fastest backward whirl so far; `None` without a contact as long as the window.
    pub fn fastest(&self) -> Option<WhirlReading> {
        self.fastest
    }
}
