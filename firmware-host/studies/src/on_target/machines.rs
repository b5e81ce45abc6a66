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
    /// How its images are built.
    pub build: Build,
}

/// How images are built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Build {
    /// For the target, with all parts of the supervisor.
    Usual,
    /// For this processor of the target's, as the compiler calls it.
    For(&'static str),
    /// Without the parts that a machine may leave out. The host has them all, so that there is nothing to compare with.
    Bare,
}

impl Build {
    /// Where its images go.
    pub fn folder(self) -> String {
        // Apart from the host's builds, whose lock it would wait for.
        let all = "target-fw";
        match self {
            Self::Usual => all.to_owned(),
            Self::For(processor) => format!("{all}/{processor}"),
            Self::Bare => format!("{all}/bare"),
        }
    }
}

/// All of them, the slowest first: the others are done meanwhile.
pub const MACHINES: [Machine; 6] = [
    Machine {
        name: "M3",
        number: Number::Float,
        board: "mps2-an385",
        target: "thumbv7m-none-eabi",
        text: "Cortex-M3, floats in software",
        build: Build::Usual,
    },
    Machine {
        name: "M3",
        number: Number::Fixed,
        board: "mps2-an385",
        target: "thumbv7m-none-eabi",
        text: "Cortex-M3, fixed point",
        build: Build::Usual,
    },
    Machine {
        name: "M0",
        number: Number::Fixed,
        board: "microbit",
        target: "thumbv6m-none-eabi",
        text: "Cortex-M0 with 16 KiB of RAM, fixed point",
        build: Build::Usual,
    },
    Machine {
        name: "M4F",
        number: Number::Float,
        board: "mps2-an386",
        target: "thumbv7em-none-eabihf",
        text: "Cortex-M4 with FPU",
        build: Build::Usual,
    },
    Machine {
        name: "M4F-bare",
        number: Number::Float,
        board: "mps2-an386",
        target: "thumbv7em-none-eabihf",
        text: "the same without unbalance, axis monitor and thermal budget",
        build: Build::Bare,
    },
    Machine {
        name: "M7",
        number: Number::Float,
        board: "mps2-an500",
        target: "thumbv7em-none-eabihf",
        text: "Cortex-M7 with FPU, compiled for it",
        build: Build::For("cortex-m7"),
    },
];

impl Machine {
    /// Name with that of its numbers, as in tables.
    pub fn title(&self) -> String {
        format!("{} {}", self.name, self.number.name())
    }
}
