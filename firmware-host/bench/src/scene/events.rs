//! What happens during a scene, from its keys: loads, outages, faults, changes.

use crate::device::actuator::{Delivers, Outage};
use crate::device::axis::Axis;
use crate::device::levitation::SetDown;
use crate::device::loads::{BaseMotion, Disturbance, TimedChange};
use crate::device::sensor_fault::{Fault, FaultKind};
use crate::scene::course::Reader;
use crate::scene::diagnostic::SceneError;
use crate::scene::keys::{Absent, Range};
use crate::scene::plane_spec::PlaneSpec;
use crate::scene::read::KeyType as _;
use crate::scene::tables::{ChangeTable, FaultTable, OutageTable, SetDownTable};
use crate::scene::values::FaultName;
use plant_model::machine::params::Unbalance;
use plant_model::{Change, V2};

/// Everything that happens; loads with the first plane alone.
pub(crate) struct Events {
    pub(crate) disturbances: Vec<Disturbance>,
    pub(crate) base_motions: Vec<BaseMotion>,
    pub(crate) outages: Vec<Outage>,
    pub(crate) faults: Vec<Fault>,
    pub(crate) changes: Vec<TimedChange>,
    pub(crate) set_downs: Vec<SetDown>,
}

/// The events of a scene file, checked.
pub(crate) fn events(spec: &PlaneSpec) -> Result<Events, SceneError> {
    let reader = Reader { spec };
    let written = &spec.tables;
    // Loads are the scene's: with the first plane, so that files are read once.
    let (loads, shakes): (&[_], &[_]) = match spec.index {
        0 => (&written.disturbance, &written.base_motion),
        _ => (&[], &[]),
    };
    let disturbances = each("disturbance", loads, |path, d| {
        let course = reader.course(path, &d.written())?;
        Ok(Disturbance {
            // Until the rotor is known.
            position_m: 0.0,
            start_s: course.start_s,
            duration_s: course.duration_s,
            force_n: course.amplitude,
            shape: course.shape,
        })
    })?;
    if written.stator.inner.is_some() && !written.base_motion.is_empty() {
        let message = "needs a rigid stator: the rings of this one would feel it too";
        let help = "remove [stator], or act on the rotor by [[disturbance]]";
        return Err(reader.error("base_motion[0]", message, help));
    }
    let base_motions = each("base_motion", shakes, |path, b| {
        let course = reader.course(path, &b.written())?;
        Ok(BaseMotion {
            start_s: course.start_s,
            duration_s: course.duration_s,
            acceleration_m_s2: course.amplitude,
            shape: course.shape,
        })
    })?;
    let outages = each("outage", &written.outage, |path, o| reader.outage(path, o))?;
    let faults = each("fault", &written.fault, |path, f| reader.fault(path, f))?;
    let mut changes = each("change", &written.change, |path, c| reader.change(path, c))?;
    reader.no_change_twice()?;
    changes.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
    let mut set_downs = each("set_down", &written.set_down, |path, s| {
        reader.set_down(path, s)
    })?;
    set_downs.sort_by(|a, b| a.start_s.total_cmp(&b.start_s));
    Ok(Events {
        disturbances,
        base_motions,
        outages,
        faults,
        changes,
        set_downs,
    })
}

/// Each table of a name, read with its path.
fn each<T, E>(
    name: &str,
    tables: &[T],
    read: impl Fn(&str, &T) -> Result<E, SceneError>,
) -> Result<Vec<E>, SceneError> {
    let numbered = tables.iter().enumerate();
    numbered
        .map(|(i, table)| read(&format!("{name}[{i}]"), table))
        .collect()
}

impl ChangeTable {
    /// Keys that another change has, too.
    pub(crate) fn keys_of_both(&self, other: &Self) -> impl Iterator<Item = &'static str> {
        let keys = |c: &Self| {
            [
                ("eccentricity_m", c.eccentricity_m.is_some()),
                ("friction_coefficient", c.friction_coefficient.is_some()),
                ("drive_torque_n_m", c.drive_torque_n_m.is_some()),
            ]
        };
        let both = keys(self).into_iter().zip(keys(other));
        both.filter_map(|((key, a), (_, b))| (a && b).then_some(key))
    }
}

