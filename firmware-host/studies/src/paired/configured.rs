//! What the supervisor is configured with.

use super::row::RIGHT;
use crate::machines::draw::Draw;
use firmware_bench::scene::{PlaneScene, Scene};
use supervisor::Config;

/// A configuration, right or with a mistake.
#[derive(Debug, Clone, Copy)]
pub struct Configured {
    /// Name in tables.
    pub name: &'static str,
    /// Makes the mistake in the configuration of a plane.
    make: fn(&mut Config, &mut Draw),
    /// Makes it in what a scene tells all planes.
    make_for_all: fn(&mut Scene),
}

impl PartialEq for Configured {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Configured {
    /// Makes the mistake in a plane.
    pub fn apply(&self, plane: &mut PlaneScene, draw: &mut Draw) {
        if let Some(config) = &mut plane.supervisor {
            (self.make)(config, draw);
        }
    }

    /// Makes the mistake in what is no plane's own.
    pub(crate) fn apply_to_all(&self, scene: &mut Scene) {
        (self.make_for_all)(scene);
    }
}

/// As the machine is.
pub(crate) const AS_IT_IS: Configured = Configured {
    name: RIGHT,
    make: |_, _| {},
    make_for_all: |_| {},
};

/// Mass, friction, stiffness, lag, clearance and restitution off by up to 30, 50, 30, 50, 5 and 20 %.
pub const MANY_WRONG: Configured = Configured {
    name: "many parameters wrong",
    make: |config, draw| {
        let mut wrong = |x: &mut f32, by: f64| *x *= draw.decades(1.0 / by, by) as f32;
        wrong(&mut config.mass_kg, 1.3);
        wrong(&mut config.friction_coefficient, 1.5);
        wrong(&mut config.stiffness_n_m, 1.3);
        wrong(&mut config.amplifier_lag_s, 1.5);
        wrong(&mut config.clearance_m, 1.05);
        config.restitution = (config.restitution * draw.between(0.8, 1.2) as f32).min(0.95);
    },
    ..AS_IT_IS
};

/// One thing wrong with the configuration of a scene.
macro_rules! one_wrong {
    ($($name:literal: $change:expr;)*) => {
        /// One mistake at a time.
        pub const ONE_WRONG: &[Configured] = &[
            $(Configured {
                name: $name,
                make: |config, _| {
                    let change: fn(&mut Config) = $change;
                    change(config);
                },
                ..AS_IT_IS
            },)*
            Configured {
                name: "spin reversed",
                make_for_all: |scene| scene.spin_sensor.gain *= -1.0,
                ..AS_IT_IS
            },
        ];
    };
}

one_wrong! {
    "mass × 0.8": |c| c.mass_kg *= 0.8;
    "mass × 1.25": |c| c.mass_kg *= 1.25;
    "friction × 0.5": |c| c.friction_coefficient *= 0.5;
    "friction × 2": |c| c.friction_coefficient *= 2.0;
    "stiffness × 0.7": |c| c.stiffness_n_m *= 0.7;
    "stiffness × 1.4": |c| c.stiffness_n_m *= 1.4;
    "lag × 0.5": |c| c.amplifier_lag_s *= 0.5;
    "lag × 2": |c| c.amplifier_lag_s *= 2.0;
    "delay − 1": |c| c.delay_samples -= 1.0;
    "delay + 1": |c| c.delay_samples += 1.0;
    "clearance × 0.9": |c| c.clearance_m *= 0.9;
    "clearance × 1.1": |c| c.clearance_m *= 1.1;
    "force cap × 0.7": |c| c.cap(0.7);
    "force cap × 1.3": |c| c.cap(1.3);
    "observer pole × 0.9": |c| c.observer_pole_flight *= 0.9;
    "observer pole × 1.05": |c| c.observer_pole_flight *= 1.05;
}

/// Caps of a configuration.
trait Cap {
    /// All that are caps of force, by a factor.
    fn cap(&mut self, by: f32);
}

impl Cap for Config {
    fn cap(&mut self, by: f32) {
        self.force_max_n *= by;
        self.axis_force_max_n *= by;
        self.continuous_force_n *= by;
    }
}
