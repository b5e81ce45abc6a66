//! The keys of scene files: every row is a key. What values mean is decided in [`crate::scene`].

use crate::device::actuator::Delivers;
use crate::device::axis::Axis;
use crate::scene::keys::Range::{
    Because, Elsewhere, Finite, NotNegative, Positive, PositiveUpTo, Within,
};
use crate::scene::keys::{Absent, Key, Kind, Range, absent, empty, key_tables};
use crate::scene::read::{self, KeyType, Refusal};
use crate::scene::values::{FaultName, MethodName, Numbers, Pair, PerAxis, PolicyNames, ShapeName};

/// No number, or any.
pub(crate) const ANY: Range = Elsewhere("");
/// Times at which something begins \[s\].
const START_S: Range = Within(0.0, 1e5);
/// How long it lasts \[s\].
const DURATION_S: Range = Within(1e-9, 1e5);

/// All keys, below the tables that they are in.
pub const KEYS: &[Key] = SceneTables::KEYS;

key_tables! {
    /// A whole file.
    SceneTables {
        title: String [required "give a name in one line: title = \"…\", above all tables"], "", Elsewhere("one line, without control characters"), "heads table and report", "name";
        story: String [= String::new()], "", ANY, "what is shown and why; an empty line begins a new paragraph of the report", "description";
        run: RunTable [required], "", ANY, "time, accuracy, policies", "simulation", "sim";
        rotor: RotorTable [required], "", ANY, "the rotor; stiffness and damping directly or as frequency and damping ratio", "shaft";
        spin: SpinTable [required], "", ANY, "how it turns";
        start: StartTable [= StartTable::default()], "", ANY, "where the rotor starts", "initial";
        stator: StatorTable [= StatorTable::default()], "", ANY, "rings of the stator; none: rigid", "housing";
        contact: Option<ContactTable> [or "that of each plane"], "", ANY, "the contact, linear or with a stiffness that grows with depth", "wall";
        friction: Option<FrictionTable> [or "that of each plane"], "", ANY, "friction, constant unless it falls with sliding speed";
        retainer: RetainerTable [= RetainerTable::default()], "", ANY, "the retainer bearing", "touchdown", "backup_bearing", "auxiliary_bearing", "catcher";
        race: Option<RaceTable> [or "a bushing"], "", ANY, "the race that the rotor touches, of a [ball bearing](../theory/model.md#retainer-bearing), with the bore radius `rotor.contact_radius_m` + `contact.clearance_m`", "ball_bearing";
        magnet: Option<MagnetTable> [or "no magnet"], "", ANY, "the magnet with its amplifier", "actuator", "amplifier", "amb", "bearing";
        sensor: SensorTable [= SensorTable::default()], "", ANY, "the position sensor", "probe";
        spin_sensor: SpinSensorTable [= SpinSensorTable::default()], "", ANY, "what is known of the spin", "tacho", "encoder";
        levitation: Option<LevitationTable> [or "no controller"], "", ANY, "the levitation controller of the firmware", "pid", "pd";
        state_space: Option<StateSpaceTable> [or "`levitation`"], "", ANY, "a [state space](controllers.md#state-space) instead of `[levitation]`, over all planes", "lqg", "h_infinity", "mu_synthesis";
        biquads: Option<BiquadsTable> [or "`levitation`"], "", ANY, "[second-order sections](controllers.md#biquads) on each axis instead of `[levitation]`", "sos", "filter", "sections";
        controller: Option<ControllerTable> [or "`levitation`"], "", ANY, "a [program](controllers.md), in Python or a shared library, instead of `[levitation]`, over all planes", "external", "plugin", "python", "library", "fmu";
        radial: RadialTable [= RadialTable::default()], "", ANY, "the policy `radial`";
        damping: DampingTable [= DampingTable::default()], "", ANY, "the policy `damping`";
        supervisor: toml::Table [= toml::Table::new()], "", ANY, "replaces single [suggested parameters](../supervisor/linking.md#parameters)", "config";
        disturbance: Vec<DisturbanceTable> [= Vec::new()], "", ANY, "a force on the rotor for a while; they add", "load", "force", "impulse";
        base_motion: Vec<BaseMotionTable> [= Vec::new()], "", ANY, "acceleration of the housing for a while; only with a rigid stator", "shock", "base", "earthquake";
        outage: Vec<OutageTable> [= Vec::new()], "", ANY, "the amplifier does not deliver what it should for a while", "power_loss", "failure";
        fault: Vec<FaultTable> [= Vec::new()], "", ANY, "of the position sensor, at samples from the start to before the end", "sensor_fault";
        set_down: Vec<SetDownTable> [= Vec::new()], "", ANY, "the reference of `[levitation]` moves to another place and stays: the rotor is set down, or lifted again", "landing", "reference", "lift_off";
        unbalance: Vec<UnbalanceTable> [= Vec::new()], "", ANY, "a residual unbalance", "imbalance";
        change: Vec<ChangeTable> [= Vec::new()], "", ANY, "parameters of the plant that take other values from a time on; see [changes](scenes.md#changes)";
        verdict: VerdictTable [= VerdictTable::default()], "", ANY, "how the end is judged", "outcome";
        plane: Vec<PlaneTable> [= Vec::new()], "", ANY, "a bearing plane of [the rotor](scenes.md#several-planes), at most four; none: one at the centre of mass, with the scene's tables", "bearing_plane", "station";
        shaft: Vec<ShaftTable> [= Vec::new()], "", ANY, "a section of the [shaft](scenes.md#shafts), from left to right; every `position_m` then counts from its left end", "section", "beam";
        disc: Vec<DiscTable> [= Vec::new()], "", ANY, "a rigid disc on the shaft", "disk", "wheel", "impeller";
        support: Vec<SupportTable> [= Vec::new()], "", ANY, "a spring with a damper from the rotor to ground", "spring", "seal";
    }

    RunTable {
        duration_s: f64 [required "give a number of seconds, as 0.2"], "s", Within(1e-9, 1e5), "rounded to whole samples, at least one; at most a billion over all policies, beyond 100 million with `--no-trace`, and 10 million where rows are kept in memory (`--verify`, Python)", "time", "t_end", "length";
        sample_rate_hz: f64 [required "give the control rate in Hz, as 20000"], "Hz", Within(1.0, 1e6), "control rate", "control_rate", "rate", "fs", "sampling", "period", "dt";
        planes_in_turn: bool [= false], "", ANY, "the supervisor of a rotor in two planes ticks one of them in a control sample and the other in the next, as [firmware without time for both](../supervisor/linking.md#two-bearing-planes) has it", "in_turn", "alternate";
        policies: PolicyNames [required], "", Elsewhere("at least one, each once"), "see [policies](scenes.md#policies)", "controllers", "policy";
        rtol: f64 [= 1e-9], "1", Within(1e-14, 1e-2), "tolerance of a contact step", "tolerance", "tol", "accuracy";
        method: MethodName [= MethodName::Auto], "", ANY, "[how contact is integrated](../theory/integration.md#choosing-a-method)", "solver", "integrator";
        seed: u64 [= 0], "", NotNegative, "seed of the sensor noise, the same for every policy";
    }

    RotorTable {
        mass_kg: Option<f64> [or "that of `[[shaft]]` and `[[disc]]`"], "kg", Positive, "m_r; required without `[[shaft]]`", "m", "weight";
        stiffness_n_m: Option<f64> [or "0"], "N/m", Finite, "of the shaft, between centre of mass and ground; excludes `natural_frequency_hz`", "k", "shaft_stiffness";
        natural_frequency_hz: Option<f64> [or "–"], "Hz", Within(0.0, 1e6), "gives m_r·(2πf)² as shaft stiffness", "f0", "omega0", "eigenfrequency";
        damping_n_s_m: Option<f64> [or "0"], "N s/m", NotNegative, "d_r; excludes `damping_ratio`", "d", "c";
        damping_ratio: Option<f64> [or "–"], "1", Within(0.0, 100.0), "gives 2·ratio·√(m_r·k), k the *shaft* stiffness, which must be positive", "zeta", "xi";
        eccentricity_m: f64 [= 0.0], "m", NotNegative, "ε_r, the unbalance", "unbalance", "imbalance", "e";
        contact_radius_m: Option<f64> [or "that of each plane"], "m", Positive, "R_r", "radius", "r", "diameter";
        gravity_m_s2: Pair [= Pair::default()], "m/s²", Within(-1e4, 1e4), "weight = m_r times this", "g";
        transverse_inertia_kg_m2: Option<f64> [or "–"], "kg m²", Positive, "I_t about the centre of mass; required in several planes; one plane without it: a point mass", "i_t", "it";
        polar_inertia_kg_m2: Option<f64> [or "–"], "kg m²", NotNegative, "I_p, at most twice I_t; goes with I_t", "i_p", "ip";
        bending_to_hz: Option<f64> [or "3000"], "Hz", NotNegative, "of `[[shaft]]` or `matrices_file`: bending modes up to here are kept, of the others the static compliance; 0: rigid";
        bending_damping_ratio: Option<f64> [or "0"], "1", Within(0.0, 100.0), "of these modes";
        elements: Option<u32> [or "16"], "", Within(1.0, 200.0), "of a `[[shaft]]`, at least";
        matrices_file: Option<String> [or "–"], "", ANY, "[matrices of the free rotor](scenes.md#rotor-by-matrices) instead of mass, inertias and `[[shaft]]`; every `position_m` then counts as its places do", "npz";
        bending: Vec<BendingTable> [= Vec::new()], "", ANY, "a bending mode of the free shaft", "mode", "flexible";
        polar_coupling_kg_m2: Numbers [= Numbers::default()], "kg m²", Finite, "∫ I_p′·φ_i′·φ_j′ dz of the slopes of tilt and bending modes, row by row; the first number is left to I_p; none: no gyroscopic effect on bending";
    }

    /// A bending mode of the free shaft at standstill.
    BendingTable {
        frequency_hz: f64 [required], "Hz", PositiveUpTo(1e6), "natural frequency", "f", "frequency";
        damping_ratio: f64 [= 0.0], "1", Within(0.0, 100.0), "share of critical damping", "zeta", "xi";
        positions_m: Numbers [required], "m", Finite, "places along the axis, rising; they enclose every plane, magnet, sensor and load", "z", "places_m";
        displacements: Numbers [required], "1", Finite, "displacement at each place, linear in between; the modal mass is the rotor's mass", "shape", "phi";
    }

    SpinTable {
        frequency_hz: f64 [required "give turns a second in Hz, as 200.0"], "Hz", Finite, "Ω/2π at the start; negative: clockwise", "rpm", "speed", "omega", "rotation", "spin";
        inertia_kg_m2: Option<f64> [or "held spin"], "kg m²", Positive, "J_r; without it the drive holds the speed", "j", "polar_inertia", "moment_of_inertia";
        drive_torque_n_m: Option<f64> [or "0"], "N m", Finite, "t_d; needs `inertia_kg_m2`", "torque", "t_d";
    }

    StartTable [Default] {
        position_m: Pair [= Pair::default()], "m", Finite, "as seen from the magnets; may lie in the wall", "x", "displacement";
        velocity_m_s: Pair [= Pair::default()], "m/s", Finite, "velocity of the rotor's centre", "v", "speed";
        tilt_rad: Option<Pair> [or "0"], "rad", Finite, "slope of the axis, dx/dz and dy/dz", "tilt", "angle_rad";
        tilt_rate_rad_s: Option<Pair> [or "0"], "rad/s", Finite, "its rate", "tilt_rate";
        spin_phase_rad: f64 [= 0.0], "rad", Finite, "σ at t = 0, the angle of the unbalance", "angle", "phase";
        levitated_before: bool [= false], "", ANY, "the rotor levitated up to t = 0: every sample has the status `LEVITATED_BEFORE`; for scenes that begin with the event";
    }

    StatorTable [Default] {
        inner: Option<RingTable> [or "rigid"], "", ANY, "the ring that the rotor touches", "ring", "mass";
        outer: Option<RingTable> [or "ground"], "", ANY, "the ring that the inner one stands on; needs `[stator.inner]`";
    }

    /// One ring with its mounting.
    RingTable {
        mass_kg: f64 [required], "kg", Positive, "of the ring", "m";
        stiffness_n_m: PerAxis [required], "N/m", NotNegative, "mounting of the ring", "k";
        damping_n_s_m: PerAxis [required], "N s/m", NotNegative, "mounting of the ring", "d", "c";
    }

    ContactTable {
        clearance_m: f64 [required "give the radial clearance in m, as 2e-4"], "m", Positive, "radial clearance c", "gap", "air_gap", "radial_clearance", "delta";
        stiffness_n_m: Option<f64> [or "–"], "N/m", Positive, "k_c of the linear contact; this or `stiffness_n_mn`", "k", "k_c";
        damping_n_s_m: Option<f64> [or "0"], "N s/m", NotNegative, "d_c; excludes `restitution`", "d", "d_c";
        balls: Option<BallsTable> [or "–"], "", ANY, "a [ball bearing](../theory/model.md#balls) instead of a stiffness: gives k_h, with n = 1.5", "ball_bearing";
        deflections_m: Option<Numbers> [or "–"], "m", Positive, "a measured curve instead of a stiffness: k_h·δⁿ is fitted to it; needs `forces_n`", "curve";
        forces_n: Option<Numbers> [or "–"], "N", Positive, "its forces";
        stiffness_n_mn: Option<f64> [or "–"], "N/mⁿ", Positive, "k_h of [Hunt and Crossley's contact](../theory/model.md#hunt-and-crossleys-law); required by `exponent`, `damping_s_m` and `restitution_speed_m_s`", "k_h", "hertz";
        exponent: Option<f64> [or "1.5"], "1", Within(1.0, 3.0), "n", "n";
        damping_s_m: Option<f64> [or "0"], "s/m", NotNegative, "λ; excludes `restitution`", "lambda";
        restitution: Option<f64> [or "–"], "1", PositiveUpTo(1.0), "e; gives d_c by [(2.12)](../theory/model.md#restitution-and-contact-damping) with the reduced mass", "e", "cor";
        restitution_speed_m_s: Option<f64> [or "–"], "m/s", Within(1e-9, 1e6), "impact speed that `restitution` belongs to (2.34); required with it in Hunt and Crossley's contact";
    }

    /// What a ball bearing's stiffness follows from.
    BallsTable {
        count: u32 [required], "", Within(3.0, 1000.0), "Z, of one row", "number", "z";
        diameter_m: f64 [required], "m", PositiveUpTo(1.0), "D of a ball", "d";
        contact_angle_deg: f64 [= 0.0], "°", Within(0.0, 89.0), "α", "angle", "alpha";
    }

    FrictionTable {
        coefficient: f64 [required "give the coefficient of sliding friction, as 0.15"], "1", NotNegative, "μ, or μ_0, at rest", "mu", "friction", "sliding";
        coefficient_at_speed: Option<f64> [or "–"], "1", Elsewhere("0 to `coefficient`"), "μ_∞; needs `speed_scale_m_s`", "mu_inf";
        speed_scale_m_s: Option<f64> [or "–"], "m/s", Positive, "v_0; needs `coefficient_at_speed`", "v0";
        rolling_coefficient: f64 [= 0.0], "1", NotNegative, "μ_r", "mu_r", "rolling";
    }

    RetainerTable [Default] {
        centre_offset_m: Pair [= Pair::default()], "m", Elsewhere("shorter than the clearance"), "its centre as seen from that of magnets and sensors; see [centres](scenes.md#centres)", "misalignment";
        ellipticity: f64 [= 0.0], "1", Within(0.0, 0.2), "ε of a bearing [out of round](../theory/model.md#out-of-round), with semi-axes c·(1 ± ε); only with a rigid stator and no race", "ovality";
        long_axis_deg: Option<f64> [or "0"], "°", Finite, "direction of the longer axis, counter-clockwise from x; needs `ellipticity`";
        severity_allowed: Option<f64> [or "that of its ledger, else `supervisor.severity_limit`"], "1", Within(1e-3, 1e8), "severity that it may bear in all, from which [`review`](review.md#landings-that-are-left) counts the landings that are left", "allowance";
        heat: Option<HeatTable> [or "stays as it is"], "", ANY, "what its losses do to the bearing", "thermal", "temperature";
    }

    /// One mass that all losses of a bearing warm.
    HeatTable {
        capacity_j_k: f64 [required], "J/K", Positive, "heat capacity C", "c";
        conductance_w_k: f64 [= 0.0], "W/K", NotNegative, "G to the surroundings", "g";
        expansion_m_k: f64 [= 0.0], "m/K", Within(-1e-4, 1e-4), "growth of the radial clearance per kelvin; negative: it closes", "growth";
        start_rise_k: f64 [= 0.0], "K", Within(-1e3, 1e4), "rise over the surroundings at the start";
    }

    RaceTable {
        inertia_kg_m2: f64 [required], "kg m²", Positive, "J_i", "j";
        drag_n_m_s: f64 [= 0.0], "N m s", NotNegative, "b, viscous drag of the bearing", "b";
        start_frequency_hz: f64 [= 0.0], "Hz", Finite, "Ω_i/2π at the start", "frequency", "speed", "rpm";
        load_drag_m: Option<f64> [or "none"], "m", NotNegative, "κ: moment against the race's spin per newton of load, = the bearing's coefficient of friction times half its bore", "kappa";
        load_drag_from_hz: f64 [= 1.0], "Hz", Positive, "spin from which that drag has its full size";
    }

    MagnetTable {
        force_max_n: f64 [required "give the force cap in N"], "N", Positive, "cap on the length of the force vector", "force", "max_force", "cap", "f_max";
        lag_s: f64 [= 0.0], "s", NotNegative, "amplifier lag τ", "tau", "time_constant", "bandwidth";
        lag_damping_ratio: Option<f64> [or "first order"], "1", PositiveUpTo(100.0), "ζ of a second-order amplifier, τ²·f̈ + 2ζτ·ḟ + f = command; needs `lag_s`", "order";
        negative_stiffness_n_m: f64 [= 0.0], "N/m", Because(0.0, 1e12, "that it is negative is in the name"), "subtracted from the shaft stiffness, also under `passive`", "k_s", "stiffness", "ks";
        axis_force_max_n: Option<f64> [or "none"], "N", Positive, "cap on each component, after the cap on the vector; the supervisor knows it";
        slew_n_s: Option<f64> [or "none"], "N/s", Positive, "fastest change of each component, before the lag: the voltage limit", "slew_rate", "rate";
        delay_samples: u32 [= 1], "samples", Within(1.0, 7.0), "from a position to the effect of the command computed from it", "delay", "latency";
        delay_jitter_samples: u32 [= 0], "samples", Within(0.0, 6.0), "largest random extra delay of a command, from `run.seed`; a command overtaken by a newer one is dropped. With `delay_samples` at most 7; the supervisor does not know it", "jitter";
        position_m: Option<f64> [or "that of its plane"], "m", Finite, "along the axis, from the centre of mass", "z";
        axes_deg: f64 [= 0.0], "°", Within(-180.0, 180.0), "angle of the magnet's x axis from the scene's: commands, axis caps and outages are along its axes; not with `poles`", "angle", "rotation";
        poles: Option<PolesTable> [or "a force that does not depend on the place"], "", ANY, "[attracting poles with currents](scenes.md#poles); needs `lag_s`", "coils";
        force_measured: bool [= false], "", ANY, "the supervisor gets the force that the magnet delivers at the sample, less what is fed forward (`APPLIED_VALID`)";
    }

    /// Two poles that face each other on each axis, and the drive of their currents.
    PolesTable {
        bias_current_a: f64 [required], "A", Positive, "i_0", "bias", "i0";
        air_gap_m: f64 [required], "m", Positive, "s_0, with the rotor in the middle", "gap", "s0";
        current_max_a: Option<f64> [or "`bias_current_a`"], "A", Positive, "largest control current; it gives `force_max_n` in the middle", "i_max";
        inductance_h: Option<f64> [or "no limit of voltage"], "H", Positive, "L of an axis; needs `voltage_max_v`", "l";
        resistance_ohm: Option<f64> [or "0"], "Ω", NotNegative, "R of an axis; needs `inductance_h`", "r";
        voltage_max_v: Option<f64> [or "–"], "V", Positive, "U, largest voltage; needs `inductance_h`", "u", "v_max", "dc_link";
    }

    SensorTable [Default] {
        quantum_m: f64 [= 0.0], "m", Within(0.0, 1.0), "step of the converter, rounded to the nearest; 0: none", "resolution", "lsb", "step";
        noise_rms_m: f64 [= 0.0], "m", Within(0.0, 1.0), "normal noise per axis, added before the converter", "noise", "sigma";
        offset_m: Pair [= Pair::default()], "m", Within(-1.0, 1.0), "reading in the centre", "bias";
        gain: PerAxis [= PerAxis::Both(1.0)], "1", Within(-100.0, 100.0), "reading per position", "sensitivity", "scale";
        range_m: Option<f64> [or "none"], "m", Within(1e-9, 1.0), "largest reading to either side; clipped there", "limit";
        delay_samples: u32 [= 0], "samples", Within(0.0, 7.0), "age of the position that is read; with the policy `supervisor` at most 7 together with `magnet.delay_samples`", "delay", "latency";
        swapped: bool [= false], "", ANY, "x reads y and y reads x";
        runout_m: f64 [= 0.0], "m", Within(0.0, 1.0), "amplitude of what the target adds to the reading once a turn", "run_out";
        runout_phase_rad: f64 [= 0.0], "rad", Within(-1e6, 1e6), "its angle at t = 0";
        position_m: Option<f64> [or "that of its plane"], "m", Finite, "along the axis, from the centre of mass", "z";
        axes_deg: f64 [= 0.0], "°", Within(-180.0, 180.0), "angle of the sensor's x axis from the scene's: the firmware reads along its axes", "angle", "rotation";
    }

    SpinSensorTable [Default] {
        valid: bool [= true], "", ANY, "whether the spin is marked valid";
        reversed: bool [= false], "", ANY, "spin reported with the wrong sign";
        gain: f64 [= 1.0], "1", Within(0.0, 100.0), "spin reported over spin";
    }

    LevitationTable {
        proportional_n_m: f64 [required], "N/m", Within(0.0, 1e12), "K_p", "kp", "k_p", "p", "stiffness", "gain";
        integral_n_m_s: f64 [= 0.0], "N/(m s)", Within(0.0, 1e15), "K_i", "ki", "k_i", "i";
        derivative_n_s_m: f64 [required], "N s/m", Within(0.0, 1e9), "K_d", "kd", "k_d", "d", "damping";
        derivative_filter_s: f64 [= 0.0], "s", Within(0.0, 1.0), "filter of the derivative; 0: plain difference", "filter", "tau_d";
        tilt: Option<TiltTable> [or "each plane by itself"], "", ANY, "levitation by mode: the gains above then act on the translation, through all magnets together, these on the tilt", "conical";
        feed_forward_weight: bool [= false], "", ANY, "the firmware adds minus the weight to the command of every policy, `passive` too; the amplifier limits the sum", "feed_forward", "gravity_compensation";
    }

    /// Gains of the tilt.
    TiltTable {
        proportional_n_m_rad: f64 [required], "N m/rad", Within(0.0, 1e12), "moment per slope", "kp";
        integral_n_m_rad_s: f64 [= 0.0], "N m/(rad s)", Within(0.0, 1e15), "moment per slope and time", "ki";
        derivative_n_m_s_rad: f64 [required], "N m s/rad", Within(0.0, 1e9), "moment per rate of slope", "kd";
        cross_feedback: f64 [= 0.0], "1", Within(-2.0, 2.0), "share of the gyroscopic moment I_p·Ω times rate of slope that is compensated, by the reported spin", "gyroscopic";
    }

    /// x ← A·x + B·y, f = C·x + D·y from the readings y of all planes, x and y of one after the other, to the forces f of all
    /// planes that have a magnet.
    StateSpaceTable {
        file: Option<String> [or "–"], "", ANY, "an `.npz` file with arrays A, B, C and D", "npz";
        a: Numbers [= Numbers::default()], "1", Finite, "A, row by row, n × n; none: a controller without state";
        b: Numbers [= Numbers::default()], "1/m", Finite, "B, n × readings";
        c: Numbers [= Numbers::default()], "N", Finite, "C, forces × n";
        d: Numbers [= Numbers::default()], "N/m", Finite, "D, forces × readings; none: zero";
        feed_forward_weight: bool [= false], "", ANY, "as of `levitation`";
    }

    /// f = −gain·H(z)·y from a plane's reading to its magnet's force, axis by axis.
    BiquadsTable {
        gain_n_m: f64 [= 1.0], "N/m", Finite, "f = −`gain_n_m`·H(z)·y on each axis, from the plane's reading to its magnet", "gain", "k";
        sections: Numbers [= Numbers::default()], "1", Finite, "H(z), six numbers a section: b0, b1, b2, a0, a1, a2, as SciPy orders them; none: 1", "sos";
        sections_y: Numbers [= Numbers::default()], "1", Finite, "of y; none: as of x", "sos_y";
        file: Option<String> [or "–"], "", ANY, "an `.npz` file instead of `sections`, with an array `sos`, sections × 6, and `sos_y` where y differs", "npz";
        feed_forward_weight: bool [= false], "", ANY, "as of `levitation`";
    }

    ControllerTable [Default] {
        python: Option<String> [or "–"], "", ANY, "a file of Python with `make(scene)`; this or `library`", "script", "module";
        library: Option<String> [or "–"], "", ANY, "a shared library with the functions of `amb_controller.h`", "shared_library", "so", "dll";
        parameters: Numbers [= Numbers::default()], "1", Finite, "numbers for the program, such as gains", "gains", "arguments";
        timeout_s: f64 [= 10.0], "s", Within(0.01, 3600.0), "longest wait for each answer, the start included; then the run ends", "timeout";
        feed_forward_weight: bool [= false], "", ANY, "as of `levitation`";
    }

    RadialTable [Default] {
        band: f64 [= 0.7], "1", Within(0.0, 1.0), "share of the clearance beyond which it pushes";
    }

    DampingTable [Default] {
        coefficient_n_s_m: Option<f64> [or "the whole cap at [lift-off speed](../theory/whirl.md#lift-off)"], "N s/m", Within(0.0, 1e9), "d of the policy", "d", "kd";
    }

    DisturbanceTable {
        start_s: Option<f64> [or "required; with `file` 0"], "s", START_S, "before the end of the run; added to the times of a file", "t", "time", "at_s";
        duration_s: Option<f64> [or "required; with `file` to its last time"], "s", DURATION_S, "how long it acts", "length";
        force_n: Option<Pair> [or "required; with `file` [1, 1]"], "N", Within(-1e9, 1e9), "force on the rotor; the amplitude where it varies; multiplies the columns of a file", "f", "amplitude";
        position_m: Option<f64> [or "the centre of mass"], "m", Finite, "where along the axis", "z";
        shape: ShapeName [= ShapeName::Constant], "", ANY, "[course](scenes.md#loads) over the interval", "form", "kind";
        frequency_hz: Option<f64> [or "–"], "Hz", Elsewhere("0 to the control rate"), "with `sine` only", "f";
        phase_rad: Option<f64> [or "0"], "rad", Within(-1e6, 1e6), "at the start; with `sine` only";
        file: Option<String> [or "–"], "", ANY, "a [recorded course](scenes.md#loads) instead of a shape: CSV, Parquet, MAT or MCAP, by its path from the scene file", "csv", "parquet", "path";
        time_column: Option<String> [or "`t_s`"], "", ANY, "times of the file, in s", "t_column";
        x_column: Option<String> [or "`force_x_n`"], "", ANY, "force along x in the file; of `x_column` and `y_column` one alone leaves the other axis without", "columns";
        y_column: Option<String> [or "`force_y_n`"], "", ANY, "force along y in the file";
    }

    BaseMotionTable {
        start_s: Option<f64> [or "required; with `file` 0"], "s", START_S, "before the end of the run; added to the times of a file", "t", "time", "at_s";
        duration_s: Option<f64> [or "required; with `file` to its last time"], "s", DURATION_S, "how long it acts", "length";
        acceleration_m_s2: Option<Pair> [or "required; with `file` [1, 1]"], "m/s²", Within(-1e7, 1e7), "of the housing; the amplitude where it varies; multiplies the columns of a file", "a", "amplitude";
        shape: ShapeName [= ShapeName::Constant], "", ANY, "[course](scenes.md#loads) over the interval", "form", "kind";
        frequency_hz: Option<f64> [or "–"], "Hz", Elsewhere("0 to the control rate"), "with `sine` only", "f";
        phase_rad: Option<f64> [or "0"], "rad", Within(-1e6, 1e6), "at the start; with `sine` only";
        file: Option<String> [or "–"], "", ANY, "a [recorded course](scenes.md#loads) instead of a shape, as of a disturbance", "csv", "parquet", "path";
        time_column: Option<String> [or "`t_s`"], "", ANY, "times of the file, in s", "t_column";
        x_column: Option<String> [or "`acceleration_x_m_s2`"], "", ANY, "acceleration along x in the file", "columns";
        y_column: Option<String> [or "`acceleration_y_m_s2`"], "", ANY, "acceleration along y in the file";
    }

    OutageTable {
        start_s: f64 [required], "s", START_S, "before the end of the run", "t", "time", "at_s";
        duration_s: f64 [required], "s", DURATION_S, "how long it lasts", "length";
        delivers: Delivers [= Delivers::Nothing], "", ANY, "no force, the opposite force, or x and y exchanged (both axes only)", "kind";
        axis: Axis [= Axis::Both], "", ANY, "which axis fails";
        known: bool [= false], "", ANY, "the firmware knows: the supervisor is given each lost axis, and that the bearing is off while both are lost; only with `nothing`";
    }

    SetDownTable {
        start_s: f64 [required], "s", START_S, "before the end of the run", "t", "time", "at_s";
        duration_s: f64 [required], "s", DURATION_S, "time in which the reference moves there, evenly", "length";
        to: Pair [required "give [x, y] in clearances, as [0.0, -1.2]"], "1", Within(-100.0, 100.0), "new reference in clearances, as seen from the magnets; beyond 1 it presses the rotor on its retainer bearing", "reference", "target";
        announced: bool [= false], "", ANY, "the supervisor gets the status `SET_DOWN`, from `start_s` until another one starts";
    }

    FaultTable {
        start_s: f64 [required], "s", START_S, "before the end of the run", "t", "time", "at_s";
        duration_s: f64 [required], "s", DURATION_S, "how long it lasts", "length";
        kind: FaultName [required], "", ANY, "see [kinds of fault](#kinds-of-fault), with the keys of each", "type";
        axis: Option<Axis> [or "`both`"], "", ANY, "not for kinds that concern the pair";
        value_m: Option<f64> [or "–"], "m", Within(-1.0, 1.0), "of an `offset`", "offset";
        factor: Option<f64> [or "–"], "1", Elsewhere("`gain`: ±100, `noise`: 0 to 1e6"), "of a `gain` or of `noise`", "gain";
        rate_hz: Option<f64> [or "–"], "Hz", Elsewhere("0 to the control rate"), "of `spikes`";
        size_m: Option<f64> [or "–"], "m", Within(0.0, 1.0), "of `spikes`", "amplitude";
        samples: Option<u32> [or "–"], "samples", Within(1.0, 1000.0), "of a `delay`", "delay";
        bits: Option<u32> [or "–"], "bits", Within(1.0, 32.0), "of a converter of fewer `bits`", "resolution";
        frequency_hz: Option<f64> [or "–"], "Hz", Within(0.0, 1e6), "of an `oscillation`";
        amplitude_m: Option<f64> [or "–"], "m", Within(0.0, 1.0), "of an `oscillation`";
    }

    ChangeTable {
        at_s: f64 [required], "s", Within(0.0, 1e5), "before the end of the run", "t", "time", "start";
        eccentricity_m: Option<f64> [or "as it was"], "m", Within(0.0, 1.0), "new ε_r", "unbalance", "imbalance";
        friction_coefficient: Option<f64> [or "as it was"], "1", Within(0.0, 10.0), "new μ, the same at every speed", "mu", "friction";
        drive_torque_n_m: Option<f64> [or "as it was"], "N m", Within(-1e9, 1e9), "new t_d; needs `spin.inertia_kg_m2`", "torque";
        unbalance: Option<UnbalanceTable> [or "as it was"], "", ANY, "added to the unbalances that there are: a lost blade", "blade", "imbalance_added";
    }

    VerdictTable [Default] {
        whirl_speed_m_s: Option<f64> [or "see [outcomes](results.md#outcomes)"], "m/s", Within(1e-9, 1e6), "backward contact speed above which a run counts as whirl", "limit";
    }

    /// A bearing plane of a whole rotor. What it does not give of its own is the scene's.
    PlaneTable {
        name: String [required "give a name in one line, as \"coupling end\""], "", Elsewhere("one line; no two alike"), "heads its figures", "title", "label";
        position_m: f64 [required], "m", Finite, "of the retainer bearing along the axis, from the centre of mass", "z", "place";
        contact_radius_m: Option<f64> [or "the scene's"], "m", Positive, "R_r", "radius", "r";
        seal: bool [= false], "", ANY, "a [seal](scenes.md#seals) or a bushing: no magnet, sensor or controller, whatever the scene's tables say", "bushing", "passive", "no_magnet";
        start_position_m: Option<Pair> [or "by `start`"], "m", Finite, "where the rotor starts in this plane, as seen from the magnets; of two planes, both or none";
        start_velocity_m_s: Option<Pair> [or "by `start`"], "m/s", Finite, "its velocity there; with `start_position_m`, or both planes alone";
        stator: Option<StatorTable> [or "the scene's"], "", ANY, "rings of the stator";
        contact: Option<ContactTable> [or "the scene's"], "", ANY, "the contact; linear";
        friction: Option<FrictionTable> [or "the scene's"], "", ANY, "friction; the same at every speed";
        retainer: Option<RetainerTable> [or "the scene's"], "", ANY, "the retainer bearing; round";
        race: Option<RaceTable> [or "the scene's"], "", ANY, "the race that the rotor touches";
        magnet: Option<MagnetTable> [or "the scene's"], "", ANY, "the magnet with its amplifier";
        sensor: Option<SensorTable> [or "the scene's"], "", ANY, "the position sensor; its noise is the plane's own";
        levitation: Option<LevitationTable> [or "the scene's"], "", ANY, "the levitation controller of this plane";
        biquads: Option<BiquadsTable> [or "the scene's"], "", ANY, "the filters of this plane";
        supervisor: Option<toml::Table> [or "the scene's"], "", ANY, "replaces single suggested parameters";
        outage: Vec<OutageTable> [= Vec::new()], "", ANY, "of this magnet; none: the scene's";
        fault: Vec<FaultTable> [= Vec::new()], "", ANY, "of this sensor; none: the scene's";
    }

    /// A cylindrical piece of the shaft; steel, unless it says otherwise.
    ShaftTable {
        length_m: f64 [required], "m", Positive, "of the section", "l", "length";
        outer_diameter_m: f64 [required], "m", Positive, "of the section", "od", "diameter", "outer_diameter";
        inner_diameter_m: f64 [= 0.0], "m", NotNegative, "less than the outer one", "id", "bore";
        density_kg_m3: f64 [= 7850.0], "kg/m³", Positive, "of the material", "rho", "density";
        youngs_modulus_n_m2: f64 [= 2.1e11], "N/m²", Positive, "of the material", "e", "youngs_modulus";
        poisson_ratio: f64 [= 0.3], "1", Within(0.0, 0.5), "of the material; gives the shear modulus", "nu", "poisson";
    }

    DiscTable {
        position_m: f64 [required], "m", NotNegative, "of its centre, from the left end of the shaft", "z";
        mass_kg: f64 [required], "kg", NotNegative, "of the disc", "m";
        transverse_inertia_kg_m2: f64 [= 0.0], "kg m²", NotNegative, "about its own centre", "i_t", "id";
        polar_inertia_kg_m2: f64 [= 0.0], "kg m²", NotNegative, "about the axis", "i_p", "ip";
    }

    SupportTable {
        position_m: f64 [required], "m", Finite, "along the axis, from the centre of mass", "z";
        stiffness_n_m: PerAxis [= PerAxis::Both(0.0)], "N/m", Finite, "of the spring; may be negative", "k";
        damping_n_s_m: PerAxis [= PerAxis::Both(0.0)], "N s/m", NotNegative, "of the damper", "d", "c";
        cross_stiffness_n_m: Pair [= Pair::default()], "N/m", Finite, "[k_xy, k_yx] of a seal: f_x = −k_xy·y, f_y = −k_yx·x; at a positive spin [k, −k] drives forward whirl", "kxy", "cross_coupling";
        cross_damping_n_s_m: Pair [= Pair::default()], "N s/m", Finite, "[d_xy, d_yx], likewise; the mean of the two no larger than √(d_xx·d_yy)", "dxy";
    }

    UnbalanceTable {
        position_m: f64 [required], "m", Finite, "along the axis, from the centre of mass", "z";
        moment_kg_m: f64 [required], "kg m", NotNegative, "mass times eccentricity", "u", "unbalance";
        angle_rad: f64 [= 0.0], "rad", Within(-1e6, 1e6), "on the rotor, from that of the spin", "phase", "angle";
    }
}
