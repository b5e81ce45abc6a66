//! How well the supervisor has to know its machine: with its data configured wrong as data commonly are.

use firmware_bench::scene::Scene;
use firmware_studies::machines::random::RandomMachine;
use firmware_studies::overloads::contenders::Contender;
use firmware_studies::overloads::results::ResultRow;
use firmware_studies::sensitivity::misjudged;
use firmware_studies::sensitivity::study::{Outcome, configured_wrong, of_the_catalogue};
use firmware_studies::trials::Trial;
use rayon::prelude::*;
use serde_json::Value;
use system_tests::ran::{Folder, has, list, number, scene_text};

/// A bearing of the catalogue, all its scenes: whatever is configured wrong by as much as is usual, the supervisor recovers
/// from what levitation alone recovers from, and from nearly all that it recovers from when configured right. The one
/// exception is no error of judgement: with less force than there is, it uses less.
#[test]
fn configured_wrong_it_loses_next_to_nothing() {
    let trials = of_the_catalogue("P2").unwrap();
    let Outcome {
        alone,
        right,
        wrong,
        ..
    } = configured_wrong(&trials, (1.0, 0), &()).unwrap();
    assert!(right > alone, "{right} {alone}");
    for t in wrong {
        let less_force = t.text == "force cap × 0.8";
        let few = if less_force { 5 } else { 1 };
        assert!(t.lost_to_right <= few, "{}: {}", t.text, t.lost_to_right);
        assert!(
            less_force || t.lost_to_levitation.is_empty(),
            "{}: {:?}",
            t.text,
            t.lost_to_levitation
        );
    }
}

/// The rows of the command on a scene.
fn rows(more: &str) -> Vec<Value> {
    let line = format!("sensitivity @overload_then_release --json {more}");
    let json = Folder::fresh().ran(&line).json();
    list(&json["rows"]).to_vec()
}

fn row<'a>(rows: &'a [Value], configured: &str) -> &'a Value {
    (rows.iter().find(|row| row["configured"] == configured))
        .unwrap_or_else(|| panic!("{configured}: {rows:#?}"))
}

/// A sensor assumed to be seven times as noisy as it is makes the observer slow and the contact band a fifth of the clearance. A rotor
/// that turns round in that band, in flight, is no rotor at rest, which would be pushed with the whole cap.
#[test]
fn a_rotor_that_turns_round_near_the_wall_does_not_rest() {
    let draws = misjudged(2.0, 8, 1);
    let noisy = draws
        .iter()
        .find(|m| m.text == "all at once, draw 7")
        .unwrap();
    for number in [0, 13] {
        let unseen = RandomMachine::unseen(number).unwrap();
        let trials = Trial::on(&unseen.plant(), &unseen.gains().unwrap());
        let rows: Vec<(ResultRow, ResultRow)> = (trials.par_iter())
            .map(|trial| {
                let scene = &trial.case.scene;
                let wrong = noisy.applied_to(scene).unwrap().unwrap();
                (
                    trial.run(Contender::Tuned),
                    trial.with(wrong).run(Contender::Supervisor),
                )
            })
            .collect();
        let lost =
            |(alone, own): &&(_, _)| ResultRow::recovered(alone) && !ResultRow::recovered(own);
        let alone = rows.iter().filter(|(alone, _)| alone.recovered()).count();
        let lost = rows.iter().filter(lost).count();
        assert!(
            alone >= 48 && lost <= 3,
            "{}: {lost} of {alone} lost",
            unseen.text
        );
    }
}

/// The first rows are what `run` gives, each datum is there twice, draws are as many as asked for, and no number of
/// threads makes a difference.
#[test]
fn the_command_tells_every_datum_wrong() {
    let run = "run @overload_then_release --out out --json";
    let verdicts = Folder::fresh().ran(run).json();
    let rows = rows("--draws 3");
    for (configured, policy) in [("levitation alone", "levitation"), ("right", "supervisor")] {
        for figure in [
            "outcome",
            "impacts",
            "peak_contact_force_n",
            "relevitation_time_s",
        ] {
            let of_row = &row(&rows, configured)[figure];
            let of_run = &verdicts["policies"][policy][figure];
            assert_eq!(of_row, of_run, "{configured} {figure}");
            assert!(!of_row.is_null(), "{configured} {figure}");
        }
    }
    // Eleven data, too small and too large.
    assert_eq!(rows.len(), 2 + 22 + 3);
    let impulse = |configured: &str| number(&row(&rows, configured)["contact_impulse_n_s"]);
    assert!(impulse("force cap × 0.8") > impulse("right"));
    assert!(impulse("force cap × 1.25") < impulse("right"));
    assert_eq!(rows, self::rows("--draws 3 --threads 1"));
    let wide = self::rows("--draws 0 --width 2");
    row(&wide, "mass × 1.56");
    row(&wide, "delay +2 ticks");
}

/// What the scene itself sets in `[supervisor]` is configured wrong, too; what makes no difference has no row; what would be
/// refused says so.
#[test]
fn what_the_scene_sets_itself_is_configured_wrong_too() {
    let text = scene_text("overload_then_release");
    let assumed = |more: &str| {
        let scene = Scene::parse(
            "test",
            &format!("{text}\n[spin_sensor]\nvalid = false\n{more}"),
        )
        .unwrap();
        let all = misjudged(1.0, 0, 1);
        move |name: &str| {
            let misjudged = all.iter().find(|m| m.text == name).unwrap();
            misjudged
                .applied_to(&scene)
                .map(|scene| scene.map(|scene| scene.planes[0].supervisor.unwrap()))
        }
    };
    let plain = assumed("");
    let mass = plain("mass × 1.25").unwrap().unwrap().mass_kg;
    let own = assumed("[supervisor]\nmass_kg = 4.0\n");
    assert_eq!(own("mass × 1.25").unwrap().unwrap().mass_kg, 5.0);
    assert!((mass - 5.0).abs() > 0.1, "{mass}");
    // Nobody looks at a spin that is not valid.
    assert_eq!(plain("spin × 1.03"), Ok(None));
    let band = assumed("[supervisor]\nfriction_coefficient = 1.5\n");
    assert!(band("friction × 0.5").unwrap().is_some());
    assert_eq!(
        band("friction × 2").unwrap_err().parameter().name,
        "friction_coefficient"
    );
}

/// Without magnet or levitation controller there is nothing to supervise; a width has its bounds.
#[test]
fn what_cannot_be_configured_wrong_is_refused() {
    for (words, expected) in [
        ("@established_whirl_two_mass_stator", "no [magnet]"),
        ("@overload_then_release --width 5", "from 0.1 to 4"),
    ] {
        let said = Folder::fresh()
            .ran(&format!("sensitivity {words}"))
            .fails(2);
        has(&said, &[expected]);
    }
}
