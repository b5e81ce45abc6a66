//! The loop itself: sample, compute, hold.

use super::station::Station;
use super::{PlaneEnded, RunError, TRUSTED, TRUSTED_TOLERANCES, Task};
use crate::device::loads::{Disturbance, cuts};
use crate::device::whole_levitation::{AtSample, WholeLevitation, WholeLevitationParams};
use crate::run::controller::{Seen, written};
use crate::run::figures::{Ended, Figures};
use crate::run::rig::Rig;
use crate::run::trace::{AxisRow, ReadOut, Recorder};
use crate::run::whole_clairvoyant::WholeReference;
use crate::scene::Scene;
use plant_model::{PlantError, Snapshot, V2};
use supervisor::{HalfTick, IntegratorHint, RotorSupervisor, Sample, Stamp};

/// A rig with its stations, sample by sample.
pub(super) struct ClosedLoop<'a> {
    scene: &'a Scene,
    pub(super) rig: Rig<'a>,
    pub(super) stations: Vec<Station<'a>>,
    /// Who levitates the rotor as a whole.
    levitation: Option<WholeLevitation>,
    /// Who sees its true state.
    pub(super) reference: Option<&'a WholeReference>,
    /// Who supervises it as a whole, and which planes it has.
    pub(super) supervisor: Option<(RotorSupervisor, [usize; 2])>,
    /// Half a tick of it, where its planes take turns.
    half: Option<HalfTick>,
    pub(super) axis: Option<&'a mut dyn Recorder<AxisRow>>,
    /// What acts at each place for loads.
    loads: Vec<Disturbance>,
    edges_s: Vec<f64>,
    /// The next of them.
    edge_s: f64,
    /// Whether nothing varies up to there.
    steady: bool,
    /// Changes that lie behind.
    changes_done: usize,
    // Buffers: planes at a sample, what is seen and commanded there, forces that are held, changes of mode within an advance.
    pub(super) now: Vec<Snapshot>,
    pub(super) seen: Vec<Seen>,
    levitation_n: Vec<V2>,
    commands_n: [Vec<V2>; 2],
    loads_n: [Vec<V2>; 2],
    changes: Vec<(usize, Snapshot)>,
    axis_row: AxisRow,
}

impl<'a> ClosedLoop<'a> {
    pub(super) fn new(scene: &'a Scene, rig: Rig<'a>, stations: Vec<Station<'a>>) -> Self {
        let loads: Vec<Disturbance> = scene.loads().collect();
        let (planes, places) = (stations.len(), loads.len());
        let known = stations.iter().filter(|s| !s.plane.seal).count();
        Self {
            scene,
            rig,
            stations,
            levitation: None,
            reference: None,
            supervisor: None,
            half: None,
            axis: None,
            loads,
            edges_s: scene.edges(),
            edge_s: f64::NEG_INFINITY,
            steady: true,
            changes_done: 0,
            now: Vec::with_capacity(planes),
            seen: Vec::with_capacity(planes),
            levitation_n: vec![V2::zeros(); known],
            commands_n: [vec![V2::zeros(); planes], vec![V2::zeros(); planes]],
            loads_n: [vec![V2::zeros(); places], vec![V2::zeros(); places]],
            changes: Vec::new(),
            axis_row: AxisRow::default(),
        }
    }

    /// Has the rotor levitated as a whole, where a policy asks for that.
    pub(super) fn levitated_by(
        &mut self,
        params: Option<&WholeLevitationParams>,
        policy: &'static str,
    ) -> Result<(), RunError> {
        let asked = self.stations.iter().any(|s| s.controller.levitates());
        let started = (params.filter(|_| asked))
            .map(|params| WholeLevitation::new(params, 1.0 / self.scene.sample_rate_hz));
        self.levitation = (started.transpose()).map_err(RunError::of_controller(policy))?;
        Ok(())
    }

    /// To the end of the scene.
    pub(super) fn run_to_end(
        mut self,
        task: Task,
        on_tick: &mut dyn FnMut(u64),
    ) -> Result<Vec<PlaneEnded>, RunError> {
        const REPORT_EVERY: u64 = 1024;
        let ticks = self.scene.samples().count();
        for tick in 0..ticks {
            self.tick(tick, task)?;
            if (tick + 1) % REPORT_EVERY == 0 {
                on_tick(REPORT_EVERY);
            }
            if task.to_decision && self.decided() {
                break;
            }
        }
        on_tick(ticks % REPORT_EVERY);
        if let Some(levitation) = self.levitation.take() {
            (levitation.close()).map_err(RunError::of_controller(task.policy))?;
        }
        self.rig.read(&mut self.now);
        let mut ended = Vec::with_capacity(self.stations.len());
        for (plane, (station, last)) in self.stations.iter_mut().zip(&self.now).enumerate() {
            station.judge.sample(last);
            station.measured_m = last.position_m + station.wall.centre_m;
            station.record(last, false);
            let run = Ended::new(&station.judge, &self.rig, (plane, last));
            let of_rotor = self.supervisor.as_mut().and_then(|(supervisor, planes)| {
                let own = planes.iter().position(|of| *of == plane)?;
                Some((supervisor, own))
            });
            let read_out = || match of_rotor {
                Some((supervisor, own)) => Some(ReadOut {
                    report: supervisor.plane(own).report(),
                    flight_record: (supervisor.record(own)).map(|r| written(&r, &Stamp::default())),
                }),
                None => station.controller.read_out(),
            };
            let recorded = station.recorder.is_some();
            ended.push((Figures::new(&run), recorded.then(read_out).flatten()));
        }
        self.record_axis();
        self.trusted(task)?;
        Ok(ended)
    }

