//! A bearing plane in the loop.

use crate::device::actuator::Amplifier;
use crate::device::axis::Turned;
use crate::device::sensor::{Sensor, SensorParams};
use crate::device::sensor_fault::seen_until_s;
use crate::run::controller::{Controller, Force, Seen};
use crate::run::judge::Judge;
use crate::run::trace::{Recorder, SupervisorTrace, TraceRow};
use crate::scene::{PlaneScene, Scene};
use plant_model::machine::params::MachinePlane;
use plant_model::{Snapshot, V2};
use supervisor::{Events, Status};

/// A bearing plane: what stands there, who drives its magnet, who watches.
pub(super) struct Station<'a> {
    scene: &'a Scene,
    pub(super) plane: &'a PlaneScene,
    pub(super) wall: &'a MachinePlane,
    sensor: Sensor,
    pub(super) controller: Box<dyn Controller>,
    pub(super) amplifier: Amplifier,
    /// Axes of sensor and magnet.
    axes: [Turned; 2],
    pub(super) judge: Judge,
    pub(super) recorder: Option<&'a mut dyn Recorder>,
    /// The last reading of the position \[m\].
    pub(super) measured_m: V2,
    /// The supervisor's answer to the last sample.
    supervisor: Option<SupervisorTrace>,
    /// What happened at it.
    events: Events,
}

impl<'a> Station<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        plane: usize,
        controller: Box<dyn Controller>,
        recorder: Option<&'a mut dyn Recorder>,
    ) -> Self {
        let period_s = 1.0 / scene.sample_rate_hz;
        let (force_max_n, own) = (scene.force_max_n(plane), &scene.planes[plane]);
        // What the target adds is on the rotor, and turns with it.
        let sensor = SensorParams {
            runout_phase_rad: own.sensor.runout_phase_rad - own.axes_rad[0],
            ..own.sensor
        };
        Self {
            scene,
            plane: own,
            wall: &scene.machine.planes[plane],
            sensor: Sensor::new(sensor, &own.faults, period_s, own.seed),
            controller,
            amplifier: Amplifier::new(own.amplifier, force_max_n, &own.outages, own.seed),
            axes: own.axes_rad.map(Turned::by),
            judge: Judge::new(scene, plane),
            recorder,
            measured_m: V2::zeros(),
            supervisor: None,
            events: Events::empty(),
        }
    }

    /// What firmware knows at a tick.
    pub(super) fn read_sensor(&mut self, t_s: f64, sensed_m: V2, now: &Snapshot) -> Seen {
        let [of_sensor, of_magnet] = self.axes;
        let sensed_m = of_sensor.seen(sensed_m);
        let reading = (self.sensor).read(t_s, sensed_m, now.spin_rad_s);
        self.measured_m = of_sensor.meant(reading.position_m);
        let sampled_s = seen_until_s(t_s, 1.0 / self.scene.sample_rate_hz);
        Seen {
            reading,
            reference_m: of_sensor.seen(self.plane.reference_m(sampled_s)),
            spin_rad_s: self.scene.spin_sensor.gain * now.spin_rad_s,
            applied_n: if self.plane.amplifier.force_measured {
                // What is fed forward the supervisor does not know of: with the weight it is nothing.
                of_magnet.seen(now.delivered_n) - self.plane.feed_forward_n
            } else {
                V2::zeros()
            },
            status: self.status(sampled_s),
            levitation_n: V2::zeros(),
        }
    }

    pub(super) fn answer(&mut self, tick: u64, seen: &Seen, now: &Snapshot) {
        let force = self.controller.command(seen, now);
        self.command(tick, force, now);
    }

    /// Passes on the answer to a sample, whoever gives it.
    pub(super) fn command(&mut self, tick: u64, force: Force, now: &Snapshot) {
        let with_weight = |force_n: V2| force_n + self.plane.feed_forward_n;
        match force {
            Force::Computed(force_n) => self.amplifier.command(tick, with_weight(force_n)),
            // Of who sees the truth, and sees it along the axes of the scene.
            Force::AtOnce(force_n) => {
                let force_n = self.axes[1].seen(force_n);
                self.amplifier.command_at_once(with_weight(force_n));
            }
        }
        self.judge.sample(now);
        self.supervisor = self.controller.supervisor_trace();
        self.record(now, false);
        // What happened at this sample is not to be read a second time.
        if let Some(trace) = &mut self.supervisor {
            self.events = std::mem::take(&mut trace.events);
        }
    }

    /// What the amplifier delivers over the halves of a stretch, along the axes of the scene \[N\].
    pub(super) fn deliver(&mut self, from_s: f64, to_s: f64) -> [V2; 2] {
        let halves_n = self.amplifier.deliver(from_s, to_s);
        halves_n.map(|force_n| self.axes[1].meant(force_n))
    }

    /// What the firmware knows to be valid and ready at a time.
    fn status(&self, t_s: f64) -> Status {
        let mut status = Status::empty();
        status.set(Status::SPIN_VALID, self.scene.spin_sensor.valid);
        let measured = self.plane.amplifier.force_measured;
        status.set(Status::APPLIED_VALID, measured);
        let [x_off, y_off] = self.amplifier.known_off(t_s);
        status.set(Status::BEARING_ON, !(x_off && y_off));
        status.set(Status::AXIS_X_LOST, x_off);
        status.set(Status::AXIS_Y_LOST, y_off);
        status.set(Status::LEVITATED_BEFORE, self.scene.levitated_before);
        let set_down = self.plane.set_down_announced(t_s);
        status.set(Status::SET_DOWN, set_down);
        status
    }

    pub(super) fn record(&mut self, plant: &Snapshot, mode_change: bool) {
        if self.recorder.is_some() {
            let row = self.row(plant, mode_change);
            if let Some(recorder) = &mut self.recorder {
                recorder.row(&row);
            }
        }
    }

    /// The row of the last control sample, with what happened at it.
    pub(super) fn sampled(&self, plant: &Snapshot) -> TraceRow {
        let (events, row) = (self.events, self.row(plant, false));
        TraceRow {
            supervisor: row.supervisor.map(|t| SupervisorTrace { events, ..t }),
            ..row
        }
    }

    /// The row of the plant as it was.
    fn row(&self, plant: &Snapshot, mode_change: bool) -> TraceRow {
        TraceRow {
            plant: *plant,
            measured_m: self.measured_m,
            commanded_n: self.axes[1].meant(self.amplifier.in_effect_n()),
            supervisor: self.supervisor.map(|trace| SupervisorTrace {
                levitation_n: self.axes[1].meant_f32(trace.levitation_n),
                stimulus_n: self.axes[1].meant_f32(trace.stimulus_n),
                ..trace
            }),
            mode_change,
        }
    }
}
