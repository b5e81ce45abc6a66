//! How time passes: exact flight, a high-order explicit pair in contact, events between them.

pub(crate) mod contact_step;
pub(crate) mod dop853;
pub(crate) mod driver;
pub(crate) mod flight;
