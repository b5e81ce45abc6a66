//! The rotor of the example (`supervisor/capi/examples/rig.c`) in Rust: the same integers, and floats
//! only where they are exact.

use supervisor::{Command, Config, Events, PARAMETERS, Sample, Status};

pub(crate) struct Rig {
    pub(crate) tick: u32,
    sequence: u32,
    position: [i32; 2],
    velocity: [i32; 2],
    force: [i32; 2],
    /// FNV-1a over all commands.
    pub(crate) hash: u32,
    pub(crate) modes: u32,
    pub(crate) events: Events,
}

/// Step of the converter.
const STEP: i32 = 4096;
const STEP_M: f32 = 1.0 / 268_435_456.0;
const CLEARANCE: i64 = 53_687;
const ACCELERATION: i32 = 17;

impl Rig {
    pub(crate) const TICKS: u32 = 4400;

    /// Its configuration at start, as the example has it; what that leaves out is 0.
    pub(crate) fn config() -> Config {
        let source = include_str!("../../../supervisor/capi/examples/rig.c");
        let mut values = PARAMETERS.iter().map(|parameter| {
            let element = format!("[AMB_P_{}] = ", parameter.name.to_uppercase());
            let found = source.split_once(&element);
            found.map_or(0.0, |(_, rest)| {
                let (value, _) = rest.split_once("f,").unwrap();
                value.parse().unwrap()
            })
        });
        Config::from_values([(); PARAMETERS.len()].map(|()| values.next().unwrap()))
    }

    pub(crate) fn new() -> Self {
        Self {
            tick: 0,
            sequence: 0,
            position: [0; 2],
            velocity: [0; 2],
            force: [0; 2],
            hash: 2_166_136_261,
            modes: 0,
            events: Events::empty(),
        }
    }

    /// The configuration that is to hold from this tick on, if it is another.
    pub(crate) fn reconfigures(&self) -> Option<Config> {
        (self.tick == 2600).then_some(Config {
            force_max_n: 900.0,
            handover_dwell_s: 5e-4,
            ..Self::config()
        })
    }

    pub(crate) fn sample(&mut self) -> Sample {
        self.sequence += match self.tick {
            3000 => 0,
            3010 => 4,
            _ => 1,
        };
        let mut status = Status::empty();
        status.set(Status::BEARING_ON, self.tick >= 50);
        status.set(Status::SPIN_VALID, self.tick >= 100);
        status.set(Status::APPLIED_VALID, self.tick >= 3020);
        status.set(Status::AXIS_Y_LOST, (3040..3300).contains(&self.tick));
        status.set(Status::LATE, self.tick == 320);
        status.set(Status::SHADOW, (3590..3640).contains(&self.tick));
        let levitation = |axis: usize| -self.position[axis] / 34360 - self.velocity[axis] / 549;
        let mut position_m = self.position.map(|p| (p / STEP) as f32 * STEP_M);
        if (2000..2030).contains(&self.tick) {
            position_m[0] = 1.0;
        }
        Sample {
            sequence: self.sequence,
            status,
            position_m,
            spin_rad_s: 1000.0,
            levitation_n: [0, 1].map(|axis| levitation(axis) as f32 / 16.0),
            applied_n: self.force.map(|f| f as f32 / 16.0),
        }
    }

    fn hash(&mut self, word: u32) {
        for byte in word.to_le_bytes() {
            self.hash = (self.hash ^ u32::from(byte)).wrapping_mul(16_777_619);
        }
    }

    fn contact(&self) -> [i32; 2] {
        let [x, y] = self.position.map(|p| i64::from(p / STEP));
        let [v_x, v_y] = self.velocity.map(i64::from);
        let radius = (x * x + y * y).isqrt();
        if radius <= CLEARANCE {
            return [0; 2];
        }
        let mut normal = (radius - CLEARANCE) * 12;
        if x * v_x + y * v_y < 0 {
            normal /= 2;
        }
        let friction = normal * 3 / 20;
        let along_x = (-normal * x + friction * y) / radius;
        let along_y = (-normal * y - friction * x) / radius;
        [along_x as i32, along_y as i32]
    }

    pub(crate) fn actuate(&mut self, command: &Command) {
        self.hash(command.force_n[0].to_bits());
        self.hash(command.force_n[1].to_bits());
        self.hash(command.own_n[0].to_bits());
        self.hash(command.own_n[1].to_bits());
        self.hash(command.severity.to_bits());
        self.hash(command.mode as u32);
        self.hash(command.limits.bits());
        self.hash((command.events - Events::RECORD_FROZEN).bits());
        self.hash(command.integrator as u32);
        self.modes |= 1 << command.mode as u32;
        self.events |= command.events;

        let contact = self.contact();
        if self.tick == 200 {
            self.velocity[0] += 32_000_000;
            self.velocity[1] -= 34_000_000;
        }
        if self.tick == 3100 {
            self.velocity[0] -= 12_000_000;
            self.velocity[1] += 16_000_000;
        }
        if self.tick == 3600 {
            self.velocity[0] += 20_000_000;
            self.velocity[1] += 20_000_000;
        }
        for (axis, contact) in contact.into_iter().enumerate() {
            self.velocity[axis] += ACCELERATION * (self.force[axis] + contact);
            self.position[axis] += self.velocity[axis];
            self.force[axis] = (command.force_n[axis] * 16.0) as i32;
        }
        self.tick += 1;
    }
}
