//! Whether a free rotor swings out ever farther: it is not back, however near the middle it still is.

/// Distances are kept as the largest in each stretch of so long \[s\], or of a sample where that is longer.
const STRETCH_S: f64 = 1e-3;
/// What grows by less than this from one window to the next may be noise, or a beat.
const GROWTH: f64 = 1.1;

/// Largest distances from the middle, stretch by stretch, since the rotor has been free.
#[derive(Debug, Clone)]
pub(crate) struct Swings {
    stretch_s: f64,
    since_s: Option<f64>,
    largest_m: Vec<f64>,
}

impl Swings {
    pub(crate) fn new(period_s: f64) -> Self {
        Self {
            stretch_s: STRETCH_S.max(period_s),
            since_s: None,
            largest_m: Vec::new(),
        }
    }

    /// The rotor touches, or something has happened to it: from here on.
    pub(crate) fn restart(&mut self) {
        self.since_s = None;
        self.largest_m.clear();
    }

    /// A distance from the middle, free.
    pub(crate) fn push(&mut self, t_s: f64, away_m: f64) {
        let since_s = *self.since_s.get_or_insert(t_s);
        let stretch = ((t_s - since_s) / self.stretch_s) as usize;
        if stretch >= self.largest_m.len() {
            self.largest_m.resize(stretch + 1, 0.0);
        }
        self.largest_m[stretch] = self.largest_m[stretch].max(away_m);
    }

    /// Whether they grow from window to window, and by more each time, so that by the smaller ratio of the two the rotor comes as far
    /// as `wall_m` in one more. These are the last three thirds of the whole time, of half of it, and so on, none shorter than
    /// `least_s`: in that time what oscillates has shown its amplitude.
    pub(crate) fn grow(&self, least_s: f64, wall_m: f64) -> bool {
        let least = (least_s / self.stretch_s).ceil().max(1.0) as usize;
        let thirds = std::iter::successors(Some(self.largest_m.len() / 3), |n| Some(n / 2));
        (thirds.take_while(|n| *n >= least)).any(|n| {
            let last = &self.largest_m[self.largest_m.len() - 3 * n..];
            let window = |i: usize| {
                last[i * n..(i + 1) * n]
                    .iter()
                    .fold(0.0, |a: f64, b| a.max(*b))
            };
            let [first, second, third] = [window(0), window(1), window(2)];
            // What kicks a quiet rotor makes one window large, and the next no larger.
            let growth = (third / second).min(second / first);
            first < second
                && growth > GROWTH
                && third - second > second - first
                && third * growth >= wall_m
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Sampled at 20 kHz.
    fn grow(duration_s: f64, away: impl Fn(f64) -> f64) -> bool {
        let mut swings = Swings::new(5e-5);
        for tick in 0..(duration_s / 5e-5) as u32 {
            let t = f64::from(tick) * 5e-5;
            swings.push(t, away(t).abs());
        }
        swings.grow(5e-3, 1.0)
    }

    #[test]
    fn what_grows_exponentially_is_seen_in_time_and_what_is_bounded_is_not() {
        let from = |start: f64, rate: f64| move |t: f64| start * (rate * t).cosh();
        // At the wall after 26 ms.
        assert!(grow(0.024, from(0.05, 141.0)));
        assert!(!grow(0.024, from(0.05, 30.0)), "far from the wall");
        let growing = |t: f64| 0.01 * (20.0 * t).exp() * (TAU * 100.0 * t).sin();
        assert!(grow(0.19, growing));
        assert!(!grow(0.05, growing), "far from the wall");
        // It came back, and goes again.
        assert!(grow(0.2, |t| (-100.0 * t).exp() + 1e-4 * (45.0 * t).exp()));
        for hz in [15.0, 50.0, 200.0] {
            for share in [0.1, 0.3, 0.5, 0.9] {
                let periods = [1.0, 1.25, 3.3].map(|n| n / hz);
                for duration_s in periods.into_iter().filter(|s| *s > 0.03) {
                    let swinging = |t: f64| share * (TAU * hz * t).sin();
                    assert!(
                        !grow(duration_s, swinging),
                        "{hz} Hz, {share}, {duration_s} s"
                    );
                    let decaying = |t: f64| share * (-5.0 * t).exp() * (TAU * hz * t).cos();
                    assert!(
                        !grow(duration_s, decaying),
                        "{hz} Hz, {share}, {duration_s} s"
                    );
                }
            }
        }
        // A kick is no growth.
        for at_s in [0.051, 0.085, 0.095] {
            let kicked = |t: f64| {
                if t < at_s {
                    0.01
                } else {
                    0.3 * (TAU * 90.0 * (t - at_s)).sin()
                }
            };
            assert!(!grow(0.1, kicked), "kicked at {at_s} s");
        }
        // A drift at constant speed.
        assert!(!grow(0.05, |t| 10.0 * t));
    }

    #[test]
    fn a_touch_begins_anew() {
        let mut swings = Swings::new(5e-5);
        for tick in 0..48 {
            swings.push(
                f64::from(tick) * 5e-4,
                0.05 * (0.07 * f64::from(tick)).cosh(),
            );
        }
        assert!(swings.grow(5e-3, 1.0));
        swings.restart();
        assert!(!swings.grow(5e-3, 1.0));
        swings.push(0.024, 0.3);
        assert!(!swings.grow(5e-3, 1.0));
    }
}
