//! What happens to a machine, written as keys of its scene: of a point mass as of a whole rotor.

use super::pair::Goal;
use crate::machines::draw::Draw;
use std::f64::consts::TAU;
use std::fmt::Write;
use toml::Value;

/// When it happens: by then the rotor levitates, and what turns with the spin has been there for long \[s\].
pub(crate) const BEGIN_S: f64 = 0.25;

/// What an event is measured by.
#[derive(Debug, Clone, Copy)]
pub struct Measures {
    /// Mass of the rotor \[kg\].
    pub mass_kg: f64,
    /// Clearance of a retainer bearing \[m\].
    pub clearance_m: f64,
    /// Cap of a magnet \[N\].
    pub force_n: f64,
    /// Spin \[Hz\].
    pub spin_hz: f64,
    /// Proportional gain of the levitation controller \[N/m\].
    pub proportional_n_m: f64,
    /// Whether weight pulls along −y.
    pub weighs: bool,
    /// Of a whole rotor.
    pub whole: Option<Whole>,
}

/// A rotor in two bearings.
#[derive(Debug, Clone, Copy)]
pub struct Whole {
    /// Distances of its ends from the centre of mass \[m\].
    pub ends_m: [f64; 2],
    /// Transverse inertia \[kg m²\].
    pub transverse_kg_m2: f64,
}

impl Measures {
    /// Mass that a magnet has to move \[kg\].
    fn moved_kg(&self) -> f64 {
        match self.whole {
            Some(_) => 0.5 * self.mass_kg,
            None => self.mass_kg,
        }
    }

    /// √(F·c/m) \[m/s\].
    fn unit_m_s(&self) -> f64 {
        (self.force_n * self.clearance_m / self.moved_kg()).sqrt()
    }

    /// √(m·c/F) \[s\].
    fn unit_s(&self) -> f64 {
        self.clearance_m / self.unit_m_s()
    }
}

/// Kinds of events.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Written {
    /// Nothing.
    Idle,
    /// A velocity of both ends alike, in percent of √(F·c/m).
    CentreBlow(u32),
    /// Of both ends against each other.
    ConicalBlow(u32),
    OneEndBlow(u32),
    /// A load in the middle for 20 ms, in percent of a magnet's cap.
    LoadInTheMiddle(u32),
    /// The same at an end.
    LoadAtOneEnd(u32),
    /// Magnets off for so many ms, which the firmware knows.
    Outage(u32),
    /// The first tick is at full spin, with unbalance and runout from the first sample.
    Restart,
    /// The same with a blow 0.6 s later.
    RestartThenBlow,
    /// The reference goes to 1.2 clearances, at a standstill or a slow spin.
    SetDown {
        /// Whether it turns, with 2 to 20 Hz.
        spins: bool,
        /// Whether the supervisor is informed.
        announced: bool,
    },
    /// A rotor at rest on its retainer bearing is lifted from the first tick on.
    LiftOff,
    /// Unbalance that begins suddenly, up to 1.5 caps.
    BladeLoss,
    /// Driven on to the wall at the spin for 15 turns, both ends alike or opposite, with unbalance.
    Rub {
        /// The ends opposite.
        conical: bool,
    },
    /// An overload under a quick integrator.
    WindUp,
    /// 0.5 to 0.95 caps for 0.1 to 1 s, in one direction or turning.
    LongLoad {
        /// With 5 to 100 Hz.
        turns: bool,
    },
    /// Power gone for 5 to 60 ms with a push, known; force measured or not.
    PowerDip {
        /// The force.
        measured: bool,
    },
}

/// How a scene is made to have an event.
#[derive(Debug, Clone)]
pub struct Keys {
    /// Tables to put behind the scene's.
    pub tables: String,
    /// Keys to set.
    pub set: Vec<(String, Value)>,
    /// Until when it lasts \[s\].
    pub end_s: f64,
    /// What counts as a recovery.
    pub goal: Goal,
}

/// A load on the rotor.
struct Load {
    start_s: f64,
    duration_s: f64,
    /// Along the direction, or the amplitude of what turns \[N\].
    force_n: f64,
    course: Course,
}

enum Course {
    /// A direction \[rad\].
    Along(f64),
    /// Turns with a rate \[Hz\] from an angle \[rad\].
    Turning(f64, f64),
}

