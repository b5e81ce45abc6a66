//! The closed loop of a scene under one of its policies.

use crate::model::{Model, Set};
use crate::parameters;
use crate::plant::tune;
use crate::quantities::{POLICY, policy, policy_number};
use crate::rows::{Of, Rows};
use crate::variable::{Kind, Role, Value, Variable};
use firmware_bench::run::closed_loop::stepwise::{Driver, Stepwise};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use firmware_bench::scene::spec::Spec;

const POLICY_NAME: &str = "policy";
/// What stands before parameters of the supervisor, as in scene files.
const SUPERVISOR: &str = "supervisor.";

/// The policy that runs unless another is set: the supervisor where the scene has it, else the scene's last.
fn own_policy(scene: &Scene) -> PolicyKind {
    let policies = &scene.policies;
    let supervised = policies.contains(&PolicyKind::Supervisor);
    match (supervised, policies.last()) {
        (false, Some(last)) => *last,
        _ => PolicyKind::Supervisor,
    }
}

/// Its variables but the time.
pub(crate) fn variables(spec: &Spec, scene: &Scene) -> Vec<Variable> {
    let kind = Kind::Enumeration(&POLICY);
    let about = format!("{}: one of the scene's", POLICY.about);
    let mut all = vec![Variable {
        start: Value::Int64(policy_number(own_policy(scene))),
        ..Variable::signal(Role::Fixed, POLICY_NAME.to_owned(), &about, "", kind)
    }];
    all.extend(parameters::of_scene(spec));
    if let [only] = &scene.planes[..]
        && let Some(config) = &only.supervisor
    {
        all.extend(parameters::of_supervisor(config, SUPERVISOR));
    }
    all.extend(Rows::new(Of::ClosedLoop).variables(scene.planes.len()));
    all
}

/// The loop at its first sample.
pub(crate) fn start(spec: &Spec, scene: &Scene, set: &[Set<'_>]) -> Result<Box<dyn Model>, String> {
    let is_policy = |s: &&Set<'_>| s.name == POLICY_NAME;
    let asked = set.iter().find(is_policy);
    let kind = match asked.map(|s| s.value) {
        Some(Value::Int64(number)) => {
            policy(number).ok_or("policy: there is none of this number")?
        }
        _ => own_policy(scene),
    };
    let of_scene: Vec<Set<'_>> = set.iter().filter(|s| !is_policy(s)).copied().collect();
    let scene = parameters::scene(spec, &of_scene)?;
    let policies = &scene.policies;
    if !policies.contains(&kind) {
        let names: Vec<&str> = policies.iter().map(|kind| kind.name()).collect();
        let (asked, names) = (kind.name(), names.join(", "));
        return Err(format!(
            "policy: {asked} is not among run.policies of the scene, which has {names}"
        ));
    }
    let stepwise = Stepwise::new(scene, Driver::Policy(kind)).map_err(|error| error.to_string())?;
    Ok(Box::new(ClosedLoop {
        stepwise,
        rows: Rows::new(Of::ClosedLoop),
    }))
}

struct ClosedLoop {
    stepwise: Stepwise,
    rows: Rows,
}

impl Model for ClosedLoop {
    fn step(&mut self, _inputs: &[Value]) -> Result<bool, String> {
        self.stepwise.advance().map_err(|error| error.to_string())
    }

    fn outputs(&self, into: &mut Vec<Value>) {
        self.rows.values(&self.stepwise, into);
    }

    fn tune(&mut self, name: &str, value: f64) -> Result<(), String> {
        tune(&mut self.stepwise, name, value)
    }

    fn trusted(&self) -> Result<(), String> {
        self.stepwise.trusted().map_err(|error| error.to_string())
    }
}
