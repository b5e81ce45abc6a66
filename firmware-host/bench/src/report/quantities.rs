//! Charts over time: which columns of a track they draw, and how their axes are laid out.

use std::borrow::Cow;

use plotters::style::RGBColor;

use crate::report::plot::TOUCHING;
use crate::report::plot::thin::Interval;
use crate::report::track::{Track, bending_name};

/// Columns over time, to be drawn with shared axes.
#[derive(Clone)]
pub(super) struct Chart {
    pub(super) heading: &'static str,
    pub(super) note: &'static str,
    symbol: &'static str,
    unit: Unit,
    pub(super) lines: Cow<'static, [Line]>,
    pub(super) limit: Option<Limit>,
    /// Whether a whirling run may have an axis of its own.
    pub(super) own_scale: bool,
    /// Values that the axis shows whatever the data are.
    pub(super) always: &'static [f64],
}

/// What the values of a chart are counted in.
#[derive(Clone, Copy)]
enum Unit {
    /// That of lengths of the track.
    Length,
    /// That of forces of the track.
    Force,
    Fixed(&'static str),
}

/// A dashed line, by its name in [`Track::limits`].
#[derive(Clone, Copy)]
pub(super) struct Limit {
    pub(super) name: &'static str,
    /// Further out than this many times the data it stays off the axis.
    reach: f64,
}

/// One line of a chart: a column of the track, by its name.
#[derive(Clone)]
pub(super) struct Line {
    pub(super) column: Cow<'static, str>,
    pub(super) colour: RGBColor,
}

const DARK: RGBColor = RGBColor(0x24, 0x4f, 0x7d);
const PALE: RGBColor = RGBColor(0xe0, 0x9b, 0x2d);

const fn line(column: &'static str, colour: RGBColor) -> Line {
    Line {
        column: Cow::Borrowed(column),
        colour,
    }
}

/// Position along both axes.
pub(super) const POSITION: Chart = Chart {
    heading: "Position",
    note: "Of a record as it was measured.",
    symbol: "x, y",
    unit: Unit::Length,
    lines: Cow::Borrowed(&[line("x", DARK), line("y", PALE)]),
    limit: None,
    own_scale: false,
    always: &[],
};

/// Distance of the rotor from the centre of the ring.
pub(super) const RADIUS: Chart = Chart {
    heading: "Radius",
    note: "Rotor against the centre of the inner ring.",
    symbol: "r",
    unit: Unit::Length,
    lines: Cow::Borrowed(&[line("r", DARK), line("largest r", PALE)]),
    limit: Some(Limit {
        name: "clearance",
        reach: f64::INFINITY,
    }),
    own_scale: true,
    always: &[0.0],
};

/// Normal force of the contact.
pub(super) const CONTACT_FORCE: Chart = Chart {
    heading: "Contact force",
    note: "Normal force at the samples and changes of mode; the table has the peaks in between.",
    symbol: "f_n",
    unit: Unit::Force,
    lines: Cow::Borrowed(&[line("normal force", TOUCHING)]),
    limit: None,
    own_scale: true,
    always: &[0.0, 1.0],
};

/// What the policy wants and what the magnet gives.
pub(super) const CONTROL_FORCE: Chart = Chart {
    heading: "Control force",
    note: "Magnitudes of the force that the policy commands and of the one that the magnet delivers.",
    symbol: "|F|",
    unit: Unit::Force,
    lines: Cow::Borrowed(&[
        line("commanded", PALE),
        line("delivered", DARK),
        line("largest command", PALE),
    ]),
    limit: Some(Limit {
        name: "force cap",
        reach: f64::INFINITY,
    }),
    own_scale: true,
    always: &[0.0, 1.0],
};

/// What was commanded along both axes.
pub(super) const FORCE_COMPONENTS: Chart = Chart {
    heading: "Commanded force along the axes",
    note: "",
    symbol: "F",
    unit: Unit::Force,
    lines: Cow::Borrowed(&[line("F_x", DARK), line("F_y", PALE)]),
    limit: None,
    own_scale: false,
    always: &[0.0, 1.0],
};

/// Speed of the whirl.
pub(super) const TANGENTIAL_SPEED: Chart = Chart {
    heading: "Tangential speed",
    note: "Rotor about the centre of the inner ring, counter-clockwise positive: whirl with the sign \
           of the dashed limit is backward. It counts against the limit in contact only. The limit is drawn \
           where it is near.",
    symbol: "v_t",
    unit: Unit::Fixed("(m/s)"),
    lines: Cow::Borrowed(&[line("v_t", DARK)]),
    limit: Some(Limit {
        name: "counts as whirl",
        reach: 4.0,
    }),
    own_scale: true,
    always: &[-1e-3, 1e-3],
};

/// How hard a slow track has the contacts to be.
pub(super) const SEVERITY: Chart = Chart {
    heading: "Severity",
    note: "",
    symbol: "severity",
    unit: Unit::Fixed("1"),
    lines: Cow::Borrowed(&[line("largest severity", TOUCHING)]),
    limit: None,
    own_scale: false,
    always: &[0.0, 1.0],
};

/// How much of a slow track is contact.
pub(super) const CONTACT_SHARE: Chart = Chart {
    heading: "Time in contact",
    note: "Of each stretch of the slow track.",
    symbol: "share",
    unit: Unit::Fixed("%"),
    lines: Cow::Borrowed(&[line("in contact", TOUCHING)]),
    limit: None,
    own_scale: false,
    always: &[0.0, 100.0],
};

/// Spin of the rotor.
pub(super) const SPIN: Chart = Chart {
    heading: "Spin",
    note: "The axis need not begin at zero.",
    symbol: "spin",
    unit: Unit::Fixed("Hz"),
    lines: Cow::Borrowed(&[line("spin", DARK)]),
    limit: None,
    own_scale: false,
    always: &[],
};

/// Slope of a whole rotor's axis.
pub(super) const SLOPE: Chart = Chart {
    heading: "Slope",
    note: "",
    symbol: "slope",
    unit: Unit::Fixed("mrad"),
    lines: Cow::Borrowed(&[line("dx/dz", DARK), line("dy/dz", PALE)]),
    limit: None,
    own_scale: false,
    always: &[],
};

/// Energy of a whole rotor's bending.
pub(super) const BENDING_ENERGY: Chart = Chart {
    heading: "Bending energy",
    note: "",
    symbol: "energy",
    unit: Unit::Fixed("J"),
    lines: Cow::Borrowed(&[line("bending energy", DARK)]),
    limit: None,
    own_scale: false,
    always: &[0.0],
};

/// Amplitudes of the bending modes of a whole rotor.
pub(super) fn bending(modes: usize) -> Chart {
    const COLOURS: [RGBColor; 6] = [
        DARK,
        PALE,
        TOUCHING,
        RGBColor(0x3a, 0x8f, 0x5c),
        RGBColor(0x7a, 0x4f, 0xb5),
        RGBColor(0x4a, 0x52, 0x5c),
    ];
    let line = |mode: usize| Line {
        column: bending_name(mode),
        colour: COLOURS[mode % COLOURS.len()],
    };
    Chart {
        heading: "Bending",
        note: "",
        symbol: "amplitude",
        unit: Unit::Fixed("µm"),
        lines: (0..modes).map(line).collect(),
        limit: None,
        own_scale: false,
        always: &[0.0],
    }
}

impl Chart {
    /// Name and unit of the vertical axis.
    pub(super) fn y_name(&self, track: &Track) -> String {
        let unit = match self.unit {
            Unit::Length => track.units.length,
            Unit::Force => track.units.force,
            Unit::Fixed(unit) => unit,
        };
        format!("{} / {unit}", self.symbol)
    }

