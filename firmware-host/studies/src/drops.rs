//! Drops on to ball bearings that are new, worn, and worn on soft mounts: how many end in backward whirl.
//!
//! M. Helfert dropped rotors at TU Darmstadt (thesis, 2008): none of those on new bearings whirled, up to 30 % on dirty or worn
//! ones, and none on such bearings in a corrugated ribbon or elastomer rings. Neither the rotor's data nor those of bearings and
//! mounts are known here, so it is the order of the classes that is compared, on a machine of our own.

use crate::campaign::{
    Block, Chapter, Claim, Extent, Machines, Progress, Report, StudyError, run_all,
};
use crate::machines::draw::Draw;
use firmware_bench::run::closed_loop::{Keep, run};
use firmware_bench::scene::Scene;
use firmware_bench::scene::policy_kind::PolicyKind;
use std::f64::consts::TAU;

const SEED: u64 = 20_261_129;
const DROPS: u64 = 200;
const QUICK_DROPS: u64 = 40;

const MASS_KG: f64 = 20.0;
const GRAVITY_M_S2: f64 = 9.81;
const CLEARANCE_M: f64 = 2e-4;
const RADIUS_M: f64 = 0.03;
/// What a mount carries.
const CARRIED_KG: f64 = 0.5 * MASS_KG;

/// A bearing in its mount.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    New,
    Worn,
    WornInRibbon,
    WornInElastomer,
    NewInRigid,
    WornInRigid,
}

impl Class {
    pub const ALL: [Self; 6] = [
        Self::New,
        Self::Worn,
        Self::WornInRibbon,
        Self::WornInElastomer,
        Self::NewInRigid,
        Self::WornInRigid,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::New => "new, in its house",
            Self::Worn => "worn, in its house",
            Self::WornInRibbon => "worn, in a ribbon",
            Self::WornInElastomer => "worn, in elastomer",
            Self::NewInRigid => "new, house rigid",
            Self::WornInRigid => "worn, house rigid",
        }
    }

    /// Friction of the rotor on the race, and of the bearing itself as a coefficient at half its bore.
    fn friction(self) -> [(f64, f64); 2] {
        match self {
            Self::New | Self::NewInRigid => [(0.1, 0.2), (0.0015, 0.003)],
            _ => [(0.2, 0.5), (0.02, 0.2)],
        }
    }

    /// Stiffness \[N/m\], and loss factor at the mount's own frequency.
    fn mount(self) -> Option<((f64, f64), f64)> {
        match self {
            Self::NewInRigid | Self::WornInRigid => None,
            Self::New | Self::Worn => Some(((2e8, 2e8), 0.05)),
            Self::WornInRibbon => Some((MOUNTS_N_M, 0.2)),
            Self::WornInElastomer => Some((MOUNTS_N_M, 0.5)),
        }
    }
}

/// Ribbons and rings of elastomer between them.
const MOUNTS_N_M: (f64, f64) = (1e6, 4e7);
/// Where they are called soft, and where stiff: thirds of the decades.
const SOFTER_THAN_N_M: f64 = 3.4e6;
const STIFFER_THAN_N_M: f64 = 1.17e7;

/// A drop of a number: spin, unbalance and motion before it are the same in all classes.
#[derive(Debug, Clone)]
pub struct Drop {
    class: Class,
    friction: f64,
    mount_n_m: f64,
    scene: String,
}

