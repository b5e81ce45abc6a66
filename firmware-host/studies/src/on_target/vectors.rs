//! Streams as text, for a port to a processor that Rust has no target for: inputs of a supervisor and what it has to command.

use super::record::Stream;
use firmware_image::wire::{command_of, sample_of};
use std::io::{self, BufWriter, Write};
use supervisor::PARAMETERS;

/// Columns of a tick: first the supervisor's inputs; from `force_x` on what it has to command.
pub(crate) const TICK_COLUMNS: [&str; 19] = [
    "piece",
    "sequence",
    "status",
    "position_x",
    "position_y",
    "spin",
    "levitation_x",
    "levitation_y",
    "applied_x",
    "applied_y",
    "force_x",
    "force_y",
    "own_x",
    "own_y",
    "severity",
    "mode",
    "limits",
    "events",
    "integrator",
];

/// A row of words in hexadecimal, behind the number of the piece.
fn row(to: &mut impl Write, piece: usize, words: &[u32]) -> io::Result<()> {
    write!(to, "{piece}")?;
    for word in words {
        write!(to, ",{word:08x}")?;
    }
    writeln!(to)
}

impl Stream {
    /// Writes the configuration of each piece, a row each: number of the piece, how many ticks it has, and the bits of its
    /// parameters.
    ///
    /// # Errors
    /// Of writing.
    pub fn write_configurations(&self, to: impl Write) -> io::Result<()> {
        let mut to = BufWriter::new(to);
        let names: Vec<_> = PARAMETERS.iter().map(|p| p.name).collect();
        writeln!(to, "piece,ticks,{}", names.join(","))?;
        for (i, piece) in self.pieces.iter().enumerate() {
            let mut words = vec![piece.ticks.len() as u32];
            words.extend(piece.config.values().map(f32::to_bits));
            row(&mut to, i, &words)?;
        }
        to.flush()
    }

    /// Writes its ticks, a row of `TICK_COLUMNS` each.
    ///
    /// # Errors
    /// Of writing.
    pub fn write_ticks(&self, to: impl Write) -> io::Result<()> {
        let mut to = BufWriter::new(to);
        writeln!(to, "{}", TICK_COLUMNS.join(","))?;
        for (i, piece) in self.pieces.iter().enumerate() {
            for tick in &piece.ticks {
                let sample = sample_of(&tick.sample);
                // Bytes that a command was turned into are one.
                let Some(command) = command_of(&tick.command) else {
                    continue;
                };
                let words = [
                    sample.sequence,
                    sample.status.bits(),
                    sample.position[0],
                    sample.position[1],
                    sample.spin,
                    sample.levitation[0],
                    sample.levitation[1],
                    sample.applied[0],
                    sample.applied[1],
                    command.force[0],
                    command.force[1],
                    command.own[0],
                    command.own[1],
                    command.severity,
                    command.mode as u32,
                    command.limits.bits(),
                    command.events.bits(),
                    command.integrator as u32,
                ];
                row(&mut to, i, &words)?;
            }
        }
        to.flush()
    }
}