impl Reader<'_> {
    fn outage(&self, path: &str, o: &OutageTable) -> Result<Outage, SceneError> {
        if self.spec.tables.magnet.is_none() {
            let help = "add a [magnet], or remove the outage";
            return Err(self.error(path, "there is no magnet that could fail", help));
        }
        self.starts(path, "start_s", o.start_s)?;
        if o.delivers == Delivers::Swapped && o.axis != Axis::Both {
            let message = "is of one axis: swapped are the two";
            return Err(self.error(&format!("{path}.axis"), message, "remove it"));
        }
        if o.delivers != Delivers::Nothing && o.known {
            let message = "can be reported to nobody: the supervisor knows of lost axes alone";
            let help = "remove it, or let the outage deliver nothing";
            return Err(self.error(&format!("{path}.known"), message, help));
        }
        Ok(Outage {
            start_s: o.start_s,
            duration_s: o.duration_s,
            delivers: o.delivers,
            axis: o.axis,
            known: o.known,
        })
    }

    fn set_down(&self, path: &str, s: &SetDownTable) -> Result<SetDown, SceneError> {
        let tables = &self.spec.tables;
        if tables.levitation.is_none() {
            let message = "moves the reference of [levitation], and there is none";
            let help = "add [levitation] with its gains, or remove it";
            return Err(self.error(path, message, help));
        }
        self.starts(path, "start_s", s.start_s)?;
        Ok(SetDown {
            start_s: s.start_s,
            duration_s: s.duration_s,
            to_m: self.spec.contact.clearance_m * V2::from(s.to),
            announced: s.announced,
        })
    }

    fn fault(&self, path: &str, f: &FaultTable) -> Result<Fault, SceneError> {
        self.starts(path, "start_s", f.start_s)?;
        let within = |key, value, range| self.needed(path, key, value, range);
        let number = |key, value| {
            let row = FaultTable::KEYS.iter().find(|row| row.name == key);
            within(key, value, row.map_or(Range::Finite, |row| row.range))
        };
        let (kind, keys): (FaultKind, &[&str]) = match f.kind {
            FaultName::Nan => (FaultKind::Nan, &[]),
            FaultName::Infinity => (FaultKind::Infinity, &[]),
            FaultName::Zero => (FaultKind::Zero, &[]),
            FaultName::Rail => (FaultKind::Rail, &[]),
            FaultName::Stuck => (FaultKind::Stuck, &[]),
            FaultName::Inverted => (FaultKind::Inverted, &[]),
            FaultName::Swapped => (FaultKind::Swapped, &[]),
            FaultName::Dropout => (FaultKind::Dropout, &[]),
            FaultName::Offset => (
                FaultKind::Offset(number("value_m", f.value_m)?),
                &["value_m"],
            ),
            FaultName::Gain => {
                let factor = within("factor", f.factor, Range::Within(-100.0, 100.0))?;
                (FaultKind::Gain(factor), &["factor"])
            }
            FaultName::Noise => {
                let factor = within("factor", f.factor, Range::Within(0.0, 1e6))?;
                (FaultKind::Noise(factor), &["factor"])
            }
            FaultName::Spikes => {
                let kind = FaultKind::Spikes {
                    rate_hz: within("rate_hz", f.rate_hz, self.rates_hz())?,
                    size_m: number("size_m", f.size_m)?,
                };
                (kind, &["rate_hz", "size_m"])
            }
            FaultName::Delay => {
                let samples = number("samples", f.samples.map(f64::from))?;
                (FaultKind::Delay(samples as usize), &["samples"])
            }
            FaultName::Bits => {
                let bits = number("bits", f.bits.map(f64::from))?;
                (FaultKind::Bits(bits as u32), &["bits"])
            }
            FaultName::Oscillation => {
                let kind = FaultKind::Oscillation {
                    frequency_hz: number("frequency_hz", f.frequency_hz)?,
                    amplitude_m: number("amplitude_m", f.amplitude_m)?,
                };
                (kind, &["frequency_hz", "amplitude_m"])
            }
        };
        let given = f.write();
        let is_given = |name: &str| {
            given
                .as_ref()
                .is_some_and(|table| table.get(name).is_some())
        };
        let foreign = FaultTable::KEYS.iter().find(|row| {
            let belongs = match row.name {
                "axis" => !kind.concerns_both(),
                name => keys.contains(&name),
            };
            matches!(row.absent, Absent::Means(_)) && is_given(row.name) && !belongs
        });
        if let Some(row) = foreign {
            let message = "has no meaning for a fault of this kind";
            let key = format!("{path}.{}", row.name);
            return Err(self.error(&key, message, "remove it, or choose another kind"));
        }
        let sensor = &self.spec.tables.sensor;
        let (missing, without) = match kind {
            FaultKind::Rail | FaultKind::Bits(_) => ("sensor.range_m", sensor.range_m.is_none()),
            FaultKind::Noise(_) => ("sensor.noise_rms_m", sensor.noise_rms_m == 0.0),
            _ => ("", false),
        };
        if without {
            let help = format!("give {missing}, or choose another kind");
            let key = format!("{path}.kind");
            return Err(self.error(&key, &format!("needs {missing}"), &help));
        }
        Ok(Fault {
            start_s: f.start_s,
            duration_s: f.duration_s,
            kind,
            axis: f.axis.unwrap_or_default(),
        })
    }

    /// Which of two values at one time would hold hangs on their order in the file.
    fn no_change_twice(&self) -> Result<(), SceneError> {
        let changes = &self.spec.tables.change;
        for (i, c) in changes.iter().enumerate() {
            for (j, other) in changes.iter().enumerate().take(i) {
                let twice = c.at_s == other.at_s;
                if let Some(key) = c.keys_of_both(other).next().filter(|_| twice) {
                    let message = format!("given for {} s by change[{j}] as well", c.at_s);
                    let help = "remove one of them, or let it come at another time";
                    return Err(self.error(&format!("change[{i}].{key}"), &message, help));
                }
            }
        }
        Ok(())
    }

    fn change(&self, path: &str, c: &ChangeTable) -> Result<TimedChange, SceneError> {
        self.starts(path, "at_s", c.at_s)?;
        if c.drive_torque_n_m.is_some() && self.spec.tables.spin.inertia_kg_m2.is_none() {
            let key = format!("{path}.drive_torque_n_m");
            let message = "has no effect while the speed is held";
            let help = "give spin.inertia_kg_m2, or remove the torque";
            return Err(self.error(&key, message, help));
        }
        let change = Change {
            // Its place counts as the scene has it until the rotor is known.
            unbalance: c.unbalance.as_ref().map(Unbalance::from),
            eccentricity_m: c.eccentricity_m,
            friction_coefficient: c.friction_coefficient,
            drive_torque_n_m: c.drive_torque_n_m,
        };
        if change == Change::default() {
            let help = "give eccentricity_m, unbalance, friction_coefficient or drive_torque_n_m";
            return Err(self.error(path, "changes nothing", help));
        }
        Ok(TimedChange {
            at_s: c.at_s,
            change,
        })
    }
}
