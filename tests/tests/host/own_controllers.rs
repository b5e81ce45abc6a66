//! Levitation controllers of the user's: they hold as the built-in one does where they compute the same, and what goes wrong
//! with them is said.

mod mistakes;

use crate::machine_scenes::files::save_in;
use firmware_bench::device::external::{Caller, Make, Question, Setup, Step};
use firmware_bench::device::levitation::{Levitation, LevitationParams};
use firmware_bench::run::closed_loop::{Accuracy, Keep, Recorders, record, run};
use firmware_bench::run::trace::Trace;
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_bench::scene::spec::Spec;
use nalgebra::DMatrix;
use plant_model::V2;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use supervisor::IntegratorHint;
use system_tests::ran::{Folder, edited, has, ran, scene_text};
use system_tests::root;

/// The gains that the example scenes' controllers have.
const GAINS: &str = "[levitation]
proportional_n_m = 5e5
integral_n_m_s = 1e7
derivative_n_s_m = 1500.0
derivative_filter_s = 1.5e-4
";
const PARAMETERS: &str = "parameters = [5e5, 1e7, 1500.0, 1.5e-4]";
const BOTH: [PolicyKind; 2] = [PolicyKind::Levitation, PolicyKind::Supervisor];

fn examples() -> PathBuf {
    root().join("firmware-host/scenes/controllers")
}

/// Python, where it is installed; in CI it has to be.
pub(crate) fn python() -> bool {
    let there = Command::new("python3").arg("--version").output().is_ok();
    assert!(
        there || std::env::var_os("CI").is_none(),
        "python3 is missing; tests/run installs it"
    );
    there
}

/// An example scene with another controller.
fn with(table: &str) -> String {
    let scene = scene_text("controllers/pid_in_python");
    let start = scene.find("[controller]").unwrap();
    let end = scene.find("feed_forward_weight").unwrap();
    format!("{}{table}{}", &scene[..start], &scene[end..])
}

/// Compiles a controller as its users do.
fn library(folder: &Folder, name: &str, source: &str) {
    let source = folder.put(&format!("{name}.c"), source);
    let mut cc = Command::new("cc");
    cc.args("-std=c99 -Wall -Wextra -Wpedantic -Werror -O2 -shared -fPIC -I".split(' '));
    cc.arg(root().join("firmware-host/controller/include"));
    cc.arg("-o").arg(folder.at(&format!("{name}.so")));
    ran(cc.arg(source).arg("-lm")).good();
}

fn trace(path: &Path, kind: PolicyKind) -> (Trace, u64) {
    let scene = Scene::load(path).unwrap_or_else(|e| panic!("{e}"));
    let (figures, trace) = run(&scene, kind, Keep::Trace, &mut |_| {}).unwrap();
    (trace, figures.impacts)
}

/// Same bits in every row: a controller that computes what the built-in one does, in the same order, is that controller,
/// limited force and integrators that stand included.
#[test]
fn the_pid_in_c_and_in_python_is_the_built_in_one() {
    let folder = Folder::fresh();
    let source = fs::read_to_string(examples().join("pid.c")).unwrap();
    assert!(source.lines().count() < 40);
    library(&folder, "pid", &source);
    fs::copy(examples().join("pid.py"), folder.at("pid.py")).unwrap();
    // Of a magnet that is soon at its cap.
    let put = |name: &str, table: &str| {
        let weak = with(table).replace("force_max_n = 1000.0", "force_max_n = 150.0");
        folder.put(name, weak)
    };
    let built_in = put("gains.toml", GAINS);
    let mut others = vec!["library = \"pid.so\""];
    if python() {
        others.push("python = \"pid.py\"");
    }
    for kind in BOTH {
        let (expected, impacts) = trace(&built_in, kind);
        let limited = expected.rows.iter();
        let limited = limited.filter(|r| r.commanded_n.norm() > 149.0).count();
        assert!(impacts > 0 && limited > 10, "{kind:?} {impacts} {limited}");
        for other in &others {
            let own = put(
                "own.toml",
                &format!("[controller]\n{other}\n{PARAMETERS}\n"),
            );
            let (rows, _) = trace(&own, kind);
            assert_eq!(rows.rows.len(), expected.rows.len());
            assert!(rows == expected, "{kind:?} {other}");
        }
    }
}

