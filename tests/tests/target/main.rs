//! The Cortex-M images: sizes, bits, closed loops on emulated processors.

mod figures;
mod images;
mod loops;
mod vectors;
