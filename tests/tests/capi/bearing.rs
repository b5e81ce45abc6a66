//! A configuration from nine numbers in C: what Rust makes of them, bit for bit, on this machine and in the emulator.

use crate::firmware::said_on_boards;
use crate::library::said_with_rig;
use supervisor::Config;
use system_tests::bearing::bearing;

/// Those of `bearing.c`.
const NUMBERS: [[f32; 9]; 3] = [
    [50e-6, 10.0, -2e5, 2e-4, 1000.0, 1.6e-4, 0.15, 1e9, 1e-6],
    [1e-4, 3.3, 1e4, 3.1e-4, 77.0, 0.0, 0.3, 3e6, 7.7e-6],
    [2e-5, 512.5, 0.0, 5e-4, 9e3, 3e-4, 0.11, 7e9, 0.0],
];

fn of_rust() -> String {
    let bearings = NUMBERS.map(bearing);
    let [first, second, third] = bearings.map(|b| Config::for_bearing(&b));
    let pair = [bearings[0], bearings[1]];
    let ends = Config::for_rotor(&crate::rotor::shaft(), &pair);
    let all = [first, second, third, ends[0], ends[1]];
    let values = all.iter().flat_map(Config::values);
    values.map(|v| format!("{:08x}\n", v.to_bits())).collect()
}

#[test]
fn nine_numbers_make_the_same_configuration_in_c() {
    let Some(said) = said_with_rig("bearing.c") else {
        return;
    };
    assert_eq!(said, of_rust());
}

#[test]
fn nine_numbers_make_the_same_configuration_in_firmware() {
    for (target, said) in said_on_boards("bearing.c") {
        assert_eq!(said, of_rust(), "{target:?}");
    }
}