impl Drop {
    pub fn new(seed: u64, class: Class, number: u64) -> Self {
        let mut draw = Draw::new(seed, number);
        let spin_hz = draw.between(100.0, 300.0);
        // Balance qualities G 0.4 to G 6.3.
        let unbalance_kg_m = MASS_KG * draw.decades(4e-4, 6.3e-3) / (TAU * spin_hz);
        let unbalance_rad = draw.angle_rad();
        let before_m_s = [0, 1].map(|_| draw.between(-0.01, 0.01));
        // Shares, so that a rough one of a class is the rough one of the others.
        let [friction, bearing] = class.friction();
        let friction = draw.between(friction.0, friction.1);
        let bearing_friction = draw.decades(bearing.0, bearing.1);
        let mount = class.mount().map(|((soft, stiff), loss_factor)| {
            let stiffness_n_m = draw.decades(soft, stiff);
            let damping_n_s_m = loss_factor * (stiffness_n_m * CARRIED_KG).sqrt();
            (stiffness_n_m, damping_n_s_m)
        });
        let ring = mount.map_or_else(String::new, |(stiffness_n_m, damping_n_s_m)| {
            format!(
                "[stator.inner]\nmass_kg = 0.4\nstiffness_n_m = {stiffness_n_m:?}\ndamping_n_s_m = {damping_n_s_m:?}"
            )
        });
        let scene = format!(
            r#"
title = "A drop"
[run]
duration_s = 0.3
sample_rate_hz = 20000
policies = ["passive"]
[rotor]
mass_kg = {MASS_KG:?}
transverse_inertia_kg_m2 = 0.9
polar_inertia_kg_m2 = 0.05
contact_radius_m = {RADIUS_M:?}
gravity_m_s2 = [0.0, {:?}]
[spin]
frequency_hz = {spin_hz:?}
inertia_kg_m2 = 0.05
[start]
velocity_m_s = [{:?}, {:?}]
[contact]
clearance_m = {CLEARANCE_M:?}
restitution = 0.6
restitution_speed_m_s = 0.1
[contact.balls]
count = 14
diameter_m = 0.007144
contact_angle_deg = 15.0
{ring}
[race]
inertia_kg_m2 = 1e-4
drag_n_m_s = 1e-5
load_drag_m = {:?}
[friction]
coefficient = {friction:?}
rolling_coefficient = 0.002
[verdict]
whirl_speed_m_s = {:?}
[[plane]]
name = "A"
position_m = -0.18
[[plane]]
name = "B"
position_m = 0.25
[[unbalance]]
position_m = 0.1
moment_kg_m = {unbalance_kg_m:?}
angle_rad = {unbalance_rad:?}
"#,
            -GRAVITY_M_S2,
            before_m_s[0],
            before_m_s[1],
            bearing_friction * RADIUS_M,
            WHIRLS * around_m_s(),
        );
        Self {
            class,
            friction,
            mount_n_m: mount.map_or(f64::INFINITY, |(stiffness_n_m, _)| stiffness_n_m),
            scene,
        }
    }

    /// Largest backward speed in contact until it is called whirl, in those that carry a rotor around.
    ///
    /// # Errors
    /// Why the run cannot be trusted.
    pub fn backward(&self) -> Result<f64, StudyError> {
        let scene = Scene::parse("drop.toml", &self.scene)?;
        let (figures, _) = run(&scene, PolicyKind::Passive, Keep::Decision, &mut |_| {})?;
        Ok(figures.peak_backward_speed_m_s / around_m_s())
    }
}

/// Speed at the bottom with which a rotor that slides without friction goes all the way around its bearing.
fn around_m_s() -> f64 {
    (5.0 * GRAVITY_M_S2 * CLEARANCE_M).sqrt()
}

/// So many of them are called whirl: a mount that gives way makes the circle larger.
pub const WHIRLS: f64 = 2.0;

/// How many of some drops whirl.
#[derive(Debug, Clone, Copy, Default)]
struct Share {
    drops: u64,
    whirls: u64,
}

impl Share {
    fn of<'a>(all: impl Iterator<Item = &'a f64>, beyond: f64) -> Self {
        all.fold(Self::default(), |sum, backward| Self {
            drops: sum.drops + 1,
            whirls: sum.whirls + u64::from(*backward > beyond),
        })
    }

    fn share(self) -> f64 {
        self.whirls as f64 / self.drops as f64
    }

    /// Wilson's interval of 95 %.
    fn interval(self) -> [f64; 2] {
        const Z: f64 = 1.959_964;
        let n = self.drops as f64;
        let middle = self.share() + Z * Z / (2.0 * n);
        let half = Z * (self.share() * (1.0 - self.share()) / n + Z * Z / (4.0 * n * n)).sqrt();
        [middle - half, middle + half].map(|x| (x / (1.0 + Z * Z / n)).clamp(0.0, 1.0))
    }

    fn text(self) -> String {
        let [low, high] = self.interval().map(|x| 100.0 * x);
        match self.drops {
            0 => "–".to_owned(),
            drops => format!(
                "{} of {drops}: {:.1} % ({low:.1} to {high:.1})",
                self.whirls,
                100.0 * self.share()
            ),
        }
    }
}

