//! The page of a sweep.

use super::{DRAWS, SWEEP, contents, sweep_file, sweep_of};
use system_tests::ran::{Folder, has, lacks, list, number};
use system_tests::scene_path;

/// Every number of the summary that people ask for stands on the page, and what it links is there.
#[test]
fn the_page_says_what_the_summary_says() {
    let folder = Folder::fresh();
    // Impacts that the levitation controller does not survive all, and the supervisor does.
    let lines = format!(
        "scene = {:?}\npolicies = [\"levitation\", \"supervisor\"]\ndesign = \"monte_carlo\"\nruns = 70\n\
         [[vary]]\nkey = \"start.velocity_m_s[0]\"\nuniform = [0.1, 0.38]\n\
         [[vary]]\nkey = \"run.method\"\nvalues = [\"series\", \"collocation\"]\n",
        scene_path("impact_at_40_hz").display().to_string()
    );
    folder.put("sweep.toml", lines);
    folder.ran(SWEEP).good();
    let page = folder.text("out/report.html");
    let summary = folder.json("out/summary.json");
    for policy in list(&summary["policies"]) {
        let (name, lost) = (policy["policy"].as_str().unwrap(), &policy["lost"]);
        has(&page, &[&format!("{name}: {lost} of 70 lost.")]);
        // The rule of three: said of those that lose nothing, and of no other.
        let bound = format!("Under {name} none of 70 independent runs was lost");
        assert_eq!(page.contains(&bound), *lost == 0, "{name}");
    }
    assert!(summary["policies"][0]["lost"].as_u64() > Some(0));
    assert_eq!(summary["policies"][1]["lost"], 0);
    has(&page, &["at most 4.29 %"]);
    // Where the supervisor loses nothing all that the other loses is gained.
    let pair = &summary["pairs"][0];
    assert!(pair["against"] == "levitation" && pair["runs"] == 70 && pair["lost"] == 0);
    let gained = &pair["gained"];
    assert_eq!(*gained, summary["policies"][0]["lost"]);
    assert!(number(&pair["impulse_ratio"]) < 1.0, "{pair}");
    has(
        &page,
        &[&format!("run by run: 0 lost, {gained} gained of 70")],
    );
    let worst = list(&summary["worst"]);
    assert_eq!(worst.len(), 3);
    for run in worst {
        let name = run["file"].as_str().unwrap();
        has(&page, &[&format!("<a href=\"{name}\">")]);
        assert!(folder.at(&format!("out/{name}")).is_file());
    }
    // Two policies over two keys, and what decides on the force; under the supervisor nothing is lost.
    let count = |words: &str| page.matches(words).count();
    assert_eq!(count("<figure>"), 3);
    assert_eq!(count("<svg"), count("<summary>Data"));
    lacks(&page, &["NaN", "<script", "inf "]);
}

/// Which keys are shown against each other is asked for, and nothing is run again when it changes.
#[test]
fn maps_are_of_the_keys_that_are_asked_for() {
    let key = "[[vary]]\nkey = \"contact.stiffness_n_m\"\nlog_uniform = [5e7, 5e8]\n";
    let with = |maps: &str| format!("{maps}{DRAWS}{key}").replace("runs = 70", "runs = 24");
    let folder = sweep_of(&with(""));
    let others = || {
        let mut all = contents(&folder, "out");
        all.retain(|(name, _)| name != "report.html");
        all
    };
    folder.ran(SWEEP).good();
    let before = others();
    let maps = "maps = [[\"contact.stiffness_n_m\", \"friction.coefficient\"], [\"friction.coefficient\", \"run.method\"]]\n";
    sweep_file(&folder, &with(maps));
    has(&folder.ran(SWEEP).good(), &["nothing was left to run"]);
    let page = folder.text("out/report.html");
    for policy in ["levitation", "supervisor"] {
        let both = format!("<b>{policy}: contact.stiffness_n_m and friction.coefficient</b>");
        let method = format!("<b>{policy}: friction.coefficient and run.method</b>");
        has(&page, &[&both, &method]);
    }
    // Over two ranges the runs one by one, over words how many of them are lost.
    let share = "Share of runs lost under supervisor over friction.coefficient and run.method";
    has(&page, &["<th scope=\"row\">collocation</th>", share]);
    assert!(before == others());
}

/// What has hardly any runs has a page, too: of one run, which shows nothing of its keys, and of none that has figures.
#[test]
fn few_runs_have_a_page() {
    for (range, code, said) in [
        ("0.5, 0.9", 0, "Nothing can be said about loss"),
        ("1.5, 1.9", 1, "run 0, levitation: short.toml"),
    ] {
        let key = format!("[[vary]]\nkey = \"contact.restitution\"\nuniform = [{range}]\n");
        let folder = sweep_of(&format!("{DRAWS}{key}").replace("runs = 70", "runs = 1"));
        folder.ran(SWEEP).fails(code);
        let page = folder.text("out/report.html");
        has(&page, &[said]);
        lacks(&page, &["NaN"]);
        assert!(page.ends_with("</html>\n"), "{page}");
    }
}
