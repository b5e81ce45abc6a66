//! The pages of `run`, `review`, `sweep` and `modes` in a real browser: drawn, moved, read aloud, and without script.

use firmware_bench::record::file::RecordFile;
use serde_json::Value;
use std::fs;
use std::path::PathBuf;
use supervisor::Stretch;
use system_tests::browser::Browser;
use system_tests::ran::{Folder, has, lacks};
use system_tests::{root, scene_path};

fn page(folder: &Folder, scene: &str, out: &str) -> PathBuf {
    folder
        .ran(&format!("run {scene} --out {out} --no-trace"))
        .good();
    folder.at(&format!("{out}/report.html"))
}

/// A record becomes a page, a damaged one as far as it is whole, and what is no record leaves nothing behind.
#[test]
fn a_record_becomes_a_page() {
    let folder = Folder::fresh();
    page(&folder, "@overload_then_release", "run");
    let reviewed = folder.ran("review run/record_supervisor.bin --out whole");
    let printed = reviewed.good();
    let whole = folder.text("whole/report.html");
    // The verdict that is printed heads the page.
    let verdict = printed.lines().next().unwrap();
    has(&whole, &[&format!("<p class=\"headline\">{verdict}")]);
    for heading in [
        "Orbit",
        "Position",
        "Radius",
        "Control force",
        "Commanded force along the axes",
        "Severity",
        "Time in contact",
        "Modes",
    ] {
        has(&whole, &[&format!("<h3>{heading}</h3>")]);
    }
    // No record has it.
    lacks(&whole, &["<h3>Contact force</h3>", "class=\"warning\""]);
    has(&whole, &["ENGAGED"]);

    let mut bytes = folder.bytes("run/record_supervisor.bin");
    the_slow_track_is_that_of_the_record(&whole, &bytes);

    let last = bytes.len() - 40;
    bytes[last] ^= 1;
    folder.put("damaged.bin", &bytes);
    folder.ran("review damaged.bin --out damaged").fails(2);
    has(&folder.text("damaged/report.html"), &["class=\"warning\""]);

    folder.put("none.bin", [7; 33]);
    folder.ran("review none.bin --out none").fails(2);
    assert!(!folder.at("none").exists());
}

/// What is written of a column: differences in steps.
fn decoded(column: &Value) -> Vec<f64> {
    let step = column["step"].as_f64().unwrap();
    let mut at = 0.0;
    (column["differences"].as_array().unwrap().iter())
        .map(|difference| {
            at += difference.as_f64().unwrap();
            at * step
        })
        .collect()
}

/// It goes on when the recorded ticks are over, and each stretch is a step of its largest values.
fn the_slow_track_is_that_of_the_record(page: &str, bytes: &[u8]) {
    let (_, data) = page.split_once("id=\"report-data\">").unwrap();
    let data: Value = serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap();
    let track = |name: &str| {
        let mut tracks = data["tracks"].as_array().unwrap().iter();
        tracks.find(|track| track["name"] == name).unwrap()
    };
    let (slow, fast) = (track("recorded: slow track"), track("recorded"));
    let file = RecordFile::of(bytes);
    let record = file.records.first().unwrap();
    let units = record.units();
    let (t, until) = (decoded(&slow["t"]), decoded(&fast["t"]));
    assert_eq!(t.len(), 2 * record.track.len());
    assert!(t.last() > Some(&(2.0 * until.last().unwrap())), "{t:?}");
    let radius = decoded(&slow["columns"]["largest r"]);
    let share = decoded(&slow["columns"]["in contact"]);
    let ms = 1e3 / units.sample_rate_hz.unwrap();
    for (i, stretch) in record.track.iter().enumerate() {
        let (from, to) = (2 * i, 2 * i + 1);
        let lasts = f64::from(stretch.ticks) * ms;
        assert!((t[to] - t[from] - lasts).abs() < 1e-3, "stretch {i}");
        let clearances = record.number(stretch.radius_square).sqrt();
        let expected = 1e3 * units.clearance_m.unwrap() * clearances;
        let contact = 100.0 * f64::from(stretch.contact_ticks) / f64::from(stretch.ticks);
        for at in [from, to] {
            assert!((radius[at] - expected).abs() < 1e-4, "stretch {i}");
            assert!((share[at] - contact).abs() < 0.1, "stretch {i}");
        }
    }
    // No time is said of the modes of a stretch that has several.
    let modes = slow["bands"]["supervisor"].as_array().unwrap();
    let alone = |stretch: &&Stretch| stretch.modes.count_ones() == 1;
    assert!(!modes.is_empty() && modes.len() <= record.track.iter().filter(alone).count());
}

