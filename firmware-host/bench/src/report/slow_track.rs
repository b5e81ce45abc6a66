//! The slow track of a flight record over time: it goes on to the end of the event, when the fast window is long over.

use super::plot::thin::{Band, Interval};
use super::track::{SUPERVISOR_MODES, Track, TrackUnits};
use crate::record::file::PlaneRecord;
use crate::record::ticks::Ticks;
use supervisor::Stretch;

impl Track {
    /// Of each stretch of ticks the largest radius, force and severity, and the share of it in contact; `ticks` are those of the
    /// record's fast window, from which times are counted. `None` where the record has no stretch.
    pub fn of_stretches(name: &str, record: &PlaneRecord, ticks: &Ticks) -> Option<Self> {
        let units = record.units();
        let (names, [ms, mm, newtons]) = TrackUnits::of(units);
        let mut track = Self::new(name, names);
        let mut columns = [(); 4].map(|()| Vec::new());
        for stretch in &record.track {
            let number = |bits: u32| record.number(bits);
            let count = f64::from(stretch.ticks.max(1));
            let values = [
                mm * number(stretch.radius_square).sqrt(),
                newtons * number(stretch.force_square).sqrt(),
                number(stretch.severity),
                100.0 * f64::from(stretch.contact_ticks) / count,
            ];
            let end = ticks.tick_of(stretch.sequence) + 1;
            let from = end - i64::from(stretch.ticks);
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
    let mut there = (SUPERVISOR_MODES.iter().enumerate())
        .filter(|(_, (mode, _))| stretch.modes & 1 << *mode as u16 != 0);
    let (class, _) = there.next()?;
    there.next().is_none().then_some(class)
}
