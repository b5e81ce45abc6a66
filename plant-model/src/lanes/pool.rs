//! Many runs on their way: those in the same mode take their steps side by side, and one that ends makes room for the next.

use super::group::{Accuracy, Group, Kind, Rows};
use super::kernel::Task;
use super::number::WIDTH;
use super::slot::Slot;
use super::{Ended, Ending, Launch};
use crate::integrate::order_control::{flight_rtol, highest_order};
use pulp::Arch;

/// Runs on their way at once: as many in every mode as a step takes, and then some.
const SLOTS: usize = 6 * WIDTH;

/// Runs on their way.
pub(super) struct Pool<T> {
    arch: Arch,
    accuracy: Accuracy,
    slots: Vec<Slot<T>>,
    rows: Box<Rows>,
    group: Box<Group>,
}

impl<T> Pool<T> {
    pub(super) fn new(arch: Arch, rtol: f64) -> Self {
        let flight = flight_rtol(rtol);
        let accuracy = Accuracy {
            rtol: [flight, rtol],
            order: [highest_order(flight), highest_order(rtol)],
        };
        Self {
            arch,
            accuracy,
            slots: Vec::with_capacity(SLOTS),
            rows: Box::default(),
            group: Box::default(),
        }
    }

    /// Runs everything. A run that has ended may be followed by another.
    pub(super) fn run(
        &mut self,
        mut waiting: impl Iterator<Item = (Launch, T)>,
        mut next: impl FnMut(T, Ended) -> Option<(Launch, T)>,
    ) {
        let mut endings: Vec<(usize, Ending)> = Vec::new();
        loop {
            while self.slots.len() < SLOTS
                && let Some((launch, tag)) = waiting.next()
            {
                self.slots.push(Slot::new(launch, tag));
            }
            if self.slots.is_empty() {
                return;
            }
            let (lanes, count) = self.choose();
            self.step(&lanes[..count], &mut endings);
            // From the last place on, so that places before it stay.
            endings.sort_unstable_by_key(|(place, _)| std::cmp::Reverse(*place));
            for (place, ending) in endings.drain(..) {
                let (tag, ended) = self.slots.swap_remove(place).ended(ending);
                if let Some((launch, tag)) = next(tag, ended) {
                    self.slots.push(Slot::new(launch, tag));
                }
            }
        }
    }

    /// Places of runs in the mode that most are in, as many as a step takes.
    fn choose(&self) -> ([usize; WIDTH], usize) {
        let mut counts = [0_usize; 4];
        for slot in &self.slots {
            counts[slot.kind() as usize] += 1;
        }
        let kind = [Kind::Flight, Kind::Beyond, Kind::Slip, Kind::Roll]
            .into_iter()
            .max_by_key(|kind| counts[*kind as usize])
            .unwrap_or(Kind::Flight);
        let (mut lanes, mut count) = ([0; WIDTH], 0);
        for (place, slot) in self.slots.iter().enumerate() {
            if slot.kind() == kind && count < WIDTH {
                lanes[count] = place;
                count += 1;
            }
        }
        (lanes, count)
    }

    fn step(&mut self, places: &[usize], endings: &mut Vec<(usize, Ending)>) {
        let Some(first) = places.first() else { return };
        let (group, slots) = (&mut *self.group, &mut self.slots);
        group.kind = slots[*first].kind();
        group.unbalanced = false;
        group.watched = false;
        for lane in 0..WIDTH {
            // Lanes to spare do what the first one does.
            slots[*places.get(lane).unwrap_or(first)].enter(group, lane);
        }
        self.arch.dispatch(Task {
            accuracy: &self.accuracy,
            rows: &mut self.rows,
            group,
        });
        let order = self.accuracy.order[1];
        for (lane, place) in places.iter().enumerate() {
            if let Some(ending) = slots[*place].leave(group, (&self.rows, order), lane) {
                endings.push((*place, ending));
            }
        }
    }
}
