//! Messages over the serial line between host and the image in the loop.
//!
//! The emulated port takes the host some ten microseconds a byte, so that bytes set the pace of the loop. Both ends
//! guess the next message from what they already have, and only the words that differ from the guess go over
//! the line, behind a bit for each.

use crate::wire::{
    COMMAND_BYTES, CONFIG_BYTES, CommandBits, SAMPLE_BYTES, SampleBits, command_of, put_command,
    put_sample, sample_of,
};

/// First byte of a message to the image in the loop: a configuration follows, answered by [`READY`] or
/// [`REFUSED`]. Both ends guess anew from here.
pub const CONFIGURE: u8 = b'C';
/// A [`Packed`] sample follows, answered by a packed command.
pub const TICK: u8 = b'T';
/// The image ends, without an answer.
pub const QUIT: u8 = b'Q';
/// The configuration is valid; the supervisor is new.
pub const READY: u8 = b'R';
/// The configuration is not valid.
pub const REFUSED: u8 = b'X';

/// Words of a sample, and of a command with mode and hint in the last.
const WORDS: usize = 9;
/// Bytes of the bits that say which words follow.
pub const MAP_BYTES: usize = 2;
/// Longest packed sample or command.
pub const LONGEST: usize = MAP_BYTES + 4 * WORDS;
/// Bytes of a message with a configuration.
pub const CONFIGURE_BYTES: usize = 1 + CONFIG_BYTES;

const _: () = assert!(SAMPLE_BYTES == 4 * WORDS && COMMAND_BYTES <= 4 * WORDS);

type Words = [u32; WORDS];

fn words_of(bytes: &[u8]) -> Words {
    let mut words = [0; WORDS];
    for (word, bytes) in words.iter_mut().zip(bytes.chunks(4)) {
        let mut whole = [0; 4];
        for (to, from) in whole.iter_mut().zip(bytes) {
            *to = *from;
        }
        *word = u32::from_le_bytes(whole);
    }
    words
}

fn put_words(words: &Words, bytes: &mut [u8]) {
    for (to, from) in bytes
        .iter_mut()
        .zip(words.iter().flat_map(|w| w.to_le_bytes()))
    {
        *to = from;
    }
}

fn words_of_sample(sample: &SampleBits) -> Words {
    let mut bytes = [0; SAMPLE_BYTES];
    put_sample(sample, &mut bytes);
    words_of(&bytes)
}

fn words_of_command(command: &CommandBits) -> Words {
    let mut bytes = [0; COMMAND_BYTES];
    put_command(command, &mut bytes);
    words_of(&bytes)
}

/// Words that differ from a guess, behind a bit for each of all words.
#[derive(Debug, Clone, Copy)]
pub struct Packed {
    bytes: [u8; LONGEST],
    length: usize,
}

impl Packed {
    fn of(words: &Words, guess: &Words) -> Self {
        let mut packed = Self {
            bytes: [0; LONGEST],
            length: MAP_BYTES,
        };
        let mut map = 0_u16;
        for (i, (word, guess)) in words.iter().zip(guess).enumerate() {
            if word != guess {
                map |= 1 << i;
                packed.put(packed.length, &word.to_le_bytes());
                packed.length += 4;
            }
        }
        packed.put(0, &map.to_le_bytes());
        packed
    }

    fn put(&mut self, place: usize, bytes: &[u8]) {
        for (to, from) in self.bytes.iter_mut().skip(place).zip(bytes) {
            *to = *from;
        }
    }

    /// What goes over the line.
    pub fn bytes(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or(&[])
    }
}

/// How many bytes follow the map; more than there are words, if it is none.
pub fn rest_of(map: [u8; MAP_BYTES]) -> usize {
    4 * u16::from_le_bytes(map).count_ones() as usize
}

/// The words of a packed message, as far as they have come.
fn unpacked(bytes: &[u8], guess: &Words) -> Words {
    let mut words = *guess;
    let Some((map, mut rest)) = bytes.split_first_chunk::<MAP_BYTES>() else {
        return words;
    };
    let map = u16::from_le_bytes(*map);
    for (i, word) in words.iter_mut().enumerate() {
        if map & (1 << i) != 0
            && let Some((bytes, behind)) = rest.split_first_chunk()
        {
            *word = u32::from_le_bytes(*bytes);
            rest = behind;
        }
    }
    words
}

/// What both ends know of the line: the last sample and command.
#[derive(Debug, Clone, Copy, Default)]
pub struct Line {
    sample: SampleBits,
    command: CommandBits,
}

impl Line {
    /// A sample like the last one, a tick later.
    fn next_sample(&self) -> Words {
        words_of_sample(&SampleBits {
            sequence: self.sample.sequence.wrapping_add(1),
            ..self.sample
        })
    }

    /// The controller's force, or what the supervisor has made of it: one force either way, and else what was.
    fn next_command(&self, own: [u32; 2]) -> Words {
        words_of_command(&CommandBits {
            force: own,
            own: self.sample.levitation,
            ..self.command
        })
    }

    /// Packs a sample and remembers it.
    pub fn pack_sample(&mut self, sample: &SampleBits) -> Packed {
        let packed = Packed::of(&words_of_sample(sample), &self.next_sample());
        self.sample = *sample;
        packed
    }

    /// The sample of a packed one; remembers it.
    pub fn sample(&mut self, bytes: &[u8]) -> SampleBits {
        let mut whole = [0; SAMPLE_BYTES];
        put_words(&unpacked(bytes, &self.next_sample()), &mut whole);
        self.sample = sample_of(&whole);
        self.sample
    }

    /// Packs the command to the last sample and remembers it.
    pub fn pack_command(&mut self, command: &CommandBits) -> Packed {
        let packed = Packed::of(&words_of_command(command), &self.next_command(command.own));
        self.command = *command;
        packed
    }

    /// The command of a packed one; remembers it. `None` where it is none.
    pub fn command(&mut self, bytes: &[u8]) -> Option<CommandBits> {
        let mut whole = [0; COMMAND_BYTES];
        // The force is guessed from the supervisor's own, which has to be known for that.
        put_words(&unpacked(bytes, &self.next_command([0; 2])), &mut whole);
        let own = command_of(&whole)?.own;
        put_words(&unpacked(bytes, &self.next_command(own)), &mut whole);
        self.command = command_of(&whole)?;
        Some(self.command)
    }
}
