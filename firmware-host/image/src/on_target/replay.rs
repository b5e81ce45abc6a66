//! Replays a recorded stream and compares each command, bit for bit, with the one of the host.
//! Reads `stream.bin`; prints `number`, `ticks`, `bit_exact_ticks`, `hash`, and `read_outs`: the hash over what
//! each supervisor leaves behind.

use super::{checked, exit, file, planted, report};
use crate::under_test::UnderTest;
use crate::wire::{self, COMMAND_BYTES, Hash, TICK_BYTES};

/// Ticks that are read at once: small enough for a small machine.
const CHUNK: usize = 16;

/// The whole image.
pub fn run<U: UnderTest>() -> ! {
    planted();
    report::text("number", U::NUMBER);
    let Some(mut stream) = file::File::read(c"stream.bin") else {
        report::failed("stream.bin cannot be read")
    };
    let Some(header) = stream.next_bytes().and_then(|b| wire::header_of(&b)) else {
        report::failed("stream.bin is no stream of this version")
    };
    let (mut ticks, mut exact) = (0_u32, 0_u32);
    let (mut hash, mut read_outs) = (Hash::default(), Hash::default());
    for _ in 0..header.segments {
        let Some(segment) = stream.next_bytes().and_then(|b| wire::segment_of(&b)) else {
            report::failed("stream.bin ends before its last segment")
        };
        let Some(mut supervisor) = U::new(&segment.config) else {
            report::failed("a configuration is not valid")
        };
        checked(&mut supervisor);
        let mut left = segment.ticks as usize;
        while left > 0 {
            let mut chunk = [[0; TICK_BYTES]; CHUNK];
            let now = left.min(CHUNK);
            let whole = chunk.as_flattened_mut();
            if !whole
                .get_mut(..now * TICK_BYTES)
                .is_some_and(|bytes| stream.fill(bytes))
            {
                report::failed("stream.bin ends within a segment")
            }
            for tick in chunk.iter().take(now) {
                let Some((sample, expected)) = tick.split_first_chunk() else {
                    break;
                };
                let sample = U::sample(&wire::sample_of(sample));
                let command = U::TICK(&mut supervisor, &sample);
                let mut bytes = [0; COMMAND_BYTES];
                wire::encode_command(&U::bits(&command), &mut bytes);
                hash.add(&bytes);
                ticks += 1;
                exact += u32::from(bytes == expected);
            }
            left -= now;
        }
        supervisor.read_out(&mut read_outs);
    }
    report::number("ticks", ticks);
    report::number("bit_exact_ticks", exact);
    report::bits("hash", hash.0);
    report::bits("read_outs", read_outs.0);
    exit::success()
}