/// The built-in controller as one of the caller's.
#[derive(Debug)]
struct Gains(Levitation, usize);

/// Makes them.
struct ByGains(LevitationParams);

impl Make for ByGains {
    fn make(&self, setup: &Setup) -> Result<Box<dyn Step>, String> {
        if setup.parameters == [13.0] {
            return Err("has no luck".to_owned());
        }
        let levitation = Levitation::new(self.0, setup.period_s, setup.force_max_n[0]);
        Ok(Box::new(Gains(levitation, setup.parameters.len())))
    }
}

impl Step for Gains {
    fn step(&mut self, question: &Question) -> Result<Vec<f64>, String> {
        let hint = match question.hold {
            true => IntegratorHint::Hold,
            false => IntegratorHint::Run,
        };
        let measured_m = V2::new(question.position_m[0], question.position_m[1]);
        let force_n = self.0.force_n(measured_m, hint);
        // One more than asked for with each parameter.
        let more = (0..self.1).map(|_| 0.0);
        Ok(force_n.iter().copied().chain(more).collect())
    }
}

/// A controller in this process is asked, limited and judged as one in another is.
#[test]
fn a_controller_of_the_callers_stands_in_the_place_of_gains() {
    let expected = Scene::parse("gains.toml", &with(GAINS)).unwrap();
    let gains = expected.planes[0].levitation.unwrap();
    let of_caller = |table: &str| {
        let mut spec = Spec::parse("own.toml", &with(table)).unwrap();
        spec.levitated_by(Caller::new("gains", ByGains(gains)))
            .unwrap();
        spec.resolve().unwrap()
    };
    let trace = |scene: &Scene, kind| run(scene, kind, Keep::Trace, &mut |_| {});
    for kind in BOTH {
        let (figures, rows) = trace(&expected, kind).unwrap();
        // In the place of gains, and of a program that need not be there.
        for table in [GAINS, "[controller]\npython = \"nowhere.py\"\n"] {
            let (own, own_rows) = trace(&of_caller(table), kind).unwrap();
            assert!(own == figures && own_rows == rows, "{kind:?} {table}");
        }
    }
    let said = |table: &str| trace(&of_caller(table), BOTH[0]).unwrap_err().to_string();
    assert_eq!(
        said("[controller]\nparameters = [1.0]\n"),
        "policy levitation: controller gains at 0 s: answered 3 forces, expected 2"
    );
    assert_eq!(
        said("[controller]\nparameters = [13.0]\n"),
        "policy levitation: controller: gains has no luck"
    );
}

/// Farthest apart of two runs at the same rows \[m\].
fn apart_m(a: &Trace, b: &Trace) -> f64 {
    assert_eq!(a.rows.len(), b.rows.len());
    let pairs = a.rows.iter().zip(&b.rows);
    pairs
        .map(|(a, b)| (a.plant.position_m - b.plant.position_m).norm())
        .fold(0.0, f64::max)
}

/// As long as the force is not limited, which is when the built-in integrators stand.
#[test]
fn the_pid_by_matrices_and_by_sections_moves_the_rotor_alike() {
    let folder = Folder::fresh();
    // From the middle and without noise: the built-in one takes its first reading as the one before it.
    let gentle = [
        ("noise_rms_m = 1e-6\n", ""),
        ("[1300.0, 750.0]", "[130.0, 75.0]"),
    ];
    let moved = |table: &str| {
        let path = folder.put("own.toml", edited(&with(table), &gentle));
        trace(&path, BOTH[0]).0
    };
    let example = scene_text("controllers/state_space");
    let start = example.find("[state_space]").unwrap();
    let end = example.find("feed_forward_weight").unwrap();
    let rows = [16.0, -31.749, 15.74925, 1.0, -1.75, 0.75];
    let sections = format!("[biquads]\ngain_n_m = 5e5\nsections = {rows:?}\n");
    // As NumPy saves sections, with a row each.
    let doubled = 2.0 * DMatrix::from_row_slice(1, 6, &rows);
    save_in(
        &folder.at("pid.npz"),
        &[("sos", doubled)],
        npyz::Order::Fortran,
    );
    let in_file = "[biquads]\ngain_n_m = 5e5\nfile = \"pid.npz\"\n";
    let expected = moved(GAINS);
    let way = expected.rows.iter().map(|row| row.plant.position_m.norm());
    assert!(way.fold(0.0, f64::max) > 1e-4);
    for table in [&example[start..end], &sections, in_file] {
        let off = apart_m(&moved(table), &expected);
        assert!(off < 1e-12, "{table} {off:e}");
    }
}