    /// Whether the energy audit closes.
    pub(super) fn trusted(&self, task: Task) -> Result<(), RunError> {
        let residual = self.rig.audit().residual();
        let limit = (TRUSTED_TOLERANCES * self.scene.rtol).clamp(TRUSTED.0, TRUSTED.1);
        if residual.is_nan() || residual > limit {
            return Err(RunError::Energy {
                policy: task.policy,
                residual,
                limit,
            });
        }
        Ok(())
    }

    /// Whether nothing can change any more of whether the rotor has recovered.
    fn decided(&self) -> bool {
        let stations = || self.stations.iter().enumerate();
        stations().any(|(plane, s)| s.judge.whirls(&self.rig.meters(plane)))
            || stations().all(|(_, s)| s.judge.is_back())
    }

    fn tick(&mut self, tick: u64, task: Task) -> Result<(), RunError> {
        self.sample(tick, task)?;
        self.advance_plant(tick, task)
    }

    /// Time of a control sample \[s\].
    pub(super) fn at_s(&self, tick: u64) -> f64 {
        tick as f64 * (1.0 / self.scene.sample_rate_hz)
    }

    /// What there is and what firmware sees of it.
    pub(super) fn read_sensors(&mut self, tick: u64) {
        let t = self.at_s(tick);
        self.rig.read(&mut self.now);
        self.seen.clear();
        for (plane, (station, now)) in self.stations.iter_mut().zip(&self.now).enumerate() {
            station.amplifier.begin(tick);
            let sensed_m = self.rig.sensed_m(plane);
            self.seen.push(station.read_sensor(t, sensed_m, now));
        }
    }

    /// A control sample: what firmware sees, and what it answers.
    pub(super) fn sample(&mut self, tick: u64, task: Task) -> Result<(), RunError> {
        self.read_sensors(tick);
        self.levitate(self.at_s(tick), task)?;
        self.apply_reference();
        self.supervise();
        for (i, station) in self.stations.iter_mut().enumerate() {
            station.answer(tick, &self.seen[i], &self.now[i]);
        }
        self.record_axis();
        Ok(())
    }

    /// From a control sample to the next.
    pub(super) fn advance_plant(&mut self, tick: u64, task: Task) -> Result<(), RunError> {
        let (t, t_next) = (self.at_s(tick), self.at_s(tick + 1));
        let mut from = t;
        while from < t_next {
            if from >= self.edge_s {
                self.pass_edges(from)?;
            }
            let to = self.edge_s.min(t_next);
            let parts = self.parts(from, to);
            let advanced = match parts {
                None => self.advance_steadily(from, to),
                Some(parts) => self.advance_by_parts((from, to), parts * task.accuracy.parts),
            };
            advanced.map_err(|reason| RunError::Plant {
                policy: task.policy,
                reason,
            })?;
            from = to;
        }
        Ok(())
    }

    /// The reference of the whole rotor, where there is one.
    fn apply_reference(&mut self) {
        let Some(reference) = self.reference else {
            return;
        };
        for (plane, force_n) in reference.forces_n(&self.now).into_iter().flatten() {
            self.seen[plane].levitation_n = force_n;
        }
    }

    /// The supervisor of the whole rotor, where there is one.
    fn supervise(&mut self) {
        let Some((supervisor, planes)) = &mut self.supervisor else {
            return;
        };
        let Ok([first, second]) = self.stations.get_disjoint_mut(*planes) else {
            return;
        };
        let [to_first, to_second] = supervisor.stimulus_n();
        first.controller.stimulated(to_first);
        second.controller.stimulated(to_second);
        let asked = (
            first.controller.ask(&self.seen[planes[0]]),
            second.controller.ask(&self.seen[planes[1]]),
        );
        let (Some(at_first), Some(at_second)) = asked else {
            return;
        };
        if !self.scene.planes_in_turn {
            let [to_first, to_second] = supervisor.tick(&[at_first, at_second]).planes;
            first.controller.answered(to_first);
            second.controller.answered(to_second);
            return;
        }
        // A tick counts both halves.
        let of_tick = |sample: Sample| Sample {
            sequence: sample.sequence / 2,
            ..sample
        };
        match self.half.take() {
            Some(half) => {
                let [_, to_second] = supervisor.tick_second(&half, &of_tick(at_second)).planes;
                first.controller.waits();
                second.controller.answered(to_second);
            }
            None => {
                let half = supervisor.tick_first(&of_tick(at_first));
                first.controller.answered(half.command);
                second.controller.waits();
                self.half = Some(half);
            }
        }
    }