/// # Errors
/// A run that cannot be trusted.
pub fn study(extent: Extent, progress: &dyn Progress) -> Result<Report, StudyError> {
    drawn(Machines::default(), extent, progress)
}

/// The same of other draws.
///
/// # Errors
/// A run that cannot be trusted.
pub fn drawn(
    machines: Machines,
    extent: Extent,
    progress: &dyn Progress,
) -> Result<Report, StudyError> {
    let seed = machines.seed.unwrap_or(SEED);
    let number = machines.number.unwrap_or(extent.pick(QUICK_DROPS, DROPS));
    let drops: Vec<Drop> = Class::ALL
        .into_iter()
        .flat_map(|class| (0..number).map(move |i| Drop::new(seed, class, i)))
        .collect();
    let ran: Result<Vec<f64>, StudyError> = run_all(&drops, progress, Drop::backward)
        .into_iter()
        .collect();
    let ran = ran?;
    let share = |class: Class, beyond: f64, which: &dyn Fn(&Drop) -> bool| {
        let of = drops.iter().zip(&ran);
        let of = of.filter(|(drop, _)| drop.class == class && which(drop));
        Share::of(of.map(|(_, backward)| backward), beyond)
    };
    let all = |class| share(class, WHIRLS, &|_| true);
    let by_class = Class::ALL.map(|class| {
        let once = share(class, 1.0, &|_| true);
        [class.name().to_owned(), all(class).text(), once.text()]
    });
    let by_friction = Class::ALL.map(|class| {
        let low = share(class, WHIRLS, &|drop| drop.friction < 0.3);
        let high = share(class, WHIRLS, &|drop| drop.friction >= 0.3);
        [class.name().to_owned(), low.text(), high.text()]
    });
    let mounted = [Class::WornInRibbon, Class::WornInElastomer];
    let soft = |class| share(class, WHIRLS, &|drop| drop.mount_n_m < SOFTER_THAN_N_M);
    let by_mount = mounted.map(|class| {
        let stiff = share(class, WHIRLS, &|drop| drop.mount_n_m > STIFFER_THAN_N_M);
        let between = share(class, WHIRLS, &|drop| {
            (SOFTER_THAN_N_M..=STIFFER_THAN_N_M).contains(&drop.mount_n_m)
        });
        [
            class.name().to_owned(),
            soft(class).text(),
            between.text(),
            stiff.text(),
        ]
    });
    let [new, worn, ribbon, elastomer, ..] = Class::ALL.map(all);
    let apart = |more: Share, less: Share| more.interval()[0] - less.interval()[1];
    let claims = vec![
        Claim::at_least(
            "worn over new: what intervals leave between them",
            0.0,
            apart(worn, new),
        ),
        Claim::at_least(
            "worn in its house over in a ribbon: the same",
            0.0,
            apart(worn, ribbon),
        ),
        Claim::at_least(
            "worn in its house over in elastomer: the same",
            0.0,
            apart(worn, elastomer),
        ),
        Claim::at_most(
            "worn in the softest third of ribbons: share that whirls",
            0.0,
            soft(Class::WornInRibbon).share(),
        ),
        Claim::at_most(
            "worn in the softest third of elastomer: share that whirls",
            0.0,
            soft(Class::WornInElastomer).share(),
        ),
        Claim::at_most("as published, new: none", 0.0, new.share()),
        Claim::at_most("as published, worn: up to 0.3", 0.3, worn.share()),
        Claim::at_most("as published, worn in a ribbon: none", 0.0, ribbon.share()),
        Claim::at_most(
            "as published, worn in elastomer: none",
            0.0,
            elastomer.share(),
        ),
    ];
    let columns = ["bearing", "whirl", "at half that speed"];
    Ok(Report {
        title: "Drops on worn bearings".to_owned(),
        claims,
        cases: drops.len() as u64,
        classes: Vec::new(),
        chapters: vec![
            Chapter::new("By bearing", vec![Block::table(columns, by_class)]),
            Chapter::folded(
                "By friction on the race",
                vec![Block::table(
                    ["bearing", "below 0.3", "from 0.3 on"],
                    by_friction,
                )],
            ),
            Chapter::new(
                "By stiffness of the mount",
                vec![Block::table(
                    ["bearing", "1 to 3.4e6 N/m", "to 1.17e7", "to 4e7"],
                    by_mount,
                )],
            ),
        ],
    })
}
