//! A retainer bearing as it is: drag by load, and heat.

use crate::scene::tables::SceneTables;
use plant_model::machine::params::{BearingHeat, LoadDrag};
use std::f64::consts::TAU;

/// Drag by load of the race.
pub(crate) fn load_drag(tables: &SceneTables) -> Option<LoadDrag> {
    let race = tables.race.as_ref()?;
    Some(LoadDrag {
        arm_m: race.load_drag_m?,
        still_rad_s: race.load_drag_from_hz * TAU,
    })
}

/// Heat of the bearing.
pub(crate) fn heat(tables: &SceneTables) -> Option<BearingHeat> {
    let heat = tables.retainer.heat.as_ref()?;
    Some(BearingHeat {
        capacity_j_k: heat.capacity_j_k,
        conductance_w_k: heat.conductance_w_k,
        expansion_m_k: heat.expansion_m_k,
        start_rise_k: heat.start_rise_k,
    })
}
