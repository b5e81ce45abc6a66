//! The processors, as the emulator has them.

/// An emulated board.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Machine {
    /// Name in tables, on the command line and in `budgets.toml`.
    pub name: &'static str,
    /// Numbers that the supervisor under test calculates in.
    pub number: &'static str,
    /// Board in QEMU.
    pub board: &'static str,
    /// Target of the compiler.
    pub target: &'static str,
    /// What is special about it.
    pub text: &'static str,
}

/// All of them, the slowest first: the others are done meanwhile.
pub const MACHINES: [Machine; 3] = [
    Machine {
        name: "M3",
        number: "f32",
        board: "mps2-an385",
        target: "thumbv7m-none-eabi",
        text: "Cortex-M3, floats in software",
    },
    Machine {
        name: "M4F",
        number: "f32",
        board: "mps2-an386",
        target: "thumbv7em-none-eabihf",
        text: "Cortex-M4 with FPU",
    },
    Machine {
        name: "M7",
        number: "f32",
        board: "mps2-an500",
        target: "thumbv7em-none-eabihf",
        text: "Cortex-M7 with FPU",
    },
];
