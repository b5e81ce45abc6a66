//! Ranges of a machine's values, and what contradicts each other.

use super::{
    MAX_MAGNETS, MAX_MOTIONS, MAX_PLANES, MachineParams, MachinePlane, MachineStart, Poles,
    RigidRotor, Rotor, Unbalance,
};
use crate::params::{
    ContactLaw, FINITE, NOT_NEGATIVE, POSITIVE, ParamError, SlidingFriction, SpinParams,
    StatorParams, check,
};
use nalgebra::DMatrix;

/// A symmetric matrix, row by row, or nothing.
fn symmetric(
    field: &str,
    values: &[f64],
    (size, count): (usize, &'static str),
) -> Result<(), ParamError> {
    let given = values.len();
    check(
        given == 0 || given == size * size,
        field,
        given as f64,
        count,
    )?;
    for (i, value) in values.iter().enumerate() {
        let mirrored = values[(i % size) * size + i / size];
        let rule = "a symmetric matrix of finite numbers";
        check(*value == mirrored, field, *value, rule)?;
    }
    Ok(())
}

impl RigidRotor {
    fn validate(&self) -> Result<(), ParamError> {
        let (transverse, polar) = (self.transverse_inertia_kg_m2, self.polar_inertia_kg_m2);
        check(self.mass_kg > 0.0, "rotor.mass_kg", self.mass_kg, POSITIVE)?;
        let field = "rotor.transverse_inertia_kg_m2";
        if !self.tilts() && transverse > 0.0 {
            let rule = "0 for a rotor that does not tilt";
            return check(polar == 0.0, "rotor.polar_inertia_kg_m2", polar, rule);
        }
        check(transverse > 0.0, field, transverse, POSITIVE)?;
        let rule =
            "from 0 to twice transverse_inertia_kg_m2: no body has more, a thin disc has just that";
        check(
            (0.0..=2.0 * transverse).contains(&polar),
            "rotor.polar_inertia_kg_m2",
            polar,
            rule,
        )
    }
}

impl Rotor {
    /// Checks every value against its range, and against the others.
    ///
    /// # Errors
    /// The first that is out of range, by name.
    pub fn validate(&self) -> Result<(), ParamError> {
        self.rigid().validate()?;
        if !matches!(self, Self::Rigid(_)) {
            let field = "rotor.transverse_inertia_kg_m2";
            let rule = "a finite number for a rotor that bends";
            check(true, field, self.rigid().transverse_inertia_kg_m2, rule)?;
        }
        for (i, mode) in self.bending().iter().enumerate() {
            let field = |name: &str| format!("rotor.bending[{i}].{name}");
            check(
                mode.frequency_rad_s > 0.0,
                field("frequency_rad_s"),
                mode.frequency_rad_s,
                POSITIVE,
            )?;
            check(
                mode.damping_ratio >= 0.0,
                field("damping_ratio"),
                mode.damping_ratio,
                NOT_NEGATIVE,
            )?;
            let places = mode.shape.len();
            check(
                places >= 2,
                field("shape"),
                places as f64,
                "at least two places",
            )?;
            for (j, (place, shape)) in mode.shape.iter().enumerate() {
                let rises = j == 0 || *place > mode.shape[j - 1].0;
                check(rises, field("shape"), *place, "finite places that rise")?;
                check(true, field("shape"), *shape, FINITE)?;
            }
        }
        let Self::Modal {
            bending,
            polar_coupling_kg_m2,
            damping_n_s_m,
            ..
        } = self
        else {
            return Ok(());
        };
        let modes = bending.len();
        symmetric(
            "rotor.polar_coupling_kg_m2",
            polar_coupling_kg_m2,
            (1 + modes, "(1 + bending modes)² numbers, or none"),
        )?;
        let field = "rotor.damping_n_s_m";
        let count = (2 + modes, "(2 + bending modes)² numbers, or none");
        symmetric(field, damping_n_s_m, count)?;
        if damping_n_s_m.is_empty() {
            return Ok(());
        }
        let matrix = DMatrix::from_row_slice(2 + modes, 2 + modes, damping_n_s_m);
        let least = matrix.symmetric_eigenvalues().min();
        let rule = "a damping that takes energy from every motion: no eigenvalue below 0";
        check(least >= -1e-9 * matrix.amax(), field, least, rule)
    }

    /// Whether a place lies on the rotor, as far as its shapes say.
    pub fn reaches(&self, position_m: f64) -> bool {
        self.bending().iter().all(|mode| {
            let ends = (mode.shape.first(), mode.shape.last());
            matches!(ends, (Some(a), Some(b)) if (a.0..=b.0).contains(&position_m))
        })
    }

    /// Refuses an eccentricity of a rotor whose shapes do not say how its centre of mass moves.
    pub(super) fn has_centre(&self, eccentricity_m: f64) -> Result<(), ParamError> {
        let field = "rotor.eccentricity_m";
        let rule = "0, for no bending mode has its shape at the centre of mass";
        check(
            eccentricity_m == 0.0 || self.reaches(0.0),
            field,
            eccentricity_m,
            rule,
        )
    }

    /// Refuses a place that does not.
    fn has(&self, field: String, position_m: f64) -> Result<(), ParamError> {
        let rule = "a place on the rotor: within the shape of every bending mode";
        check(self.reaches(position_m), field, position_m, rule)
    }
}

impl Unbalance {
    pub(super) fn validate(&self, rotor: &Rotor, of: &str) -> Result<(), ParamError> {
        rotor.has(format!("{of}.position_m"), self.position_m)?;
        let (moment, field) = (self.moment_kg_m, format!("{of}.moment_kg_m"));
        check(moment >= 0.0, field, moment, NOT_NEGATIVE)?;
        check(true, format!("{of}.angle_rad"), self.angle_rad, FINITE)
    }
}

impl Poles {
    fn validate(&self, of: &str) -> Result<(), ParamError> {
        let positive = |name: &str, x: f64| check(x > 0.0, format!("{of}.{name}"), x, POSITIVE);
        positive("bias_current_a", self.bias_current_a)?;
        let (most, bias) = (self.current_max_a, self.bias_current_a);
        let within = most > 0.0 && most <= bias;
        let rule = "more than 0, and at most bias_current_a: beyond it one pole is off, and the force no more in proportion";
        check(within, format!("{of}.current_max_a"), most, rule)?;
        positive("air_gap_m", self.air_gap_m)?;
        let Some(coil) = &self.coil else {
            return Ok(());
        };
        positive("inductance_h", coil.inductance_h)?;
        let needed = coil.resistance_ohm * self.current_max_a;
        let enough = coil.voltage_max_v > 0.0 && coil.voltage_max_v > needed;
        let rule = "more than the resistance takes at the largest current";
        check(
            enough,
            format!("{of}.voltage_max_v"),
            coil.voltage_max_v,
            rule,
        )?;
        let (field, ohm) = (format!("{of}.resistance_ohm"), coil.resistance_ohm);
        check(ohm >= 0.0, field, ohm, NOT_NEGATIVE)
    }
}

impl MachinePlane {
    fn validate(&self, i: usize) -> Result<(), ParamError> {
        let field = |name: &str| format!("planes[{i}].{name}");
        let finite = |name, value| check(true, field(name), value, FINITE);
        let positive = |name, value: f64| check(value > 0.0, field(name), value, POSITIVE);
        let not_negative = |name, value: f64| check(value >= 0.0, field(name), value, NOT_NEGATIVE);
        finite("centre_m", self.centre_m.x)?;
        finite("centre_m", self.centre_m.y)?;
        positive("radius_m", self.radius_m)?;
        positive("contact.clearance_m", self.contact.clearance_m)?;
        match self.contact.law {
            ContactLaw::Linear(law) => {
                positive("contact.stiffness_n_m", law.stiffness_n_m)?;
                not_negative("contact.damping_n_s_m", law.damping_n_s_m)?;
            }
            ContactLaw::HuntCrossley(law) => {
                positive("contact.stiffness_n_mn", law.stiffness_n_mn)?;
                let (n, rule) = (law.exponent, "a number from 1 to 3");
                check((1.0..=3.0).contains(&n), field("contact.exponent"), n, rule)?;
                not_negative("contact.damping_s_m", law.damping_s_m)?;
            }
        }
        match self.friction.sliding {
            SlidingFriction::Constant { coefficient } => {
                not_negative("friction.coefficient", coefficient)?;
            }
            SlidingFriction::Falling {
                at_rest,
                at_speed,
                speed_scale_m_s,
            } => {
                not_negative("friction.coefficient", at_rest)?;
                let falls = (0.0..=at_rest).contains(&at_speed);
                let rule = "from 0 to the coefficient at rest";
                check(
                    falls,
                    field("friction.coefficient_at_speed"),
                    at_speed,
                    rule,
                )?;
                positive("friction.speed_scale_m_s", speed_scale_m_s)?;
            }
        }
        not_negative(
            "friction.rolling_coefficient",
            self.friction.rolling_coefficient,
        )?;
        match &self.stator {
            StatorParams::Rigid => {}
            StatorParams::RigidEllipse(bore) => {
                let (e, range) = (bore.ellipticity, "a number from 0 to 0.2");
                check(
                    (0.0..=0.2).contains(&e),
                    field("stator.ellipticity"),
                    e,
                    range,
                )?;
                check(
                    true,
                    field("stator.long_axis_rad"),
                    bore.long_axis_rad,
                    FINITE,
                )?;
                // A race would turn the ellipse with it.
                let race = self.race.map_or(0.0, |race| race.inertia_kg_m2);
                let rule = "no race: it would turn the ellipse with it";
                check(self.race.is_none(), field("race.inertia_kg_m2"), race, rule)?;
                let expands = self.heat.map_or(0.0, |heat| heat.expansion_m_k);
                let rule = "0 in a bore that is out of round";
                check(expands == 0.0, field("heat.expansion_m_k"), expands, rule)?;
            }
            StatorParams::OneMass(ring) => ring.validate_as(&field, "stator.inner")?,
            StatorParams::TwoMass { inner, outer } => {
                inner.validate_as(&field, "stator.inner")?;
                outer.validate_as(&field, "stator.outer")?;
            }
        }
        if let Some(heat) = &self.heat {
            heat.validate(field)?;
        }
        if let Some(drag) = &self.load_drag {
            drag.validate(field)?;
            let rule = "a race, which it brakes";
            check(
                self.race.is_some(),
                field("load_drag.arm_m"),
                drag.arm_m,
                rule,
            )?;
        }
        let Some(race) = &self.race else {
            return Ok(());
        };
        positive("race.inertia_kg_m2", race.inertia_kg_m2)?;
        not_negative("race.drag_n_m_s", race.drag_n_m_s)?;
        finite("race.start_spin_rad_s", race.start_spin_rad_s)
    }
}

impl crate::params::RingParams {
    fn validate_as(&self, field: &impl Fn(&str) -> String, ring: &str) -> Result<(), ParamError> {
        let name = |key: &str| field(&format!("{ring}.{key}"));
        check(self.mass_kg > 0.0, name("mass_kg"), self.mass_kg, POSITIVE)?;
        for axis in [0, 1] {
            let (k, d) = (self.stiffness_n_m[axis], self.damping_n_s_m[axis]);
            check(k >= 0.0, name("stiffness_n_m"), k, NOT_NEGATIVE)?;
            check(d >= 0.0, name("damping_n_s_m"), d, NOT_NEGATIVE)?;
        }
        Ok(())
    }
}

impl MachineParams {
    /// Checks every value against its range, and against the others.
    ///
    /// # Errors
    /// The first that is out of range, by name.
    pub fn validate(&self) -> Result<(), ParamError> {
        self.rotor.validate()?;
        let polar = self.rotor.rigid().polar_inertia_kg_m2;
        if let SpinParams::Free {
            inertia_kg_m2,
            drive_torque_n_m,
        } = self.spin
        {
            let rule = "more than 0 and at least the rotor's polar inertia, which turns with it";
            check(
                inertia_kg_m2 > 0.0 && inertia_kg_m2 >= polar,
                "spin.inertia_kg_m2",
                inertia_kg_m2,
                rule,
            )?;
            check(true, "spin.drive_torque_n_m", drive_torque_n_m, FINITE)?;
        }
        let place = |list: &str, i: usize, position_m: f64| {
            self.rotor
                .has(format!("{list}[{i}].position_m"), position_m)
        };
        for (i, support) in self.supports.iter().enumerate() {
            place("supports", i, support.position_m)?;
            for axis in [0, 1] {
                let (k, d) = (support.stiffness_n_m[axis], support.damping_n_s_m[axis]);
                check(true, format!("supports[{i}].stiffness_n_m"), k, FINITE)?;
                let field = format!("supports[{i}].damping_n_s_m");
                check(d >= 0.0, field, d, NOT_NEGATIVE)?;
                let (k, d) = (
                    support.cross_stiffness_n_m[axis],
                    support.cross_damping_n_s_m[axis],
                );
                check(
                    true,
                    format!("supports[{i}].cross_stiffness_n_m"),
                    k,
                    FINITE,
                )?;
                check(
                    true,
                    format!("supports[{i}].cross_damping_n_s_m"),
                    d,
                    FINITE,
                )?;
            }
            // What d_xy and d_yx have in common gives power, unless the dampers take as much.
            let (d, common) = (
                support.damping_n_s_m,
                support.cross_damping_n_s_m.sum() / 2.0,
            );
            let rule = "two numbers whose mean is, by its size, at most √(d_xx·d_yy)";
            check(
                common * common <= d.x * d.y,
                format!("supports[{i}].cross_damping_n_s_m"),
                common,
                rule,
            )?;
        }
        let field = "rotor.eccentricity_m";
        check(
            self.eccentricity_m >= 0.0,
            field,
            self.eccentricity_m,
            NOT_NEGATIVE,
        )?;
        self.rotor.has_centre(self.eccentricity_m)?;
        for (i, unbalance) in self.unbalances.iter().enumerate() {
            unbalance.validate(&self.rotor, &format!("unbalances[{i}]"))?;
        }
        let magnets = self.magnets.len();
        let few = magnets <= MAX_MAGNETS;
        check(few, "magnets", magnets as f64, "at most four magnets")?;
        for (i, magnet) in self.magnets.iter().enumerate() {
            place("magnets", i, magnet.position_m)?;
            let (cap, lag) = (magnet.force_max_n, magnet.lag_s);
            check(
                cap > 0.0,
                format!("magnets[{i}].force_max_n"),
                cap,
                POSITIVE,
            )?;
            check(lag >= 0.0, format!("magnets[{i}].lag_s"), lag, NOT_NEGATIVE)?;
            if let Some(ratio) = magnet.lag_damping_ratio {
                let field = format!("magnets[{i}].lag_damping_ratio");
                let rule = "more than 0, with a lag and without poles";
                let alone = lag > 0.0 && magnet.poles.is_none();
                check(ratio > 0.0 && alone, field, ratio, rule)?;
            }
            if let Some(poles) = &magnet.poles {
                let rule =
                    "more than 0: it is the time constant with which poles' currents are set";
                check(lag > 0.0, format!("magnets[{i}].lag_s"), lag, rule)?;
                poles.validate(&format!("magnets[{i}].poles"))?;
                let reach =
                    |plane: &MachinePlane| plane.contact.clearance_m + plane.centre_m.norm();
                let widest = self.planes.iter().map(reach).fold(0.0, f64::max);
                let rule = "more than the clearance of every plane with its offset: retainer bearings keep rotor and poles apart";
                let gap_m = poles.air_gap_m;
                check(
                    gap_m > widest,
                    format!("magnets[{i}].poles.air_gap_m"),
                    gap_m,
                    rule,
                )?;
            }
        }
        for (list, places) in [("loads", &self.loads_m), ("probes", &self.probes_m)] {
            for (i, position_m) in places.iter().enumerate() {
                place(list, i, *position_m)?;
            }
        }
        for axis in [0, 1] {
            check(true, "gravity_m_s2", self.gravity_m_s2[axis], FINITE)?;
        }
        let planes = self.planes.len();
        check(
            (1..=MAX_PLANES).contains(&planes),
            "planes",
            planes as f64,
            "one to four planes",
        )?;
        for (i, plane) in self.planes.iter().enumerate() {
            place("planes", i, plane.position_m)?;
            plane.validate(i)?;
        }
        let rings = self.planes.iter().map(|plane| match plane.stator {
            StatorParams::Rigid | StatorParams::RigidEllipse(_) => 0,
            StatorParams::OneMass(_) => 1,
            StatorParams::TwoMass { .. } => 2,
        });
        let motions = 2 + self.rotor.bending().len() + rings.sum::<usize>();
        let rule = "at most 64 motions, of translation, tilt, bending modes and rings together: keep fewer modes";
        check(
            motions <= MAX_MOTIONS,
            "rotor.bending",
            motions as f64,
            rule,
        )
    }
}

impl MachineStart {
    /// Checks that every value is finite.
    ///
    /// # Errors
    /// The first that is not.
    pub fn validate(&self) -> Result<(), ParamError> {
        let vectors = [
            ("start.centre_m", self.centre_m),
            ("start.centre_velocity_m_s", self.centre_velocity_m_s),
            ("start.tilt_rad", self.tilt_rad),
            ("start.tilt_rate_rad_s", self.tilt_rate_rad_s),
        ];
        for (field, v) in vectors {
            check(true, field, v.x, FINITE)?;
            check(true, field, v.y, FINITE)?;
        }
        check(true, "start.spin_rad_s", self.spin_rad_s, FINITE)?;
        check(true, "start.spin_phase_rad", self.spin_phase_rad, FINITE)
    }
}
