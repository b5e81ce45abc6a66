//! A whole rotor in several planes: against the point mass, closed forms and an independent code, and at its limits.

mod bearing;
mod changes;
mod closed_forms;
mod cost;
mod degenerate;
mod extremes;
mod linear;
mod matrices;
mod poles;
mod reference;
mod refusals;
mod rotor;
mod seals;
mod shaft;
mod silently_wrong;
mod starts;
mod whirl_ranges;
