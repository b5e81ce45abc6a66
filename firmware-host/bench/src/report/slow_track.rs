//! The slow track of a flight record over time: it goes on to the end of the event, when the fast window is long over.

use super::plot::thin::{Band, Interval};
use super::track::{SUPERVISOR_MODES, Track, TrackUnits};
use crate::record::file::PlaneRecord;
use crate::record::unknown::{has_mode, is_unseen};
use supervisor::Stretch;

impl Track {
    /// Of each stretch of ticks the largest radius, force and severity, and the share of it in contact, where a reading carried
    /// them. `None` where the record has no stretch.
    pub fn of_stretches(name: &str, record: &PlaneRecord) -> Option<Self> {
        let units = record.units();
        let (names, [ms, mm, newtons]) = TrackUnits::of(units);
        let mut track = Self::new(name, names);
        let mut columns = [(); 4].map(|()| Vec::new());
        for (stretch, [from, end]) in record.stretches() {
            let number = |bits: u32| record.number(bits);
            let count = f64::from(stretch.ticks.max(1));
            // What cannot be drawn is left out.
            let seen = |value: f64| if is_unseen(stretch) { f64::NAN } else { value };
            let values = [
                seen(mm * number(stretch.radius_square).sqrt()),
                newtons * number(stretch.force_square).sqrt(),
                seen(number(stretch.severity)),
                seen(100.0 * f64::from(stretch.contact_ticks) / count),
            ];
            let span = Interval {
                lo: ms * from as f64,
                hi: ms * end as f64,
            };
            // It holds from its first to its last tick: a step.
            track.t.extend([span.lo, span.hi]);
            for (column, value) in columns.iter_mut().zip(values) {
                column.extend([value; 2]);
            }
            let Some(class) = only_mode(stretch) else {
                continue;
            };
            match track.supervisor.last_mut() {
                Some(last) if last.class == class && last.span.hi == span.lo => {
                    last.span.hi = span.hi;
                }
                _ => track.supervisor.push(Band { class, span }),
            }
        }
        let names = [
            "largest r",
            "largest command",
            "largest severity",
            "in contact",
        ];
        track.columns = (names.into_iter().zip(columns))
            .map(|(name, values)| (name.into(), values))
            .collect();
        track.limits = vec![("clearance", mm), ("force cap", newtons)];
        (!track.t.is_empty()).then_some(track)
    }
}

/// The mode of a stretch that has one: where it has several, none says when which was.
fn only_mode(stretch: &Stretch) -> Option<usize> {
    let mut there =
        (SUPERVISOR_MODES.iter().enumerate()).filter(|(_, (mode, _))| has_mode(stretch, *mode));
    let (class, _) = there.next()?;
    there.next().is_none().then_some(class)
}
