//! What goes between the host and a controller: numbers, little-endian, one after the other.

use std::io::{self, ErrorKind, Read};

/// First word of a [`Setup`]; its last byte is the version of these frames.
const MAGIC: u32 = u32::from_le_bytes(*b"AMC\x01");
/// Most sensors, magnets and parameters that are believed.
const MOST: u32 = 1 << 16;
/// Longest text that is believed.
const LONGEST_TEXT: usize = 1 << 20;

/// What a controller is given before the first sample.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Setup {
    /// From one sample to the next \[s\].
    pub period_s: f64,
    /// Position sensors, one a plane.
    pub sensors: u32,
    /// The sensor in whose plane each magnet is.
    pub magnet_plane: Vec<u32>,
    /// Cap of each magnet \[N\].
    pub force_max_n: Vec<f64>,
    /// `controller.parameters` of the scene.
    pub parameters: Vec<f64>,
}

/// What is asked at a control sample.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Question {
    /// Time \[s\].
    pub t_s: f64,
    /// Spin as reported \[rad/s\].
    pub spin_rad_s: f64,
    /// Whether integrators are to stand.
    pub hold: bool,
    /// Number of each sensor's reading; one that did not come has the number of the last.
    pub sequence: Vec<u32>,
    /// x and y of each sensor, one after the other \[m\].
    pub position_m: Vec<f64>,
}

/// What a controller answers.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// x and y of each magnet, one after the other \[N\]; none to a [`Setup`].
    Forces(Vec<f64>),
    /// It cannot: why.
    Failed(String),
}

impl Setup {
    /// Forces of an answer.
    pub fn forces(&self) -> usize {
        2 * self.magnet_plane.len()
    }

    /// As bytes.
    pub fn bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let counts = [self.magnet_plane.len(), self.parameters.len()].map(|n| n as u32);
        push_words(&mut bytes, &[MAGIC, self.sensors]);
        push_words(&mut bytes, &counts);
        push_numbers(&mut bytes, &[self.period_s]);
        push_words(&mut bytes, &self.magnet_plane);
        push_numbers(&mut bytes, &self.force_max_n);
        push_numbers(&mut bytes, &self.parameters);
        bytes
    }

    /// From whoever sends them.
    ///
    /// # Errors
    /// What the system says, or [`ErrorKind::InvalidData`] for bytes that are no setup of this version.
    pub fn read(from: &mut impl Read) -> io::Result<Self> {
        let [magic, sensors, magnets, parameters] = words(from, 4)?[..] else {
            return Err(ErrorKind::InvalidData.into());
        };
        if magic != MAGIC || [sensors, magnets, parameters].iter().any(|n| *n > MOST) {
            return Err(ErrorKind::InvalidData.into());
        }
        Ok(Self {
            sensors,
            period_s: numbers(from, 1)?.first().copied().unwrap_or_default(),
            magnet_plane: words(from, magnets as usize)?,
            force_max_n: numbers(from, magnets as usize)?,
            parameters: numbers(from, parameters as usize)?,
        })
    }
}

impl Question {
    /// Encoded, in the place of what is in `bytes`.
    pub fn encode(&self, bytes: &mut Vec<u8>) {
        bytes.clear();
        push_numbers(bytes, &[self.t_s, self.spin_rad_s]);
        push_words(bytes, &[u32::from(self.hold)]);
        push_words(bytes, &self.sequence);
        push_numbers(bytes, &self.position_m);
    }

    /// From whoever sends it, for so many sensors; `None` where nobody does any more.
    ///
    /// # Errors
    /// What the system says.
    pub fn read(from: &mut impl Read, sensors: u32) -> io::Result<Option<Self>> {
        let sensors = sensors as usize;
        let mut bytes = vec![0; 20 + 20 * sensors];
        match from.read_exact(&mut bytes) {
            Ok(()) => {}
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(None),
            Err(error) => return Err(error),
        }
        let from = &mut &bytes[..];
        let t_and_spin = numbers(from, 2)?;
        let hold = words(from, 1)?;
        Ok(Some(Self {
            t_s: t_and_spin.first().copied().unwrap_or_default(),
            spin_rad_s: t_and_spin.last().copied().unwrap_or_default(),
            hold: hold.first().is_some_and(|word| *word != 0),
            sequence: words(from, sensors)?,
            position_m: numbers(from, 2 * sensors)?,
        }))
    }
}