impl Written {
    /// Name in tables.
    pub fn name(self) -> String {
        let by = |what: &str, percent: u32| format!("{what}, {percent} %");
        match self {
            Self::Idle => "nothing".to_owned(),
            Self::CentreBlow(percent) => by("blow at the centre", percent),
            Self::ConicalBlow(percent) => by("conical blow", percent),
            Self::OneEndBlow(percent) => by("blow at one end", percent),
            Self::LoadInTheMiddle(percent) => format!("load of {percent} % in the middle"),
            Self::LoadAtOneEnd(percent) => format!("load of {percent} % at one end"),
            Self::Outage(ms) => format!("power gone for {ms} ms"),
            Self::Restart => "restart at spin".to_owned(),
            Self::RestartThenBlow => "restart at spin, then a blow".to_owned(),
            Self::SetDown { spins, announced } => {
                let spin = if spins { "slow spin" } else { "standstill" };
                let known = if announced { "" } else { "not " };
                format!("set-down at {spin}, {known}announced")
            }
            Self::LiftOff => "lift-off".to_owned(),
            Self::BladeLoss => "blade loss".to_owned(),
            Self::Rub { conical: false } => "forward rub, cylindrical".to_owned(),
            Self::Rub { conical: true } => "forward rub, conical".to_owned(),
            Self::WindUp => "wind-up".to_owned(),
            Self::LongLoad { turns: false } => "long load".to_owned(),
            Self::LongLoad { turns: true } => "long load that turns".to_owned(),
            Self::PowerDip { measured: false } => "power dip".to_owned(),
            Self::PowerDip { measured: true } => "power dip, force measured".to_owned(),
        }
    }

    /// As keys of a machine's scene, as large as is drawn.
    pub fn keys(self, of: &Measures, draw: &mut Draw) -> Keys {
        let mut keys = Keys {
            tables: String::new(),
            set: Vec::new(),
            end_s: BEGIN_S,
            goal: Goal::Free,
        };
        let share = |percent: u32| 0.01 * f64::from(percent);
        match self {
            Self::Idle => {}
            Self::CentreBlow(percent) => keys.blow(of, BEGIN_S, [share(percent), 0.0]),
            Self::ConicalBlow(percent) => keys.blow(of, BEGIN_S, [0.0, share(percent)]),
            Self::OneEndBlow(percent) => keys.blow(of, BEGIN_S, [0.5 * share(percent); 2]),
            Self::LoadInTheMiddle(percent) => keys.overload(of, share(percent), false),
            Self::LoadAtOneEnd(percent) => keys.overload(of, share(percent), true),
            Self::Outage(ms) => keys.outage(1e-3 * f64::from(ms)),
            Self::Restart => keys.turn_unbalanced(of, draw),
            Self::RestartThenBlow => {
                keys.turn_unbalanced(of, draw);
                keys.blow(of, 0.6, [draw.between(0.7, 1.5), 0.0]);
            }
            Self::SetDown { spins, announced } => keys.set_down(of, draw, [spins, announced]),
            Self::LiftOff => {
                let angle = lowest(of, draw);
                let at = 1.0001 * of.clearance_m;
                let position = vec![at * angle.cos(), at * angle.sin()];
                keys.set("start.position_m", position);
                keys.set("spin.frequency_hz", 0.0);
            }
            Self::BladeLoss => keys.lose_blade(of, draw),
            Self::Rub { conical } => keys.rub(of, draw, conical),
            Self::WindUp => {
                keys.set("levitation.integral_n_m_s", 30.0 * of.proportional_n_m);
                let load = Load {
                    start_s: BEGIN_S,
                    duration_s: draw.between(0.1, 0.5),
                    force_n: of.force_n * draw.between(0.9, 1.4),
                    course: Course::Along(draw.angle_rad()),
                };
                keys.load(of, &load, [1.0; 2]);
            }
            Self::LongLoad { turns } => {
                let angle = draw.angle_rad();
                let load = Load {
                    start_s: BEGIN_S,
                    duration_s: draw.decades(0.1, 1.0),
                    force_n: of.force_n * draw.between(0.5, 0.95),
                    course: match turns {
                        true => Course::Turning(draw.decades(5.0, 100.0), angle),
                        false => Course::Along(angle),
                    },
                };
                keys.load(of, &load, [1.0; 2]);
            }
            Self::PowerDip { measured } => {
                keys.blow(of, BEGIN_S, [draw.between(0.2, 0.6), 0.0]);
                keys.outage(draw.decades(5e-3, 0.06));
                keys.of_each(of, "magnet.force_measured", measured);
            }
        }
        keys
    }
}

