//! Rotors and controllers out of files of matrices.

use super::levitated::LEVITATED;
use super::{ONE_PLANE, apart, machine, planes};
use firmware_bench::device::modal_levitation::Weights;
use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use nalgebra::DMatrix;
use npyz::WriterBuilder;
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use system_tests::ran::{Folder, edited, has};
use zip::write::SimpleFileOptions;

/// Writes what `numpy.savez_compressed` would.
pub(crate) fn save(path: &Path, arrays: &[(&str, DMatrix<f64>)]) {
    save_in(path, arrays, npyz::Order::C);
}

/// The same, with columns or rows that follow each other.
pub(crate) fn save_in(path: &Path, arrays: &[(&str, DMatrix<f64>)], order: npyz::Order) {
    let mut archive = zip::ZipWriter::new(File::create(path).unwrap());
    for (name, matrix) in arrays {
        let shape: Vec<u64> = match matrix.ncols() {
            1 => vec![matrix.nrows() as u64],
            columns => vec![matrix.nrows() as u64, columns as u64],
        };
        let by_columns = match order {
            npyz::Order::C => matrix.transpose(),
            npyz::Order::Fortran => matrix.clone(),
        };
        let mut bytes = Vec::new();
        let options = npyz::WriteOptions::new();
        let mut writer = (options.default_dtype().shape(&shape).order(order))
            .writer(&mut bytes)
            .begin_nd()
            .unwrap();
        writer.extend(by_columns.iter().copied()).unwrap();
        writer.finish().unwrap();
        let options = SimpleFileOptions::default();
        archive.start_file(format!("{name}.npy"), options).unwrap();
        archive.write_all(&bytes).unwrap();
    }
    archive.finish().unwrap();
}

fn numbers(matrix: &DMatrix<f64>) -> String {
    let all: Vec<f64> = matrix.transpose().iter().copied().collect();
    format!("{all:?}")
}

/// Writes a scene and loads it from there.
fn load(folder: &Folder, text: &str) -> Result<Scene, String> {
    Scene::load(&folder.put("scene.toml", text)).map_err(|error| error.to_string())
}

/// A scene that is refused, with these words.
#[track_caller]
fn refused(folder: &Folder, text: &str, says: &[&str]) {
    has(&load(folder, text).expect_err("taken"), says);
}