impl Answer {
    /// As bytes.
    pub fn bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        match self {
            Self::Forces(forces_n) => {
                push_words(&mut bytes, &[0, 8 * forces_n.len() as u32]);
                push_numbers(&mut bytes, forces_n);
            }
            Self::Failed(text) => {
                push_words(&mut bytes, &[1, text.len() as u32]);
                bytes.extend_from_slice(text.as_bytes());
            }
        }
        bytes
    }

    /// From whoever sends it.
    ///
    /// # Errors
    /// What the system says, or [`ErrorKind::InvalidData`] for bytes that are no answer.
    pub fn read(from: &mut impl Read) -> io::Result<Self> {
        let [kind, length] = words(from, 2)?[..] else {
            return Err(ErrorKind::InvalidData.into());
        };
        let length = length as usize;
        match kind {
            0 if length.is_multiple_of(8) && length <= LONGEST_TEXT => {
                Ok(Self::Forces(numbers(from, length / 8)?))
            }
            1 if length <= LONGEST_TEXT => {
                let mut text = vec![0; length];
                from.read_exact(&mut text)?;
                Ok(Self::Failed(String::from_utf8_lossy(&text).into_owned()))
            }
            _ => Err(ErrorKind::InvalidData.into()),
        }
    }
}

fn push_words(bytes: &mut Vec<u8>, words: &[u32]) {
    bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
}

fn push_numbers(bytes: &mut Vec<u8>, numbers: &[f64]) {
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
}

fn words(from: &mut impl Read, count: usize) -> io::Result<Vec<u32>> {
    let mut bytes = vec![0; 4 * count];
    from.read_exact(&mut bytes)?;
    let (words, _) = bytes.as_chunks();
    Ok(words.iter().map(|word| u32::from_le_bytes(*word)).collect())
}

fn numbers(from: &mut impl Read, count: usize) -> io::Result<Vec<f64>> {
    let mut bytes = vec![0; 8 * count];
    from.read_exact(&mut bytes)?;
    let (numbers, _) = bytes.as_chunks();
    Ok((numbers.iter())
        .map(|number| f64::from_le_bytes(*number))
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_sent_arrives() {
        let setup = Setup {
            period_s: 5e-5,
            sensors: 3,
            magnet_plane: vec![0, 2],
            force_max_n: vec![600.0, 500.0],
            parameters: vec![1.0, -2.0, 3.5],
        };
        assert_eq!(Setup::read(&mut &setup.bytes()[..]).unwrap(), setup);
        let question = Question {
            t_s: 0.25,
            spin_rad_s: -7.0,
            hold: true,
            sequence: vec![1, 2, 3],
            position_m: vec![1e-5, -0.0, 3.0, 4.0, 5.0, f64::MIN_POSITIVE],
        };
        let mut bytes = vec![9; 3];
        question.encode(&mut bytes);
        let stream = &mut &bytes[..];
        assert_eq!(Question::read(stream, 3).unwrap(), Some(question));
        assert_eq!(Question::read(stream, 3).unwrap(), None);
        for answer in [
            Answer::Forces(vec![1.0, f64::INFINITY]),
            Answer::Forces(Vec::new()),
            Answer::Failed("why\n".to_owned()),
        ] {
            assert_eq!(Answer::read(&mut &answer.bytes()[..]).unwrap(), answer);
        }
    }

    #[test]
    fn other_bytes_are_refused() {
        let mut bytes = Setup::default().bytes();
        bytes[3] = 2;
        let error = Setup::read(&mut &bytes[..]).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidData);
        for answer in [[7, 0], [0, 9], [1, u32::MAX]] {
            let mut bytes = Vec::new();
            push_words(&mut bytes, &answer);
            let error = Answer::read(&mut &bytes[..]).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::InvalidData);
        }
    }
}
