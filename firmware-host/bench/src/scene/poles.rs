//! Magnets with poles.

use crate::scene::diagnostic::{SceneError, SceneText};
use crate::scene::tables::MagnetTable;
use plant_model::machine::params::{Coil, Poles};

/// Poles of a magnet, where it has them.
pub(crate) fn poles(magnet: &MagnetTable, text: &SceneText) -> Result<Option<Poles>, SceneError> {
    let Some(written) = &magnet.poles else {
        return Ok(None);
    };
    let of_poles = [(
        "magnet.negative_stiffness_n_m",
        magnet.negative_stiffness_n_m > 0.0,
    )];
    text.none_given(&of_poles, "follows from magnet.poles", "remove it")?;
    let coil = match (written.inductance_h, written.voltage_max_v) {
        (Some(inductance_h), Some(voltage_max_v)) => Some(Coil {
            inductance_h,
            resistance_ohm: written.resistance_ohm.unwrap_or(0.0),
            voltage_max_v,
        }),
        (None, None) => None,
        (given, _) => {
            let (has, lacks) = match given {
                Some(_) => ("inductance_h", "voltage_max_v"),
                None => ("voltage_max_v", "inductance_h"),
            };
            let message = format!("needs magnet.poles.{lacks}");
            let help = "give both, or none: the current then follows its command with magnet.lag_s";
            let key = format!("magnet.poles.{has}");
            return Err(text.error_at_key(&key, message, Some(help.to_owned())));
        }
    };
    if coil.is_none() {
        let alone = [(
            "magnet.poles.resistance_ohm",
            written.resistance_ohm.is_some(),
        )];
        text.none_given(
            &alone,
            "needs magnet.poles.inductance_h",
            "give it, or remove this",
        )?;
    }
    Ok(Some(Poles {
        bias_current_a: written.bias_current_a,
        current_max_a: written.current_max_a.unwrap_or(written.bias_current_a),
        air_gap_m: written.air_gap_m,
        coil,
    }))
}
