//! The page of a sweep.

use super::{DRAWS, contents, succeeds, sweep, sweep_file};
use std::fs;
use std::path::Path;
use system_tests::scene_path;
use tempfile::TempDir;

fn page(out: &Path) -> String {
    fs::read_to_string(out.join("report.html")).unwrap()
}

/// Every number of the summary that people ask for stands on the page, and what it links is there.
#[test]
fn the_page_says_what_the_summary_says() {
    let folder = TempDir::new().unwrap();
    // Impacts that the levitation controller does not survive all, and the supervisor does.
    let lines = format!(
        "scene = {:?}\npolicies = [\"levitation\", \"supervisor\"]\ndesign = \"monte_carlo\"\nruns = 70\n\
         [[vary]]\nkey = \"start.velocity_m_s[0]\"\nuniform = [0.1, 0.38]\n\
         [[vary]]\nkey = \"run.method\"\nvalues = [\"series\", \"collocation\"]\n",
        scene_path("impact_at_40_hz").display().to_string()
    );
    let file = folder.path().join("impacts.toml");
    fs::write(&file, lines).unwrap();
    let out = folder.path().join("out");
    succeeds(&sweep(&file, &out, &[]));
    let page = page(&out);
    let summary = fs::read_to_string(out.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    for policy in summary["policies"].as_array().unwrap() {
        let (name, lost) = (policy["policy"].as_str().unwrap(), &policy["lost"]);
        assert!(
            page.contains(&format!("{name}: {lost} of 70 lost.")),
            "{name}"
        );
        // The rule of three: said of those that lose nothing, and of no other.
        let bounded = page.contains(&format!(
            "Under {name} none of 70 independent runs was lost"
        ));
        assert_eq!(bounded, *lost == 0, "{name}");
    }
    assert!(summary["policies"][0]["lost"].as_u64() > Some(0));
    assert!(summary["policies"][1]["lost"] == 0 && page.contains("at most 4.29 %"));
    // Where the supervisor loses nothing all that the other loses is gained.
    let pair = &summary["pairs"][0];
    assert!(pair["against"] == "levitation" && pair["runs"] == 70 && pair["lost"] == 0);
    assert_eq!(pair["gained"], summary["policies"][0]["lost"]);
    let ratio = pair["impulse_ratio"].as_f64().unwrap();
    assert!(ratio < 1.0, "{ratio}");
    let gained = &pair["gained"];
    assert!(page.contains(&format!("run by run: 0 lost, {gained} gained of 70")));
    let worst = summary["worst"].as_array().unwrap();
    assert_eq!(worst.len(), 3);
    for run in worst {
        let name = run["file"].as_str().unwrap();
        assert!(page.contains(&format!("<a href=\"{name}\">")) && out.join(name).is_file());
    }
    // Two policies over two keys, and what decides on the force; under the supervisor nothing is lost.
    assert_eq!(page.matches("<figure>").count(), 3);
    assert_eq!(
        page.matches("<svg").count(),
        page.matches("<summary>Data").count()
    );
    for word in ["NaN", "<script", "inf "] {
        assert!(!page.contains(word), "{word}");
    }
}

/// Which keys are shown against each other is asked for, and nothing is run again when it changes.
#[test]
fn maps_are_of_the_keys_that_are_asked_for() {
    let folder = TempDir::new().unwrap();
    let key = "[[vary]]\nkey = \"contact.stiffness_n_m\"\nlog_uniform = [5e7, 5e8]\n";
    let with = |maps: &str| format!("{maps}{DRAWS}{key}").replace("runs = 70", "runs = 24");
    let out = folder.path().join("out");
    let file = sweep_file(folder.path(), &with(""));
    succeeds(&sweep(&file, &out, &[]));
    let before = contents(&out);
    let maps = "maps = [[\"contact.stiffness_n_m\", \"friction.coefficient\"], [\"friction.coefficient\", \"run.method\"]]\n";
    sweep_file(folder.path(), &with(maps));
    let text = succeeds(&sweep(&file, &out, &[]));
    assert!(text.contains("nothing was left to run"), "{text}");
    let page = page(&out);
    for policy in ["levitation", "supervisor"] {
        for keys in [
            "contact.stiffness_n_m and friction.coefficient",
            "friction.coefficient and run.method",
        ] {
            assert!(page.contains(&format!("<b>{policy}: {keys}</b>")), "{keys}");
        }
    }
    // Over two ranges the runs one by one, over words how many of them are lost.
    assert!(page.contains("<th scope=\"row\">collocation</th>"));
    assert!(
        page.contains(
            "Share of runs lost under supervisor over friction.coefficient and run.method"
        )
    );
    let others = |all: Vec<(String, Vec<u8>)>| {
        all.into_iter()
            .filter(|(name, _)| name != "report.html")
            .collect::<Vec<_>>()
    };
    assert!(others(before) == others(contents(&out)));
}

/// What has hardly any runs has a page, too: of one run, which shows nothing of its keys, and of none that has figures.
#[test]
fn few_runs_have_a_page() {
    let folder = TempDir::new().unwrap();
    let key = "[[vary]]\nkey = \"contact.restitution\"\nuniform = [0.5, 0.9]\n";
    for (lines, code, text) in [
        (key.to_owned(), 0, "Nothing can be said about loss"),
        (
            key.replace("0.5, 0.9", "1.5, 1.9"),
            1,
            "run 0, levitation: short.toml",
        ),
    ] {
        let lines = format!("{DRAWS}{lines}").replace("runs = 70", "runs = 1");
        let file = sweep_file(folder.path(), &lines);
        let out = folder.path().join(code.to_string());
        assert_eq!(sweep(&file, &out, &[]).status.code(), Some(code));
        let page = page(&out);
        assert!(page.contains(text) && page.ends_with("</html>\n"), "{page}");
        assert!(!page.contains("NaN"), "{page}");
    }
}
