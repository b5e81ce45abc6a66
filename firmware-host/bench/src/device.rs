//! What stands between rotor and firmware: loads from outside, sensors and drives with their faults, the levitation controller.

pub mod actuator;
pub mod axis;
pub mod biquads;
pub mod external;
pub mod levitation;
pub mod loads;
pub mod loop_shape;
pub mod modal_levitation;
pub mod sensor;
pub mod sensor_fault;
pub mod state_space;
pub mod whole_levitation;
