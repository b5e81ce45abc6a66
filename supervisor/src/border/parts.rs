//! Parts that firmware of a machine which has no use for them leaves out, by features of the crate: what is not linked costs no
//! instructions and no flash. All are there unless a build says otherwise.

/// A load that turns with the rotor is told from one that stands still. Without it a bearing whose unbalance pulls with some tenths
/// of the cap is engaged for a load that is none.
pub(crate) const UNBALANCE: bool = cfg!(feature = "unbalance");
/// A drive that does not do what it is told is found, where its force is measured.
pub(crate) const AXIS_MONITOR: bool = cfg!(feature = "axis-monitor");
/// The cap falls to what the magnet bears for ever. Without it a configuration that asks for that is refused.
pub(crate) const THERMAL_BUDGET: bool = cfg!(feature = "thermal-budget");
/// Bending modes may be told, so that the force does not drive them. Without it a configuration that tells one is refused.
pub(crate) const BENDING: bool = cfg!(feature = "bending");

/// The machine is held against its configuration before the supervisor acts. Without it a configuration that asks for that is
/// refused.
pub(crate) const CHECK: bool = cfg!(feature = "check");

/// Nothing of what a tick does is left out.
pub(crate) const ALL: bool = UNBALANCE && AXIS_MONITOR && THERMAL_BUDGET && BENDING;

/// What is left out, a bit each.
pub(crate) const LEFT_OUT: u32 = !UNBALANCE as u32
    | (!AXIS_MONITOR as u32) << 1
    | (!THERMAL_BUDGET as u32) << 2
    | (!BENDING as u32) << 3;
