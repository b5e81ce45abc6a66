//! Any bits as a configuration: refused with a reason, or a supervisor that works. First which of
//! the parameters do not keep a plausible value, so that the search does not have to find all ranges at once, then these.

#![no_main]

use fuzz::{Bytes, plausible};
use libfuzzer_sys::fuzz_target;
use supervisor::{
    Config, Core, CoreError, CoreSample, PARAMETERS, Prepared, Q, Scalar, Status, Supervisor,
};

fn in_numbers<S: Scalar>(config: &Config, holds_all: bool) {
    match Prepared::<S>::new(config) {
        Ok(prepared) => {
            assert!(config.validate().is_ok());
            let mut core = Core::<S, 16>::new(&prepared);
            for i in 0..20_u32 {
                let command = core.tick(&CoreSample {
                    sequence: i,
                    status: Status::SPIN_VALID | Status::BEARING_ON,
                    position: [S::from_f32(0.2 * i as f32), S::from_f32(0.1)],
                    spin: S::ONE,
                    levitation: [S::ONE, S::ONE],
                    ..CoreSample::default()
                });
                for force in command.force {
                    assert!(force.is_finite() && force.to_f32().abs() <= 1.000_001);
                }
            }
        }
        Err(CoreError::Range(error)) => {
            let refused = config.validate().expect_err("refused once");
            // The value may be NaN.
            assert_eq!(refused.index, error.index);
        }
        Err(CoreError::NotRepresentable(not_representable)) => {
            assert!(config.validate().is_ok());
            assert!(!holds_all, "{not_representable:?}");
        }
    }
}

fuzz_target!(|data: &[u8]| {
    let mut bytes = Bytes::new(data);
    let mut values = plausible().values();
    let replaced = u64::from(bytes.u32()) << 32 | u64::from(bytes.u32());
    for (i, value) in values.iter_mut().enumerate() {
        if replaced & (1 << i) != 0 {
            *value = f32::from_bits(bytes.u32());
        }
    }
    let config = Config::from_values(values);
    assert_eq!(values.map(f32::to_bits), config.values().map(f32::to_bits));
    let in_range = (PARAMETERS.iter().zip(values)).all(|(p, v)| v >= p.low && v <= p.high);
    assert_eq!(Supervisor::<16>::new(&config).is_ok(), in_range);
    in_numbers::<f32>(&config, true);
    in_numbers::<f64>(&config, true);
    in_numbers::<Q>(&config, false);
});
