//! What holds for every command.

use crate::storm::AnyBits;
use supervisor::{Command, Config, CoreCommand, Scaling, Status};

/// A command in newtons, per unit of the force.
pub fn per_unit(scaling: &Scaling, command: &Command) -> CoreCommand<f32> {
    CoreCommand {
        force: command.force_n.map(|x| x / scaling.force_n),
        own: command.own_n.map(|x| x / scaling.force_n),
        mode: command.mode,
        limits: command.limits,
        events: command.events,
        integrator: command.integrator,
        severity: command.severity,
    }
}

/// What holds for every command \[caps\], by the configuration.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    force_max_n: f32,
    axis_cap: f64,
    slew_step: f64,
    /// By how much rounding may exceed the caps, and by how much the slew limit.
    beyond: f64,
    rounding: f64,
    /// Up to here it is nothing: what a conversion from other units cannot tell from it.
    nothing: f64,
    /// By how much a cut to other caps may have rounded; for one tick.
    cut: f64,
    /// Until the machine has confirmed its configuration all is in a shadow.
    checked_first: bool,
    /// Last force and last force of its own.
    last: [[f64; 2]; 2],
}

impl Bounds {
    /// For a core of this configuration; as it has them, in the nearest number, to a unit in the last place of 1.
    pub fn new<S: AnyBits>(config: &Config) -> Self {
        let cap = config.force_max_n;
        let slew = config.force_slew_n_s * config.sample_period_s / cap;
        Self {
            force_max_n: cap,
            axis_cap: S::from_f32((config.axis_force_max_n / cap).min(1.0)).exact(),
            slew_step: S::from_f32(slew.min(4.0)).exact(),
            beyond: S::TOO_LONG,
            rounding: S::LAST_PLACE,
            nothing: 0.0,
            cut: 0.0,
            checked_first: false,
            last: [[0.0; 2]; 2],
        }
    }

    /// For a supervisor of this configuration, in newtons: the conversion there and back rounds, too.
    pub fn in_newtons(config: &Config) -> Self {
        Self {
            beyond: 4.0 * f32::LAST_PLACE,
            rounding: 4.0 * f32::LAST_PLACE,
            nothing: f64::from(f32::MIN_POSITIVE) / f64::from(config.force_max_n),
            checked_first: config.check_first >= 0.5,
            ..Self::new::<f32>(config)
        }
    }

    /// What holds from a change of the configuration on: a force that is beyond a cap then is cut to it at once.
    pub fn reconfigured(self, new: Self) -> Self {
        let unit = f64::from(self.force_max_n / new.force_max_n);
        let far = unit > 500.0 || self.last.iter().any(|[x, y]| x.hypot(*y) * unit > 10.0);
        let cut = |last: [f64; 2]| {
            let [x, y] = last.map(|x| x * unit);
            let within_disc = 1.0 / x.hypot(y).max(1.0);
            let largest = x.abs().max(y.abs()) * within_disc;
            let within_box = within_disc * (new.axis_cap / largest).min(1.0);
            [x * within_box, y * within_box]
        };
        Self {
            last: self.last.map(cut),
            // What is very far beyond a cap need not keep its direction, and fixed point holds no larger ratio.
            cut: if far { 2.0 } else { 32.0 * new.rounding },
            ..new
        }
    }

    /// Finite; within the cap, the caps of the axes and the slew limit; and nothing on an axis that is lost.
    ///
    /// # Errors
    /// What is broken.
    pub fn check<S: AnyBits>(
        &mut self,
        command: &CoreCommand<S>,
        status: Status,
    ) -> Result<(), String> {
        let lost = [Status::AXIS_X_LOST, Status::AXIS_Y_LOST].map(|axis| status.contains(axis));
        let cut = std::mem::take(&mut self.cut);
        if !command.severity.is_finite() || command.severity < S::ZERO {
            return Err(format!("severity: {command:?}"));
        }
        if !(status.contains(Status::SHADOW) || self.checked_first) {
            if command.own != command.force {
                return Err(format!("two forces without a shadow: {command:?}"));
            }
            // What it would have done ends where it acts: it goes on from what was done.
            self.last[1] = self.last[0];
        }
        for (force, last) in [command.force, command.own].into_iter().zip(&mut self.last) {
            let say = |what: &str| Err(format!("{what}: {command:?} after {last:?}, {status:?}"));
            let ([x, y], [u, v]) = (force.map(S::exact), *last);
            if !(x.is_finite() && y.is_finite()) {
                return say("not finite");
            }
            if x.hypot(y) > 1.0 + self.beyond {
                return say("beyond the cap");
            }
            if x.abs().max(y.abs()) > self.axis_cap + self.beyond {
                return say("beyond the cap of an axis");
            }
            if (lost[0] && x.abs() > self.nothing) || (lost[1] && y.abs() > self.nothing) {
                return say("force on a lost axis");
            }
            let on = |axis: usize, change: f64| if lost[axis] { 0.0 } else { change };
            let change = on(0, x - u).hypot(on(1, y - v));
            if change > self.slew_step + self.rounding + cut {
                return say("faster than the slew limit");
            }
            *last = [x, y];
        }
        Ok(())
    }
}
