//! `init --shaft-file`: a drawing's list of steps becomes a scene with the frequencies of that shaft.

use crate::init::{init, judged, recovers};
use crate::refusals::all;
use std::f64::consts::{PI, TAU};
use system_tests::ran::{Folder, edited, has, list};

/// Without a magnet's stiffness: `modes` is then of the free shaft.
const NUMBERS: &str = "--sample-rate-hz 20000 --stiffness-n-m 0 --clearance-m 2e-4 --contact-stiffness-n-m 3e8 \
    --force-max-n 900 --lag-s 1e-4 --friction 0.15 --noise-rms-m 1e-6 --spin-hz 150";

const DENSITY_KG_M3: f64 = 7850.0;
const YOUNGS_MODULUS_N_M2: f64 = 2.1e11;
const POISSON_RATIO: f64 = 0.3;

/// A turbine-like one: five steps, a wheel in the middle of the third.
const STEPS_M: [(f64, f64); 5] = [
    (0.15, 0.04),
    (0.2, 0.06),
    (0.1, 0.09),
    (0.2, 0.06),
    (0.15, 0.05),
];
const WHEEL_SECTION: usize = 2;
const WHEEL_KG: f64 = 12.0;
const WHEEL_TRANSVERSE_KG_M2: f64 = 0.05;
const WHEEL_POLAR_KG_M2: f64 = 0.09;

fn wheel_csv() -> String {
    let head = "# steps from left to right\nlength_m,outer_diameter_m,disc_mass_kg,disc_transverse_inertia_kg_m2,disc_polar_inertia_kg_m2\n";
    let rows = STEPS_M.iter().enumerate().map(|(i, (length, diameter))| {
        let wheel = match i == WHEEL_SECTION {
            true => format!("{WHEEL_KG},{WHEEL_TRANSVERSE_KG_M2},{WHEEL_POLAR_KG_M2}"),
            false => ",,".to_owned(),
        };
        format!("{length},{diameter},{wheel}\n")
    });
    head.to_owned() + &rows.collect::<String>()
}

/// Frequencies at standstill that are no rigid motion \[Hz\], one of each two.
fn bending_hz(folder: &Folder, scene: &str) -> Vec<f64> {
    let told = folder
        .ran(&format!("modes --json --points 2 {scene}"))
        .json();
    let modes = list(&told["modes"]).iter();
    let still = modes.filter(|mode| mode["spin_rad_s"] == 0.0 && mode["whirl"] == "forward");
    let all = still.filter_map(|mode| mode["frequency_hz"].as_f64());
    all.filter(|hz| *hz > 10.0).collect()
}

type Matrix = [[f64; 4]; 4];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
}

/// Deflection, rotation, moment and shear force at the right end of a piece of Timoshenko's beam from those at its left.
fn over_a_piece(length_m: f64, diameter_m: f64, omega: f64) -> Matrix {
    const PIECES: u32 = 32;
    let area = PI / 4.0 * diameter_m.powi(2);
    let second = PI / 64.0 * diameter_m.powi(4);
    // Cowper's shear coefficient of a solid circle.
    let kappa = 6.0 * (1.0 + POISSON_RATIO) / (7.0 + 6.0 * POISSON_RATIO);
    let shear = kappa * YOUNGS_MODULUS_N_M2 / (2.0 * (1.0 + POISSON_RATIO)) * area;
    let mut rate = [[0.0; 4]; 4];
    rate[0][1] = 1.0;
    rate[0][3] = 1.0 / shear;
    rate[1][2] = 1.0 / (YOUNGS_MODULUS_N_M2 * second);
    rate[2][1] = -DENSITY_KG_M3 * second * omega * omega;
    rate[2][3] = -1.0;
    rate[3][0] = -DENSITY_KG_M3 * area * omega * omega;
    let step = rate.map(|row| row.map(|x| x * length_m / f64::from(PIECES)));
    let unit: Matrix =
        std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    let (mut power, mut exponential) = (unit, unit);
    for n in 1..=16 {
        power = product(&step, &power).map(|row| row.map(|x| x / f64::from(n)));
        for (to, from) in exponential.iter_mut().flatten().zip(power.iter().flatten()) {
            *to += from;
        }
    }
    (0..PIECES).fold(unit, |whole, _| product(&exponential, &whole))
}

/// Exact frequencies of the stepped shaft with its wheel, free at both ends \[Hz\]: where moment and force vanish there.
fn exact_hz(count: usize) -> Vec<f64> {
    let free = |hz: f64| {
        let omega = TAU * hz;
        let mut whole: Option<Matrix> = None;
        let mut then = |next: Matrix| {
            whole = Some(whole.map_or(next, |before| product(&next, &before)));
        };
        for (i, (length, diameter)) in STEPS_M.iter().enumerate() {
            let half = over_a_piece(0.5 * length, *diameter, omega);
            then(half);
            if i == WHEEL_SECTION {
                let mut jump: Matrix =
                    std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
                jump[2][1] = -WHEEL_TRANSVERSE_KG_M2 * omega * omega;
                jump[3][0] = -WHEEL_KG * omega * omega;
                then(jump);
            }
            then(half);
        }
        let m = whole.unwrap();
        m[2][0] * m[3][1] - m[2][1] * m[3][0]
    };
    let grid = (1..).map(|i| 20.0 * f64::from(i));
    let changes = grid.filter(|hz| free(*hz) * free(hz + 20.0) <= 0.0);
    let bisected = changes.map(|from| {
        let (mut low, mut high) = (from, from + 20.0);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            match free(low) * free(middle) <= 0.0 {
                true => high = middle,
                false => low = middle,
            }
        }
        low
    });
    bisected.take(count).collect()
}