/// Where the rotor lies on its retainer bearing \[rad\]: below, or anywhere without weight.
fn lowest(of: &Measures, draw: &mut Draw) -> f64 {
    match of.weighs {
        true => -0.25 * TAU,
        false => draw.angle_rad(),
    }
}

impl Keys {
    fn set(&mut self, key: &str, value: impl Into<Value>) {
        self.set.push((key.to_owned(), value.into()));
    }

    /// Of the only plane, or of each with a magnet.
    fn of_each(&mut self, of: &Measures, key: &str, value: impl Into<Value>) {
        let value = value.into();
        match of.whole {
            None => self.set(key, value),
            Some(_) => {
                self.set(&format!("plane[0].{key}"), value.clone());
                self.set(&format!("plane[1].{key}"), value);
            }
        }
    }

    fn lasts_to(&mut self, end_s: f64) {
        self.end_s = self.end_s.max(end_s);
    }

    /// A table of a load; formatting into a string does not fail.
    fn table(&mut self, load: &Load, times: f64, place_m: Option<f64>) {
        let Load {
            start_s,
            duration_s,
            ..
        } = load;
        let force_n = times * load.force_n;
        let place = place_m.map_or_else(String::new, |z| format!("position_m = {z}\n"));
        let head =
            format!("[[disturbance]]\nstart_s = {start_s}\nduration_s = {duration_s}\n{place}");
        match load.course {
            Course::Along(angle) => {
                let force_n = [force_n * angle.cos(), force_n * angle.sin()];
                let _ = writeln!(self.tables, "{head}force_n = {force_n:?}");
            }
            Course::Turning(hz, phase) => {
                let (rate, sense) = (hz.abs(), hz.signum());
                // A cosine along x, a sine along y.
                for (force_n, phase) in [
                    ([force_n, 0.0], phase + 0.25 * TAU),
                    ([0.0, sense * force_n], phase),
                ] {
                    let _ = writeln!(
                        self.tables,
                        "{head}force_n = {force_n:?}\nshape = \"sine\"\nfrequency_hz = {rate}\nphase_rad = {phase}"
                    );
                }
            }
        }
        self.lasts_to(start_s + duration_s);
    }

    /// A load of each end, so many times; of a point mass that of the second.
    fn load(&mut self, of: &Measures, load: &Load, times: [f64; 2]) {
        match of.whole {
            None => self.table(load, times[1], None),
            Some(Whole { ends_m: [a, b], .. }) => {
                for (times, place_m) in times.into_iter().zip([-a, b]) {
                    if times != 0.0 {
                        self.table(load, times, Some(place_m));
                    }
                }
            }
        }
    }

    /// A change of speed of the centre, and of the ends against each other, in √(F·c/m), within two fifths of √(m·c/F): no
    /// hammer, whose blow would be over between two samples.
    fn blow(&mut self, of: &Measures, start_s: f64, [centre, tilt]: [f64; 2]) {
        let duration_s = 0.4 * of.unit_s();
        let momentum_n = of.mass_kg * of.unit_m_s() * centre / duration_s;
        let load = Load {
            start_s,
            duration_s,
            force_n: 1.0,
            course: Course::Along(0.1_f64.atan()),
        };
        let ends_n = match of.whole {
            None => [0.0, momentum_n],
            Some(Whole {
                ends_m: [a, b],
                transverse_kg_m2,
            }) => {
                let rate_rad_s = of.unit_m_s() * tilt / (0.5 * (a + b));
                let moment_n_m = transverse_kg_m2 * rate_rad_s / duration_s;
                let second_n = (moment_n_m + a * momentum_n) / (a + b);
                [momentum_n - second_n, second_n]
            }
        };
        self.load(of, &load, ends_n);
    }

