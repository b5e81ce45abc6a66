//! One step of several runs that are in the same mode, compiled for each set of instructions.

use super::contact::contact;
use super::flight::{beyond, flight};
use super::group::{Accuracy, Group, Kind, Rows};
use pulp::{Simd, WithSimd};

/// A step of a group.
pub(super) struct Task<'a> {
    pub(super) accuracy: &'a Accuracy,
    pub(super) rows: &'a mut Rows,
    pub(super) group: &'a mut Group,
}

/// Compiled for each set of instructions. Nothing in it says which: the compiler puts the arrays into what registers there are.
impl WithSimd for Task<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            accuracy,
            rows,
            group,
        } = self;
        match group.kind {
            Kind::Flight => flight(accuracy, rows, group),
            Kind::Beyond => beyond(accuracy, rows, group),
            Kind::Slip => contact::<false>(accuracy, rows, group),
            Kind::Roll => contact::<true>(accuracy, rows, group),
        }
    }
}
