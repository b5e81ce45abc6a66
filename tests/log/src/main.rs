//! Prints what an image has logged through `defmt`, a line each, its level first: `decode-log IMAGE < BYTES`.

use defmt_decoder::{DecodeError, Table};
use std::io::Read;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let image = std::env::args_os().nth(1).ok_or("which image?")?;
    let table = Table::parse(&std::fs::read(image)?)?.ok_or("the image does not log")?;
    let mut bytes = Vec::new();
    std::io::stdin().read_to_end(&mut bytes)?;
    let mut decoder = table.new_stream_decoder();
    decoder.received(&bytes);
    loop {
        match decoder.decode() {
            Ok(frame) => {
                let level = frame.level().map_or("", |level| level.as_str());
                println!("{level} {}", frame.display_message());
            }
            Err(DecodeError::UnexpectedEof) => return Ok(()),
            Err(DecodeError::Malformed) => return Err("no frame after these".into()),
        }
    }
}
