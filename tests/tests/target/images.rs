//! The images for Cortex-M: they build, and no panic can be reached in any of them.

use object::{Object, ObjectSymbol};
use std::path::Path;
use std::process::Output;
use system_tests::root;
use system_tests::target::{OTHER_LEVELS, PANIC_FREE, WITHOUT_DEBUG, build_at_level, build_some};

const M4F: &str = "thumbv7em-none-eabihf";
const M3: &str = "thumbv7m-none-eabi";
const M0: &str = "thumbv6m-none-eabi";
/// What each target runs or is measured with, and both that are only linked. Those with `-q` are fixed point, the others floats.
const IMAGES: [(&str, &[&str]); 3] = [
    (M4F, &ALL),
    (M3, &ALL),
    (M0, &["panic-free", "panic-free-q", "replay-q", "count-q"]),
];
const ALL: [&str; 10] = [
    "panic-free",
    "panic-free-q",
    "replay",
    "replay-q",
    "count",
    "count-q",
    "count-pair",
    "count-half",
    "in-the-loop",
    "timer-interrupt",
];

/// Requirements: SR-32, SR-33
#[test]
fn linked_images_hold_no_panic_path() {
    for (target, images) in IMAGES {
        let Some(output) = build_some(target, images, &[]) else {
            return;
        };
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{error}");
        let folder = root().join("target-fw").join(target).join("fw");
        for image in images {
            assert_no_panic_in(&folder.join(image));
        }
    }
}

/// Where the compiler saves size it leaves checks in that it removes for speed. Floats and fixed point with an FPU, and what has
/// neither FPU nor division.
/// Requirement: SR-32
#[test]
fn no_level_of_optimisation_leaves_a_panic_path() {
    for level in OTHER_LEVELS {
        for (target, images) in [(M4F, &PANIC_FREE[..]), (M0, &PANIC_FREE[1..])] {
            let Some(output) = build_at_level(target, images, level, &[]) else {
                return;
            };
            let error = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{level}: {error}");
            let folder = root().join("target-fw").join(level).join(target).join("fw");
            for image in images {
                assert_no_panic_in(&folder.join(image));
            }
        }
    }
}

fn assert_no_panic_in(image: &Path) {
    let bytes = std::fs::read(image).unwrap();
    let file = object::File::parse(bytes.as_slice()).unwrap();
    let names: Vec<&str> = file.symbols().filter_map(|s| s.name().ok()).collect();
    let start = ["_start", "main"];
    assert!(
        names.iter().any(|n| start.contains(n)),
        "symbols are there to be looked at"
    );
    let is_panic = |n: &&&str| n.contains("panicking") || n.contains("begin_unwind");
    let panics: Vec<_> = names.iter().filter(is_panic).collect();
    assert!(panics.is_empty(), "{}: {panics:?}", image.display());
}

const PLANTED: [&str; 3] = ["--features", "planted-panic", "--keep-going"];

/// The check finds a panic that is put in, in every kind of image, and for every target.
/// Requirement: SR-32
#[test]
fn a_planted_panic_fails_to_link() {
    let some: [(&str, &[&str]); 3] = [
        (M4F, &["panic-free", "replay", "count", "timer-interrupt"]),
        (M3, &["in-the-loop"]),
        (M0, &["panic-free-q"]),
    ];
    for (target, images) in some {
        let more = [&PLANTED[..], &WITHOUT_DEBUG].concat();
        let Some(output) = build_some(target, images, &more) else {
            return;
        };
        assert_none_links(&output, images, target);
    }
}

/// So it does where the compiler saves size.
#[test]
fn a_planted_panic_fails_to_link_at_s() {
    let Some(output) = build_at_level(M4F, &PANIC_FREE, "s", &PLANTED) else {
        return;
    };
    assert_none_links(&output, &PANIC_FREE, M4F);
}

fn assert_none_links(output: &Output, images: &[&str], target: &str) {
    let error = String::from_utf8_lossy(&output.stderr);
    for image in images {
        let failed = format!("could not compile `firmware-image` (bin \"{image}\")");
        assert!(error.contains(&failed), "{target}, {image}: {error}");
    }
    let undefined = error.matches("undefined symbol: a_panic_can_be_reached");
    assert_eq!(undefined.count(), images.len(), "{target}: {error}");
}
