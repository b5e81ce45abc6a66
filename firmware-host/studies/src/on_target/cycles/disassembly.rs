//! Instructions of an image by address, as the disassembler of GNU binutils writes them.

use std::collections::HashMap;
use std::io;
use std::path::Path;
use std::process::Command;

/// Comes with the C compiler that the tests use, and knows every extension of these processors.
pub(super) const OBJDUMP: &str = "arm-none-eabi-objdump";

/// An instruction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Instruction {
    /// Mnemonic without a suffix of width, e.g. `vmla.f32`, `ldrne`.
    pub(super) mnemonic: String,
    /// Operands as text.
    pub(super) operands: String,
    /// Address of the one after it in the image.
    pub(super) next: u32,
}

impl Instruction {
    /// Registers in a list in braces.
    pub(super) fn listed(&self) -> u32 {
        let list = self
            .operands
            .split_once('{')
            .and_then(|(_, rest)| rest.split_once('}'));
        let Some((list, _)) = list else {
            return 1;
        };
        list.split(',').map(registers_of).sum()
    }

    /// The first operand, which most write to.
    pub(super) fn first(&self) -> &str {
        self.operands.split(',').next().unwrap_or("").trim()
    }

    /// Whether a register is one of the operands that are read, which for most are those after the first.
    pub(super) fn reads(&self, register: &str) -> bool {
        // What accumulates, compares and stores reads its first one too.
        let all = ["vml", "vnml", "vcmp", "vstr", "vfm"]
            .iter()
            .any(|m| self.mnemonic.starts_with(m));
        let skipped = usize::from(!all);
        let mut operands = self
            .operands
            .split([',', '[', ']', '{', '}', ' '])
            .filter(|o| !o.is_empty())
            .skip(skipped);
        operands.any(|o| o == register)
    }
}

/// Of `r4`, or of a span such as `s16-s19`.
fn registers_of(item: &str) -> u32 {
    let number = |name: &str| {
        name.trim()
            .trim_start_matches(|c: char| c.is_ascii_alphabetic())
            .parse::<u32>()
            .ok()
    };
    match item.split_once('-') {
        Some((from, to)) => match (number(from), number(to)) {
            (Some(from), Some(to)) => to.saturating_sub(from) + 1,
            _ => 1,
        },
        None => 1,
    }
}

/// All of an image, by address.
///
/// # Errors
/// Of starting the disassembler; not found if it is not installed.
pub(super) fn disassemble(image: &Path) -> io::Result<HashMap<u32, Instruction>> {
    let output = Command::new(OBJDUMP)
        .args(["-d", "--no-show-raw-insn"])
        .arg(image)
        .output()?;
    if !output.status.success() {
        return Err(io::Error::other(
            String::from_utf8_lossy(&output.stderr).into_owned(),
        ));
    }
    Ok(parse(&String::from_utf8_lossy(&output.stdout)))
}

fn parse(text: &str) -> HashMap<u32, Instruction> {
    let mut all: Vec<(u32, Instruction)> = text.lines().filter_map(line).collect();
    // An instruction ends where the next one begins; the last of a function is followed by data or another function.
    let mut after = u32::MAX;
    for (address, instruction) in all.iter_mut().rev() {
        instruction.next = after;
        after = *address;
    }
    all.into_iter().collect()
}

/// Address, mnemonic, operands and a remark, with tabs between them.
fn line(text: &str) -> Option<(u32, Instruction)> {
    let mut fields = text.split('\t');
    let address = fields.next()?.trim().strip_suffix(':')?;
    let address = u32::from_str_radix(address, 16).ok()?;
    let mnemonic = fields.next()?.trim();
    let mnemonic = mnemonic
        .strip_suffix(".w")
        .or_else(|| mnemonic.strip_suffix(".n"))
        .unwrap_or(mnemonic);
    let instruction = Instruction {
        mnemonic: mnemonic.to_owned(),
        operands: fields.next().unwrap_or("").trim().to_owned(),
        next: u32::MAX,
    };
    Some((address, instruction))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_a_listing() {
        let text = "00000780 <f>:\n     786:\tvstr\ts4, [sp, #480]\t@ 0x1e0\n     78a:\tldmia.w\tsp!, {r4, r5, r8-r11, pc}\n     78e:\tvmla.f32\ts0, s1, s2\n";
        let all = parse(text);
        assert_eq!(all.len(), 3);
        let store = &all[&0x786];
        assert_eq!((store.mnemonic.as_str(), store.next), ("vstr", 0x78a));
        assert!(store.reads("s4") && store.reads("sp") && !store.reads("s0"));
        let load = &all[&0x78a];
        assert_eq!((load.mnemonic.as_str(), load.listed()), ("ldmia", 7));
        let sum = &all[&0x78e];
        assert!(sum.reads("s0") && sum.reads("s2") && !sum.reads("s20"));
        assert_eq!(sum.first(), "s0");
    }
}