/// Eigenvalues of numbers whose products are not finite would be sought without end.
#[test]
fn numbers_of_a_state_space_have_a_limit() {
    let text = scene_text("controllers/state_space");
    let with = |x: &str| Scene::parse("own.toml", &text.replace("-5000.0", x));
    assert!(with("-1e29").is_ok());
    for beyond in ["1e31", "-1e300", "nan"] {
        let error = miette::Report::new(with(beyond).expect_err("taken"));
        has(&format!("{error:?}"), &["state_space.a"]);
    }
}

/// Every example holds its rotor under both policies, whatever the number of threads, to the last bit.
#[test]
fn the_examples_hold_their_rotor() {
    let mut scenes = vec!["state_space", "biquads"];
    if python() {
        scenes.push("pid_in_python");
    }
    for name in scenes {
        let ran = |threads: u32| {
            let folder = Folder::fresh();
            let line = format!("run @controllers/{name} --out . --json --threads {threads}");
            let json = folder.ran(&line).json();
            ["levitation", "supervisor"].map(|policy| {
                let outcome = &json["policies"][policy]["outcome"];
                assert_eq!(outcome, "recovered", "{name} {policy}");
                folder.bytes(&format!("trace_{policy}.parquet"))
            })
        };
        assert!(ran(1) == ran(2), "{name}");
    }
}

/// As the built-in controller does it, without integrators and filter.
const WHOLE: &str = "
class Pd:
    def __init__(self, scene):
        self.scene, self.last_m = scene, None
        self.speed_m_s = [0.0] * (2 * scene.sensors)

    def step(self, now):
        last_m, self.last_m = self.last_m or now.position_m, now.position_m
        (kp, kd), force_n = self.scene.parameters, []
        for plane in self.scene.magnet_plane:
            for i in (2 * plane, 2 * plane + 1):
                m, rate = now.position_m[i], (now.position_m[i] - last_m[i]) / self.scene.period_s
                self.speed_m_s[i] += rate - self.speed_m_s[i]
                force_n.append(-kp * m - kd * self.speed_m_s[i])
        return force_n

make = Pd
";

/// A rotor in two planes with this controller in the place of its gains.
fn rotor_with(table: &str) -> String {
    let gains = "[levitation]\nproportional_n_m = 4e5\nderivative_n_s_m = 900.0\nderivative_filter_s = 1e-4\n";
    let edits = [("duration_s = 0.3", "duration_s = 0.1"), (gains, table)];
    edited(&scene_text("one_machine/rigid"), &edits)
}

/// Gains of its planes without a filter.
const PLAIN: &str = "[levitation]\nproportional_n_m = 4e5\nderivative_n_s_m = 900.0\n";

fn traces(folder: &Folder, text: &str, kind: PolicyKind) -> Vec<Trace> {
    let path = folder.put("rotor.toml", text);
    let scene = Scene::load(&path).unwrap_or_else(|e| panic!("{e}"));
    let mut traces = vec![Trace::default(); scene.planes.len()];
    let recorders = Recorders::of_planes(&mut traces);
    record(&scene, kind, recorders, Accuracy::default(), &mut |_| {}).unwrap();
    traces
}

#[test]
fn a_program_holds_a_whole_rotor_as_gains_of_its_planes_do() {
    if !python() {
        return;
    }
    let folder = Folder::fresh();
    folder.put("pd.py", WHOLE);
    let program = "[controller]\npython = \"pd.py\"\nparameters = [4e5, 900.0]\n";
    for kind in BOTH {
        let [expected, own] =
            [PLAIN, program].map(|table| traces(&folder, &rotor_with(table), kind));
        assert_eq!(own.len(), 2);
        for (a, b) in own.iter().zip(&expected) {
            assert!(b.rows.len() > 1000 && a.rows == b.rows, "{kind:?}");
        }
    }
}