/// Three frequencies of a stepped shaft with a wheel agree with Timoshenko's beam, solved exactly; mass and loop are right.
#[test]
fn a_stepped_shaft_has_its_frequencies_and_a_loop() {
    let folder = Folder::fresh();
    folder.put("steps.csv", wheel_csv());
    let places = "--bearings-m 0.1,0.7 --gravity-m-s2 9.81 --shaft-file steps.csv";
    let numbers = format!("{NUMBERS} {places}");
    init(&folder, "a.toml", &numbers).good();
    let (found, exact) = (bending_hz(&folder, "a.toml"), exact_hz(3));
    assert!((300.0..600.0).contains(&exact[0]), "{exact:?}");
    for (found, exact) in found.iter().zip(&exact) {
        // The damping ratio of 0.002 alone makes 2e-6.
        assert!((found / exact - 1.0).abs() < 1e-5, "{found} {exact}");
    }
    let text = folder.text("a.toml");
    has(&text, &["position_m = 0.4\nmass_kg = 12.0\n"]);
    // That of the shaft at each bearing.
    has(
        &text,
        &[
            "\ncontact_radius_m = 0.02\n",
            "\ncontact_radius_m = 0.025\n",
        ],
    );
    has(&text, &["gravity_m_s2 = [0.0, -9.81]"]);

    judged(&folder, "a.toml");
    recovers(&folder, "a.toml");
    // It falls away before so late a force can come: no file then.
    let late = [
        ("--lag-s 1e-4", "--lag-s 5e-3"),
        ("--stiffness-n-m 0", "--stiffness-n-m -3e6"),
    ];
    let refused = init(&folder, "none.toml", &edited(&numbers, &late)).fails(2);
    has(&refused, &["no levitation controller"]);
    assert!(!folder.at("none.toml").exists());
}

/// In five pieces, as columns in another order between semicolons, it is the shaft of one diameter, and slender enough for
/// Euler's beam: βL = 4.730041, 7.853205 of a free one.
#[test]
fn a_uniform_shaft_in_pieces_is_the_uniform_shaft() {
    const LENGTH_M: f64 = 1.2;
    const DIAMETER_M: f64 = 0.02;
    let folder = Folder::fresh();
    let rows = [0.1, 0.3, 0.25, 0.35, 0.2].map(|l| format!("{DIAMETER_M};{l};2.1e11\r\n"));
    let text = "\u{feff}outer_diameter_m;length_m;youngs_modulus_n_m2\r\n".to_owned();
    folder.put("steps.csv", text + &rows.concat());
    let mass_kg = PI / 4.0 * DIAMETER_M.powi(2) * LENGTH_M * DENSITY_KG_M3 * (1.0 + 1e-12);
    let uniform = format!(
        "--bearings-m -0.5,0.5 --length-m {LENGTH_M} --shaft-diameter-m {DIAMETER_M} --mass-kg {mass_kg}"
    );
    let pieces = "--bearings-m 0.1,1.1 --shaft-file steps.csv";
    let [whole, cut] = [("whole.toml", &uniform[..]), ("cut.toml", pieces)].map(|(file, more)| {
        let numbers = NUMBERS.replace("900", "60");
        init(&folder, file, &format!("{numbers} {more}")).good();
        bending_hz(&folder, file)
    });
    let euler = |beta_l: f64| {
        let radius_of_gyration = 0.25 * DIAMETER_M;
        (beta_l / LENGTH_M).powi(2)
            * radius_of_gyration
            * (YOUNGS_MODULUS_N_M2 / DENSITY_KG_M3).sqrt()
            / TAU
    };
    for (i, beta_l) in [4.730041, 7.853205].into_iter().enumerate() {
        assert!((cut[i] / whole[i] - 1.0).abs() < 1e-6, "{cut:?} {whole:?}");
        assert!((cut[i] / euler(beta_l) - 1.0).abs() < 3e-3, "{cut:?}");
    }
}

#[test]
fn a_file_that_is_no_shaft_is_refused_by_line_and_column() {
    let folder = Folder::fresh();
    let good = wheel_csv();
    let many = "length_m,outer_diameter_m\n".to_owned() + &"0.01,0.05\n".repeat(201);
    let numbers = format!("{NUMBERS} --bearings-m 0.1,0.7");
    let refused = |numbers: &str, steps: &str| {
        let said = init(
            &folder,
            "a.toml",
            &format!("{numbers} --shaft-file {steps}"),
        )
        .fails(2);
        assert!(!folder.at("a.toml").exists(), "{numbers}");
        said
    };
    let of_file = |text: &str, _: &[String]| {
        folder.put("steps.csv", text);
        refused(&numbers, "steps.csv")
    };
    all("files/shaft", 13, &good, of_file);
    has(&of_file(&many, &[]), &["more than 200 sections"]);
    folder.put("steps.csv", &good);
    all("files/numbers_beside_a_shaft", 5, &numbers, |line, _| {
        refused(line, "steps.csv")
    });
    refused(&numbers, ".");
}
