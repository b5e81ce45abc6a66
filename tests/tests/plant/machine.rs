//! A whole rotor in several planes: against the point mass, closed forms and an independent code, and at its limits.

mod closed_forms;
mod degenerate;
mod extremes;
mod reference;
mod refusals;
mod rotor;
mod silently_wrong;