    /// The levitation controller of the whole rotor, where there is one.
    fn levitate(&mut self, t_s: f64, task: Task) -> Result<(), RunError> {
        let Some(levitation) = &mut self.levitation else {
            return Ok(());
        };
        let holds = |s: &Station| s.controller.hint() == IntegratorHint::Hold;
        let hold = self.stations.iter().any(holds);
        let at = AtSample {
            t_s,
            spin_rad_s: self.seen.first().map_or(0.0, |seen| seen.spin_rad_s),
            hold,
        };
        let known = |(_, station): &(&Seen, &Station)| !station.plane.seal;
        let readings = (self.seen.iter().zip(&self.stations)).filter(known);
        let readings = readings.map(|(seen, _)| seen.off_reference());
        levitation
            .forces_n(readings, at, &mut self.levitation_n)
            .map_err(RunError::of_controller(task.policy))?;
        let known = self.seen.iter_mut().zip(&self.stations);
        let known = known.filter(|(_, station)| !station.plane.seal);
        for ((seen, _), force_n) in known.zip(&self.levitation_n) {
            seen.levitation_n = *force_n;
        }
        Ok(())
    }

    /// Parts over whose halves what varies is to be held; `None` where nothing does.
    fn parts(&self, from_s: f64, to_s: f64) -> Option<u32> {
        let loads = match self.steady {
            true => None,
            false => self
                .loads
                .iter()
                .filter_map(|l| l.parts(from_s, to_s))
                .max(),
        };
        let ramps = self
            .stations
            .iter()
            .filter_map(|s| s.amplifier.parts(from_s));
        loads.max(ramps.max())
    }

    /// Makes the changes that are due, and looks at what acts up to the next edge.
    fn pass_edges(&mut self, t_s: f64) -> Result<(), RunError> {
        let next = self.edges_s.iter().find(|edge| **edge > t_s);
        self.edge_s = next.copied().unwrap_or(f64::INFINITY);
        self.steady = self.loads.iter().all(|l| l.parts(t_s, t_s).is_none());
        for (load, held_n) in self.loads.iter().zip(&mut self.loads_n[0]) {
            [*held_n, _] = load.halves_n(t_s, t_s);
        }
        while let Some(due) = self.scene.changes.get(self.changes_done)
            && due.at_s <= t_s
        {
            self.rig.change(&due.change)?;
            self.changes_done += 1;
        }
        Ok(())
    }

    fn advance_steadily(&mut self, from_s: f64, to_s: f64) -> Result<(), PlantError> {
        self.deliver(from_s, to_s);
        self.advance(to_s, 0, 0)
    }

    fn advance_by_parts(&mut self, stretch_s: (f64, f64), parts: u32) -> Result<(), PlantError> {
        for [begin, middle, end] in cuts(stretch_s, parts) {
            self.deliver(begin, end);
            let second = match self.steady {
                true => 0,
                false => {
                    self.hold_loads(begin, end);
                    1
                }
            };
            self.advance(middle, 0, 0)?;
            self.advance(end, 1, second)?;
        }
        Ok(())
    }

    /// What the amplifiers deliver over the halves of a stretch.
    fn deliver(&mut self, from_s: f64, to_s: f64) {
        for (i, station) in self.stations.iter_mut().enumerate() {
            let halves_n = station.deliver(from_s, to_s);
            [self.commands_n[0][i], self.commands_n[1][i]] = halves_n;
        }
    }

    fn hold_loads(&mut self, from_s: f64, to_s: f64) {
        for (i, load) in self.loads.iter().enumerate() {
            [self.loads_n[0][i], self.loads_n[1][i]] = load.halves_n(from_s, to_s);
        }
    }

    /// With what was laid down for one of two halves.
    fn advance(&mut self, to_s: f64, commands: usize, loads: usize) -> Result<(), PlantError> {
        let (commands_n, loads_n) = (&self.commands_n[commands], &self.loads_n[loads]);
        (self.rig).advance(to_s, commands_n, loads_n, &mut self.changes)?;
        for (plane, snapshot) in self.changes.drain(..) {
            let station = &mut self.stations[plane];
            station.judge.change(&snapshot);
            station.record(&snapshot, true);
        }
        Ok(())
    }

    fn record_axis(&mut self) {
        if let Some(recorder) = &mut self.axis {
            self.rig.read_axis(&mut self.axis_row);
            recorder.row(&self.axis_row);
        }
    }
}
