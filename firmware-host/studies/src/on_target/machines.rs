//! The processors, as the emulator has them.

use super::numbers::Number;

/// An emulated board.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Machine {
    /// Name in tables, on the command line and in `budgets.toml`.
    pub name: &'static str,
    /// Numbers that the supervisor under test calculates in.
    pub number: Number,
    /// Board in QEMU.
    pub board: &'static str,
    /// Target of the compiler.
    pub target: &'static str,
    /// What is special about it.
    pub text: &'static str,
}

/// All of them, the slowest first: the others are done meanwhile.
pub const MACHINES: [Machine; 5] = [
    Machine {
        name: "M3",
        number: Number::Float,
        board: "mps2-an385",
        target: "thumbv7m-none-eabi",
        text: "Cortex-M3, floats in software",
    },
    Machine {
        name: "M3",
        number: Number::Fixed,
        board: "mps2-an385",
        target: "thumbv7m-none-eabi",
        text: "Cortex-M3, fixed point",
    },
    Machine {
        name: "M0",
        number: Number::Fixed,
        board: "microbit",
        target: "thumbv6m-none-eabi",
        text: "Cortex-M0 with 16 KiB of RAM, fixed point",
    },
    Machine {
        name: "M4F",
        number: Number::Float,
        board: "mps2-an386",
        target: "thumbv7em-none-eabihf",
        text: "Cortex-M4 with FPU",
    },
    Machine {
        name: "M7",
        number: Number::Float,
        board: "mps2-an500",
        target: "thumbv7em-none-eabihf",
        text: "Cortex-M7 with FPU",
    },
];

impl Machine {
    /// Name with that of its numbers, as in tables.
    pub fn title(&self) -> String {
        format!("{} {}", self.name, self.number.name())
    }
}
