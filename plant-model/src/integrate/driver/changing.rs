//! Parameters that change during a run.

use super::Run;
use crate::integrate::contact_step::ContactStepper;
use crate::integrate::flight_map::FlightMaps;
use crate::integrate::series_step::SeriesStepper;
use crate::integrate::transitions::AtZero;
use crate::magnet::Amplifier;
use crate::mode::Phase;
use crate::params::{Change, ParamError, SlidingFriction};
use crate::plane::{Bore, Raceway};
use crate::spin::Spin;
use crate::stator::Stator;
use crate::system::{StateOf, SuppressedGuards};

impl<S: Stator, W: Spin, M: Amplifier, B: Bore, R: Raceway> Run<S, W, M, B, R> {
    /// See [`crate::plant::Plant::change`].
    pub(crate) fn change(&mut self, change: &Change) -> Result<(), ParamError> {
        change.validate()?;
        let refused = |field, value, expected| {
            Err(ParamError {
                field,
                value,
                expected,
            })
        };
        let system = &mut self.system;
        if let Some(e) = change.eccentricity_m
            && e > 0.0
            && !W::KNOWS_ANGLE
        {
            let expected = "0, or a plant built for changes, which follows the rotor's angle";
            return refused("rotor.eccentricity_m", e, expected);
        }
        if let Some(torque) = change.drive_torque_n_m
            && !system.spin.set_drive_torque_n_m(torque)
        {
            let expected = "nothing while the speed is held";
            return refused("spin.drive_torque_n_m", torque, expected);
        }
        if let Some(e) = change.eccentricity_m {
            system.rotor.eccentricity_m = e;
        }
        if let Some(coefficient) = change.friction_coefficient {
            system.plane.friction.sliding = SlidingFriction::Constant { coefficient };
        }
        // What was learnt from the field as it was.
        let rate = system.contact_rate_rad_s();
        self.maps = FlightMaps::default();
        self.series = (system.plane.contact.law.linear())
            .filter(|_| !B::OUT_OF_ROUND)
            .map(|law| SeriesStepper::new(self.options.rtol, rate, law));
        self.explicit = ContactStepper::new::<StateOf<S, W, M, R>>(rate);
        self.stiff = ContactStepper::new::<StateOf<S, W, M, R>>(rate);
        if let Phase::Contact(slide, whirl) = self.phase {
            // A weaker cone may not hold what the stronger one held.
            let held = AtZero::held((slide, whirl));
            let here = (self.t_s, &self.y);
            let (slide, whirl) = self.system.settle(here, &self.inputs, held);
            self.phase = Phase::Contact(slide, whirl);
            self.suppressed = self.suppressed.among(SuppressedGuards::NORMAL);
        }
        Ok(())
    }
}
