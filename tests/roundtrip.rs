//! What the writers write, the readers read: the same commands, to the bit, for random traces, in
//! either form and from one to the other; and one frame of a trace is the same however it is found.

#[path = "support/commands.rs"]
mod commands;

use commands::trace;
use proptest::prelude::*;
use std::io::{BufReader, Cursor};
use tessim::error::Result;
use tessim::trace::command::Command;
use tessim::trace::open::Trace;
use tessim::trace::read::{Located, Reader};
use tessim::trace::{binary, write};

fn text(commands: &[Command]) -> Vec<u8> {
    let mut writer = write::Writer::new(Vec::new());
    for command in commands {
        writer.write(command).expect("memory takes all");
    }
    writer.into_inner()
}

fn blocks(commands: &[Command]) -> Vec<u8> {
    let mut writer = binary::write::Writer::new(Vec::new()).expect("a compressor");
    for command in commands {
        writer.write(command).expect("memory takes all");
    }
    writer.into_inner()
}

fn all(located: impl Iterator<Item = Result<Located>>) -> Vec<Command> {
    let commands: Result<_> = located.map(|c| c.map(|c| c.command)).collect();
    commands.expect("what is written is well-formed")
}

fn read_text(bytes: &[u8]) -> Vec<Command> {
    all(Reader::new(bytes, "t", "."))
}

fn read_blocks(bytes: &[u8]) -> Vec<Command> {
    all(binary::read::Reader::new(bytes, "t", "."))
}

/// The same to the bit: equality takes -0 for 0, what is shown does not.
fn same(read: &[Command], commands: &[Command]) -> Result<(), TestCaseError> {
    prop_assert_eq!(read.len(), commands.len());
    prop_assert_eq!(read, commands);
    prop_assert_eq!(format!("{read:?}"), format!("{commands:?}"));
    Ok(())
}

proptest! {
    #[test]
    fn reading_undoes_writing(commands in trace()) {
        same(&read_text(&text(&commands)), &commands)?;
    }

    #[test]
    fn reading_blocks_undoes_writing_them(commands in trace()) {
        let bytes = blocks(&commands);
        same(&read_blocks(&bytes), &commands)?;
        prop_assert_eq!(blocks(&commands), bytes, "the same commands make the same bytes");
    }

    #[test]
    fn text_survives_the_binary_form_and_the_other_way_round(commands in trace()) {
        let (text_before, blocks_before) = (text(&commands), blocks(&commands));
        let through = text(&read_blocks(&blocks(&read_text(&text_before))));
        prop_assert_eq!(through, text_before);
        let through = blocks(&read_text(&text(&read_blocks(&blocks_before))));
        prop_assert_eq!(through, blocks_before);
    }

    #[test]
    fn a_frame_found_by_the_index_is_the_frame_picked_from_the_whole(commands in trace()) {
        let folder = tempfile::tempdir().expect("a folder");
        let (written, bytes) = (folder.path().join("t"), blocks(&commands));
        std::fs::write(&written, text(&commands)).expect("a file");
        let frames = commands.iter().filter(|c| matches!(c, Command::Frame(_))).count() as u64;
        for frame in 0..frames {
            let sought = binary::seek::FrameReader::new(Cursor::new(&bytes), "t", ".", frame);
            let sought = all(sought.expect("there is such a frame"));
            let picked = all(Trace::open_frame(&written, frame).expect("a file"));
            same(&sought, &picked)?;
            // It is a trace of its own, too.
            same(&read_text(&text(&sought)), &picked)?;
        }
        let none = binary::seek::FrameReader::new(Cursor::new(&bytes), "t", ".", frames);
        prop_assert!(none.err().is_some_and(|e| e.to_string().contains("no such frame")));
    }
}

#[test]
fn either_form_is_told_from_its_content() {
    let path = "traces/mesh.jsonl";
    let commands = all(Trace::open(path).expect("a shipped trace"));
    let folder = tempfile::tempdir().expect("a folder");
    let misnamed = folder.path().join("binary.jsonl");
    let bytes = blocks(&commands);
    std::fs::write(&misnamed, &bytes).expect("a file");
    let mut trace = Trace::open(&misnamed).expect("a file");
    assert_eq!(all(trace.by_ref()), commands);
    let mut one = Trace::open_frame(&misnamed, 1).expect("a file");
    assert!(one.by_ref().all(|located| located.is_ok()));
    assert_eq!(one.hash(), trace.hash(), "a trace has one hash, however it is read");
    let stream = Trace::new(BufReader::new(Cursor::new(bytes)), "-", ".").expect("memory");
    assert_eq!(all(stream), commands);
}
