//! What happens during a scene, from its keys: loads, outages, faults, changes.

use crate::device::actuator::{Delivers, Outage};
use crate::device::axis::Axis;
use crate::device::loads::{BaseMotion, Disturbance, Shape, TimedChange};
use crate::device::sensor_fault::{Fault, FaultKind};
use crate::scene::diagnostic::{Checks, SceneError};
use crate::scene::event_file::{
    AxisFile, ChangeFile, DeliversFile, FaultFile, FaultName, OutageFile, ShapeFile, ShapeName,
};
use crate::scene::file::SceneFile;
use plant_model::Change;

/// Everything that happens.
pub(crate) struct Events {
    pub(crate) disturbances: Vec<Disturbance>,
    pub(crate) base_motions: Vec<BaseMotion>,
    pub(crate) outages: Vec<Outage>,
    pub(crate) faults: Vec<Fault>,
    pub(crate) changes: Vec<TimedChange>,
}

/// Reads and checks the events of a scene file.
pub(crate) fn events_of(file: &SceneFile, check: &Checks<'_>) -> Result<Events, SceneError> {
    let reader = Reader { file, check };
    let mut events = Events {
        disturbances: Vec::with_capacity(file.disturbance.len()),
        base_motions: Vec::with_capacity(file.base_motion.len()),
        outages: Vec::with_capacity(file.outage.len()),
        faults: Vec::with_capacity(file.fault.len()),
        changes: Vec::with_capacity(file.change.len()),
    };
    for (i, d) in file.disturbance.iter().enumerate() {
        let path = format!("disturbance[{i}]");
        reader.span(&path, d.start_s, d.duration_s)?;
        for force in d.force_n.0 {
            check.within(&format!("{path}.force_n"), force, -1e9, 1e9)?;
        }
        events.disturbances.push(Disturbance {
            start_s: d.start_s,
            duration_s: d.duration_s,
            force_n: d.force_n.0.into(),
            shape: reader.shape(&path, (d.shape, d.frequency_hz, d.phase_rad))?,
        });
    }
    for (i, b) in file.base_motion.iter().enumerate() {
        let path = format!("base_motion[{i}]");
        if file.stator.inner.is_some() {
            let message = "needs a rigid stator: the rings of this one would feel it too";
            let help = Some("remove [stator], or act on the rotor by [[disturbance]]".to_owned());
            return Err(check.text.error_at_key(&path, message.to_owned(), help));
        }
        reader.span(&path, b.start_s, b.duration_s)?;
        for a in b.acceleration_m_s2.0 {
            check.within(&format!("{path}.acceleration_m_s2"), a, -1e7, 1e7)?;
        }
        events.base_motions.push(BaseMotion {
            start_s: b.start_s,
            duration_s: b.duration_s,
            acceleration_m_s2: b.acceleration_m_s2.0.into(),
            shape: reader.shape(&path, (b.shape, b.frequency_hz, b.phase_rad))?,
        });
    }
    for (i, o) in file.outage.iter().enumerate() {
        let path = format!("outage[{i}]");
        if file.magnet.is_none() {
            let help = Some("add a [magnet], or remove the outage".to_owned());
            let message = "there is no magnet that could fail".to_owned();
            return Err(check.text.error_at_key(&path, message, help));
        }
        events.outages.push(reader.outage(&path, o)?);
    }
    for (i, f) in file.fault.iter().enumerate() {
        events.faults.push(reader.fault(&format!("fault[{i}]"), f)?);
    }
    for (i, c) in file.change.iter().enumerate() {
        events
            .changes
            .push(reader.change(&format!("change[{i}]"), c)?);
    }
    reader.no_change_twice()?;
    (events.changes).sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
    Ok(events)
}

fn axis_of(axis: AxisFile) -> Axis {
    match axis {
        AxisFile::X => Axis::X,
        AxisFile::Y => Axis::Y,
        AxisFile::Both => Axis::Both,
    }
}

struct Reader<'a> {
    file: &'a SceneFile,
    check: &'a Checks<'a>,
}

