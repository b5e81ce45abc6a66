//! Stiff and extreme plants: every case states the physics that it must show, with the methods that
//! share nothing but the equations.

mod bench;
mod extreme;
mod stiff;
