//! How many cycles an instruction takes, as Arm's technical reference manuals table it for memory without wait states:
//! Cortex-M3 (DDI 0337, "Instruction set summary"), Cortex-M4 (DDI 0439, the same, and "FPU instruction set" for floats),
//! Cortex-M0 (DDI 0432). None is published of Cortex-M7, which issues up to two at once.
//!
//! Where a manual leaves a span open, both ends are taken: a refill of the pipeline after a branch (one to three cycles), loads and
//! stores that follow one another (one cycle instead of two), divisions and long products by their values, `IT` folded into the instruction
//! before it, conditional instructions that do nothing.

use super::disassembly::Instruction;

/// The processor a table is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Processor {
    /// With the multiplier of one cycle; the slow one of 32 is for parts that hardly calculate.
    CortexM0,
    CortexM3,
    CortexM4F,
}

/// Cycles, at least and at most.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Cycles {
    pub(super) low: u32,
    pub(super) high: u32,
}

/// What an instruction does, for the mix of a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Kind {
    Integer,
    Multiply,
    Divide,
    Load,
    Store,
    Branch,
    Choice,
    FloatArithmetic,
    FloatCompare,
    FloatDivide,
    FloatMove,
}

impl Kind {
    pub(super) const ALL: [(Self, &'static str); 11] = [
        (Self::FloatArithmetic, "sums and products of floats"),
        (Self::FloatDivide, "quotients of floats"),
        (Self::FloatCompare, "comparisons of floats, and their flags"),
        (Self::FloatMove, "moves of floats"),
        (Self::Load, "loads"),
        (Self::Store, "stores"),
        (Self::Integer, "integer arithmetic and moves"),
        (Self::Multiply, "integer products"),
        (Self::Divide, "integer quotients"),
        (Self::Choice, "IT"),
        (Self::Branch, "branches and calls"),
    ];
}

/// A single load or store, which a neighbour of its kind lets begin a cycle earlier.
fn is_single_access(mnemonic: &str) -> bool {
    let access = ["ldr", "str", "vldr", "vstr"]
        .iter()
        .any(|m| mnemonic.starts_with(m));
    access && !is_double(mnemonic)
}

fn is_double(mnemonic: &str) -> bool {
    ["ldrd", "strd"].iter().any(|m| mnemonic.starts_with(m))
}

/// Cycles of a straight run of instructions; what the one before leaves behind counts.
#[derive(Debug, Clone)]
pub(super) struct Counter {
    processor: Processor,
    total: Cycles,
    after_access: bool,
    /// Cycles that the divider may still be at work beside integers.
    dividing: u32,
    /// Cycles that floats have waited for it.
    waited: u32,
    /// What the last float operation has written.
    result: Option<String>,
}

impl Counter {
    pub(super) fn new(processor: Processor) -> Self {
        Self {
            processor,
            total: Cycles::default(),
            after_access: false,
            dividing: 0,
            waited: 0,
            result: None,
        }
    }

    pub(super) fn total(&self) -> Cycles {
        Cycles {
            low: self.total.low + self.waited,
            high: self.total.high,
        }
    }

    /// Of these, least cycles of quotients beyond the one that each begins with.
    pub(super) fn waited(&self) -> u32 {
        self.waited
    }

    /// Adds an instruction that was followed by the one at `then`.
    pub(super) fn add(&mut self, instruction: &Instruction, then: u32) -> (Kind, Cycles) {
        let taken = then != instruction.next;
        let (kind, mut cycles) = match self.processor {
            Processor::CortexM0 => of_m0(instruction, taken),
            processor => of_m3_and_m4(instruction, taken, processor),
        };
        if self.processor != Processor::CortexM0 && is_single_access(&instruction.mnemonic) {
            if self.after_access {
                cycles.low = 1;
            }
            self.after_access = true;
        } else {
            self.after_access = false;
        }
        if self.processor == Processor::CortexM4F {
            self.wait_for_floats(instruction, kind, &mut cycles);
        }
        self.total.low += cycles.low;
        self.total.high += cycles.high;
        (kind, cycles)
    }