    /// Its lines of a track, each with its values.
    pub(super) fn lines_of<'a>(
        &'a self,
        track: &'a Track,
    ) -> impl Iterator<Item = (&'a Line, &'a [f64])> {
        (self.lines.iter()).filter_map(|line| Some((line, track.column(&line.column)?)))
    }

    /// Whether a track has any of its columns.
    pub(super) fn is_of(&self, track: &Track) -> bool {
        self.lines_of(track).next().is_some()
    }

    /// Place of the limit, where it can be drawn.
    pub(super) fn limit_at(&self, track: &Track) -> Option<f64> {
        track.limit(self.limit.as_ref()?.name)
    }

    /// What the axis has to show of a track.
    pub(super) fn range(&self, track: &Track, window: Interval) -> Interval {
        let visible = |values: &[f64]| {
            let pairs = track.t.iter().zip(values);
            let inside = pairs.filter(|(t, _)| window.contains(**t));
            Interval::of(inside.map(|(_, value)| *value))
        };
        let lines = self
            .lines_of(track)
            .filter_map(|(_, values)| visible(values));
        let range = (lines.chain(Interval::of(self.always.iter().copied()))).reduce(Interval::with);
        let range = range.unwrap_or(Interval { lo: 0.0, hi: 1.0 });
        // The smallest positive number keeps an infinite reach times zero from being no number.
        let size = range.magnitude().max(f64::MIN_POSITIVE);
        let reach = self.limit.as_ref().map_or(0.0, |limit| limit.reach * size);
        match self.limit_at(track) {
            Some(at) if at.abs() <= reach => range.with(Interval { lo: at, hi: at }),
            _ => range,
        }
    }
}