/// Three masses on a shaft without mass, as matrices and as numbers.
fn three_masses() -> [(&'static str, DMatrix<f64>); 4] {
    let out = DMatrix::from_row_slice(1, 3, &[4.0 / 7.0, -1.0, 3.0 / 7.0]);
    [
        ("M", DMatrix::from_diagonal(&vec![2.0, 5.0, 3.0].into())),
        ("K", out.transpose() * 3e6 * &out),
        (
            "places_m",
            DMatrix::from_column_slice(3, 1, &[0.1, 0.4, 0.8]),
        ),
        ("displacement", DMatrix::identity(3, 3)),
    ]
}

const ON_SUPPORTS: &str = r#"
title = "Three masses"
[run]
duration_s = 0.05
sample_rate_hz = 20000
policies = ["passive"]
[rotor]
ROTOR
[spin]
frequency_hz = 100.0
[start]
position_m = [1.9e-4, 0.0]
velocity_m_s = [0.3, -0.1]
[contact]
clearance_m = 2e-4
stiffness_n_m = 1e8
restitution = 0.7
[friction]
coefficient = 0.02
[verdict]
whirl_speed_m_s = 1.0
[[support]]
position_m = LEFT
stiffness_n_m = 1e5
[[plane]]
name = "left"
position_m = LEFT
contact_radius_m = 0.05
[[plane]]
name = "right"
position_m = RIGHT
contact_radius_m = 0.05
"#;

#[test]
fn a_rotor_by_matrices_is_the_rotor_that_they_say() {
    let folder = Folder::fresh();
    save(&folder.at("rotor.npz"), &three_masses());
    let by_file = load(&folder, &on_supports(BY_FILE, 0.1, 0.7)).unwrap();
    // Mass 10 kg at 0.46 m; out of line it gives by (4/7)²/2 + 1/5 + (3/7)²/3 per kg, in the shape out/m of 10 kg.
    let mobility: f64 = 16.0 / 49.0 / 2.0 + 0.2 + 9.0 / 49.0 / 3.0;
    let size = (10.0 / mobility).sqrt();
    let shape = [4.0 / 7.0 / 2.0, -1.0 / 5.0, 3.0 / 7.0 / 3.0].map(|phi| size * phi);
    let transverse = 2.0 * 0.36_f64.powi(2) + 5.0 * 0.06_f64.powi(2) + 3.0 * 0.34_f64.powi(2);
    let hz = (3e6 * mobility).sqrt() / std::f64::consts::TAU;
    let by_numbers = format!(
        "mass_kg = 10.0\ntransverse_inertia_kg_m2 = {transverse:?}\npolar_inertia_kg_m2 = 0.0\n\
         bending = [{{ frequency_hz = {hz:?}, positions_m = [-0.36, -0.06, 0.34], displacements = {shape:?} }}]"
    );
    let by_numbers = machine(&on_supports(&by_numbers, -0.36, 0.24));
    let [by_file, by_numbers] =
        [&by_file, &by_numbers].map(|scene| planes(scene, PolicyKind::Passive));
    let impacts = [0, 1].map(|plane| by_file[plane].0.impacts);
    assert!(impacts.iter().all(|impacts| *impacts > 3), "{impacts:?}");
    for (a, b) in by_file.iter().zip(&by_numbers) {
        let off = apart(&a.1, &b.1);
        assert!(off < 1e-5, "{off:e} clearances");
    }
}

const BY_FILE: &str = "matrices_file = \"rotor.npz\"";

fn on_supports(rotor: &str, left: f64, right: f64) -> String {
    (ON_SUPPORTS.replace("ROTOR", rotor))
        .replace("LEFT", &left.to_string())
        .replace("RIGHT", &right.to_string())
}

#[test]
fn files_that_are_no_rotor_are_refused_by_name() {
    let folder = Folder::fresh();
    let path = folder.at("rotor.npz");
    let scene = on_supports(BY_FILE, 0.1, 0.7);
    let file = ["rotor.matrices_file", "rotor.npz", "No such file"];
    refused(&folder, &scene, &file);
    fs::write(&path, "no archive").unwrap();
    refused(&folder, &scene, &file[..2]);
    let [m, k, ..] = three_masses().map(|(_, matrix)| matrix);
    let mut odd = k.clone();
    odd[(0, 1)] += 1.0;
    let mut cases = vec![(three_masses()[1..].to_vec(), "has no array M")];
    let mut odd_one = three_masses().to_vec();
    odd_one[1].1 = odd;
    cases.push((odd_one, "K of rotor.npz"));
    // A damping that drives, and an inertia that no body has, by their names in the file.
    for (name, matrix, says) in [
        ("D", -1e-4 * k, "D of rotor.npz"),
        ("G", 1e3 * m, "G of rotor.npz"),
    ] {
        cases.push(([&three_masses()[..], &[(name, matrix)]].concat(), says));
    }
    for (arrays, says) in cases {
        save(&path, &arrays);
        refused(&folder, &scene, &["rotor.matrices_file", says]);
    }
    save(&path, &three_masses());
    load(&folder, &scene).unwrap();
    let outside = scene.replace("position_m = 0.7", "position_m = 0.9");
    refused(
        &folder,
        &outside,
        &["plane[1].position_m: is 0.9", "places_m"],
    );
    let twice = scene.replace("[rotor]", "[rotor]\nmass_kg = 3.0");
    let says = ["rotor.mass_kg", "follows from rotor.matrices_file"];
    refused(&folder, &twice, &says);
}

/// PD by differences as a state space that remembers the last readings.
fn pd(proportional: &DMatrix<f64>, rates: &DMatrix<f64>) -> [(&'static str, DMatrix<f64>); 4] {
    let per_sample = 20_000.0 * rates;
    let readings = proportional.ncols();
    [
        ("A", DMatrix::zeros(readings, readings)),
        ("B", DMatrix::identity(readings, readings)),
        ("D", -(proportional + &per_sample)),
        ("C", per_sample),
    ]
}

#[test]
fn gains_as_a_state_space_levitate_alike() {
    let bare = [
        "integral_n_m_s = 1e6\n",
        "derivative_filter_s = 1e-4\n",
        "position_m = [1e-5, 0.0]\n",
        "noise_rms_m = 1e-6\n",
        "quantum_m = 1e-7\n",
        "runout_m = 2e-6\n",
        "[retainer]\ncentre_offset_m = [2e-5, -1e-5]\n",
        "feed_forward_weight = true\n",
    ];
    let gains = edited(ONE_PLANE, &bare.map(|line| (line, "")));
    let diagonal = |x: f64| DMatrix::from_diagonal_element(2, 2, x);
    let table: String = pd(&diagonal(4e5), &diagonal(900.0))
        .iter()
        .map(|(name, matrix)| format!("{} = {}\n", name.to_lowercase(), numbers(matrix)))
        .collect();
    let old = "[levitation]\nproportional_n_m = 4e5\nderivative_n_s_m = 900.0\n";
    let own = edited(&gains, &[(old, &format!("[state_space]\n{table}"))]);
    for kind in [PolicyKind::Levitation, PolicyKind::Supervisor] {
        let [a, b] =
            [&gains, &own].map(|text| run(&machine(text), kind, Keep::Trace, &mut |_| {}).unwrap());
        assert!(a.0.impacts > 0, "{kind:?}");
        let off = apart(&a.1, &b.1);
        assert!(off < 1e-6, "{kind:?} {off:e}");
    }
}

#[test]
fn a_state_space_holds_a_whole_rotor_as_levitation_by_mode_does() {
    let folder = Folder::fresh();
    let by_mode = edited(
        LEVITATED,
        &[
            ("integral_n_m_s = 4e6\n", ""),
            ("derivative_filter_s = 1e-4\n", ""),
            ("CROSS", "0.0"),
            ("position_m = [6e-5, 0.0]", "velocity_m_s = [3e-2, 0.0]"),
            ("position_m = [-6e-5, 0.0]", "velocity_m_s = [-2e-2, 1e-2]"),
        ],
    );
    let weights = Weights::new(&[-0.2, 0.25]);
    let of = |w: &[f64]| {
        let column = DMatrix::from_column_slice(2, 1, w);
        (&column * column.transpose()).kronecker(&DMatrix::identity(2, 2))
    };
    let (centre, tilt) = (of(&weights.translation), of(&weights.tilt));
    let controller = pd(
        &(1.4e6 * &centre + 3e4 * &tilt),
        &(3e3 * &centre + 60.0 * &tilt),
    );
    save(&folder.at("controller.npz"), &controller);
    let start = by_mode.find("[levitation]").unwrap();
    let end = by_mode.find("[[plane]]").unwrap();
    let own = format!(
        "{}[state_space]\nfile = \"controller.npz\"\nfeed_forward_weight = true\n{}",
        &by_mode[..start],
        &by_mode[end..]
    );
    let own_scene = load(&folder, &own).unwrap();
    let [a, b] = [&machine(&by_mode), &own_scene].map(|s| planes(s, PolicyKind::Levitation));
    for (a, b) in a.iter().zip(&b) {
        assert!(a.0.recovered);
        let off = apart(&a.1, &b.1);
        assert!(off < 1e-7, "{off:e} clearances");
    }

    let both = format!("{own}levitation = {{ proportional_n_m = 1.0, derivative_n_s_m = 1.0 }}\n");
    refused(&folder, &both, &["plane[1].levitation", "[state_space]"]);
    let wide = own.replace("file = \"controller.npz\"", "d = [1.0, 2.0]");
    refused(&folder, &wide, &["state_space.d", "expected 4 × 4 = 16"]);
    let mut short = controller;
    short[1].1 = short[1].1.clone().remove_row(0);
    save(&folder.at("controller.npz"), &short);
    refused(&folder, &own, &["B is 3 × 4, expected 4 × 4"]);
}
