//! Studies: many runs of many scenes, and what is claimed of them.
//!
//! ```
//! use firmware_bench::scene::Scene;
//! use firmware_studies::accuracy::sweep;
//!
//! let text = r#"
//! title = "An impact"
//! [run]
//! duration_s = 0.01
//! sample_rate_hz = 20000
//! policies = ["passive"]
//! [rotor]
//! mass_kg = 10.0
//! stiffness_n_m = 8e5
//! damping_n_s_m = 170.0
//! contact_radius_m = 0.1
//! [spin]
//! frequency_hz = 40.0
//! [start]
//! velocity_m_s = [0.05, 0.0]
//! [contact]
//! clearance_m = 1e-4
//! stiffness_n_m = 1e8
//! restitution = 0.7
//! [friction]
//! coefficient = 0.125
//! "#;
//! let (rows, reference) = sweep(&Scene::parse("impact.toml", text)?)?;
//! assert!(reference.confirmed); // two methods of little in common end at the same place
//! let series = rows.iter().find(|row| row.method == "series" && row.rtol == 1e-9);
//! assert!(series.and_then(|row| row.error).is_some_and(|clearances| clearances < 1e-7));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Rooms, each importing only from those above it: `campaign`, `impacts`, `map`, `machines`, `accuracy`, `drops`, `paper`, `overloads`, `found_in_records`, `paired`, `commissioning`,
//! `trials`, `unseen_machines`, `whole_rotors`, `loop_rates`, `optimum`, `sensitivity`, `on_target`, `validation`.

#![forbid(unsafe_code)]
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod accuracy;
pub mod campaign;
pub mod commissioning;
pub mod drops;
pub mod found_in_records;
mod impacts;
pub mod loop_rates;
pub mod machines;
pub mod map;
pub mod on_target;
pub mod optimum;
pub mod overloads;
pub mod paired;
pub mod paper;
pub mod sensitivity;
pub mod trials;
pub mod unseen_machines;
pub mod validation;
pub mod whole_rotors;

use campaign::Study;

/// Every study, by name. The page of the documentation that shows its last full run is `docs/src/measured/NAME.md`.
pub const STUDIES: &[Study] = &[
    Study {
        name: "accuracy",
        about: "error against run time of the integrator on its benchmark problems",
        run: accuracy::study::study,
        drawn: None,
        on_record: None,
    },
    Study {
        name: "bending",
        about: "what it is worth to configure a bending mode, and what a wrong one costs",
        run: paired::bending::study,
        drawn: None,
        on_record: None,
    },
    Study {
        name: "commissioning",
        about: "mistakes of who links the supervisor, found on levitated machines before it acts",
        run: commissioning::study,
        drawn: Some(commissioning::drawn),
        on_record: None,
    },
    Study {
        name: "drops",
        about: "drops on new, worn and softly mounted ball bearings: how many whirl, beside what others measured",
        run: drops::study,
        drawn: Some(drops::drawn),
        on_record: None,
    },
    Study {
        name: "found-in-records",
        about: "impacts, friction, restitution and outcome as found in flight records of the catalogue, against the plant",
        run: found_in_records::study,
        drawn: None,
        on_record: None,
    },
    Study {
        name: "harm",
        about: "the supervisor against levitation alone on machines drawn at random, with sensors as they are",
        run: paired::harm::study,
        drawn: Some(paired::harm::drawn),
        on_record: None,
    },
    Study {
        name: "loop-rates",
        about: "what a slower call of the supervisor costs",
        run: loop_rates::study,
        drawn: None,
        on_record: None,
    },
    Study {
        name: "optimum",
        about: "the hardest impact that any force within the cap could take, and the supervisor's beside it",
        run: optimum::study,
        drawn: None,
        on_record: None,
    },
    Study {
        name: "overloads",
        about: "every overload of the catalogue under every policy, against what the supervisor promises",
        run: overloads::page::study,
        drawn: None,
        on_record: None,
    },
    Study {
        name: "paper",
        about: "every number and figure of the paper, computed",
        run: paper::study,
        drawn: None,
        on_record: None,
    },
    Study {
        name: "rotor-catalogue",
        about: "hardest blows and overloads of the catalogue's whole rotors, P5 to P8",
        run: whole_rotors::catalogue::study,
        drawn: None,
        on_record: None,
    },
    Study {
        name: "rub",
        about: "forward rub that levitation alone stays in, on machines drawn at random: how often it is broken",
        run: paired::rub::study,
        drawn: Some(paired::rub::drawn),
        on_record: None,
    },
    Study {
        name: "sensitivity",
        about: "what it costs when the supervisor is configured with wrong data of its machine",
        run: sensitivity::study::study,
        drawn: None,
        on_record: None,
    },
    Study {
        name: "target",
        about: "the supervisor on emulated processors: bits, instructions, sizes",
        run: on_target::study::study,
        drawn: None,
        on_record: None,
    },
    Study {
        name: "unseen-machines",
        about: "the catalogue on machines that nothing was tuned on, by how late their forces come",
        run: unseen_machines::study,
        drawn: None,
        on_record: None,
    },
    Study {
        name: "validation",
        about: "the plant beside a record that others measured: flight and impact of a rotor about a pivot",
        run: validation::study,
        drawn: None,
        on_record: Some(validation::on_record),
    },
    Study {
        name: "whole-rotors",
        about: "the supervisor of both planes against levitation alone on rotors drawn at random: rigid, gyroscopic, flexible",
        run: paired::whole_rotors::study,
        drawn: Some(paired::whole_rotors::drawn),
        on_record: None,
    },
    Study {
        name: "worst-tick",
        about: "the dearest tick on an emulated Cortex-M4, looked for by changing the dearest so far",
        run: on_target::worst_tick::study,
        drawn: None,
        on_record: None,
    },
];
