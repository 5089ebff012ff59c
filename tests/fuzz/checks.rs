//! What must hold for any bytes at all: shared by the fuzz targets and by `tests/corpus.rs`, which
//! runs the corpus in plain `cargo test`.

use tessim::error::Result;
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
