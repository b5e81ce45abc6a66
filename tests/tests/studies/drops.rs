//! Drops on worn bearings whirl more often than those on new ones, and hardly in soft mounts with damping.

use firmware_studies::drops::{Class, Drop, WHIRLS};

/// Another draw than that of the page, and fewer.
const SEED: u64 = 7;
const DROPS: u64 = 30;

fn whirls(class: Class) -> usize {
    let drops = (0..DROPS).map(|number| Drop::new(SEED, class, number).backward().unwrap());
    drops.filter(|backward| *backward > WHIRLS).count()
}

#[test]
fn wear_makes_drops_whirl_and_a_damped_mount_stops_it() {
    let new = whirls(Class::New);
    let worn = whirls(Class::Worn);
    let ribbon = whirls(Class::WornInRibbon);
    let elastomer = whirls(Class::WornInElastomer);
    let all = format!("{new}, {worn}, {ribbon}, {elastomer} of {DROPS}");
    assert!(new < 10 && worn >= 14, "{all}");
    assert!(ribbon < 10 && elastomer < 5, "{all}");
}
