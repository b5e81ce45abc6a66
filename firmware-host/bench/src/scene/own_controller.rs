//! Controllers of the user's, whichever the scene names.

use crate::device::external::Caller;
use crate::device::whole_levitation::WholeLevitationParams;
use crate::scene::biquads::biquads;
use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::external::{external, of_caller};
use crate::scene::plane_spec::PlaneSpec;
use crate::scene::spec::Spec;
use crate::scene::state_space::state_space;
use crate::scene::tables::{ControllerTable, SceneTables};

impl SceneTables {
    /// Whether somebody levitates.
    pub(crate) fn levitates(&self) -> bool {
        self.levitation.is_some() || self.biquads.is_some() || self.own_of_the_whole().count() > 0
    }

    /// Whether whoever does adds minus the weight.
    pub(crate) fn feeds_weight_forward(&self) -> bool {
        (self.levitation.as_ref()).is_some_and(|l| l.feed_forward_weight)
            || (self.state_space.as_ref()).is_some_and(|s| s.feed_forward_weight)
            || (self.biquads.as_ref()).is_some_and(|b| b.feed_forward_weight)
            || (self.controller.as_ref()).is_some_and(|c| c.feed_forward_weight)
    }

    /// Tables of controllers of the user's that see and drive the rotor as a whole.
    pub(crate) fn own_of_the_whole(&self) -> impl Iterator<Item = &'static str> + use<> {
        let tables = [
            ("state_space", self.state_space.is_some()),
            ("controller", self.controller.is_some()),
        ];
        tables
            .into_iter()
            .filter_map(|(table, given)| given.then_some(table))
    }
}

impl Spec {
    /// Has a controller of the caller's levitate: as if `[controller]` stood in the place of whatever
    /// levitates in the file, with the parameters that it may have there, and with the weight fed forward where it is.
    ///
    /// # Errors
    /// [`SceneError`] of a value that no scene may have.
    pub fn levitated_by(&mut self, caller: Caller) -> Result<(), SceneError> {
        let mut tables = self.tables.clone();
        let feed_forward_weight = tables.feeds_weight_forward()
            || tables.plane.iter().any(|plane| {
                (plane.levitation.as_ref()).is_some_and(|l| l.feed_forward_weight)
                    || (plane.biquads.as_ref()).is_some_and(|b| b.feed_forward_weight)
            });
        let written = tables.controller.take();
        for plane in &mut tables.plane {
            (plane.levitation, plane.biquads) = (None, None);
        }
        (tables.levitation, tables.state_space, tables.biquads) = (None, None, None);
        tables.controller = Some(ControllerTable {
            python: None,
            library: None,
            feed_forward_weight,
            ..written.unwrap_or_default()
        });
        self.caller = Some(caller);
        self.set_tables(tables);
        Ok(())
    }
}

/// The controller of the user's in a scene of these planes, where it names one.
pub(crate) fn own_controller(
    tables: &SceneTables,
    text: &SceneText,
    planes: &[PlaneSpec],
) -> Result<Option<WholeLevitationParams>, SceneError> {
    let filters = planes.iter().any(|plane| plane.tables.biquads.is_some());
    let filters = filters.then_some("biquads");
    let mut own = tables.own_of_the_whole().chain(filters);
    let Some(table) = own.next() else {
        return Ok(None);
    };
    let gains = planes.iter().find(|p| p.tables.levitation.is_some());
    let other = match gains {
        Some(plane) => Some((&plane.text, "levitation")),
        None => own.next().map(|other| (text, other)),
    };
    if let Some((text, other)) = other {
        let message = format!("does not go with [{table}], which stands in its place");
        return Err(text.error_at_key(other, message, Some("remove one of them".to_owned())));
    }
    let caps_n: Vec<Option<f64>> = (planes.iter())
        .map(|plane| Some(plane.tables.magnet.as_ref()?.force_max_n))
        .collect();
    if let Some(written) = &tables.controller {
        let period_s = 1.0 / tables.run.sample_rate_hz;
        let caller = planes.iter().find_map(|plane| plane.caller.as_ref());
        let own = match caller {
            Some(caller) => of_caller(written, caller, period_s, caps_n),
            None => external(written, text, period_s, caps_n)?,
        };
        return Ok(Some(WholeLevitationParams::External(own)));
    }
    Ok(match state_space(tables, text, caps_n)? {
        Some(own) => Some(WholeLevitationParams::StateSpace(own)),
        None => Some(WholeLevitationParams::Biquads(biquads(planes)?)),
    })
}