/// What the walk-through shows is what the tool draws today of the record that it is about, and all of it is small.
#[test]
fn pictures_of_the_walk_through_are_the_tools() {
    let folder = Folder::fresh();
    page(&folder, "@overload_then_release", "run");
    let reviewed = folder.ran("review run/record_supervisor.bin --figures drawn");
    let printed = reviewed.good();
    let kept = root().join("docs/src/start/overload");
    let drawn = folder.names("drawn");
    // A path that begins at the root stays as it is.
    let of_page = folder.names(kept.to_str().unwrap());
    assert_eq!(drawn, of_page, "docs/src/start/overload has others");
    for name in &drawn {
        let svg = folder.text(&format!("drawn/{name}"));
        assert!(svg.len() < 60_000, "{name} has {} bytes", svg.len());
        assert!(
            svg == fs::read_to_string(kept.join(name)).unwrap(),
            "docs/src/start/overload/{name} is another: renew it with the command of docs/src/start/review.md"
        );
    }
    // Every sentence that the page has of the verdict is printed.
    let text = fs::read_to_string(root().join("docs/src/start/review.md")).unwrap();
    let (_, shown) = text.split_once("```text\n").unwrap();
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let shown = words(shown.split_once("```").unwrap().0);
    let printed = words(&printed);
    assert!(printed.starts_with(&shown), "{printed}");
    for link in text.split("](overload/").skip(1) {
        let name = link.split(')').next().unwrap();
        assert!(drawn.iter().any(|drawn| drawn == name), "{name}");
    }
}

#[test]
fn pages_work_in_a_browser() {
    let Some(browser) = Browser::found() else {
        return;
    };
    let folder = Folder::fresh();
    // Two seconds at 20 kHz.
    let long = [
        ("duration_s = 0.2\n", "duration_s = 2.0\n"),
        ("sample_rate_hz = 20000\n", "sample_rate_hz = 20000\n"),
    ];
    folder.scene("long.toml", "overload_then_release", &long);
    let run = page(&folder, "long.toml", "run");
    let machine = page(&folder, "@machines/overload_of_a_flexible_rotor", "machine");
    let record = "review run/record_supervisor.bin --out record";
    folder.ran(record).good();
    let size = fs::metadata(&run).unwrap().len();
    assert!(size < 3_000_000, "the page has {size} bytes");

    // Maps of both kinds, and influences.
    let lines = format!(
        "scene = {:?}\npolicies = [\"levitation\", \"supervisor\"]\ndesign = \"sobol\"\nruns = 96\n\
         maps = [[\"start.velocity_m_s[0]\", \"friction.coefficient\"], [\"magnet.delay_samples\", \"friction.coefficient\"]]\n\
         [[vary]]\nkey = \"start.velocity_m_s[0]\"\nuniform = [0.1, 0.5]\n\
         [[vary]]\nkey = \"friction.coefficient\"\nuniform = [0.05, 0.2]\n\
         [[vary]]\nkey = \"magnet.delay_samples\"\nvalues = [1, 2]\n",
        scene_path("impact_at_40_hz").display().to_string()
    );
    folder.put("sweep.toml", lines);
    folder.ran("sweep sweep.toml --out swept").good();
    let modes = "modes @machines/misaligned_bearings --html modes.html";
    folder.ran(modes).good();

    println!("{size} bytes");
    let [record, sweep, modes] =
        ["record/report.html", "swept/report.html", "modes.html"].map(|name| folder.at(name));
    browser.check("report.mjs", &[&run, &machine, &record, &sweep, &modes]);
}