impl Reader<'_> {
    fn outage(&self, path: &str, o: &OutageFile) -> Result<Outage, SceneError> {
        self.span(path, o.start_s, o.duration_s)?;
        let axis = axis_of(o.axis);
        let delivers = match o.delivers {
            DeliversFile::Nothing => Delivers::Nothing,
            DeliversFile::Inverted => Delivers::Inverted,
            DeliversFile::Swapped => Delivers::Swapped,
        };
        if delivers == Delivers::Swapped && axis != Axis::Both {
            let message = "is of one axis: swapped are the two".to_owned();
            return Err(self.error(&format!("{path}.axis"), message, "remove it"));
        }
        if delivers != Delivers::Nothing && o.known {
            let message = "has nobody to be told to: the supervisor is told of lost axes alone";
            let help = "remove it, or let the outage deliver nothing";
            return Err(self.error(&format!("{path}.known"), message.to_owned(), help));
        }
        Ok(Outage {
            start_s: o.start_s,
            duration_s: o.duration_s,
            delivers,
            axis,
            known: o.known,
        })
    }

    fn error(&self, key: &str, message: String, help: &str) -> SceneError {
        (self.check.text).error_at_key(key, message, Some(help.to_owned()))
    }

    fn starts(&self, key: &str, start_s: f64) -> Result<(), SceneError> {
        self.check.within(key, start_s, 0.0, 1e5)?;
        let end_s = self.file.run.duration_s;
        if start_s >= end_s {
            let message = format!("is {start_s}, not before the end of the run at {end_s}");
            return Err(self.error(key, message, "start it earlier, or lengthen run.duration_s"));
        }
        Ok(())
    }

    fn span(&self, path: &str, start_s: f64, duration_s: f64) -> Result<(), SceneError> {
        (self.check).within(&format!("{path}.start_s"), start_s, 0.0, 1e5)?;
        (self.check).within(&format!("{path}.duration_s"), duration_s, 1e-9, 1e5)?;
        self.starts(&format!("{path}.start_s"), start_s)
    }

    fn shape(
        &self,
        path: &str,
        (name, frequency_hz, phase_rad): ShapeFile,
    ) -> Result<Shape, SceneError> {
        if name != ShapeName::Sine {
            let given = [
                ("frequency_hz", frequency_hz.is_some()),
                ("phase_rad", phase_rad.is_some()),
            ];
            if let Some((key, _)) = given.iter().find(|(_, given)| *given) {
                let key = format!("{path}.{key}");
                let message = "has a meaning with shape = \"sine\" only".to_owned();
                return Err(self.error(&key, message, "remove it, or choose that shape"));
            }
        }
        Ok(match name {
            ShapeName::Constant => Shape::Constant,
            ShapeName::HalfSine => Shape::HalfSine,
            ShapeName::Sine => {
                // Faster ones are no load that a sampled loop could be asked about.
                let most = self.file.run.sample_rate_hz;
                let frequency_hz = self.needed(path, "frequency_hz", frequency_hz, 0.0, most)?;
                let phase_rad = phase_rad.unwrap_or(0.0);
                (self.check).within(&format!("{path}.phase_rad"), phase_rad, -1e6, 1e6)?;
                Shape::Sine {
                    frequency_hz,
                    phase_rad,
                }
            }
        })
    }

    /// A key that this kind or shape cannot do without.
    fn needed(
        &self,
        path: &str,
        key: &str,
        value: Option<f64>,
        low: f64,
        high: f64,
    ) -> Result<f64, SceneError> {
        let key = format!("{path}.{key}");
        let Some(value) = value else {
            let help = format!("give a number from {low} to {high}");
            return Err(self.error(&key, "is missing".to_owned(), &help));
        };
        self.check.within(&key, value, low, high)?;
        Ok(value)
    }

    fn fault(&self, path: &str, f: &FaultFile) -> Result<Fault, SceneError> {
        self.span(path, f.start_s, f.duration_s)?;
        let needed = |key, value, low, high| self.needed(path, key, value, low, high);
        let whole = |value: Option<u32>| value.map(f64::from);
        let rate_hz = self.file.run.sample_rate_hz;
        let (kind, keys): (FaultKind, &[&str]) = match f.kind {
            FaultName::Nan => (FaultKind::Nan, &[]),
            FaultName::Infinity => (FaultKind::Infinity, &[]),
            FaultName::Zero => (FaultKind::Zero, &[]),
            FaultName::Rail => (FaultKind::Rail, &[]),
            FaultName::Stuck => (FaultKind::Stuck, &[]),
            FaultName::Inverted => (FaultKind::Inverted, &[]),
            FaultName::Swapped => (FaultKind::Swapped, &[]),
            FaultName::Dropout => (FaultKind::Dropout, &[]),
            FaultName::Offset => {
                let value = needed("value_m", f.value_m, -1.0, 1.0)?;
                (FaultKind::Offset(value), &["value_m"])
            }
            FaultName::Gain => {
                let factor = needed("factor", f.factor, -100.0, 100.0)?;
                (FaultKind::Gain(factor), &["factor"])
            }
            FaultName::Noise => {
                let factor = needed("factor", f.factor, 0.0, 1e6)?;
                (FaultKind::Noise(factor), &["factor"])
            }
            FaultName::Spikes => {
                let rate_hz = needed("rate_hz", f.rate_hz, 0.0, rate_hz)?;
                let size_m = needed("size_m", f.size_m, 0.0, 1.0)?;
                (
                    FaultKind::Spikes { rate_hz, size_m },
                    &["rate_hz", "size_m"],
                )
            }
            FaultName::Delay => {
                let samples = needed("samples", whole(f.samples), 1.0, 1000.0)?;
                (FaultKind::Delay(samples as usize), &["samples"])
            }
            FaultName::Bits => {
                let bits = needed("bits", whole(f.bits), 1.0, 32.0)?;
                (FaultKind::Bits(bits as u32), &["bits"])
            }
            FaultName::Oscillation => {
                let frequency_hz = needed("frequency_hz", f.frequency_hz, 0.0, 1e6)?;
                let amplitude_m = needed("amplitude_m", f.amplitude_m, 0.0, 1.0)?;
                let kind = FaultKind::Oscillation {
                    frequency_hz,
                    amplitude_m,
                };
                (kind, &["frequency_hz", "amplitude_m"])
            }
        };
        let given = [
            ("value_m", f.value_m.is_some()),
            ("factor", f.factor.is_some()),
            ("rate_hz", f.rate_hz.is_some()),
            ("size_m", f.size_m.is_some()),
            ("samples", f.samples.is_some()),
            ("bits", f.bits.is_some()),
            ("frequency_hz", f.frequency_hz.is_some()),
            ("amplitude_m", f.amplitude_m.is_some()),
            ("axis", f.axis.is_some() && kind.concerns_both()),
        ];
        for (key, given) in given {
            if given && !keys.contains(&key) {
                let message = "has no meaning for a fault of this kind".to_owned();
                let key = format!("{path}.{key}");
                return Err(self.error(&key, message, "remove it, or choose another kind"));
            }
        }
        let sensor = &self.file.sensor;
        let (missing, without) = match kind {
            FaultKind::Rail | FaultKind::Bits(_) => ("sensor.range_m", sensor.range_m.is_none()),
            FaultKind::Noise(_) => ("sensor.noise_rms_m", sensor.noise_rms_m == 0.0),
            _ => ("", false),
        };
        if without {
            let help = format!("give {missing}, or choose another kind");
            let key = format!("{path}.kind");
            return Err(self.error(&key, format!("needs {missing}"), &help));
        }
        Ok(Fault {
            start_s: f.start_s,
            duration_s: f.duration_s,
            kind,
            axis: f.axis.map_or(Axis::Both, axis_of),
        })
    }

    /// Which of two values at one time would hold hangs on their order in the file.
    fn no_change_twice(&self) -> Result<(), SceneError> {
        for (i, c) in self.file.change.iter().enumerate() {
            for (j, other) in self.file.change.iter().enumerate().take(i) {
                let twice = c.at_s == other.at_s;
                if let Some(key) = c.keys_of_both(other).next().filter(|_| twice) {
                    let message = format!("given for {} s by change[{j}] as well", c.at_s);
                    let help = "remove one of them, or let it come at another time";
                    return Err(self.error(&format!("change[{i}].{key}"), message, help));
                }
            }
        }
        Ok(())
    }

    fn change(&self, path: &str, c: &ChangeFile) -> Result<TimedChange, SceneError> {
        self.starts(&format!("{path}.at_s"), c.at_s)?;
        let within = |key: &str, value: Option<f64>, low: f64, high: f64| {
            let key = format!("{path}.{key}");
            value.map_or(Ok(()), |v| self.check.within(&key, v, low, high))
        };
        within("eccentricity_m", c.eccentricity_m, 0.0, 1.0)?;
        within("friction_coefficient", c.friction_coefficient, 0.0, 10.0)?;
        within("drive_torque_n_m", c.drive_torque_n_m, -1e9, 1e9)?;
        if c.drive_torque_n_m.is_some() && self.file.spin.inertia_kg_m2.is_none() {
            let key = format!("{path}.drive_torque_n_m");
            let message = "has no effect while the speed is held".to_owned();
            return Err(self.error(
                &key,
                message,
                "give spin.inertia_kg_m2, or remove the torque",
            ));
        }
        let change = Change {
            eccentricity_m: c.eccentricity_m,
            friction_coefficient: c.friction_coefficient,
            drive_torque_n_m: c.drive_torque_n_m,
        };
        if change == Change::default() {
            let help = "give eccentricity_m, friction_coefficient or drive_torque_n_m";
            return Err(self.error(path, "changes nothing".to_owned(), help));
        }
        Ok(TimedChange {
            at_s: c.at_s,
            change,
        })
    }
}
