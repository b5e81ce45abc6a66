//! Any bits as samples of a bearing: in SI and in fixed point every command is finite, within the cap, the caps of the
//! axes and the slew limit, and nothing is commanded on a lost axis.

#![no_main]

use fuzz::{Bytes, plausible};
use libfuzzer_sys::fuzz_target;
use supervisor::{Config, Core, CoreSample, Prepared, Q, Sample, Scalar, Status, Supervisor};

/// What the conversion from newtons cannot tell from zero it lets through \[caps\].
const NOTHING: f64 = f32::MIN_POSITIVE as f64;

/// What a force may be \[caps\], and by how much rounding may exceed it.
struct Bounds {
    axis: f64,
    slew: f64,
    rounding: f64,
    last: [f64; 2],
}

impl Bounds {
    fn check(&mut self, force: [f64; 2], status: Status) {
        let lost = [Status::AXIS_X_LOST, Status::AXIS_Y_LOST].map(|axis| status.contains(axis));
        let mut change = [0.0; 2];
        for n in 0..2 {
            assert!(force[n].is_finite());
            assert!(
                force[n].abs() <= self.axis + self.rounding,
                "axis: {force:?}"
            );
            assert!(!lost[n] || force[n].abs() < NOTHING, "lost: {force:?}");
            if !lost[n] {
                change[n] = force[n] - self.last[n];
            }
        }
        assert!(
            f64::hypot(force[0], force[1]) <= 1.0 + self.rounding,
            "cap: {force:?}"
        );
        let way = f64::hypot(change[0], change[1]);
        assert!(
            way <= self.slew + self.rounding,
            "slew: {:?} to {force:?}",
            self.last
        );
        self.last = force;
    }
}

fuzz_target!(|data: &[u8]| {
    let mut bytes = Bytes::new(data);
    let share = |byte: u8| (f32::from(byte) + 1.0) / 256.0;
    let bench = plausible();
    let config = Config {
        axis_force_max_n: bench.force_max_n * 1.5 * share(bytes.u8()),
        force_slew_n_s: bench.force_max_n / bench.sample_period_s
            * (3e-3 + 3.0 * share(bytes.u8()).powi(2)),
        continuous_force_n: bench.force_max_n * 1.2 * share(bytes.u8()),
        thermal_time_s: 0.01 + share(bytes.u8()),
        delay_samples: f32::from(bytes.u8() % 8),
        observer_pole_flight: 0.98 * share(bytes.u8()),
        ..bench
    };
    let cap = f64::from(config.force_max_n);
    let bounds = |rounding| Bounds {
        axis: f64::from(config.axis_force_max_n).min(cap) / cap,
        slew: f64::from(config.force_slew_n_s) * f64::from(config.sample_period_s) / cap,
        rounding,
        last: [0.0; 2],
    };
    // Some units in the last place of coefficients, of forces and of their conversion.
    let (mut single, mut fixed) = (bounds(1e-6), bounds(2e-6));
    let mut supervisor = Supervisor::<16>::new(&config).expect("in range");
    // Not every bearing fits: one whose axes are too weak to stop any whirl does not.
    let mut core = Prepared::new(&config)
        .map(|prepared| Core::<Q, 16>::new(&prepared))
        .ok();
    let mut sequence = 0_u32;
    let mut angle = 0.0_f32;
    while bytes.left() > 0 {
        // A whirl on the wall that the input disturbs: without it hardly a sample would be believed.
        angle = (angle + 0.1) % std::f32::consts::TAU;
        let radius = config.clearance_m * 1.01;
        let what = bytes.u8();
        sequence = sequence.wrapping_add(if what & 1 == 0 { 1 } else { bytes.u32() });
        let mut sample = Sample {
            sequence,
            status: Status::SPIN_VALID | Status::BEARING_ON,
            position_m: [radius * angle.cos(), radius * angle.sin()],
            spin_rad_s: -1000.0,
            ..Sample::default()
        };
        if what & 2 != 0 {
            sample.status = Status::from_bits_retain(bytes.u32());
        }
        let mut numbers = |bit: u8, v: &mut [f32; 2], scale: f32| match (what >> bit) & 3 {
            0 => {}
            1 => *v = [0; 2].map(|_| f32::from_bits(bytes.u32())),
            _ => *v = [0; 2].map(|_| scale * f32::from(bytes.u8() as i8) / 64.0),
        };
        numbers(2, &mut sample.position_m, config.clearance_m);
        numbers(4, &mut sample.levitation_n, config.force_max_n);
        numbers(6, &mut sample.applied_n, config.force_max_n);
        let command = supervisor.tick(&sample);
        assert!(command.severity.is_finite() && command.severity >= 0.0);
        single.check(command.force_n.map(|f| f64::from(f) / cap), sample.status);

        if let Some(core) = &mut core {
            let scaling = config.scaling();
            let q = |v: [f32; 2], per: f32| v.map(|x| Q::from_f32(x * per));
            let command = core.tick(&CoreSample {
                sequence,
                status: sample.status,
                position: q(sample.position_m, scaling.position_per_m),
                spin: Q::from_f32(sample.spin_rad_s * scaling.time_s),
                levitation: q(sample.levitation_n, scaling.force_per_n),
                applied: q(sample.applied_n, scaling.force_per_n),
            });
            fixed.check(command.force.map(|f| f64::from(f.to_f32())), sample.status);
        }
        while supervisor.next_event().is_some() {}
    }
    let report = supervisor.report();
    assert!(report.severity_index.is_finite() && report.thermal_state.is_finite());
});
