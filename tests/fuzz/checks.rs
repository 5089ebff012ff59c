//! What must hold for any bytes at all: shared by the fuzz targets and by `tests/corpus.rs`, which
//! runs the corpus in plain `cargo test`.

use std::io::Cursor;
use tessim::error::{Error, Result};
use tessim::trace::binary;
use tessim::trace::command::Command;
use tessim::trace::import;
use tessim::trace::read::Reader;
use tessim::trace::write::Writer;

/// The commands of a trace. There is no such folder, so no bytes can name a file.
fn commands(bytes: &[u8]) -> Result<Vec<Command>> {
    Reader::new(bytes, "fuzz", "no/such/folder").map(|c| c.map(|c| c.command)).collect()
}

fn written(commands: &[Command]) -> Vec<u8> {
    let mut writer = Writer::new(Vec::new());
    for command in commands {
        writer.write(command).expect("memory takes all");
    }
    writer.into_inner()
}

/// A text trace is refused with its place, or it means the same when it is written and read again.
/// Says which.
pub(crate) fn read_text(bytes: &[u8]) -> bool {
    match commands(bytes) {
        Ok(all) => {
            let text = written(&all);
            let again = commands(&text).expect("what was written is well-formed");
            assert_eq!(all, again);
            assert!(written(&again) == text, "the sign of a zero is lost");
            true
        }
        Err(error) => {
            let message = error.to_string();
            assert!(message.starts_with("fuzz:"), "no place: {message}");
            assert!(message.chars().count() < 2000, "too long: {message}");
            false
        }
    }
}

/// A BPT file is refused with its place, or becomes a well-formed trace. Says which.
pub(crate) fn import_bpt(bytes: &[u8]) -> bool {
    let mut trace = Vec::new();
    match import::import_bpt(bytes, "fuzz", &mut trace) {
        Ok(()) => {
            commands(&trace).expect("what was imported is well-formed");
            true
        }
        Err(error) => {
            assert!(error.to_string().starts_with("fuzz:"), "no place: {error}");
            assert!(trace.is_empty(), "a refused file left output");
            false
        }
    }
}

/// The commands of a binary trace.
fn blocks(bytes: &[u8]) -> Result<Vec<Command>> {
    let reader = binary::read::Reader::new(bytes, "fuzz", "no/such/folder");
    reader.map(|c| c.map(|c| c.command)).collect()
}

/// An error of a binary trace says where it is.
fn located(error: &Error) {
    let message = error.to_string();
    assert!(message.starts_with("fuzz: byte "), "no place: {message}");
    assert!(message.chars().count() < 2000, "too long: {message}");
}

/// A binary trace is refused with its place, or it means the same when it is written and read again,
/// in either form, and any of its frames can be read alone. Bytes that do not begin like one are
/// taken for the content of a block, which is wrapped in right checksums. Says whether it was
/// accepted.
pub(crate) fn read_binary(bytes: &[u8]) -> bool {
    if binary::is_binary(bytes) {
        return read_file(bytes);
    }
    match binary::write::file_of(bytes) {
        Ok(file) => read_file(&file),
        Err(_) => false, // nothing, or more than a block holds
    }
}

fn read_file(file: &[u8]) -> bool {
    let read = blocks(file);
    for frame in 0..3 {
        let input = Cursor::new(file);
        let one = binary::seek::FrameReader::new(input, "fuzz", "no/such/folder", frame);
        let one: Result<Vec<_>> = one.and_then(Iterator::collect);
        match (&read, one) {
            (Ok(all), Err(error)) => {
                let frames = all.iter().filter(|c| matches!(c, Command::Frame(_))).count() as u64;
                assert!(frame >= frames, "frame {frame} of {frames}: {error}");
            }
            (Ok(_), Ok(one)) => assert!(one.len() >= 3, "header, frame, end"),
            (Err(_), Err(error)) if matches!(error, Error::Input { .. }) => located(&error),
            (Err(_), _) => {} // what is wrong is in another frame
        }
    }
    match read {
        Ok(all) => {
            let mut writer = binary::write::Writer::new(Vec::new()).expect("a compressor");
            for command in &all {
                writer.write(command).expect("what was read fits a block");
            }
            let again = blocks(&writer.into_inner()).expect("what was written is well-formed");
            let text = written(&all);
            assert!(written(&again) == text, "the binary form changes a command");
            let through = commands(&text).expect("what the binary form says, the text can say");
            assert!(written(&through) == text, "the text form changes a command");
            true
        }
        Err(error) => {
            located(&error);
            false
        }
    }
}
