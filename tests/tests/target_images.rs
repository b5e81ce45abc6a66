//! The images for Cortex-M: they build, and no panic can be reached in any of them.

use object::{Object, ObjectSymbol};
use system_tests::root;
use system_tests::target::build_images;

const TARGETS: [&str; 3] = [
    "thumbv7em-none-eabihf",
    "thumbv7m-none-eabi",
    "thumbv6m-none-eabi",
];
/// Those with `-q` are fixed point, the others floats.
const IMAGES: [&str; 9] = [
    "panic-free",
    "panic-free-q",
    "replay",
    "replay-q",
    "count",
    "count-q",
    "count-pair",
    "in-the-loop",
    "timer-interrupt",
];

#[test]
fn linked_images_hold_no_panic_path() {
    for target in TARGETS {
        let Some(output) = build_images(target, &[]) else {
            return;
        };
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{error}");
        for image in IMAGES {
            let path = root().join("target-fw").join(target).join("fw").join(image);
            let bytes = std::fs::read(path).unwrap();
            let file = object::File::parse(bytes.as_slice()).unwrap();
            let names: Vec<&str> = file.symbols().filter_map(|s| s.name().ok()).collect();
            let start = ["_start", "main"];
            assert!(
                names.iter().any(|n| start.contains(n)),
                "symbols are there to be looked at"
            );
            let is_panic = |n: &&&str| n.contains("panicking") || n.contains("begin_unwind");
            let panics: Vec<_> = names.iter().filter(is_panic).collect();
            assert!(panics.is_empty(), "{target}, {image}: {panics:?}");
        }
    }
}

/// The check finds a panic that is put in, in every image for every target.
#[test]
fn a_planted_panic_fails_to_link() {
    for target in TARGETS {
        let more = ["--features", "planted-panic", "--keep-going"];
        let Some(output) = build_images(target, &more) else {
            return;
        };
        let error = String::from_utf8_lossy(&output.stderr);
        for image in IMAGES {
            let failed = format!("could not compile `firmware-image` (bin \"{image}\")");
            assert!(error.contains(&failed), "{target}, {image}: {error}");
        }
        let undefined = error.matches("undefined symbol: a_panic_can_be_reached");
        assert_eq!(undefined.count(), IMAGES.len(), "{target}: {error}");
    }
}
