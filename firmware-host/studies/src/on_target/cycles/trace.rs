//! The path of every instruction through some ticks, as the emulator logs it.

use super::disassembly::{Instruction, OBJDUMP, disassemble};
use crate::on_target::emulator::{EmulatorError, Running, Time};
use crate::on_target::images::Project;
use crate::on_target::machines::Machine;
use crate::on_target::measure::SHIFT;
use object::{Object, ObjectSymbol};
use std::collections::{HashMap, HashSet};
use std::io::{self, BufRead, BufReader};
use std::ops::Range;
use std::path::Path;
use std::process::Stdio;
use std::sync::mpsc;
use std::time::Duration;

/// Why there is no trace.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum TraceError {
    /// The disassembler.
    #[error("{OBJDUMP}: {0}")]
    #[diagnostic(help("apt-get install gcc-arm-none-eabi, which brings it"))]
    Disassembler(io::Error),
    /// The image.
    #[error("{image} cannot be read: {reason}")]
    Image {
        /// File.
        image: String,
        /// What is wrong.
        reason: String,
    },
    /// The emulator.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Emulator(#[from] EmulatorError),
    /// The path and the image do not fit.
    #[error("the emulator was at {address:#x}, where {image} has no instruction")]
    NoInstruction {
        /// Where.
        address: u32,
        /// File.
        image: String,
    },
}

/// A tick: addresses of its instructions in the order in which they were executed.
pub(super) type Path32 = Vec<u32>;

/// An image and its paths.
#[derive(Debug)]
pub(super) struct Traced {
    instructions: HashMap<u32, Instruction>,
    image: String,
    /// Of each tick.
    pub(super) ticks: Vec<Path32>,
}

impl Traced {
    /// The instruction at an address.
    pub(super) fn at(&self, address: u32) -> Result<&Instruction, TraceError> {
        (self.instructions.get(&address)).ok_or_else(|| TraceError::NoInstruction {
            address,
            image: self.image.clone(),
        })
    }
}

/// Runs the image `count` of a machine over the stream in a folder, one instruction at a time.
pub(super) fn trace(
    project: &Project,
    machine: &Machine,
    folder: &Path,
    limit: Duration,
) -> Result<Traced, TraceError> {
    let file = project.image(machine, &machine.number.image("count"));
    let image = file.display().to_string();
    let instructions = disassemble(&file).map_err(TraceError::Disassembler)?;
    let functions = Functions::of(&file, &instructions).map_err(|reason| TraceError::Image {
        image: image.clone(),
        reason,
    })?;
    // Each instruction is a block of its own, and each block is logged.
    let logging = ["-singlestep", "-d", "exec,nochain"];
    let time = Time::Counted { shift: SHIFT };
    let mut running = Running::start_with(machine, &file, folder, time, Stdio::null(), &logging)?;
    let late = || EmulatorError::Late {
        image: image.clone(),
        machine: machine.name,
        limit,
    };
    let log = running.log().ok_or_else(late)?;
    let (sender, received) = mpsc::channel();
    // It ends with the emulator, which is stopped when `running` is dropped.
    std::thread::spawn(move || sender.send(ticks_in(BufReader::new(log), &functions)));
    let (ticks, said) = received.recv_timeout(limit).map_err(|_| late())?;
    let ended = running.wait(limit).ok_or_else(late)?;
    if !ended.well {
        return Err(TraceError::Emulator(EmulatorError::Failed {
            image,
            machine: machine.name,
            said: format!("{}{said}", ended.said()),
        }));
    }
    Ok(Traced {
        instructions,
        image,
        ticks,
    })
}

/// Where an image times what it calls.
#[derive(Debug)]
struct Functions {
    /// Between two looks at the clock.
    timing: Vec<Range<u32>>,
    /// Calls there.
    calls: HashSet<u32>,
    /// What is called that is no tick.
    idle: Vec<Range<u32>>,
}

impl Functions {
    fn of(image: &Path, instructions: &HashMap<u32, Instruction>) -> Result<Self, String> {
        let bytes = std::fs::read(image).map_err(|e| e.to_string())?;
        let file = object::File::parse(bytes.as_slice()).map_err(|e| e.to_string())?;
        let named = |names: &[&str]| -> Vec<Range<u32>> {
            let is_named = |symbol: &str| names.iter().any(|name| symbol.contains(name));
            let symbols = file.symbols().filter(|s| s.name().is_ok_and(is_named));
            // The lowest bit says that it is Thumb.
            let begin = |address: u64| address as u32 & !1;
            symbols
                .map(|s| begin(s.address())..begin(s.address()) + s.size() as u32)
                .collect()
        };
        let timing = named(&["5count7between"]);
        let in_timing = |address: &u32| timing.iter().any(|f| f.contains(address));
        let calls: HashSet<u32> = (instructions.iter())
            .filter(|(address, i)| i.mnemonic == "blx" && in_timing(address))
            .map(|(address, _)| *address)
            .collect();
        if calls.is_empty() {
            return Err("it has no function `between` that calls what it times".to_owned());
        }
        Ok(Self {
            timing,
            calls,
            idle: named(&["counted_nothing", "5count5turns"]),
        })
    }
}

/// What `between` has called, but for what is no tick, and what else the emulator said.
fn ticks_in(log: impl BufRead, functions: &Functions) -> (Vec<Path32>, String) {
    let within = |all: &[Range<u32>], address: u32| all.iter().any(|f| f.contains(&address));
    let (mut ticks, mut said) = (Vec::new(), String::new());
    // That of what is being timed.
    let mut path: Option<Path32> = None;
    for line in log.lines().map_while(Result::ok) {
        let Some(address) = executed(&line) else {
            said.push_str(&line);
            said.push('\n');
            continue;
        };
        if let Some(begun) = &mut path {
            if within(&functions.timing, address) {
                let idle = begun
                    .first()
                    .is_some_and(|first| within(&functions.idle, *first));
                ticks.extend(path.take().filter(|_| !idle));
            } else if begun.last() != Some(&address) {
                // What the emulator interrupts for its own work is logged again when it goes on; nothing in a tick jumps
                // to itself.
                begun.push(address);
            }
        } else if functions.calls.contains(&address) {
            path = Some(Path32::new());
        }
    }
    (ticks, said)
}

/// `Trace 0: 0x7f6c340000c0 [00000000/000004fc/00000110/ff000201] `: the second of the four.
fn executed(line: &str) -> Option<u32> {
    let (_, fields) = line.strip_prefix("Trace ")?.split_once('[')?;
    u32::from_str_radix(fields.split('/').nth(1)?, 16).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_timed_and_no_tick_is_left_out() {
        let functions = Functions {
            timing: std::iter::once(0x100..0x110).collect(),
            calls: [0x104].into(),
            idle: std::iter::once(0x200..0x202).collect(),
        };
        let addresses = [
            0x80, 0x100, 0x104, 0x200, 0x106, 0x82, // an empty call
            0x100, 0x104, 0x300, 0x302, 0x302, 0x106, 0x84, // a tick, interrupted
        ];
        let log: String = (addresses.iter())
            .map(|a| format!("Trace 0: 0x7f6c340000c0 [00000000/{a:08x}/00000110/ff000201] \n"))
            .chain(["qemu: said something\n".to_owned()])
            .collect();
        let (ticks, said) = ticks_in(log.as_bytes(), &functions);
        assert_eq!(ticks, [vec![0x300, 0x302]]);
        assert_eq!(said, "qemu: said something\n");
    }
}