    /// A result that the very next instruction reads comes a cycle later; a quotient is computed beside integers.
    fn wait_for_floats(&mut self, instruction: &Instruction, kind: Kind, cycles: &mut Cycles) {
        let float = instruction.mnemonic.starts_with('v');
        if self
            .result
            .take()
            .is_some_and(|register| float && instruction.reads(&register))
        {
            cycles.low += 1;
            cycles.high += 1;
        }
        if float {
            self.waited += self.dividing;
            self.dividing = 0;
        } else {
            self.dividing = self.dividing.saturating_sub(cycles.low);
        }
        match kind {
            Kind::FloatDivide => {
                // Reserved for whom it may be waited for.
                self.dividing = cycles.low - 1;
                cycles.low = 1;
            }
            Kind::FloatArithmetic => self.result = Some(instruction.first().to_owned()),
            _ => {}
        }
    }
}

const fn exactly(cycles: u32) -> Cycles {
    Cycles {
        low: cycles,
        high: cycles,
    }
}

/// Refill of the pipeline of M3 and M4 after a branch.
const REFILL: Cycles = Cycles { low: 1, high: 3 };

fn with_refill(cycles: u32) -> Cycles {
    Cycles {
        low: cycles + REFILL.low,
        high: cycles + REFILL.high,
    }
}

fn starts(mnemonic: &str, with: &[&str]) -> bool {
    with.iter().any(|m| mnemonic.starts_with(m))
}

/// Loads of several registers, `pop` among them.
const LOADS_OF_MANY: [&str; 4] = ["ldm", "pop", "vldm", "vpop"];
/// And stores.
const STORES_OF_MANY: [&str; 4] = ["stm", "push", "vstm", "vpush"];

fn is_branch(mnemonic: &str) -> bool {
    // Not the operations on bits that begin alike.
    let bits = starts(mnemonic, &["bic", "bfi", "bfc", "bkpt"]);
    starts(mnemonic, &["b", "cbz", "cbnz", "tbb", "tbh"]) && !bits
}

/// Operations whose names have a condition behind them, such as `vmovgt.f32`: they take a cycle and no more if it does not hold.
fn of_m3_and_m4(i: &Instruction, taken: bool, processor: Processor) -> (Kind, Cycles) {
    let name = i.mnemonic.as_str();
    if starts(name, &["it"]) {
        return (Kind::Choice, Cycles { low: 0, high: 1 });
    }
    if is_branch(name) {
        let table = u32::from(starts(name, &["tbb", "tbh"]));
        let cycles = if taken {
            with_refill(1 + table)
        } else {
            exactly(1)
        };
        return (Kind::Branch, cycles);
    }
    if starts(name, &LOADS_OF_MANY) {
        let words = i.listed() * words_of_each(i);
        let cycles = if taken {
            with_refill(1 + words)
        } else {
            exactly(1 + words)
        };
        return (Kind::Load, cycles);
    }
    if starts(name, &STORES_OF_MANY) {
        return (Kind::Store, exactly(1 + i.listed() * words_of_each(i)));
    }
    if starts(name, &["ldr", "vldr"]) {
        let cycles = if is_double(name) || is_wide(i) { 3 } else { 2 };
        let cycles = if taken {
            with_refill(cycles)
        } else {
            exactly(cycles)
        };
        return (Kind::Load, unless_conditional(i, cycles));
    }
    if starts(name, &["str", "vstr"]) {
        let cycles = if is_double(name) || is_wide(i) { 3 } else { 2 };
        return (Kind::Store, unless_conditional(i, exactly(cycles)));
    }
    if name.starts_with('v') {
        return of_floats(i);
    }
    if starts(name, &["sdiv", "udiv"]) {
        return (Kind::Divide, Cycles { low: 2, high: 12 });
    }
    if starts(
        name,
        &["umull", "smull", "umlal", "smlal", "mla", "mls", "mul"],
    ) {
        return (Kind::Multiply, of_products(name, processor));
    }
    if starts(name, &["mrs", "msr"]) {
        return (Kind::Integer, Cycles { low: 1, high: 2 });
    }
    // A barrier waits for what it has to.
    let barrier = starts(name, &["dmb", "dsb", "isb"]);
    let cycles = Cycles {
        low: 1,
        high: if barrier { 4 } else { 1 },
    };
    let moved_to_pc = taken.then(|| with_refill(1));
    (Kind::Integer, moved_to_pc.unwrap_or(cycles))
}

fn of_products(name: &str, processor: Processor) -> Cycles {
    match (processor, name.get(..4).unwrap_or(name)) {
        (Processor::CortexM4F, _) => exactly(1),
        (_, "umul" | "smul") => Cycles { low: 3, high: 5 },
        (_, "umla" | "smla") => Cycles { low: 4, high: 7 },
        _ if name.starts_with("ml") => exactly(2),
        _ => exactly(1),
    }
}

fn of_floats(i: &Instruction) -> (Kind, Cycles) {
    let name = i.mnemonic.as_str();
    if starts(name, &["vdiv", "vsqrt"]) {
        return (Kind::FloatDivide, exactly(14));
    }
    if starts(name, &["vmla", "vmls", "vnmla", "vnmls", "vfma", "vfms"]) {
        return (Kind::FloatArithmetic, unless_conditional(i, exactly(3)));
    }
    if starts(name, &["vcmp", "vmrs"]) {
        return (Kind::FloatCompare, exactly(1));
    }
    if starts(name, &["vmov", "vmsr"]) {
        // Two registers at once take two.
        let registers = i.operands.split(',').count() as u32;
        let cycles = registers.saturating_sub(2).max(1);
        return (Kind::FloatMove, exactly(cycles));
    }
    (Kind::FloatArithmetic, exactly(1))
}

/// What has a condition behind its name takes one cycle if that does not hold.
fn unless_conditional(i: &Instruction, cycles: Cycles) -> Cycles {
    const CONDITIONS: [&str; 14] = [
        "eq", "ne", "cs", "cc", "mi", "pl", "vs", "vc", "hi", "ls", "ge", "lt", "gt", "le",
    ];
    let name = i.mnemonic.split('.').next().unwrap_or("");
    // `vmls` ends like a condition and has none.
    let conditional =
        name.len() > 4 && !name.starts_with("vnml") && CONDITIONS.iter().any(|c| name.ends_with(c));
    Cycles {
        low: if conditional { 1 } else { cycles.low },
        high: cycles.high,
    }
}

/// Registers of 64 bits, of which each counts twice.
fn is_wide(i: &Instruction) -> bool {
    i.mnemonic.starts_with('v') && i.first().starts_with('d')
}

fn words_of_each(i: &Instruction) -> u32 {
    let wide = i.mnemonic.starts_with('v') && i.operands.contains("{d");
    if wide { 2 } else { 1 }
}

fn of_m0(i: &Instruction, taken: bool) -> (Kind, Cycles) {
    let name = i.mnemonic.as_str();
    if is_branch(name) {
        let cycles = match name {
            "bl" => 4,
            _ if taken => 3,
            _ => 1,
        };
        return (Kind::Branch, exactly(cycles));
    }
    if starts(name, &LOADS_OF_MANY) {
        // With the program counter in the list it branches as well.
        let cycles = i.listed() + if taken { 3 } else { 1 };
        return (Kind::Load, exactly(cycles));
    }
    if starts(name, &STORES_OF_MANY) {
        return (Kind::Store, exactly(1 + i.listed()));
    }
    if name.starts_with("ldr") {
        return (Kind::Load, exactly(2));
    }
    if name.starts_with("str") {
        return (Kind::Store, exactly(2));
    }
    if name.starts_with("mul") {
        return (Kind::Multiply, exactly(1));
    }
    let waits = starts(name, &["mrs", "msr", "dmb", "dsb", "isb"]);
    let cycles = if waits {
        4
    } else if taken {
        3
    } else {
        1
    };
    (Kind::Integer, exactly(cycles))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn instruction(mnemonic: &str, operands: &str) -> Instruction {
        Instruction {
            mnemonic: mnemonic.to_owned(),
            operands: operands.to_owned(),
            next: 4,
        }
    }

    /// Of instructions that follow one another.
    fn straight(processor: Processor, all: &[(&str, &str)]) -> (u32, u32) {
        let mut counter = Counter::new(processor);
        for (mnemonic, operands) in all {
            counter.add(&instruction(mnemonic, operands), 4);
        }
        (counter.total().low, counter.total().high)
    }

    #[test]
    fn a_processor_each() {
        use Processor::{CortexM0, CortexM3, CortexM4F};
        let product = [("smull", "r0, r1, r2, r3")];
        assert_eq!(straight(CortexM3, &product), (3, 5));
        assert_eq!(straight(CortexM4F, &product), (1, 1));
        let saved = [("push", "{r4, r5, lr}")];
        for processor in [CortexM0, CortexM3, CortexM4F] {
            assert_eq!(straight(processor, &saved), (4, 4));
        }
        assert_eq!(straight(CortexM4F, &[("vpush", "{d8-d9}")]), (5, 5));
    }

    #[test]
    fn a_branch_that_is_taken_refills() {
        let branch = instruction("bne", "400");
        let of = |processor, then| Counter::new(processor).add(&branch, then).1;
        assert_eq!(of(Processor::CortexM4F, 4), exactly(1));
        assert_eq!(of(Processor::CortexM4F, 0x400), Cycles { low: 2, high: 4 });
        assert_eq!(of(Processor::CortexM0, 0x400), exactly(3));
        let bits = instruction("bics", "r0, r1");
        assert_eq!(
            Counter::new(Processor::CortexM0).add(&bits, 4).0,
            Kind::Integer
        );
    }

    #[test]
    fn neighbours_matter() {
        use Processor::CortexM4F;
        let loads = [("ldr", "r0, [r1]"), ("ldr", "r2, [r1, #4]")];
        assert_eq!(straight(CortexM4F, &loads), (3, 4));
        let chain = [("vmul.f32", "s0, s1, s2"), ("vadd.f32", "s3, s0, s1")];
        assert_eq!(straight(CortexM4F, &chain), (3, 3));
        let apart = [("vmul.f32", "s0, s1, s2"), ("vadd.f32", "s3, s4, s1")];
        assert_eq!(straight(CortexM4F, &apart), (2, 2));
        // A quotient beside three integers, then waited for: as long as alone.
        let quotient = ("vdiv.f32", "s0, s1, s2");
        let integer = ("adds", "r0, r0, #1");
        let waited = [quotient, integer, integer, integer, ("vneg.f32", "s4, s5")];
        assert_eq!(straight(CortexM4F, &waited), (15, 18));
    }

    #[test]
    fn what_is_not_done_takes_one() {
        use Processor::CortexM4F;
        assert_eq!(straight(CortexM4F, &[("ldrne", "r0, [r1]")]), (1, 2));
        assert_eq!(straight(CortexM4F, &[("vmls.f32", "s0, s1, s2")]), (3, 3));
        assert_eq!(straight(CortexM4F, &[("ldr", "r0, [r1]")]), (2, 2));
        assert_eq!(straight(CortexM4F, &[("itt", "ne")]), (0, 1));
    }
}