/// One plane with the scene's sections, one with its own.
#[test]
fn sections_hold_a_whole_rotor_as_gains_of_its_planes_do() {
    let folder = Folder::fresh();
    // K_p + K_d·(1 − z⁻¹)/T.
    let scenes = "[biquads]\nsections = [18.4e6, -18e6, 0.0, 1.0, 0.0, 0.0]\n";
    let own = "[plane.biquads]\ngain_n_m = 4e5\nsections = [92.0, -90.0, 0.0, 2.0, 0.0, 0.0]\nfeed_forward_weight = true\n";
    let name = "name = \"coupling end\"\nposition_m = 0.7\ncontact_radius_m = 0.02\n";
    // From the middle and without noise, as above.
    let quiet = |table: &str| rotor_with(table).replace("noise_rms_m = 1e-6\n", "");
    let filters = edited(&quiet(scenes), &[(name, &format!("{name}{own}"))]);
    for kind in BOTH {
        let expected = traces(&folder, &quiet(PLAIN), kind);
        let own = traces(&folder, &filters, kind);
        for (a, b) in own.iter().zip(&expected) {
            let off = apart_m(a, b);
            assert!(off < 1e-11, "{kind:?} {off:e}");
        }
    }
    let alone = filters.replace(&format!("{scenes}feed_forward_weight = true\n"), "");
    let both = filters.replace(scenes, "[state_space]\nd = [0.0]\n");
    for (text, says) in [
        (alone, "plane[0].biquads: is missing"),
        (both, "plane[1].biquads: does not go with [state_space]"),
    ] {
        let refused = Scene::load(&folder.put("rotor.toml", text));
        has(&refused.expect_err("taken").to_string(), &[says]);
    }
}

/// What the C controller is told, checked by itself.
const ASKS_IN_C: &str = "#include \"amb_controller.h\"
AMB_CONTROLLER_DEFINE_ABI
static uint32_t n;
void *amb_controller_init(const amb_controller_setup *s) {
    int good = s->period_s == 5e-5 && s->sensors == 1 && s->magnets == 1 && s->parameters == 2 && s->reserved == 0
        && s->magnet_plane[0] == 0 && s->force_max_n[0] == 1000.0 && s->parameter[0] == 3.0 && s->parameter[1] == -7.0;
    return good ? &n : 0;
}
int amb_controller_step(void *it, const amb_controller_sample *s, double *force_n) {
    int good = it == &n && s->t_s == n * 5e-5 && s->sequence[0] == n && s->integrator == AMB_CONTROLLER_RUN
        && s->reserved == 0 && s->spin_rad_s > 942.4 && s->spin_rad_s < 942.5;
    force_n[0] = -8e5 * s->position_m[0], force_n[1] = -8e5 * s->position_m[1], n++;
    return good ? 0 : 1;
}
void amb_controller_close(void *it) { (void)it; }
";

/// The same in Python.
const ASKS_IN_PYTHON: &str = "
class Asks:
    def __init__(self, scene):
        self.n = 0
        assert (scene.period_s, scene.sensors, scene.magnets, scene.magnet_plane) == (5e-5, 1, 1, [0])
        assert (scene.force_max_n, scene.parameters) == ([1000.0], [3.0, -7.0])

    def step(self, sample):
        assert (sample.t_s, sample.sequence, sample.hold) == (self.n * 5e-5, [self.n], False)
        assert 942.4 < sample.spin_rad_s < 942.5 and len(sample.position_m) == 2
        self.n += 1
        return tuple(-8e5 * m for m in sample.position_m)

    def close(self):
        assert self.n == 2000

make = Asks
";

#[test]
fn controllers_are_told_what_the_scene_says() {
    let folder = Folder::fresh();
    library(&folder, "asks", ASKS_IN_C);
    folder.put("asks.py", ASKS_IN_PYTHON);
    let mut programs = vec!["library = \"asks.so\""];
    if python() {
        programs.push("python = \"asks.py\"");
    }
    let rows = programs.iter().map(|program| {
        let table = format!("[controller]\n{program}\nparameters = [3.0, -7.0]\n");
        let scene = folder.put("asks.toml", with(&table));
        trace(&scene, PolicyKind::Levitation).0
    });
    let rows: Vec<Trace> = rows.collect();
    assert!(rows.windows(2).all(|pair| pair[0] == pair[1]));
}
