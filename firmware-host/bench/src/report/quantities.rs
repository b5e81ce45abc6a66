//! Quantities over time: how each is read from a trace and how its axes are laid out.

use std::f64::consts::TAU;

use plant_model::V2;
use plotters::style::RGBColor;

use crate::report::plot::TOUCHING;
use crate::report::plot::thin::{Interval, drawable};
use crate::report::summary::SceneSummary;
use crate::run::trace::TraceRow;
use crate::run::verdict::PolicyRun;

/// A quantity over time, to be drawn with shared axes.
pub(super) struct Chart {
    pub(super) heading: &'static str,
    pub(super) note: &'static str,
    pub(super) y_name: &'static str,
    pub(super) lines: &'static [Quantity],
    pub(super) limit: Option<Limit>,
    /// Whether a whirling run may have an axis of its own.
    pub(super) own_scale: bool,
    /// Values that the axis shows whatever the data are.
    pub(super) always: &'static [f64],
}

/// A dashed line.
pub(super) struct Limit {
    pub(super) name: &'static str,
    /// Its place on the axis.
    at: fn(&SceneSummary, &PolicyRun) -> Option<f64>,
    /// Further out than this many times the data it stays off the axis.
    reach: f64,
}

/// One line of a chart.
pub(super) struct Quantity {
    pub(super) name: &'static str,
    pub(super) colour: RGBColor,
    pub(super) value: fn(&TraceRow) -> f64,
}

const DARK: RGBColor = RGBColor(0x24, 0x4f, 0x7d);
const PALE: RGBColor = RGBColor(0xe0, 0x9b, 0x2d);
/// Distance of the rotor from the centre of the ring.
pub(super) const RADIUS: Chart = Chart {
    heading: "Radius",
    note: "Rotor against the centre of the inner ring.",
    y_name: "r / mm",
    lines: &[Quantity {
        name: "r",
        colour: DARK,
        value: |row| 1e3 * radial(row).norm(),
    }],
    limit: Some(Limit {
        name: "clearance",
        at: |scene, _| Some(1e3 * scene.clearance_m),
        reach: f64::INFINITY,
    }),
    own_scale: true,
    always: &[0.0],
};

/// Normal force of the contact.
pub(super) const CONTACT_FORCE: Chart = Chart {
    heading: "Contact force",
    note: "Normal force at the samples and changes of mode; the table has the peaks in between.",
    y_name: "f_n / N",
    lines: &[Quantity {
        name: "normal force",
        colour: TOUCHING,
        value: |row| row.plant.normal_force_n,
    }],
    limit: None,
    own_scale: true,
    always: &[0.0, 1.0],
};

/// What the policy wants and what the magnet gives.
pub(super) const CONTROL_FORCE: Chart = Chart {
    heading: "Control force",
    note: "Magnitudes of the force that the policy commands and of the one that the magnet delivers.",
    y_name: "|F| / N",
    lines: &[
        Quantity {
            name: "commanded",
            colour: PALE,
            value: |row| row.commanded_n.norm(),
        },
        Quantity {
            name: "delivered",
            colour: DARK,
            value: |row| row.plant.delivered_n.norm(),
        },
    ],
    limit: Some(Limit {
        name: "force cap",
        at: |scene, _| scene.force_max_n,
        reach: f64::INFINITY,
    }),
    own_scale: true,
    always: &[0.0, 1.0],
};

/// Speed of the whirl.
pub(super) const TANGENTIAL_SPEED: Chart = Chart {
    heading: "Tangential speed",
    note: "Rotor about the centre of the inner ring, counter-clockwise positive: whirl with the sign \
           of the dashed limit is backward. It counts against the limit in contact only. The limit is drawn \
           where it is near.",
    y_name: "v_t / (m/s)",
    lines: &[Quantity {
        name: "v_t",
        colour: DARK,
        value: tangential_speed,
    }],
    limit: Some(Limit {
        name: "counts as whirl",
        at: backward_limit,
        reach: 4.0,
    }),
    own_scale: true,
    always: &[-1e-3, 1e-3],
};

/// Spin of the rotor.
pub(super) const SPIN: Chart = Chart {
    heading: "Spin",
    note: "The axis need not begin at zero.",
    y_name: "spin / Hz",
    lines: &[Quantity {
        name: "spin",
        colour: DARK,
        value: |row| row.plant.spin_rad_s / TAU,
    }],
    limit: None,
    own_scale: false,
    always: &[],
};

/// Rotor against the centre of the inner ring \[m\].
pub(super) fn radial(row: &TraceRow) -> V2 {
    row.plant.position_m - row.plant.inner_ring.position
}

fn tangential_speed(row: &TraceRow) -> f64 {
    let (r, v) = (
        radial(row),
        row.plant.velocity_m_s - row.plant.inner_ring.velocity,
    );
    // Exactly in the centre there is no direction to be tangential to.
    if r.norm() > 0.0 {
        r.perp(&v) / r.norm()
    } else {
        0.0
    }
}

/// Backward is against the spin that the run starts with; without spin, as if counter-clockwise.
fn backward_limit(scene: &SceneSummary, run: &PolicyRun) -> Option<f64> {
    let spin = run
        .trace
        .rows
        .first()
        .map_or(0.0, |row| row.plant.spin_rad_s);
    let limit = scene.whirl_speed_m_s.abs();
    Some(if spin < 0.0 { limit } else { -limit })
}

impl Chart {
    /// Place of the limit, where it can be drawn.
    pub(super) fn limit_at(&self, scene: &SceneSummary, run: &PolicyRun) -> Option<f64> {
        let limit = self.limit.as_ref()?;
        (limit.at)(scene, run).filter(|at| drawable(*at))
    }

    /// What the axis has to show of a run.
    pub(super) fn range(
        &self,
        scene: &SceneSummary,
        run: &PolicyRun,
        window: Interval,
    ) -> Interval {
        let rows = run.trace.rows.iter();
        let visible = rows.filter(|row| window.contains(1e3 * row.plant.t_s));
        let values = visible.flat_map(|row| self.lines.iter().map(|line| (line.value)(row)));
        let range = Interval::of(values.chain(self.always.iter().copied()));
        let range = range.unwrap_or(Interval { lo: 0.0, hi: 1.0 });
        // The smallest positive number keeps an infinite reach times zero from being no number.
        let size = range.magnitude().max(f64::MIN_POSITIVE);
        let reach = self.limit.as_ref().map_or(0.0, |limit| limit.reach * size);
        match self.limit_at(scene, run) {
            Some(at) if at.abs() <= reach => range.with(Interval { lo: at, hi: at }),
            _ => range,
        }
    }
}