    fn overload(&mut self, of: &Measures, caps: f64, at_end: bool) {
        let load = Load {
            start_s: BEGIN_S,
            duration_s: 0.02,
            force_n: caps * of.force_n,
            course: Course::Along(0.0),
        };
        let place = of
            .whole
            .map(|whole| if at_end { whole.ends_m[1] } else { 0.0 });
        self.table(&load, 1.0, place);
    }

    fn outage(&mut self, duration_s: f64) {
        let _ = writeln!(
            self.tables,
            "[[outage]]\nstart_s = {BEGIN_S}\nduration_s = {duration_s}\nknown = true"
        );
        self.lasts_to(BEGIN_S + duration_s);
    }

    /// Unbalance with an orbit of up to 0.15 clearances, and runout.
    fn turn_unbalanced(&mut self, of: &Measures, draw: &mut Draw) {
        let eccentricity_m = of.clearance_m * draw.decades(0.01, 0.15);
        self.unbalance(of, eccentricity_m, [1.0; 2]);
        let runout_m = of.clearance_m * draw.decades(0.005, 0.05);
        self.of_each(of, "sensor.runout_m", runout_m);
        self.lasts_to(0.6);
    }

    /// A centre of mass that is off, of each half of a rotor.
    fn unbalance(&mut self, of: &Measures, eccentricity_m: f64, times: [f64; 2]) {
        let Some(whole) = of.whole else {
            return self.set("rotor.eccentricity_m", eccentricity_m);
        };
        let moment_kg_m = of.moved_kg() * eccentricity_m;
        for (times, place_m) in times.into_iter().zip([-whole.ends_m[0], whole.ends_m[1]]) {
            let angle_rad = if times < 0.0 { 0.5 * TAU } else { 0.0 };
            let _ = writeln!(
                self.tables,
                "[[unbalance]]\nposition_m = {place_m}\nmoment_kg_m = {moment_kg_m}\nangle_rad = {angle_rad}"
            );
        }
    }

    fn set_down(&mut self, of: &Measures, draw: &mut Draw, [spins, announced]: [bool; 2]) {
        let angle = lowest(of, draw);
        let to = [1.2 * angle.cos(), 1.2 * angle.sin()];
        let duration_s = draw.between(0.3, 0.8);
        let _ = writeln!(
            self.tables,
            "[[set_down]]\nstart_s = {BEGIN_S}\nduration_s = {duration_s}\nto = {to:?}\nannounced = {announced}"
        );
        let spin_hz = if spins { draw.decades(2.0, 20.0) } else { 0.0 };
        self.set("spin.frequency_hz", spin_hz * of.spin_hz.signum());
        self.goal = Goal::SetDown;
        self.lasts_to(BEGIN_S + duration_s);
    }

    fn lose_blade(&mut self, of: &Measures, draw: &mut Draw) {
        let square = (TAU * of.spin_hz).powi(2);
        let moment_kg_m = draw.between(0.2, 1.5) * of.force_n / square;
        let what = match of.whole {
            None => format!("eccentricity_m = {}", moment_kg_m / of.mass_kg),
            Some(whole) => format!(
                "unbalance = {{ position_m = {}, moment_kg_m = {moment_kg_m}, angle_rad = {} }}",
                draw.between(-whole.ends_m[0], whole.ends_m[1]),
                draw.angle_rad()
            ),
        };
        let _ = writeln!(self.tables, "[[change]]\nat_s = {BEGIN_S}\n{what}");
        self.lasts_to(BEGIN_S);
    }

    fn rub(&mut self, of: &Measures, draw: &mut Draw, conical: bool) {
        let times = if conical { [-1.0, 1.0] } else { [1.0; 2] };
        let eccentricity_m = of.clearance_m * draw.decades(0.06, 0.3);
        self.unbalance(of, eccentricity_m, times);
        let driven_n = of.moved_kg() * of.clearance_m * (TAU * of.spin_hz).powi(2);
        let load = Load {
            start_s: BEGIN_S,
            duration_s: 15.0 / of.spin_hz.abs(),
            force_n: driven_n + of.force_n,
            course: Course::Turning(of.spin_hz, TAU * of.spin_hz * BEGIN_S),
        };
        self.load(of, &load, times);
    }
}
